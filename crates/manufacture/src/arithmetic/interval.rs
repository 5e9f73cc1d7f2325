//! Intervals that enclose real numbers, each bound rounded outward.
//!
//! A sum is rounded by the sign of its exact error (Knuth, TwoSum), a product or quotient to the
//! next number, since IEEE 754 rounds these to the nearest one. Functions of the C library are
//! widened by [`ULPS`]; those of glibc, musl and Apple have errors of at most two units of the last
//! place.

use std::f64::consts::{FRAC_PI_2, LN_10, PI};
use std::ops::{Add, Div, Mul, Neg, Sub};

use crate::language::names::Function;

/// Bounds that a function of the C library gives are moved outward by so many numbers.
const ULPS: usize = 4;

/// Beyond this angle a sine may have any value between -1 and 1: its period is not resolved.
const LARGEST_ANGLE: f64 = 1e6;

/// An angle so near to a maximum, or to a pole, over its size, counts as one that has it: a
/// multiple of pi is computed within three units of the last place.
const ANGLE: f64 = 8.0 * f64::EPSILON;

/// The real numbers between two bounds, which may be infinite.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Interval {
    pub(crate) lo: f64,
    pub(crate) hi: f64,
}

impl Interval {
    pub(crate) const ENTIRE: Self = Self {
        lo: f64::NEG_INFINITY,
        hi: f64::INFINITY,
    };

    /// One number; all numbers in place of NaN.
    pub(crate) fn point(value: f64) -> Self {
        Self::new(value, value)
    }

    /// All numbers if a bound is NaN.
    pub(crate) fn new(lo: f64, hi: f64) -> Self {
        if lo.is_nan() || hi.is_nan() {
            return Self::ENTIRE;
        }
        Self { lo, hi }
    }

    pub(crate) fn contains_zero(self) -> bool {
        self.lo <= 0.0 && 0.0 <= self.hi
    }

    pub(crate) fn width(self) -> f64 {
        self.hi - self.lo
    }

    /// A number between the bounds.
    pub(crate) fn midpoint(self) -> f64 {
        (0.5 * self.lo + 0.5 * self.hi).clamp(self.lo, self.hi)
    }

    /// From the least of some bounds to the largest of others.
    fn extremes(below: [f64; 4], above: [f64; 4]) -> Self {
        Self::new(
            below.into_iter().fold(f64::INFINITY, f64::min),
            above.into_iter().fold(f64::NEG_INFINITY, f64::max),
        )
    }

    /// The smallest interval around both.
    pub(crate) fn hull(self, other: Self) -> Self {
        Self::new(self.lo.min(other.lo), self.hi.max(other.hi))
    }

    /// The numbers of both; `self` if there is none, which is so only where nothing has a value.
    pub(crate) fn and(self, other: Self) -> Self {
        let lo = self.lo.max(other.lo);
        let hi = self.hi.min(other.hi);
        if lo <= hi { Self { lo, hi } } else { self }
    }

    pub(crate) fn abs(self) -> Self {
        let largest = self.lo.abs().max(self.hi.abs());
        let least = if self.contains_zero() {
            0.0
        } else {
            self.lo.abs().min(self.hi.abs())
        };
        Self::new(least, largest)
    }

    pub(crate) fn min(self, other: Self) -> Self {
        Self::new(self.lo.min(other.lo), self.hi.min(other.hi))
    }

    pub(crate) fn max(self, other: Self) -> Self {
        Self::new(self.lo.max(other.lo), self.hi.max(other.hi))
    }

    /// Whether a pole of the tangent may lie between the bounds.
    pub(crate) fn has_pole_of_tan(self) -> bool {
        has_multiple(self, FRAC_PI_2, PI)
    }

    /// To a power; the numbers that have none are left out.
    pub(crate) fn power(self, exponent: Self) -> Self {
        let is_constant = exponent.lo == exponent.hi;
        if is_constant && exponent.lo.fract() == 0.0 {
            return self.whole_power(exponent.lo);
        }
        if self.hi < 0.0 || (!is_constant && self.lo <= 0.0) {
            return Self::ENTIRE;
        }
        let base = self.max(Self::point(0.0));
        let corners = [
            base.lo.powf(exponent.lo),
            base.lo.powf(exponent.hi),
            base.hi.powf(exponent.lo),
            base.hi.powf(exponent.hi),
        ];
        let power = around(corners, ULPS);
        power.max(Self::point(0.0))
    }

