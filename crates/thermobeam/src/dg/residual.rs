//! The equations of a step, tested with every basis function and every L_i(t): their residuals.

use super::DgLevel;
use super::block::{Block, add_columns};
use super::space::Space;
use super::time::{Forcing, MAX_STAGES, Path, TimeForms};
use crate::contact::Phase;
use crate::lanes::fma;
use crate::parameters::{Beam, Obstacles};

/// u and φ in a block during the step, and the combinations of them in the equations.
#[derive(Debug, Clone, Copy)]
pub(super) struct BlockTerms<const S: usize> {
    /// u(t) and φ(t).
    pub(super) places: [Path<S>; 2],
    /// `∫ y_t L_i + (y(0+) - y_0) L_i(0)` of v, w, θ~.
    inertia: [[f64; S]; 3],
    /// `∫ (u + ζ v) L_i` and `∫ (φ + ζ w) L_i`.
    strain: [[f64; S]; 2],
    /// `∫ (u + ζ v + N(u) u) L_i`.
    tension: [f64; S],
    /// `a ∫ w L_i`.
    turning: [f64; S],
    /// `∫ θ~ L_i`.
    heat: [f64; S],
}

impl<const S: usize> BlockTerms<S> {
    pub(super) const ZERO: Self = Self {
        places: [Path {
            low: [0.0; S],
            top: 0.0,
        }; 2],
        inertia: [[0.0; S]; 3],
        strain: [[0.0; S]; 2],
        tension: [0.0; S],
        turning: [0.0; S],
        heat: [0.0; S],
    };
}

/// Moments of the axial force over a step, a matrix on polynomials in time: `∫ N(u) L_i L_j`.
#[derive(Debug, Clone, Copy)]
pub(super) struct AxialForce<const S: usize> {
    /// i, j <= q.
    pub(super) low: [[f64; S]; S],
    /// j = q + 1.
    pub(super) top: [f64; S],
}

/// The data of a step's equations.
pub(super) struct Equations<'a> {
    pub(super) space: &'a Space,
    pub(super) beam: &'a Beam,
    pub(super) obstacles: Option<&'a Obstacles>,
    /// The level at the start of the step.
    pub(super) level: &'a DgLevel,
    /// The step's length τ.
    pub(super) h: f64,
    /// The phase of the free end throughout the step.
    pub(super) phase: Phase,
}

