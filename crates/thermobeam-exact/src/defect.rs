//! Deliberate mistakes in the loads and in the initial data, for negative controls.
//!
//! Loads and solver share no function of the problem. So a mistake here stands for the same mistake
//! in the solver: it leaves the same difference between both sides.

use thermobeam::parameters::{Beam, Obstacles};

use crate::formulas::axial_force;

/// A deliberate mistake in the loads or in the initial data.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Defect {
    /// Values at t_n where the scheme uses t_{n-½}.
    SourceAtNewLevel,
    /// The load σ(1, t) + g(u(1, t)) is dropped.
    StressDropped,
    /// The load φ_x(1, t) + ζ φ_xt(1, t) is dropped.
    MomentDropped,
    /// N(u^n) instead of the mean ½(N(u^n) + N(u^{n-1})).
    ForceAtNewLevel,
    /// Contact at t_{n-½} where the scheme uses t_n.
    ContactAtMiddle,
    /// `N = β + ½ ρ ‖u_x‖²`.
    HalfOfRho,
    /// `N = ρ ‖u_x‖²`.
    WithoutBeta,
    /// N(½(u^n + u^{n-1})) instead of the mean ½(N(u^n) + N(u^{n-1})).
    ForceOfMeanState,
    /// g/2.
    HalfOfContact,
    /// The obstacle g1 is not there.
    LowerForgotten,
    /// The obstacle g2 is not there.
    UpperForgotten,
    /// -g.
    ContactReversed,
    /// The load ½ a θ_x instead of a θ_x.
    HalfOfCoupling,
    /// The initial temperature without θ_A (1 - x).
    StartNotLifted,
}

impl Defect {
    /// All defects, with their effects in words.
    pub const ALL: [(Self, &str); 14] = [
        (
            Self::SourceAtNewLevel,
            "source at t_n instead of the middle",
        ),
        (Self::StressDropped, "boundary load of the stress dropped"),
        (Self::MomentDropped, "boundary load of the moment dropped"),
        (Self::ForceAtNewLevel, "N(u^n) instead of the mean of N"),
        (
            Self::ContactAtMiddle,
            "contact at the middle instead of t_n",
        ),
        (Self::HalfOfRho, "half of rho in N"),
        (Self::WithoutBeta, "N without beta"),
        (
            Self::ForceOfMeanState,
            "N of the mean state instead of the mean of N",
        ),
        (Self::HalfOfContact, "half of the contact force"),
        (Self::LowerForgotten, "lower obstacle forgotten"),
        (Self::UpperForgotten, "upper obstacle forgotten"),
        (Self::ContactReversed, "contact force with the other sign"),
        (Self::HalfOfCoupling, "half of the load a theta_x"),
        (
            Self::StartNotLifted,
            "theta_A missing in the initial temperature",
        ),
    ];

    /// Its effect in words.
    pub const fn name(self) -> &'static str {
        Self::ALL[self as usize].1
    }

    /// Whether it is a mistake in a formula of (1.1)-(1.3), for any method; the others are about
    /// the levels of one-step schemes.
    pub const fn is_of_the_problem(self) -> bool {
        !matches!(
            self,
            Self::SourceAtNewLevel
                | Self::ForceAtNewLevel
                | Self::ContactAtMiddle
                | Self::ForceOfMeanState
        )
    }

    /// Whether the problem with these coefficients has the term that is wrong.
    pub fn applies(self, beam: &Beam, obstacles: Option<&Obstacles>) -> bool {
        match self {
            Self::SourceAtNewLevel | Self::StressDropped | Self::MomentDropped => true,
            Self::ForceAtNewLevel | Self::HalfOfRho | Self::ForceOfMeanState => beam.rho != 0.0,
            Self::WithoutBeta => beam.beta != 0.0,
            Self::HalfOfCoupling => beam.a != 0.0,
            Self::StartNotLifted => beam.theta_a != 0.0,
            Self::ContactAtMiddle
            | Self::HalfOfContact
            | Self::LowerForgotten
            | Self::UpperForgotten
            | Self::ContactReversed => obstacles.is_some(),
        }
    }
}

/// N(u) for given `‖u_x‖²`, with a defect if it is one of N.
pub(crate) fn axial_force_with(defect: Option<Defect>, beam: &Beam, slope_squared: f64) -> f64 {
    match defect {
        Some(Defect::HalfOfRho) => axial_force(
            &Beam {
                rho: 0.5 * beam.rho,
                ..*beam
            },
            slope_squared,
        ),
        Some(Defect::WithoutBeta) => axial_force(&Beam { beta: 0.0, ..*beam }, slope_squared),
        _ => axial_force(beam, slope_squared),
    }
}

/// The contact force by a law, with a defect if it is one of the law; zero without obstacles.
pub(crate) fn contact_with(
    defect: Option<Defect>,
    obstacles: Option<&Obstacles>,
    law: impl Fn(&Obstacles) -> f64,
) -> f64 {
    let Some(&obstacles) = obstacles else {
        return 0.0;
    };
    match defect {
        Some(Defect::HalfOfContact) => 0.5 * law(&obstacles),
        Some(Defect::LowerForgotten) => law(&Obstacles {
            g1: f64::NEG_INFINITY,
            ..obstacles
        }),
        Some(Defect::UpperForgotten) => law(&Obstacles {
            g2: f64::INFINITY,
            ..obstacles
        }),
        Some(Defect::ContactReversed) => -law(&obstacles),
        _ => law(&obstacles),
    }
}
