//! The sums over the elements in the balance of a step.
//!
//! The sum is split into four partial sums, each over every fourth element: in a single sum each
//! addition would wait for the previous one. For one case the four partial sums fill a vector
//! register; for several cases in lanes each partial sum is a register with one number per case.
//! Both give the same bits for a case.

use crate::lanes::{Lane, Lanes};
use crate::level::TimeLevel;
use crate::norms::element_product;

/// Number of partial sums: the numbers in a vector register.
const WIDTH: usize = 4;

/// Sums over elements, in the notation of [`super`].
#[derive(Clone, Copy)]
pub(crate) struct Sums<T> {
    /// ½ of the differences of ‖v‖², ‖w‖², ‖u_x - φ‖², ‖φ_x‖², ‖θ~‖².
    pub(super) quadratic: T,
    /// ‖u_x‖² at the old and at the new level.
    pub(super) slope_squared: [T; 2],
    /// ∫ (φ - φ0).
    pub(super) rotation_change: T,
    /// ‖V_x - W‖² + ‖W_x‖².
    pub(super) viscous: T,
    /// ‖θ~_x‖² at n-½.
    pub(super) heat_flow: T,
    /// ‖v - v0‖² + ‖w - w0‖².
    pub(super) jump: T,
}

/// An element, or one element of each of several cases in lanes.
#[derive(Clone, Copy)]
pub(crate) struct Element<T> {
    /// Its length h.
    pub(crate) length: T,
    /// 1/h.
    pub(crate) inverse: T,
    /// The fields at both ends at the old level.
    pub(crate) old: [Fields<T>; 2],
    /// The fields at both ends at the new level.
    pub(crate) new: [Fields<T>; 2],
}

/// The fields at a node; `theta` is lifted.
#[derive(Clone, Copy)]
pub(crate) struct Fields<T> {
    pub(crate) u: T,
    pub(crate) phi: T,
    pub(crate) v: T,
    pub(crate) w: T,
    pub(crate) theta: T,
}

impl Sums<f64> {
    /// The sums over all elements of one case.
    ///
    /// * `weight`: the c of `V = c v + (1 - c) v0`, 1/inertia of the scheme.
    /// * `LOSSES`: whether `viscous`, `heat_flow` and `jump` are computed; otherwise they are zero.
    pub(super) fn over<const LOSSES: bool>(
        lengths: &[f64],
        weight: f64,
        old: &TimeLevel,
        new: &TimeLevel,
    ) -> Self {
        let whole = lengths.len() / WIDTH * WIDTH;
        let mut lanes = Sums::<Lanes<WIDTH>>::zero();
        for first in (0..whole).step_by(WIDTH) {
            lanes.add::<LOSSES>(weight, &Element::load(lengths, first, old, new));
        }
        let mut parts = [0, 1, 2, 3].map(|k| lanes.of_lane(k));
        for (part, element) in parts.iter_mut().zip(whole..lengths.len()) {
            part.add::<LOSSES>(weight, &Element::load(lengths, element, old, new));
        }
        Self::added_up(&parts)
    }
}

impl<T: Lane> Sums<T> {
    /// The sums over all elements of several cases, given by number; `weight` as in [`Sums::over`].
    #[inline(always)]
    pub(crate) fn over_cases(
        elements: usize,
        weight: f64,
        element: impl Fn(usize) -> Element<T>,
    ) -> Self {
        let mut parts = [Self::zero(); WIDTH];
        for i in 0..elements {
            parts[i % WIDTH].add::<true>(weight, &element(i));
        }
        Self::added_up(&parts)
    }

    fn zero() -> Self {
        Self::map(|_| T::splat(0.0))
    }

    fn added_up([one, two, three, four]: &[Self; WIDTH]) -> Self {
        Self::map(|of| of(one) + of(two) + of(three) + of(four))
    }

    /// The sums of case k.
    pub(crate) fn of_lane(&self, k: usize) -> Sums<f64> {
        Self::map(|of| of(self).lane(k))
    }

    /// Each sum from the function that reads it.
    fn map<U>(each: impl Fn(fn(&Self) -> T) -> U) -> Sums<U> {
        Sums {
            quadratic: each(|sums| sums.quadratic),
            slope_squared: [
                each(|sums| sums.slope_squared[0]),
                each(|sums| sums.slope_squared[1]),
            ],
            rotation_change: each(|sums| sums.rotation_change),
            viscous: each(|sums| sums.viscous),
            heat_flow: each(|sums| sums.heat_flow),
            jump: each(|sums| sums.jump),
        }
    }