    fn whole_power(self, exponent: f64) -> Self {
        let is_even = exponent % 2.0 == 0.0;
        if exponent == 0.0 {
            return Self::point(1.0);
        }
        if exponent < 0.0 {
            return Self::point(1.0) / self.whole_power(-exponent);
        }
        if exponent == 2.0 {
            let size = self.abs();
            return size * size;
        }
        let base = if is_even { self.abs() } else { self };
        let below = down(base.lo.powf(exponent), ULPS);
        let above = up(base.hi.powf(exponent), ULPS);
        // A power of zero is exact, and one of a size has no sign.
        let lo = if base.lo >= 0.0 {
            below.max(0.0)
        } else {
            below
        };
        let hi = if base.hi <= 0.0 {
            above.min(0.0)
        } else {
            above
        };
        Self::new(lo, hi)
    }

    /// The values of a function; arguments outside its domain are left out.
    pub(crate) fn call(self, function: Function) -> Self {
        let unit = Self::new(-1.0, 1.0);
        let positive = Self::new(0.0, f64::INFINITY);
        match function {
            Function::Sin => sine(self, FRAC_PI_2),
            Function::Cos => sine(self, 0.0),
            Function::Tan if self.has_pole_of_tan() => Self::ENTIRE,
            Function::Tan => self.rising(f64::tan),
            Function::Asin => self.and(unit).rising(f64::asin),
            Function::Acos => (-self.and(unit)).rising(|x| (-x).acos()),
            Function::Atan => self.rising(f64::atan),
            Function::Sinh => self.rising(f64::sinh),
            Function::Cosh => {
                let cosh = self.abs().rising(f64::cosh);
                cosh.max(Self::point(1.0))
            }
            Function::Tanh => self.rising(f64::tanh).and(unit),
            // An exponential is not zero, though its number may be.
            Function::Exp => {
                Self::new(down(self.lo.exp(), ULPS), up(self.hi.exp(), ULPS)).and(positive)
            }
            Function::Ln if self.hi <= 0.0 => Self::ENTIRE,
            Function::Ln => self.and(positive).rising(f64::ln),
            Function::Log10 if self.hi <= 0.0 => Self::ENTIRE,
            Function::Log10 => self.and(positive).rising(f64::log10),
            Function::Sqrt if self.hi < 0.0 => Self::ENTIRE,
            Function::Sqrt => self.and(positive).rising(f64::sqrt).and(positive),
        }
    }

    /// The derivatives of a function at these arguments, where its values are `values`.
    pub(crate) fn slope(self, function: Function, values: Self) -> Self {
        let one = Self::point(1.0);
        match function {
            Function::Sin => self.call(Function::Cos),
            Function::Cos => -self.call(Function::Sin),
            Function::Tan => one + values.whole_power(2.0),
            Function::Asin => one / (one - self.whole_power(2.0)).call(Function::Sqrt),
            Function::Acos => -(one / (one - self.whole_power(2.0)).call(Function::Sqrt)),
            Function::Atan => one / (one + self.whole_power(2.0)),
            Function::Sinh => self.call(Function::Cosh),
            Function::Cosh => self.call(Function::Sinh),
            Function::Tanh => one - values.whole_power(2.0),
            Function::Exp => values,
            Function::Ln => one / self,
            Function::Log10 => one / (self * Self::new(LN_10.next_down(), LN_10.next_up())),
            Function::Sqrt => Self::point(0.5) / values,
        }
    }

    /// The values of a function that rises, and whose zeros are exact.
    fn rising(self, function: impl Fn(f64) -> f64) -> Self {
        let [lo, hi] = [function(self.lo), function(self.hi)];
        let ulps = |bound: f64| if bound == 0.0 { 0 } else { ULPS };
        Self::new(down(lo, ulps(lo)), up(hi, ulps(hi)))
    }
}

/// A lower bound, moved down by so many numbers. An infinite lower bound is one that overflowed.
fn down(value: f64, ulps: usize) -> f64 {
    if value == f64::INFINITY {
        return f64::MAX;
    }
    (0..ulps).fold(value, |value, _| value.next_down())
}

fn up(value: f64, ulps: usize) -> f64 {
    -down(-value, ulps)
}

