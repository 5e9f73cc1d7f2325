//! The scheme (3.7)-(3.8) and its semi-discrete limit as dense systems, written from the equations.
//!
//! No unknown is eliminated: u, v, φ, w at the nodes 1..n and θ~ at the nodes 1..n-1, stacked in
//! this order.

use super::p1::{P1Matrices, over_all_nodes};
use crate::prelude::*;
use nalgebra::{DMatrix, DVector};

/// Position of the tip at the end of a step.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Side {
    Between,
    Above,
    Below,
}

pub(crate) struct Dense {
    beam: Beam,
    obstacles: Option<Obstacles>,
    p1: P1Matrices,
    /// `a θ_A C (1 - x)`.
    lift: DVector<f64>,
}

/// u, v, φ, w and θ~.
type Fields = [DVector<f64>; 5];

fn stacked(fields: &Fields) -> DVector<f64> {
    let values: Vec<f64> = fields.iter().flatten().copied().collect();
    DVector::from_vec(values)
}

fn unstacked(y: &DVector<f64>) -> Fields {
    let n = y.len().div_ceil(5);
    std::array::from_fn(|k| y.rows(k * n, n.min(y.len() - k * n)).into_owned())
}

/// The unknowns of a level.
pub(crate) fn unknowns(level: &TimeLevel) -> DVector<f64> {
    let free = fields(level).map(|values| &values[1..]).concat();
    // The temperature of the tip is none of them.
    DVector::from_column_slice(&free[..free.len() - 1])
}

/// The level with these unknowns.
pub(crate) fn level_of(y: &DVector<f64>) -> TimeLevel {
    let [u, v, phi, w, theta] = unstacked(y);
    let mut level = TimeLevel::new(u.len() + 1);
    for (values, free) in [
        (&mut level.u, u),
        (&mut level.v, v),
        (&mut level.phi, phi),
        (&mut level.w, w),
        (&mut level.theta, theta),
    ] {
        values[1..=free.len()].copy_from_slice(free.as_slice());
    }
    level
}

/// The matrix of an affine map, and its value at zero.
pub(crate) fn affine(
    size: usize,
    mut map: impl FnMut(&DVector<f64>) -> DVector<f64>,
) -> (DMatrix<f64>, DVector<f64>) {
    let constant = map(&DVector::zeros(size));
    let columns: Vec<_> = DMatrix::identity(size, size)
        .column_iter()
        .map(|unit| map(&unit.into_owned()) - &constant)
        .collect();
    (DMatrix::from_columns(&columns), constant)
}

impl Dense {
    pub(crate) fn new(problem: &Problem) -> Self {
        let (mesh, beam) = (&problem.mesh, problem.beam);
        let [_, _, c] = over_all_nodes(mesh);
        let steady = mesh.nodes().iter().map(|x| beam.theta_a * (1.0 - x));
        let steady = DVector::from_iterator(c.nrows(), steady);
        Self {
            beam,
            obstacles: problem.obstacles,
            p1: P1Matrices::new(mesh),
            lift: (c * steady * beam.a).remove_row(0),
        }
    }

    pub(crate) fn initial(&self, problem: &Problem) -> DVector<f64> {
        let InitialValues {
            u,
            u_t,
            phi,
            phi_t,
            theta,
        } = problem.initial.clone();
        let places = theta.iter().zip(problem.mesh.nodes());
        let lifted = places.map(|(theta, x)| theta - self.beam.theta_a * (1.0 - x));
        unknowns(&TimeLevel {
            theta: lifted.collect(),
            u,
            v: u_t,
            phi,
            w: phi_t,
            contact_force: 0.0,
        })
    }

    fn axial_force(&self, u: &DVector<f64>) -> f64 {
        self.beam.beta + self.beam.rho * u.dot(&(&self.p1.stiffness * u))
    }

    /// M or K restricted to the nodes of θ~.
    fn of_theta(matrix: &DMatrix<f64>) -> DMatrix<f64> {
        let inner = matrix.nrows() - 1;
        matrix.view((0, 0), (inner, inner)).into_owned()
    }

