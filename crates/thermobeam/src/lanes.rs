//! The numbers with which a time step is computed: one case (`f64`) or several cases in parallel
//! ([`Lanes`]).
//!
//! Lanes do not interact: the operations of lane k are those of a single run of case k, in the same
//! order, so the results are bitwise equal.

use std::ops::{Add, Mul, Neg, Sub};

/// `a * b + c`, with one rounding on a machine with fused multiply-add, otherwise with two.
///
/// Without the instruction, `f64::mul_add` is a library call, a hundred times slower.
#[inline(always)]
pub(crate) fn fma(a: f64, b: f64, c: f64) -> f64 {
    if cfg!(any(target_feature = "fma", target_arch = "aarch64")) {
        a.mul_add(b, c)
    } else {
        a * b + c
    }
}

/// A number for each of `WIDTH` cases.
pub trait Lane:
    Copy
    + std::fmt::Debug
    + Send
    + Sync
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Neg<Output = Self>
{
    /// Number of cases.
    const WIDTH: usize;
    /// The same value for every case.
    fn splat(value: f64) -> Self;
    /// The value of each case.
    fn from_fn(value: impl FnMut(usize) -> f64) -> Self;
    /// The first `WIDTH` of the values.
    ///
    /// # Panics
    /// If there are fewer than `WIDTH`.
    fn load(values: &[f64]) -> Self;
    /// The value of case k < WIDTH.
    fn lane(&self, k: usize) -> f64;
    /// Sets the value of case k < WIDTH.
    fn set_lane(&mut self, k: usize, value: f64);
    /// `self * factor + addend`.
    fn mul_add(self, factor: Self, addend: Self) -> Self;
}

impl Lane for f64 {
    const WIDTH: usize = 1;
    #[inline(always)]
    fn splat(value: f64) -> Self {
        value
    }
    #[inline(always)]
    fn from_fn(mut value: impl FnMut(usize) -> f64) -> Self {
        value(0)
    }
    #[inline(always)]
    fn load(values: &[f64]) -> Self {
        values[0]
    }
    #[inline(always)]
    fn lane(&self, _: usize) -> f64 {
        *self
    }
    #[inline(always)]
    fn set_lane(&mut self, _: usize, value: f64) {
        *self = value;
    }
    #[inline(always)]
    fn mul_add(self, factor: Self, addend: Self) -> Self {
        fma(self, factor, addend)
    }
}

/// W cases in parallel; the compiler turns the loops over W into vector instructions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lanes<const W: usize>([f64; W]);

impl<const W: usize> Lane for Lanes<W> {
    const WIDTH: usize = W;
    #[inline(always)]
    fn splat(value: f64) -> Self {
        Self([value; W])
    }
    #[inline(always)]
    fn from_fn(value: impl FnMut(usize) -> f64) -> Self {
        Self(std::array::from_fn(value))
    }
    #[inline(always)]
    fn load(values: &[f64]) -> Self {
        Self(*values.first_chunk().expect("a value for each lane"))
    }
    #[inline(always)]
    fn lane(&self, k: usize) -> f64 {
        self.0[k]
    }
    #[inline(always)]
    fn set_lane(&mut self, k: usize, value: f64) {
        self.0[k] = value;
    }
    #[inline(always)]
    fn mul_add(self, factor: Self, addend: Self) -> Self {
        let mut result = addend;
        for k in 0..W {
            result.0[k] = fma(self.0[k], factor.0[k], addend.0[k]);
        }
        result
    }
}

impl<const W: usize> Add for Lanes<W> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        let mut result = self;
        for k in 0..W {
            result.0[k] = self.0[k] + other.0[k];
        }
        result
    }
}

impl<const W: usize> Sub for Lanes<W> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        let mut result = self;
        for k in 0..W {
            result.0[k] = self.0[k] - other.0[k];
        }
        result
    }
}

impl<const W: usize> Mul for Lanes<W> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let mut result = self;
        for k in 0..W {
            result.0[k] = self.0[k] * other.0[k];
        }
        result
    }
}

impl<const W: usize> Neg for Lanes<W> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        let mut result = self;
        for k in 0..W {
            result.0[k] = -self.0[k];
        }
        result
    }
}
