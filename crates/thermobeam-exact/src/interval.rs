//! Intervals that enclose real numbers: each bound is rounded outward, so that an enclosure is a
//! theorem about the real number and not about its floating-point image.
//!
//! IEEE 754 rounds + - × ÷ √ to the nearest number: the exact result lies between the two
//! neighbours of the computed one. No function of libm is called, whose error nothing bounds: the
//! Stumpff functions are summed here, with a remainder that is proven, and sin, cos and tanh come
//! from them.

use std::f64::consts::PI;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A closed interval that contains a real number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Enclosure {
    /// The lower bound.
    pub lo: f64,
    /// The upper bound.
    pub hi: f64,
}

/// Terms of a series before its tail: for |x| <= 1 the tail is below 1/20! = 4e-19.
const TERMS: usize = 10;

/// The tail of a Stumpff series over its first term, for |x| <= 1; see [`series`].
const TAIL: Enclosure = Enclosure { lo: 0.0, hi: 2.0 };

/// From here on `1 - tanh κ = 2/(e^2κ + 1) < 2 · 2.7^-40 < 2^-53`.
const SATURATED: f64 = 20.0;

/// Halvings of an argument below [`SATURATED`] that make it less than 1.
const HALVINGS: usize = 5;

impl Enclosure {
    /// All real numbers.
    pub(crate) const ENTIRE: Self = Self {
        lo: f64::NEG_INFINITY,
        hi: f64::INFINITY,
    };

    /// The numbers between two.
    pub(crate) fn between(a: f64, b: f64) -> Self {
        Self {
            lo: a.min(b),
            hi: a.max(b),
        }
    }

    /// π: the constant of the standard library is the double below it.
    pub(crate) fn pi() -> Self {
        Self {
            lo: PI,
            hi: PI.next_up(),
        }
    }

    /// The smallest and the largest of bounds that were computed to the nearest number, rounded
    /// outward.
    fn around<const N: usize>(bounds: [f64; N]) -> Self {
        if bounds.iter().any(|bound| bound.is_nan()) {
            return Self::ENTIRE;
        }
        let lo = bounds.into_iter().fold(f64::INFINITY, f64::min);
        let hi = bounds.into_iter().fold(f64::NEG_INFINITY, f64::max);
        #[cfg(test)]
        if planted::rounds_inward() {
            return Self {
                lo: lo.next_up(),
                hi: hi.next_down(),
            };
        }
        Self {
            lo: lo.next_down(),
            hi: hi.next_up(),
        }
    }

    /// A number between the bounds.
    pub fn midpoint(self) -> f64 {
        0.5 * self.lo + 0.5 * self.hi
    }

    /// The difference of the bounds.
    pub fn width(self) -> f64 {
        self.hi - self.lo
    }

    /// Whether it contains this number.
    pub fn contains(self, value: f64) -> bool {
        self.lo <= value && value <= self.hi
    }

    /// Whether all its numbers are positive.
    pub fn is_positive(self) -> bool {
        self.lo > 0.0
    }

    /// Whether all its numbers are negative.
    pub fn is_negative(self) -> bool {
        self.hi < 0.0
    }

    /// The numbers of both; `None` if there is none.
    pub(crate) fn intersection(self, other: Self) -> Option<Self> {
        let lo = self.lo.max(other.lo);
        let hi = self.hi.min(other.hi);
        (lo <= hi).then_some(Self { lo, hi })
    }

    pub(crate) fn square(self) -> Self {
        let square = self * self;
        Self {
            lo: square.lo.max(0.0),
            hi: square.hi,
        }
    }

    /// The root of the numbers >= 0 in it.
    pub(crate) fn sqrt(self) -> Self {
        let root = Self::around([self.lo, self.hi].map(|bound| bound.max(0.0).sqrt()));
        Self {
            lo: root.lo.max(0.0),
            hi: root.hi,
        }
    }
}

impl From<f64> for Enclosure {
    fn from(value: f64) -> Self {
        Self {
            lo: value,
            hi: value,
        }
    }
}

impl Neg for Enclosure {
    type Output = Self;

    fn neg(self) -> Self {
        Self {
            lo: -self.hi,
            hi: -self.lo,
        }
    }
}

impl<T: Into<Enclosure>> Add<T> for Enclosure {
    type Output = Self;

    fn add(self, other: T) -> Self {
        let other = other.into();
        Self::around([self.lo + other.lo, self.hi + other.hi])
    }
}

impl<T: Into<Enclosure>> Sub<T> for Enclosure {
    type Output = Self;

