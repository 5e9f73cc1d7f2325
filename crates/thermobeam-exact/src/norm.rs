//! The norms in which an error is measured, and the values of an error in them.

use std::ops::{Index, IndexMut};

use thermobeam::norms::max_or_nan;

/// A norm of the error at one time level. A convergence study takes its maximum over the time levels n = 1..N.
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
    /// Root of the sum of these five squares at the same n: the left-hand side of (3.14), Theorem 3.4.
    Theorem34,
    /// ‖u_h - u‖.
    Displacement,
    /// The norm of [`Norm::Theorem34`] of the distance to the nodal interpolants of the exact solution: Z_n^½ of
    /// (3.16).
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_norm_has_its_own_number() {
        for (k, norm) in Norm::ALL.into_iter().enumerate() {
            let mut norms = Norms::of(|norm| norm as usize as f64);
            assert_eq!(norms[norm], k as f64);
            norms[norm] = -1.0;
            assert_eq!(norms.iter().filter(|(_, value)| *value == -1.0).collect::<Vec<_>>(), [(norm, -1.0)]);
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
