//! The two sweeps of a pass of Newton's method: residual of (3.7) and elimination forward,
//! substitution and (3.8) backward.
//!
//! The unknown at a node is `X = (V, W, Θ)`: the velocities of the step, `u = u0 + dt V`,
//! `phi = phi0 + dt W`, (3.8), and the mean temperature `Θ = (θ~ + θ~0)/2`. With `u½ = u0 + dt V/2`
//! and so on, (3.1), `κ = inertia/dt` and the mean axial force m = ½(N(u) + N(u0)), the residual of
//! (3.7) is
//!
//! ```text
//! R_u = κ M (V - v0) + K ((1 + m) u½ + ζ V) - C (φ½ + ζ W)                          + F(u(1)) e - F_u
//! R_φ = κ M (W - w0) + (K + M)(φ½ + ζ W)    - Cᵀ(u½ + ζ V) - a C (Θ + θ_A (1 - x))              - F_φ
//! R_θ = 2/dt M (Θ - θ~0) + K Θ              + a Cᵀ W                                            - F_θ
//! ```
//!
//! and a pass solves `A(m̄) δ = -R` with `R_θ` negated, which makes A symmetric. m̄ is the axial
//! force for which A was factorised. It may differ from m: then δ is not exact, but the residual R
//! of the next pass is. The contact force is part of the solve: it acts on one node, the last in
//! the elimination, where it is a scalar equation with a closed solution (`contact.rs`).
//!
//! A pass runs over the nodes twice and allocates nothing.

use crate::block_tridiagonal::{Block, minus_times, minus_transpose_times, times};
use crate::lanes::{Lane, MultiplyAdd};
use crate::solve::control::{ElementLengths, Scalars};
use crate::solve::newton::Newton;

impl Scalars<f64> {
    /// Blocks `(O_i, D_i)` of A(m) at node i of n, from the elements to the left and to the right
    /// of it (`None` at the tip).
    pub(super) fn blocks<const B: usize>(
        &self,
        m: f64,
        left: ElementLengths<f64>,
        right: Option<ElementLengths<f64>>,
    ) -> (Block<f64, B>, Block<f64, B>) {
        let tip = right.is_none();
        let right = right.unwrap_or(ElementLengths {
            inverse: 0.0,
            sixth: 0.0,
        });
        let stiff_u = self.zeta + (1.0 + m) * self.half_dt;
        let (inverse, sixth) = (left.inverse + right.inverse, left.sixth + right.sixth);
        let (mut lower, mut diagonal) = ([[0.0; B]; B], [[0.0; B]; B]);
        lower[0][0] = self.inertia * left.sixth - stiff_u * left.inverse;
        lower[0][1] = -0.5 * self.stiff;
        lower[1][0] = 0.5 * self.stiff;
        lower[1][1] = (self.inertia + self.stiff) * left.sixth - self.stiff * left.inverse;
        diagonal[0][0] = 2.0 * self.inertia * sixth + stiff_u * inverse;
        diagonal[1][1] = (self.inertia + self.stiff) * 2.0 * sixth + self.stiff * inverse;
        if tip {
            // C has only one diagonal entry, (N_n, N_n') = 1/2 at the tip.
            diagonal[0][1] = -0.5 * self.stiff;
            diagonal[1][0] = -0.5 * self.stiff;
        }
        if B == 3 {
            // The temperature is prescribed at the tip: the equation -1 δΘ = 0 keeps the block
            // structure.
            diagonal[2][2] = if tip {
                -1.0
            } else {
                -(self.two_over_dt * 2.0 * sixth + inverse)
            };
            if !tip {
                lower[2][1] = self.half_a;
                lower[2][2] = -(self.two_over_dt * left.sixth - left.inverse);
            }
            lower[1][2] = -self.half_a;
        }
        (lower, diagonal)
    }
}

/// Nodal quantities from which the residual of an element is computed.
#[derive(Clone, Copy)]
struct Nodal<T, const B: usize> {
    /// X.
    x: [T; B],
    /// (1 + m) u½ + ζ V.
    axial: T,
    /// u½ + ζ V.
    displacement: T,
    /// φ½ + ζ W.
    rotation: T,
    /// The argument of the mass matrix in each equation.
    mass: [T; B],
}