    fn sub(self, other: T) -> Self {
        self + -other.into()
    }
}

impl<T: Into<Enclosure>> Mul<T> for Enclosure {
    type Output = Self;

    fn mul(self, other: T) -> Self {
        let other = other.into();
        Self::around([
            self.lo * other.lo,
            self.lo * other.hi,
            self.hi * other.lo,
            self.hi * other.hi,
        ])
    }
}

impl<T: Into<Enclosure>> Div<T> for Enclosure {
    type Output = Self;

    /// All real numbers if the divisor may be 0.
    fn div(self, other: T) -> Self {
        let other = other.into();
        if other.contains(0.0) {
            return Self::ENTIRE;
        }
        Self::around([
            self.lo / other.lo,
            self.lo / other.hi,
            self.hi / other.lo,
            self.hi / other.hi,
        ])
    }
}

/// The Stumpff function `c_k(x) = Σ_i (-x)^i/(k + 2i)!` for |x| <= 1, k <= 7.
pub(crate) fn stumpff(k: u32, x: Enclosure) -> Enclosure {
    debug_assert!(x.lo >= -1.0 && x.hi <= 1.0, "{x:?}");
    series(k, x, TERMS, TAIL)
}

/// `T_i = 1 - x T_{i+1}/((k+2i+1)(k+2i+2))` and `c_k = T_0/k!`.
///
/// T_i is the sum from its i-th term on, over that term. For |x| <= 1 the further terms are at most
/// 1/2, 1/4, ... of the first, so that `0 <= T_i <= 2`: the `tail`.
fn series(k: u32, x: Enclosure, terms: usize, tail: Enclosure) -> Enclosure {
    let mut sum = tail;
    for i in (0..terms).rev() {
        let n = f64::from(k) + 2.0 * i as f64;
        sum = Enclosure::from(1.0) - x * sum / ((n + 1.0) * (n + 2.0));
    }
    sum / f64::from((1..=k).product::<u32>())
}

/// sin k and cos k, by the multiple of π/2 nearest to k.
pub(crate) fn sin_cos(k: Enclosure) -> [Enclosure; 2] {
    let quadrant = (k.midpoint() / (0.5 * PI)).round();
    let rest = k - Enclosure::pi() * (0.5 * quadrant);
    let square = rest.square();
    if square.hi.is_nan() || square.hi > 1.0 {
        return [Enclosure { lo: -1.0, hi: 1.0 }; 2];
    }
    let (sin, cos) = (rest * stumpff(1, square), stumpff(0, square));
    match quadrant.rem_euclid(4.0) {
        0.0 => [sin, cos],
        1.0 => [cos, -sin],
        2.0 => [-sin, -cos],
        _ => [-cos, sin],
    }
}

/// tanh κ for κ >= 0, which increases.
pub(crate) fn tanh(kappa: Enclosure) -> Enclosure {
    Enclosure {
        lo: tanh_of(kappa.lo).lo,
        hi: tanh_of(kappa.hi).hi,
    }
}

/// By `tanh 2y = 2 tanh y/(1 + tanh² y)`.
fn tanh_of(kappa: f64) -> Enclosure {
    if kappa.is_nan() || kappa >= SATURATED {
        let lo = 1.0 - 0.5 * f64::EPSILON;
        return Enclosure { lo, hi: 1.0 };
    }
    // A power of two divides exactly.
    let y = Enclosure::from(kappa / f64::from(1_u32 << HALVINGS));
    let square = -y.square();
    let mut value = y * stumpff(1, square) / stumpff(0, square);
    for _ in 0..HALVINGS {
        // It increases up to tanh y = 1, so each bound comes from one bound.
        value = Enclosure {
            lo: doubled(value.lo).lo,
            hi: doubled(value.hi.min(1.0)).hi,
        };
    }
    value
}

fn doubled(value: f64) -> Enclosure {
    let value = Enclosure::from(value);
    value * 2.0 / (value.square() + 1.0)
}

/// A mistake that tests plant: bounds rounded inward.
#[cfg(test)]
pub(crate) mod planted {
    use std::cell::Cell;

    thread_local! {
        static INWARD: Cell<bool> = const { Cell::new(false) };
    }

    pub(super) fn rounds_inward() -> bool {
        INWARD.get()
    }

    /// What `compute` gives with bounds rounded inward.
    pub(crate) fn inward<T>(compute: impl FnOnce() -> T) -> T {
        INWARD.set(true);
        let value = compute();
        INWARD.set(false);
        value
    }
}

#[cfg(test)]
pub(crate) mod tests;