    #[inline(always)]
    fn add<const LOSSES: bool>(&mut self, weight: f64, element: &Element<T>) {
        let Element {
            length: h,
            inverse,
            old,
            new,
        } = *element;
        let (half, sixth) = (T::splat(0.5), h * T::splat(1.0 / 6.0));
        // ∫ p q, p_x and (u_x - φ at both ends) of P1 functions given by their values at the ends.
        let product = |p: [T; 2], q: [T; 2]| element_product(sixth, p, q);
        let slope = |y: [T; 2]| (y[1] - y[0]) * inverse;
        let shear = |u: [T; 2], phi: [T; 2]| [slope(u) - phi[0], slope(u) - phi[1]];
        let u = FieldChange::new(old.map(|end| end.u), new.map(|end| end.u));
        let phi = FieldChange::new(old.map(|end| end.phi), new.map(|end| end.phi));
        let v = FieldChange::new(old.map(|end| end.v), new.map(|end| end.v));
        let w = FieldChange::new(old.map(|end| end.w), new.map(|end| end.w));
        let theta = FieldChange::new(old.map(|end| end.theta), new.map(|end| end.theta));

        let kinetic_and_thermal =
            product(v.mean, v.jump) + product(w.mean, w.jump) + product(theta.mean, theta.jump);
        let elastic = product(shear(u.mean, phi.mean), shear(u.jump, phi.jump))
            + h * slope(phi.mean) * slope(phi.jump);
        self.quadratic = self.quadratic + kinetic_and_thermal + elastic;
        let half_step = half * slope(u.jump);
        self.slope_squared[0] = self.slope_squared[0] + h * square(slope(u.mean) - half_step);
        self.slope_squared[1] = self.slope_squared[1] + h * square(slope(u.mean) + half_step);
        self.rotation_change = self.rotation_change + half * h * (phi.jump[0] + phi.jump[1]);
        if !LOSSES {
            return;
        }
        let carrying_w = w.weighted(weight);
        let shear_rate = shear(v.weighted(weight), carrying_w);
        self.viscous =
            self.viscous + product(shear_rate, shear_rate) + h * square(slope(carrying_w));
        self.heat_flow = self.heat_flow + h * square(slope(theta.mean));
        self.jump = self.jump + product(v.jump, v.jump) + product(w.jump, w.jump);
    }
}

/// Mean and difference of a field's two levels at both ends of an element: `½ (‖y‖² - ‖y0‖²)` is
/// their product, without cancellation.
struct FieldChange<T> {
    mean: [T; 2],
    jump: [T; 2],
}

impl<T: Lane> FieldChange<T> {
    #[inline(always)]
    fn new(old: [T; 2], new: [T; 2]) -> Self {
        let half = T::splat(0.5);
        Self {
            mean: [half * (new[0] + old[0]), half * (new[1] + old[1])],
            jump: [new[0] - old[0], new[1] - old[1]],
        }
    }

    /// `weight y + (1 - weight) y0`.
    #[inline(always)]
    fn weighted(&self, weight: f64) -> [T; 2] {
        let beyond = T::splat(weight - 0.5);
        [
            self.mean[0] + beyond * self.jump[0],
            self.mean[1] + beyond * self.jump[1],
        ]
    }
}

#[inline(always)]
fn square<T: Lane>(p: T) -> T {
    p * p
}

impl<T: Lane> Element<T> {
    /// The elements `first..first + T::WIDTH` of one case.
    #[inline(always)]
    fn load(lengths: &[f64], first: usize, old: &TimeLevel, new: &TimeLevel) -> Self {
        let length = T::load(&lengths[first..]);
        let inverse = T::from_fn(|k| 1.0 / length.lane(k));
        Self {
            length,
            inverse,
            old: Fields::load_ends(old, first),
            new: Fields::load_ends(new, first),
        }
    }
}

impl<T: Lane> Fields<T> {
    /// At both ends of the elements `first..first + T::WIDTH` of one case.
    #[inline(always)]
    fn load_ends(level: &TimeLevel, first: usize) -> [Self; 2] {
        [Self::load(level, first), Self::load(level, first + 1)]
    }

    /// At the nodes `first..first + T::WIDTH` of one case.
    #[inline(always)]
    fn load(level: &TimeLevel, first: usize) -> Self {
        Self {
            u: T::load(&level.u[first..]),
            phi: T::load(&level.phi[first..]),
            v: T::load(&level.v[first..]),
            w: T::load(&level.w[first..]),
            theta: T::load(&level.theta[first..]),
        }
    }
}