    /// What accelerates u without obstacles, what turns φ, and what heats, at the axial force N.
    fn forces(&self, n_value: f64, [u, v, phi, w, theta]: &Fields) -> [DVector<f64>; 3] {
        let Beam { zeta, a, .. } = self.beam;
        let P1Matrices {
            mass: m,
            stiffness: k,
            coupling: c,
            ..
        } = &self.p1;
        let c_theta = c.columns(0, theta.len());
        let (moved, turned) = (u + v * zeta, phi + w * zeta);
        [
            c * &turned - k * (&moved + u * n_value),
            c.transpose() * moved - (k + m) * turned + c_theta * theta * a + &self.lift,
            -(Self::of_theta(k) * theta) - c_theta.transpose() * w * a,
        ]
    }

    /// Time derivative of the semi-discrete solution, which both schemes approximate.
    pub(crate) fn rate(&self) -> impl Fn(&DVector<f64>) -> DVector<f64> + '_ {
        let mass = &self.p1.mass;
        let [inverse, inverse_theta] =
            [mass.clone(), Self::of_theta(mass)].map(|mass| mass.try_inverse().unwrap());
        move |y| {
            let y = unstacked(y);
            let [mut force, moment, heat] = self.forces(self.axial_force(&y[0]), &y);
            let last = force.len() - 1;
            let tip = y[0][last];
            force[last] -= self.potential(self.side(tip), tip)[1];
            let [_, v, _, w, _] = y;
            stacked(&[
                v,
                &inverse * force,
                w,
                &inverse * moment,
                &inverse_theta * heat,
            ])
        }
    }

    /// One step by Newton's method on the whole system. Each side of the obstacles is tried; the
    /// consistent one is returned.
    pub(crate) fn step(
        &self,
        scheme: &Scheme,
        dt: f64,
        old: &DVector<f64>,
        load: &[[f64; 3]],
    ) -> Option<DVector<f64>> {
        let sides: &[Side] = if self.obstacles.is_some() {
            &[Side::Between, Side::Above, Side::Below]
        } else {
            &[Side::Between]
        };
        let step = Step {
            dense: self,
            scheme,
            dt,
            old: unstacked(old),
            load,
        };
        let (linear, _) = affine(old.len(), |y| step.residual(y, 0.0));
        let solved = |tip: f64, side: Side| step.solve_from(&linear, tip, side);
        sides.iter().find_map(|&side| {
            let mut starts = step.starts(side).into_iter();
            starts.find_map(|tip| solved(tip, side))
        })
    }

    fn side(&self, tip: f64) -> Side {
        match self.obstacles {
            Some(o) if tip > o.g2 => Side::Above,
            Some(o) if tip < o.g1 => Side::Below,
            _ => Side::Between,
        }
    }

    /// G, G' and G'' for a tip on the given side.
    fn potential(&self, side: Side, tip: f64) -> [f64; 3] {
        let Some(o) = self.obstacles else {
            return [0.0; 3];
        };
        let spring = |depth: f64| {
            [
                0.5 * depth * depth / o.epsilon,
                depth / o.epsilon,
                1.0 / o.epsilon,
            ]
        };
        match side {
            Side::Between => [0.0; 3],
            Side::Above => spring(tip - o.g2),
            Side::Below => spring(tip - o.g1),
        }
    }
}

/// The data of a step.
struct Step<'a> {
    dense: &'a Dense,
    scheme: &'a Scheme,
    dt: f64,
    old: Fields,
    load: &'a [[f64; 3]],
}