impl Equations<'_> {
    /// `u(t) = u_0 + ∫ v`, `φ(t) = φ_0 + ∫ w` for the velocities in `x`.
    pub(super) fn displace<const S: usize>(&self, x: &[Block<S>], terms: &mut [BlockTerms<S>]) {
        for ((terms, x), places) in terms.iter_mut().zip(x).zip(&self.level.places) {
            for field in 0..2 {
                terms.places[field] = TimeForms::integrate(places[field], self.h, &x[field]);
            }
        }
    }

    /// `∫ N(u) L_i L_j` with `N(u) = β + ρ‖u_x‖²`, by 2q + 2 Gauss points.
    pub(super) fn axial_force<const S: usize>(
        &self,
        forms: &TimeForms<S>,
        terms: &[BlockTerms<S>],
    ) -> AxialForce<S> {
        let mut force = AxialForce {
            low: [[0.0; S]; S],
            top: [0.0; S],
        };
        if self.beam.rho == 0.0 {
            for i in 0..S {
                force.low[i][i] = self.beam.beta * forms.product[i];
            }
            return force;
        }
        let slopes = Gram::of(self.space, terms);
        for point in &forms.gauss {
            let legendre = &point.legendre;
            let weight = point.weight * self.beam.axial_force(slopes.at(legendre));
            for i in 0..S {
                for j in 0..S {
                    force.low[i][j] += weight * legendre[i] * legendre[j];
                }
                force.top[i] += weight * legendre[i] * legendre[S];
            }
        }
        force
    }

    /// The residuals of the three equations of a step, for the velocities and the temperature in
    /// `x`:
    ///
    /// ```text
    /// ∫ [(v_t, χ) + (u_x - φ + ζ(v_x - w), χ_x) + N(u)(u_x, χ_x) + g(u(1)) χ(1) - F_u] + (v(0+) - v_0, χ(0))
    /// ∫ [(w_t, ψ) + (φ_x + ζ w_x, ψ_x) - (u_x - φ + ζ(v_x - w), ψ) - a (θ~, ψ_x) - a θ_A (1, ψ) - F_φ] + (w(0+) - w_0, ψ(0))
    /// ∫ [(θ~_t, η) + (θ~_x, η_x) + a (w_x, η) - F_θ] + (θ~(0+) - θ~_0, η(0))
    /// ```
    ///
    /// * `forcing`: the loads, integrated over the step.
    ///
    /// Returns the contact force as the first equation at the free end requires it: the
    /// coefficients of L_0..L_q of its projection on polynomials in time, of which the first is its
    /// mean. Unlike g(u(1)) it contains no rounding errors of u(1) divided by ε.
    pub(super) fn residual<const S: usize>(
        &self,
        forms: &TimeForms<S>,
        forcing: Option<&Forcing<S>>,
        x: &[Block<S>],
        terms: &mut [BlockTerms<S>],
        axial: &AxialForce<S>,
        residual: &mut [Block<S>],
    ) -> [f64; S] {
        for ((terms, x), start) in terms.iter_mut().zip(x).zip(&self.level.rates) {
            self.combine(forms, x, start, axial, terms);
        }
        residual.fill([[0.0; S]; 3]);
        for (element, &length) in self.space.lengths.iter().enumerate() {
            let (m, k) = (0.5 * length, 2.0 / length);
            for c in &self.space.couplings {
                let terms = &terms[self.space.block(element, c.column)];
                let row = &mut residual[self.space.block(element, c.row)];
                let [inertia_v, inertia_w, inertia_theta] = &terms.inertia;
                let [u, phi] = &terms.strain;
                for i in 0..S {
                    row[0][i] += m * c.mass_u * inertia_v[i] + k * c.stiff_u * terms.tension[i]
                        - c.u_phi * phi[i];
                    row[1][i] += m * c.mass_phi * (inertia_w[i] + phi[i])
                        + k * c.stiff_phi * phi[i]
                        - c.phi_u * u[i]
                        - c.phi_theta * self.beam.a * terms.heat[i];
                    row[2][i] += m * c.mass_u * inertia_theta[i]
                        + k * c.stiff_u * terms.heat[i]
                        + c.theta_phi * terms.turning[i];
                }
            }
        }
        let tip = self.space.tip();
        let load = |i: usize| forcing.map_or(0.0, |forcing| forcing.moments[i][tip][0]);
        let force =
            std::array::from_fn(|i| (load(i) - residual[tip][0][i]) / (self.h * forms.product[i]));
        self.add_forces(forms, forcing, terms, residual);
        residual[0] = [[0.0; S]; 3];
        residual[tip][2] = [0.0; S];
        force
    }

    /// Contact, the heated end, and the loads.
    fn add_forces<const S: usize>(
        &self,
        forms: &TimeForms<S>,
        forcing: Option<&Forcing<S>>,
        terms: &[BlockTerms<S>],
        residual: &mut [Block<S>],
    ) {
        let tip = self.space.tip();
        if let Some((obstacle, obstacles)) = self.phase.obstacle(self.obstacles).zip(self.obstacles)
        {
            let u = &terms[tip].places[0].low;
            for i in 0..S {
                let depth = if i == 0 { u[0] - obstacle } else { u[i] };
                residual[tip][0][i] += self.h * forms.product[i] * depth / obstacles.epsilon;
            }
        }
        let hot = self.beam.a * self.beam.theta_a * self.h;
        if hot != 0.0 {
            for (residual, integral) in residual.iter_mut().zip(&self.space.rotation_integrals) {
                residual[1][0] -= hot * integral;
            }
        }
        if let Some(forcing) = forcing {
            for (stage, moments) in forcing.moments.iter().enumerate() {
                for (residual, moment) in residual.iter_mut().zip(moments) {
                    for field in 0..3 {
                        residual[field][stage] -= moment[field];
                    }
                }
            }
        }
    }

    /// The integrals in time of one block.
    fn combine<const S: usize>(
        &self,
        forms: &TimeForms<S>,
        x: &Block<S>,
        start: &[f64; 3],
        axial: &AxialForce<S>,
        terms: &mut BlockTerms<S>,
    ) {
        for field in 0..3 {
            let mut sum = forms.start.map(|sign| -sign * start[field]);
            add_columns(&mut sum, &forms.derivative_columns, &x[field]);
            terms.inertia[field] = sum;
        }
        for i in 0..S {
            let duration = self.h * forms.product[i];
            for field in 0..2 {
                terms.strain[field][i] =
                    duration * (terms.places[field].low[i] + self.beam.zeta * x[field][i]);
            }
            terms.turning[i] = self.beam.a * duration * x[1][i];
            terms.heat[i] = duration * x[2][i];
        }
        let u = &terms.places[0];
        let mut sum = axial.top.map(|top| top * u.top);
        // Symmetric: its rows equal its columns.
        add_columns(&mut sum, &axial.low, &u.low);
        terms.tension = std::array::from_fn(|i| terms.strain[0][i] + self.h * sum[i]);
    }
}

/// `(u_i, u_j)` in the product of derivatives, for the coefficients u_0..u_{q+1} of u in time.
#[derive(Debug, Clone, Copy)]
pub(super) struct Gram<const S: usize> {
    entries: [[f64; MAX_STAGES + 1]; MAX_STAGES + 1],
}

impl<const S: usize> Gram<S> {
    /// For the displacement in `terms`.
    pub(super) fn of(space: &Space, terms: &[BlockTerms<S>]) -> Self {
        let mut gram = Self {
            entries: [[0.0; MAX_STAGES + 1]; MAX_STAGES + 1],
        };
        let tip = space.tip();
        let (nodes, inside) = terms.split_at(tip + 1);
        for (element, &length) in space.lengths.iter().enumerate() {
            let [left, right] = [&nodes[element].places[0], &nodes[element + 1].places[0]];
            let low = std::array::from_fn(|i| right.low[i] - left.low[i]);
            gram.add(
                1.0 / length,
                &Path {
                    low,
                    top: right.top - left.top,
                },
            );
            for terms in &inside[element * space.inner()..(element + 1) * space.inner()] {
                gram.add(2.0 / length, &terms.places[0]);
            }
        }
        gram
    }

    fn add(&mut self, weight: f64, u: &Path<S>) {
        for i in 0..S {
            let factor = weight * u.low[i];
            for j in 0..S {
                self.entries[i][j] = fma(factor, u.low[j], self.entries[i][j]);
            }
            self.entries[i][S] = fma(factor, u.top, self.entries[i][S]);
        }
        self.entries[S][S] = fma(weight * u.top, u.top, self.entries[S][S]);
    }

    /// `‖u_x‖²` for the given values of the Legendre polynomials.
    fn at(&self, legendre: &[f64; MAX_STAGES + 1]) -> f64 {
        let mut sum = self.entries[S][S] * legendre[S] * legendre[S];
        for i in 0..S {
            let mut row = 2.0 * self.entries[i][S] * legendre[S];
            for j in 0..S {
                row += self.entries[i][j] * legendre[j];
            }
            sum += row * legendre[i];
        }
        sum
    }
}