/// The interval around four bounds, widened.
fn around(bounds: [f64; 4], ulps: usize) -> Interval {
    if bounds.iter().any(|bound| bound.is_nan()) {
        return Interval::ENTIRE;
    }
    let least = bounds.into_iter().fold(f64::INFINITY, f64::min);
    let largest = bounds.into_iter().fold(f64::NEG_INFINITY, f64::max);
    Interval::new(down(least, ulps), up(largest, ulps))
}

/// Whether `start` plus a multiple of `period` lies between the bounds, or next to them.
fn has_multiple(angle: Interval, start: f64, period: f64) -> bool {
    let largest = angle.lo.abs().max(angle.hi.abs());
    if !(largest < LARGEST_ANGLE) {
        return true;
    }
    let near = ANGLE * (largest + start + period);
    let first = ((angle.lo - near - start) / period).floor();
    let last = ((angle.hi + near - start) / period).floor();
    first != last
}

/// The cosine of an angle minus `shift`: its largest values are at `shift`.
fn sine(angle: Interval, shift: f64) -> Interval {
    let is_sine = shift != 0.0;
    let value = |x: f64| if is_sine { x.sin() } else { x.cos() };
    let ends = [value(angle.lo), value(angle.hi)];
    if ends.iter().any(|end| end.is_nan()) {
        return Interval::new(-1.0, 1.0);
    }
    let mut lo = down(ends[0].min(ends[1]), ULPS).max(-1.0);
    let mut hi = up(ends[0].max(ends[1]), ULPS).min(1.0);
    if has_multiple(angle, shift, 2.0 * PI) {
        hi = 1.0;
    }
    if has_multiple(angle, shift + PI, 2.0 * PI) {
        lo = -1.0;
    }
    // The sine of zero is zero.
    if is_sine && angle.lo == 0.0 && angle.hi <= FRAC_PI_2 {
        lo = lo.max(0.0);
    }
    Interval::new(lo, hi)
}

/// A sum, rounded down.
fn sum_down(a: f64, b: f64) -> f64 {
    let sum = a + b;
    if !sum.is_finite() {
        let is_above = sum == f64::INFINITY;
        return if is_above {
            f64::MAX
        } else {
            f64::NEG_INFINITY
        };
    }
    let part = sum - a;
    let error = (a - (sum - part)) + (b - part);
    // An error that is not known, since a part of it overflowed, counts.
    if error >= 0.0 { sum } else { sum.next_down() }
}

/// A product, rounded down; zero times infinity is zero, as the bounds of intervals need it.
fn product_down(a: f64, b: f64) -> f64 {
    if a == 0.0 || b == 0.0 {
        return 0.0;
    }
    let is_exact = a.abs() == 1.0 || b.abs() == 1.0;
    down(a * b, usize::from(!is_exact))
}

/// A quotient, rounded down.
fn quotient_down(a: f64, b: f64) -> f64 {
    if a == 0.0 {
        return 0.0;
    }
    if a.is_infinite() && b.is_infinite() {
        // From zero to infinity, by how the operands grow.
        return f64::min(0.0, a * b.signum());
    }
    down(a / b, usize::from(b.abs() != 1.0))
}

impl Neg for Interval {
    type Output = Self;

    fn neg(self) -> Self {
        Self::new(-self.hi, -self.lo)
    }
}

impl Add for Interval {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self::new(sum_down(self.lo, other.lo), -sum_down(-self.hi, -other.hi))
    }
}

impl Sub for Interval {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Interval {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let corners = [
            [self.lo, other.lo],
            [self.lo, other.hi],
            [self.hi, other.lo],
            [self.hi, other.hi],
        ];
        let below = corners.map(|[a, b]| product_down(a, b));
        let above = corners.map(|[a, b]| -product_down(-a, b));
        Self::extremes(below, above)
    }
}

impl Div for Interval {
    type Output = Self;

    /// All numbers if the divisor may be zero.
    fn div(self, other: Self) -> Self {
        if other.contains_zero() {
            return Self::ENTIRE;
        }
        let corners = [
            [self.lo, other.lo],
            [self.lo, other.hi],
            [self.hi, other.lo],
            [self.hi, other.hi],
        ];
        let below = corners.map(|[a, b]| quotient_down(a, b));
        let above = corners.map(|[a, b]| -quotient_down(-a, b));
        Self::extremes(below, above)
    }
}