impl Step<'_> {
    fn old_tip(&self) -> f64 {
        self.old[0][self.dense.p1.elements - 1]
    }

    /// Initial tips on the given side. The discrete gradient is strongly curved: Newton's method
    /// needs a start near the root, or on the side from which it does not overshoot.
    fn starts(&self, side: Side) -> Vec<f64> {
        let old = self.old_tip();
        let Some(o) = self.dense.obstacles else {
            return vec![old];
        };
        let depths = [0.1 * o.epsilon, o.epsilon, 1e-3, 1e-2, 0.1, 1.0];
        match side {
            Side::Between if self.dense.side(old) == side => vec![old],
            Side::Between if old > o.g2 => vec![o.g2, 0.5 * (o.g1 + o.g2), o.g1],
            Side::Between => vec![o.g1, 0.5 * (o.g1 + o.g2), o.g2],
            Side::Above => depths.map(|depth| o.g2 + depth).to_vec(),
            Side::Below => depths.map(|depth| o.g1 - depth).to_vec(),
        }
    }

    /// * `linear`: the matrix of the residual without N and contact.
    fn solve_from(&self, linear: &DMatrix<f64>, tip: f64, side: Side) -> Option<DVector<f64>> {
        let Dense { beam, p1, .. } = self.dense;
        let (n, k) = (p1.elements, &p1.stiffness);
        let mut y = stacked(&self.old);
        y[n - 1] = tip;
        let mut last = f64::INFINITY;
        for _ in 0..100 {
            let u = y.rows(0, n).into_owned();
            // ½(N(u) + N(u0)).
            let mean_n = 0.5
                * [&u, &self.old[0]]
                    .map(|u| self.dense.axial_force(u))
                    .iter()
                    .sum::<f64>();
            let mut residual = self.residual(&y, mean_n);
            let (force, slope) = self.contact(side, u[n - 1]);
            residual[n - 1] += force;
            // d/du of ½(N(u) + N(u0)) K u½: N'(u) = 2ρ (K u)ᵀ.
            let bent_half = k * (&u + &self.old[0]) * 0.5;
            let mut jacobian = linear.clone();
            let mut u_by_u = jacobian.view_mut((0, 0), (n, n));
            u_by_u += k * (0.5 * mean_n) + bent_half * (k * u).transpose() * beam.rho;
            jacobian[(n - 1, n - 1)] += slope;
            let correction = jacobian.lu().solve(&residual)?;
            y -= &correction;
            let size = correction.amax() / y.amax();
            // Iterate until the corrections are round-off and stop decreasing.
            if size <= 1e-12 && !(size < 0.5 * last) {
                return Some(y).filter(|y| self.dense.side(y[n - 1]) == side);
            }
            last = size;
        }
        None
    }

    /// Residual of the first equation of (3.7), (3.8) for u, the second equation, (3.8) for φ, and
    /// the third equation, with this mean of N and without contact: affine in the unknowns.
    fn residual(&self, y: &DVector<f64>, mean_n: f64) -> DVector<f64> {
        let new = unstacked(y);
        let mean = |share: f64| -> Fields {
            std::array::from_fn(|k| &new[k] * share + &self.old[k] * (1.0 - share))
        };
        let [u, _, phi, _, theta] = mean(0.5);
        // The velocities of the step: v and w themselves, or the means of both levels.
        let [_, v, _, w, _] = mean(1.0 / self.scheme.inertia);
        let rates: Fields = std::array::from_fn(|k| (&new[k] - &self.old[k]) / self.dt);
        let [u_t, v_t, phi_t, w_t, theta_t] = rates;
        let [turns, moves] = [phi_t - &w, u_t - &v];
        let forces = self.dense.forces(mean_n, &[u, v, phi, w, theta]);
        let mass = &self.dense.p1.mass;
        let inertia = [mass * v_t, mass * w_t, Dense::of_theta(mass) * theta_t];
        let [in_u, in_phi, in_theta] = std::array::from_fn(|equation| {
            let load = |i: usize, _| self.load.get(i + 1).map_or(0.0, |load| load[equation]);
            let balance = &inertia[equation] - &forces[equation];
            &balance - DVector::from_fn(balance.len(), load)
        });
        stacked(&[in_u, moves, in_phi, turns, in_theta])
    }

    /// The contact force and its derivative.
    fn contact(&self, side: Side, tip: f64) -> (f64, f64) {
        let start = self.old_tip();
        let [g, dg, ddg] = self.dense.potential(side, tip);
        match self.scheme.contact {
            ContactRule::Implicit => (dg, ddg),
            // G is a parabola on one side: its difference quotient is the mean of the slopes.
            ContactRule::DiscreteGradient if self.dense.side(start) == side => {
                (0.5 * (dg + self.dense.potential(side, start)[1]), 0.5 * ddg)
            }
            ContactRule::DiscreteGradient => {
                let quotient =
                    (g - self.dense.potential(self.dense.side(start), start)[0]) / (tip - start);
                (quotient, (dg - quotient) / (tip - start))
            }
        }
    }
}
