//! The sums over the elements of which the balance of a step consists.
//!
//! Elements stand side by side here, not cases: lane k adds up every fourth element from the kth on, and the lanes are
//! added in the end. One sum over all elements would make each wait for the one before.

use crate::lanes::{Lane, Lanes};
use crate::norms::element_product;
use crate::solve::Level;

/// Elements side by side: as many numbers as a vector register holds.
const WIDTH: usize = 4;

/// Sums over elements.
#[derive(Clone, Copy)]
pub(super) struct Sums<T> {
    /// ½ of the differences of ‖v‖², ‖w‖², ‖u_x - φ‖², ‖φ_x‖², ‖θ~‖².
    pub(super) quadratic: T,
    /// ‖u_x‖², old and new.
    pub(super) slope_squared: [T; 2],
    /// ∫ φ - φ0.
    pub(super) rotation_change: T,
    /// ‖V_x - W‖² + ‖W_x‖².
    pub(super) viscous: T,
    /// ‖θ~_x‖² at n-½.
    pub(super) heat_flow: T,
    /// ‖v - v0‖² + ‖w - w0‖².
    pub(super) jump: T,
}

impl Sums<f64> {
    /// Over all elements; `weight` is that of the new velocity in the one that carries the step.
    ///
    /// Without `LOSSES` the last three sums stay zero, for who asks for the change of the energy alone.
    pub(super) fn over<const LOSSES: bool>(lengths: &[f64], weight: f64, old: &Level, new: &Level) -> Self {
        let whole = lengths.len() / WIDTH * WIDTH;
        let mut lanes = Sums::<Lanes<WIDTH>>::zero();
        for first in (0..whole).step_by(WIDTH) {
            lanes.add::<LOSSES>(lengths, weight, first, old, new);
        }
        let mut sums = lanes.added_up();
        for element in whole..lengths.len() {
            sums.add::<LOSSES>(lengths, weight, element, old, new);
        }
        sums
    }
}

impl<T: Lane> Sums<T> {
    fn zero() -> Self {
        let zero = T::splat(0.0);
        Self {
            quadratic: zero,
            slope_squared: [zero; 2],
            rotation_change: zero,
            viscous: zero,
            heat_flow: zero,
            jump: zero,
        }
    }

    fn added_up(&self) -> Sums<f64> {
        let sum = |value: T| (0..T::WIDTH).map(|k| value.lane(k)).sum();
        Sums {
            quadratic: sum(self.quadratic),
            slope_squared: self.slope_squared.map(sum),
            rotation_change: sum(self.rotation_change),
            viscous: sum(self.viscous),
            heat_flow: sum(self.heat_flow),
            jump: sum(self.jump),
        }
    }

    /// Adds the elements `first..first + T::WIDTH`.
    #[inline(always)]
    fn add<const LOSSES: bool>(&mut self, lengths: &[f64], weight: f64, first: usize, old: &Level, new: &Level) {
        let h = T::load(&lengths[first..]);
        let inverse = T::from_fn(|k| 1.0 / h.lane(k));
        let (half, sixth) = (T::splat(0.5), h * T::splat(1.0 / 6.0));
        let square = |p: T| p * p;
        // ∫ p q, (p_x) and (u_x - φ at both ends), of P1 functions given by their values at the ends.
        let product = |p: [T; 2], q: [T; 2]| element_product(sixth, p, q);
        let slope = |y: [T; 2]| (y[1] - y[0]) * inverse;
        let shear = |u: [T; 2], phi: [T; 2]| [slope(u) - phi[0], slope(u) - phi[1]];
        let mean_and_jump = |y, y0| mean_and_jump::<T>(y, y0, first);
        let (u, du) = mean_and_jump(&new.u, &old.u);
        let (phi, dphi) = mean_and_jump(&new.phi, &old.phi);
        let (v, dv) = mean_and_jump(&new.v, &old.v);
        let (w, dw) = mean_and_jump(&new.w, &old.w);
        let (theta, dtheta) = mean_and_jump(&new.theta, &old.theta);

        let kinetic_and_thermal = product(v, dv) + product(w, dw) + product(theta, dtheta);
        let elastic = product(shear(u, phi), shear(du, dphi)) + h * slope(phi) * slope(dphi);
        self.quadratic = self.quadratic + kinetic_and_thermal + elastic;
        let half_step = half * slope(du);
        self.slope_squared[0] = self.slope_squared[0] + h * square(slope(u) - half_step);
        self.slope_squared[1] = self.slope_squared[1] + h * square(slope(u) + half_step);
        self.rotation_change = self.rotation_change + half * h * (dphi[0] + dphi[1]);
        if !LOSSES {
            return;
        }
        // weight y + (1 - weight) y0, from the mean on.
        let beyond = T::splat(weight - 0.5);
        let carrying = |mean: [T; 2], jump: [T; 2]| [mean[0] + beyond * jump[0], mean[1] + beyond * jump[1]];
        let carrying_w = carrying(w, dw);
        let shear_rate = shear(carrying(v, dv), carrying_w);
        self.viscous = self.viscous + product(shear_rate, shear_rate) + h * square(slope(carrying_w));
        self.heat_flow = self.heat_flow + h * square(slope(theta));
        self.jump = self.jump + product(dv, dv) + product(dw, dw);
    }
}

/// Of the elements from `first` on, at both ends: the mean of a field's two levels, and their difference. With them
/// `½ (‖y‖² - ‖y0‖²)` is a product, in which nothing cancels.
#[inline(always)]
fn mean_and_jump<T: Lane>(y: &[f64], y0: &[f64], first: usize) -> ([T; 2], [T; 2]) {
    let (y, y0) = (ends::<T>(y, first), ends::<T>(y0, first));
    let half = T::splat(0.5);
    ([half * (y[0] + y0[0]), half * (y[1] + y0[1])], [y[0] - y0[0], y[1] - y0[1]])
}

/// A field's values at both ends of the elements from `first` on.
#[inline(always)]
fn ends<T: Lane>(y: &[f64], first: usize) -> [T; 2] {
    [T::load(&y[first..]), T::load(&y[first + 1..])]
}