impl<T: Lane, const B: usize> Newton<T, B> {
    /// The forward sweep for the mean axial forces m: sets `middle` to S⁻¹ y, the right-hand side
    /// after the elimination.
    ///
    /// * `FIRST`: whether the iterate is extrapolated from the history.
    /// * `LOADED`: whether there are loads.
    #[inline(always)]
    pub(super) fn forward<A: MultiplyAdd, const FIRST: bool, const LOADED: bool>(&mut self, m: T) {
        let zero = T::splat(0.0);
        let weights = self.weights().map(T::splat);
        let count = self.elements.len();
        // Slices of equal length, so the compiler removes the bounds checks in the loop.
        let (elements, nodes) = (&self.elements[..count], &self.nodes[..count]);
        let [iterate, history @ ..] = &mut self.iterates;
        let history = history.each_ref().map(|level| &level[..count]);
        let old = &self.old[..count];
        let old_velocity = if self.velocity[0].is_empty() {
            history[0]
        } else {
            &self.velocity[0][..count]
        };
        let load = if LOADED { &self.load[..count] } else { &[] };
        let (iterate, middle) = (&mut iterate[..count], &mut self.middle[..count]);
        let scalars = &self.scalars;

        let mut left = Nodal {
            x: [zero; B],
            axial: zero,
            displacement: zero,
            rotation: zero,
            mass: [zero; B],
        };
        left.mass[1] = -scalars.lift;
        let (mut pending, mut y) = ([zero; B], [zero; B]);
        for i in 1..count {
            if FIRST {
                let mut x = history[0][i];
                for k in 0..B {
                    let sum =
                        history[1][i][k].mul_add::<A>(weights[1], history[2][i][k] * weights[2]);
                    x[k] = x[k].mul_add::<A>(weights[0], sum);
                }
                iterate[i] = x;
            }
            let right = nodal::<A, _, _>(scalars, m, iterate[i], old[i], old_velocity[i]);
            let (to_left, to_right) = element::<A, _, _>(scalars, elements[i], &left, &right);
            if i > 1 {
                let mut residual = to_left;
                for k in 0..B {
                    residual[k] = pending[k] + residual[k];
                    if LOADED {
                        residual[k] = residual[k] - load[i - 1][k];
                    }
                }
                y = minus_times::<A, _, _>(signed(residual), &nodes[i - 1].multiplier, y);
                middle[i - 1] = times::<A, _, _>(&nodes[i - 1].inverse, y);
            }
            (pending, left) = (to_right, right);
        }
        let tip = count - 1;
        if LOADED {
            for k in 0..B {
                pending[k] = pending[k] - load[tip][k];
            }
        }
        if B == 3 {
            pending[2] = zero;
        }
        y = minus_times::<A, _, _>(signed(pending), &nodes[tip].multiplier, y);
        middle[tip] = times::<A, _, _>(&nodes[tip].inverse, y);
    }
}

/// -R with its third component negated, the right-hand side of the symmetric system.
#[inline(always)]
fn signed<T: Lane, const B: usize>(residual: [T; B]) -> [T; B] {
    let mut right = residual;
    (right[0], right[1]) = (-residual[0], -residual[1]);
    right
}

/// The nodal quantities of the iterate x.
#[inline(always)]
fn nodal<A: MultiplyAdd, T: Lane, const B: usize>(
    s: &Scalars<T>,
    m: T,
    x: [T; B],
    old: [T; B],
    velocity: [T; B],
) -> Nodal<T, B> {
    let half_u = x[0].mul_add::<A>(s.half_dt, old[0]);
    let displacement = x[0].mul_add::<A>(s.zeta, half_u);
    let rotation = x[1].mul_add::<A>(s.stiff, old[1]);
    let mut mass = [T::splat(0.0); B];
    mass[0] = s.inertia * (x[0] - velocity[0]);
    mass[1] = s.inertia.mul_add::<A>(x[1] - velocity[1], rotation) - s.lift;
    if B == 3 {
        mass[2] = s.two_over_dt * (x[2] - old[2]);
    }
    Nodal {
        x,
        axial: m.mul_add::<A>(half_u, displacement),
        displacement,
        rotation,
        mass,
    }
}

