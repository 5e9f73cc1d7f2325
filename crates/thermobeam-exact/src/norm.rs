//! The norms in which an error is measured.

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
