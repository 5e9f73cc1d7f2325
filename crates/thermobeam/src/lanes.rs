//! The numbers with which a time step is computed: one case (`f64`) or several cases in parallel
//! ([`Lanes`]).
//!
//! Lanes do not interact: the operations of lane k are those of a single run of case k, in the same
//! order, so the results are bitwise equal.

use std::ops::{Add, Mul, Neg, Sub};

/// Whether every machine for which this is compiled has fused multiply-add.
const IS_FUSED: bool = cfg!(any(target_feature = "fma", target_arch = "aarch64"));

/// `a * b + c`, with one rounding if [`IS_FUSED`], otherwise with two.
///
/// Without the instruction, `f64::mul_add` is a library call, a hundred times slower.
#[inline(always)]
pub(crate) fn fma(a: f64, b: f64, c: f64) -> f64 {
    if IS_FUSED {
        Fused::multiply_add(a, b, c)
    } else {
        Separate::multiply_add(a, b, c)
    }
}

/// How `a * b + c` is computed.
pub(crate) trait MultiplyAdd {
    /// `a * b + c`.
    fn multiply_add(a: f64, b: f64, c: f64) -> f64;
}

/// With one rounding, by the machine's instruction.
pub(crate) struct Fused;

/// With two roundings, on machines without such an instruction.
pub(crate) struct Separate;

impl MultiplyAdd for Fused {
    #[inline(always)]
    fn multiply_add(a: f64, b: f64, c: f64) -> f64 {
        a.mul_add(b, c)
    }
}

impl MultiplyAdd for Separate {
    #[inline(always)]
    fn multiply_add(a: f64, b: f64, c: f64) -> f64 {
        a * b + c
    }
}

/// Code that is compiled for each kind of machine. All of it must be `#[inline(always)]`.
pub(crate) trait Kernel {
    /// Its result.
    type Output;
    /// Runs it.
    fn run<A: MultiplyAdd>(self) -> Self::Output;
}

/// Runs a kernel with the instructions of this machine, also in a program that was compiled for
/// every machine: with fused multiply-add wherever the machine has it, so the results are the same.
///
/// Compiled for every x86-64 machine, a step by Newton's method takes 1.2 times as long as compiled
/// for one with the instruction; with two roundings it took 1.7 times as long.
#[inline(always)]
pub(crate) fn run_kernel<K: Kernel>(kernel: K) -> K::Output {
    if IS_FUSED {
        return kernel.run::<Fused>();
    }
    #[cfg(all(target_arch = "x86_64", not(target_feature = "fma"), not(doc)))]
    if let Some(machine) = pulp::x86::V3::try_new() {
        return machine.vectorize(ForMachine(kernel));
    }
    kernel.run::<Separate>()
}

/// A kernel for the instructions that `pulp` has found. (`rustdoc` may be started without the
/// instruction set by which cargo has left `pulp` out: it does without.)
#[cfg(all(target_arch = "x86_64", not(target_feature = "fma"), not(doc)))]
struct ForMachine<K>(K);

#[cfg(all(target_arch = "x86_64", not(target_feature = "fma"), not(doc)))]
impl<K: Kernel> pulp::NullaryFnOnce for ForMachine<K> {
    type Output = K::Output;

    #[inline(always)]
    fn call(self) -> K::Output {
        self.0.run::<Fused>()
    }
}

/// A number for each of `WIDTH` cases.
pub(crate) trait Lane:
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
    fn mul_add<A: MultiplyAdd>(self, factor: Self, addend: Self) -> Self;
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
    fn mul_add<A: MultiplyAdd>(self, factor: Self, addend: Self) -> Self {
        A::multiply_add(self, factor, addend)
    }
}

/// W cases in parallel; the compiler turns the loops over W into vector instructions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Lanes<const W: usize>([f64; W]);

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
    fn mul_add<A: MultiplyAdd>(self, factor: Self, addend: Self) -> Self {
        let mut result = addend;
        for k in 0..W {
            result.0[k] = A::multiply_add(self.0[k], factor.0[k], addend.0[k]);
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

#[cfg(test)]
mod tests {
    use super::*;

    /// (1 + ε)(1 - ε) - 1 is -ε², and 0 with two roundings.
    struct Cancellation;

    impl Kernel for Cancellation {
        type Output = f64;

        #[inline(always)]
        fn run<A: MultiplyAdd>(self) -> f64 {
            A::multiply_add(1.0 + f64::EPSILON, 1.0 - f64::EPSILON, -1.0)
        }
    }

    #[test]
    fn a_kernel_rounds_once_wherever_the_machine_can() {
        #[cfg(target_arch = "x86_64")]
        let is_fused = std::is_x86_feature_detected!("fma");
        #[cfg(not(target_arch = "x86_64"))]
        let is_fused = cfg!(target_arch = "aarch64");
        let expected = if is_fused {
            -f64::EPSILON * f64::EPSILON
        } else {
            0.0
        };
        assert_eq!(run_kernel(Cancellation), expected);
    }
}