/// Contributions of an element to the residual of (3.7) at its left and at its right node.
#[inline(always)]
fn element<A: MultiplyAdd, T: Lane, const B: usize>(
    s: &Scalars<T>,
    e: ElementLengths<T>,
    left: &Nodal<T, B>,
    right: &Nodal<T, B>,
) -> ([T; B], [T; B]) {
    let half = T::splat(0.5);
    // Stresses, multiplied by the derivative of the test function.
    let stress = (right.axial - left.axial)
        .mul_add::<A>(e.inverse, -(half * (left.rotation + right.rotation)));
    let mut moment = (right.rotation - left.rotation) * e.inverse;
    // Shear, multiplied by the test function itself, the same at both nodes.
    let shear = half * (right.displacement - left.displacement);
    let (mut to_left, mut to_right) = ([T::splat(0.0); B], [T::splat(0.0); B]);
    for k in 0..B {
        let sum = left.mass[k] + right.mass[k];
        to_left[k] = sum + left.mass[k];
        to_right[k] = sum + right.mass[k];
    }
    to_left[0] = e.sixth.mul_add::<A>(to_left[0], -stress);
    to_right[0] = e.sixth.mul_add::<A>(to_right[0], stress);
    if B == 3 {
        moment = (-s.half_a).mul_add::<A>(left.x[2] + right.x[2], moment);
        let flux = (right.x[2] - left.x[2]) * e.inverse;
        let heating = s.half_a * (right.x[1] - left.x[1]);
        to_left[2] = e.sixth.mul_add::<A>(to_left[2], heating - flux);
        to_right[2] = e.sixth.mul_add::<A>(to_right[2], heating + flux);
    }
    to_left[1] = e.sixth.mul_add::<A>(to_left[1], -(moment + shear));
    to_right[1] = e.sixth.mul_add::<A>(to_right[1], moment - shear);
    (to_left, to_right)
}

impl<T: Lane, const B: usize> Newton<T, B> {
    /// The backward sweep: adds the correction to the iterate, and updates the new level.
    ///
    /// * `active`: 1 for the cases that take part in the pass, 0 for those whose iterate stays.
    /// * `tip`: δ at the tip, including contact.
    /// * Returns ‖u_x‖² of the new iterate, and ‖δV_x‖² of the correction.
    #[inline(always)]
    pub(super) fn backward<A: MultiplyAdd>(&mut self, active: T, tip: [T; B]) -> [T; 2] {
        let count = self.elements.len();
        let (elements, nodes) = (&self.elements[..count], &self.nodes[..count]);
        let (middle, old) = (&self.middle[..count], &self.old[..count]);
        let (iterate, new) = (&mut self.iterates[0][..count], &mut self.new[..count]);
        let zero = T::splat(0.0);
        let (mut slope_squared, mut increment_squared) = (zero, zero);
        let mut delta = tip;
        for i in (1..count).rev() {
            let mut x = iterate[i];
            for k in 0..B {
                x[k] = active.mul_add::<A>(delta[k], x[k]);
            }
            iterate[i] = x;
            let updated = update::<A, _, _>(&self.scalars, x, old[i]);
            new[i] = updated;
            if i + 1 < count {
                let slope = new[i + 1][0] - updated[0];
                slope_squared =
                    (slope * elements[i + 1].inverse).mul_add::<A>(slope, slope_squared);
            }
            let next = if i > 1 {
                minus_transpose_times::<A, _, _>(middle[i - 1], &nodes[i].multiplier, delta)
            } else {
                [zero; B]
            };
            let change = delta[0] - next[0];
            increment_squared =
                (change * elements[i].inverse).mul_add::<A>(change, increment_squared);
            delta = next;
        }
        let first = new[1][0];
        [
            (first * elements[1].inverse).mul_add::<A>(first, slope_squared),
            increment_squared,
        ]
    }
}

/// (u, φ, θ~) at the new level from X: (3.8), and `θ~ = 2 Θ - θ~0`.
#[inline(always)]
fn update<A: MultiplyAdd, T: Lane, const B: usize>(
    s: &Scalars<T>,
    x: [T; B],
    old: [T; B],
) -> [T; B] {
    let mut new = old;
    for k in 0..2 {
        new[k] = x[k].mul_add::<A>(s.dt, old[k]);
    }
    if B == 3 {
        new[2] = x[2] + x[2] - old[2];
    }
    new
}
