//! The norms in which an error is measured, and the values of an error in them.
//!
//! The norms of P1 functions are written here a second time: the solver uses its own in the energy
//! and in the fixed point.

use std::ops::{Index, IndexMut};

/// A norm of the error at one time level. A convergence study takes its maximum over the time
/// levels n = 1..N.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Norm {
    /// ‖û - u_t‖.
    Velocity,
    /// ‖u_hx - φ_h - (u_x - φ)‖.
    Shear,
    /// ‖φ̂ - φ_t‖.
    RotationRate,
    /// ‖φ_hx - φ_x‖.
    Curvature,
    /// ‖θ_h - θ‖.
    Temperature,
    /// Root of the sum of these five squares at the same n: the left-hand side of (3.14), Theorem
    /// 3.4.
    Theorem34,
    /// ‖u_h - u‖.
    Displacement,
    /// The norm of [`Norm::Theorem34`] of the distance to the nodal interpolants of the exact
    /// solution: Z_n^½ of (3.16).
    Superclose,
}

impl Norm {
    /// All norms.
    pub const ALL: [Norm; 8] = [
        Norm::Velocity,
        Norm::Shear,
        Norm::RotationRate,
        Norm::Curvature,
        Norm::Temperature,
        Norm::Theorem34,
        Norm::Displacement,
        Norm::Superclose,
    ];

    /// The name in study files and records.
    pub const fn name(self) -> &'static str {
        match self {
            Norm::Velocity => "velocity",
            Norm::Shear => "shear",
            Norm::RotationRate => "rotation-rate",
            Norm::Curvature => "curvature",
            Norm::Temperature => "temperature",
            Norm::Theorem34 => "theorem-3.4",
            Norm::Displacement => "displacement",
            Norm::Superclose => "superclose",
        }
    }

    /// The notation of the paper, for the legends of figures.
    pub const fn symbol(self) -> &'static str {
        match self {
            Norm::Velocity => "‖ûₕ−uₜ‖",
            Norm::Shear => "‖uₕₓ−φₕ−(uₓ−φ)‖",
            Norm::RotationRate => "‖φ\u{302}ₕ−φₜ‖",
            Norm::Curvature => "‖φₕₓ−φₓ‖",
            Norm::Temperature => "‖θₕ−θ‖",
            Norm::Theorem34 => "norm of (3.14)",
            Norm::Displacement => "‖uₕ−u‖",
            Norm::Superclose => "√Zₙ of (3.16)",
        }
    }
}

/// One number for each norm, such as the errors at one time level.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Norms([f64; Norm::ALL.len()]);

impl Norms {
    /// Zero in each norm: the initial value of a maximum.
    pub const ZERO: Self = Self([0.0; Norm::ALL.len()]);

    /// NaN in each norm: the result of a failed run.
    pub const NAN: Self = Self([f64::NAN; Norm::ALL.len()]);

    /// The values of `f`.
    pub fn of(f: impl FnMut(Norm) -> f64) -> Self {
        Self(Norm::ALL.map(f))
    }

    /// Each norm with its number.
    pub fn iter(&self) -> impl Iterator<Item = (Norm, f64)> {
        Norm::ALL.into_iter().zip(self.0)
    }

    /// The larger number in each norm; NaN if either is NaN.
    pub fn max(&self, other: &Self) -> Self {
        Self::of(|norm| max_or_nan(self[norm], other[norm]))
    }
}

impl Index<Norm> for Norms {
    type Output = f64;

    fn index(&self, norm: Norm) -> &f64 {
        &self.0[norm as usize]
    }
}

impl IndexMut<Norm> for Norms {
    fn index_mut(&mut self, norm: Norm) -> &mut f64 {
        &mut self.0[norm as usize]
    }
}

/// The larger of two numbers; NaN if either is NaN, which `f64::max` would drop.
pub fn max_or_nan(a: f64, b: f64) -> f64 {
    if a.is_nan() || a >= b { a } else { b }
}

/// The scalar product of two lists of numbers.
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// `∫ y²` over an element of length h for the linear y with these values at its ends:
/// `h (y0² + y0 y1 + y1²)/3`.
fn on_element(h: f64, [left, right]: [f64; 2]) -> f64 {
    h / 6.0 * (left * (2.0 * left + right) + right * (left + 2.0 * right))
}

/// `‖y‖²` of a P1 function.
///
/// * `lengths`: the n element lengths; `y`: the n + 1 nodal values.
pub fn l2_squared(lengths: &[f64], y: &[f64]) -> f64 {
    lengths
        .iter()
        .zip(y.windows(2))
        .map(|(&h, y)| on_element(h, [y[0], y[1]]))
        .sum()
}

/// `‖y_x‖²` of a P1 function; arguments as in [`l2_squared`].
pub fn slope_squared(lengths: &[f64], y: &[f64]) -> f64 {
    lengths
        .iter()
        .zip(y.windows(2))
        .map(|(&h, y)| (y[1] - y[0]) * (y[1] - y[0]) / h)
        .sum()
}

/// `‖u_x - φ‖²` of two P1 functions; arguments as in [`l2_squared`].
fn shear_squared(lengths: &[f64], u: &[f64], phi: &[f64]) -> f64 {
    let mut sum = 0.0;
    for (&h, (u, phi)) in lengths.iter().zip(u.windows(2).zip(phi.windows(2))) {
        let slope = (u[1] - u[0]) / h;
        sum += on_element(h, [slope - phi[0], slope - phi[1]]);
    }
    sum
}

/// The five squares on the left-hand side of (3.14), Theorem 3.4, in its order.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TheoremSquares {
    /// ‖û‖².
    pub velocity: f64,
    /// ‖u_x - φ‖².
    pub shear: f64,
    /// ‖φ̂‖².
    pub rotation_rate: f64,
    /// ‖φ_x‖².
    pub curvature: f64,
    /// ‖θ‖².
    pub temperature: f64,
}

impl TheoremSquares {
    /// Those of the P1 functions with these nodal values; arguments as in [`l2_squared`].
    pub fn of(
        lengths: &[f64],
        v: &[f64],
        u: &[f64],
        w: &[f64],
        phi: &[f64],
        theta: &[f64],
    ) -> Self {
        Self {
            velocity: l2_squared(lengths, v),
            shear: shear_squared(lengths, u, phi),
            rotation_rate: l2_squared(lengths, w),
            curvature: slope_squared(lengths, phi),
            temperature: l2_squared(lengths, theta),
        }
    }

    /// Root of the sum of the squares: the norm in which (3.14) is stated.
    pub fn norm(&self) -> f64 {
        (self.velocity + self.shear + self.rotation_rate + self.curvature + self.temperature).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_norm_has_its_own_number() {
        for (k, norm) in Norm::ALL.into_iter().enumerate() {
            let mut norms = Norms::of(|norm| norm as usize as f64);
            assert_eq!(norms[norm], k as f64);
            norms[norm] = -1.0;
            assert_eq!(
                norms
                    .iter()
                    .filter(|(_, value)| *value == -1.0)
                    .collect::<Vec<_>>(),
                [(norm, -1.0)]
            );
        }
    }

    #[test]
    fn a_maximum_keeps_nan() {
        let one = Norms::of(|norm| if norm == Norm::Shear { f64::NAN } else { 1.0 });
        let two = Norms::of(|norm| if norm == Norm::Velocity { 2.0 } else { 0.5 });
        for worst in [one.max(&two), two.max(&one)] {
            assert_eq!((worst[Norm::Velocity], worst[Norm::Theorem34]), (2.0, 1.0));
            assert!(worst[Norm::Shear].is_nan());
        }
    }
}
