//! The discrete energy (3.9) and its exact balance over a step, term by term.
//!
//! For an exactly solved step without loads:
//!
//! ```text
//! E^n - E^{n-1} + dt ζ (‖V_x - W‖² + ‖W_x‖²) + dt ‖θ~_x‖²(n-½) + ½ (‖v - v0‖² + ‖w - w0‖²) + gap = 0,
//! gap = F (u(1) - u0(1)) - (G(u(1)) - G(u0(1))) >= 0,
//! ```
//!
//! V and W are the velocities of the step, F is its contact force. The balance follows from (3.7)
//! with the test functions dt V, dt W and dt θ~^{n-½}, as in the proof of Proposition 3.1, with
//! each inequality kept as an equation. In the `midpoint` scheme the terms ½ (‖v - v0‖² + ‖w -
//! w0‖²) and gap are zero. For θ_A ≠ 0 the energy is (3.9) with the lifted temperature θ~ plus the
//! term `-a θ_A ∫φ`, without which it need not decrease.
//!
//! A wrong step may still lose energy, but its balance does not close to round-off.

use std::ops::AddAssign;

mod rounding;
pub(crate) mod sums;

pub use rounding::Rounding;

use crate::level::TimeLevel;
use crate::norms::{l2_squared, shear_squared, slope_squared};
use crate::parameters::{Beam, Obstacles};
use crate::scheme::SteppedBeam;
use sums::Sums;

/// The terms of the discrete energy E^n, (3.9).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Energy {
    /// ½ (‖û‖² + ‖φ̂‖²).
    pub kinetic: f64,
    /// ½ ‖u_x - φ‖².
    pub shear: f64,
    /// ½ ‖φ_x‖².
    pub bending: f64,
    /// ½ ‖θ~‖².
    pub thermal: f64,
    /// N(u)²/(4ρ), or β/2 ‖u_x‖² for ρ = 0.
    pub kirchhoff: f64,
    /// G(u)(1).
    pub contact: f64,
    /// -a θ_A ∫φ.
    pub lifting: f64,
}

impl Energy {
    /// E^n, the sum of the terms.
    pub fn total(&self) -> f64 {
        self.kinetic
            + self.shear
            + self.bending
            + self.thermal
            + self.kirchhoff
            + self.contact
            + self.lifting
    }

    /// The sum of the absolute values of the terms, Kirchhoff's without its constant: `N²/(4ρ)`
    /// contains β²/(4ρ), which would hide every residual for small ρ.
    ///
    /// * `stretch`: ‖u_x‖².
    pub(crate) fn size(&self, beam: &Beam, stretch: f64) -> f64 {
        let kirchhoff = 0.5 * beam.beta.abs() * stretch + 0.25 * beam.rho * stretch * stretch;
        self.kinetic
            + self.shear
            + self.bending
            + self.thermal
            + self.contact
            + self.lifting.abs()
            + kirchhoff
    }
}

/// ∫ y of a P1 function.
fn mean(lengths: &[f64], y: &[f64]) -> f64 {
    lengths
        .iter()
        .zip(y.windows(2))
        .map(|(h, y)| 0.5 * h * (y[0] + y[1]))
        .sum()
}

/// The balance of one step, of a one-step scheme or of [`dg`](crate::dg); `residual` is the sum of
/// the other terms, and round-off for an exactly solved step.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Balance {
    /// E^n - E^{n-1}, computed from the differences of the fields, without cancellation.
    pub change: f64,
    /// dt ζ (‖V_x - W‖² + ‖W_x‖²); for dG its integral over the step.
    pub viscous: f64,
    /// dt ‖θ~_x‖² at n-½; for dG its integral over the step.
    pub thermal: f64,
    /// ½ (‖v - v0‖² + ‖w - w0‖²), the numerical dissipation of backward Euler; zero for `midpoint`.
    /// For dG that of the jumps at the start of the step, including the temperature.
    pub inertial: f64,
    /// The gap of the contact energy; for dG round-off, unless the free end grazes an obstacle.
    pub contact: f64,
    /// Minus the work of the loads; omitted, and zero, for one-step schemes.
    pub load: f64,
    /// The sum of the other terms.
    pub residual: f64,
}

impl AddAssign for Balance {
    fn add_assign(&mut self, other: Self) {
        self.change += other.change;
        self.viscous += other.viscous;
        self.thermal += other.thermal;
        self.inertial += other.inertial;
        self.contact += other.contact;
        self.load += other.load;
        self.residual += other.residual;
    }
}

impl Balance {
    /// The balance if no step was done.
    pub(crate) const NAN: Self = Self {
        change: f64::NAN,
        viscous: f64::NAN,
        thermal: f64::NAN,
        inertial: f64::NAN,
        contact: f64::NAN,
        load: f64::NAN,
        residual: f64::NAN,
    };

    /// The balance from the sums over the elements.
    ///
    /// * `tip`: u0(1) and u(1).
    /// * `force`: the contact force of the step.
    pub(crate) fn from_sums(
        case: &SteppedBeam,
        sums: &Sums<f64>,
        [u0, u]: [f64; 2],
        force: f64,
    ) -> Self {
        let SteppedBeam {
            beam,
            obstacles,
            scheme,
            dt,
            ..
        } = case;
        let stored = contact_change(obstacles.as_ref(), u0, u);
        let change = change(case, sums, stored);
        let gap = obstacles.map_or(0.0, |_| force * (u - u0) - stored);
        let viscous = dt * beam.zeta * sums.viscous;
        let thermal = dt * sums.heat_flow;
        // (v - v0, V) with V = v0 + (v - v0)/inertia: backward Euler loses half of the squared
        // jump, the midpoint rule nothing.
        let inertial = (1.0 / scheme.inertia - 0.5) * sums.jump;
        let residual = change + viscous + thermal + inertial + gap;
        Self {
            change,
            viscous,
            thermal,
            inertial,
            contact: gap,
            load: 0.0,
            residual,
        }
    }
}

impl SteppedBeam {
    /// The energy (3.9) of a level.
    pub fn energy(&self, level: &TimeLevel) -> Energy {
        let Self {
            beam,
            obstacles,
            lengths,
            ..
        } = self;
        Energy {
            kinetic: 0.5 * (l2_squared(lengths, &level.v) + l2_squared(lengths, &level.w)),
            shear: 0.5 * shear_squared(lengths, &level.u, &level.phi),
            bending: 0.5 * slope_squared(lengths, &level.phi),
            thermal: 0.5 * l2_squared(lengths, &level.theta),
            kirchhoff: beam.kirchhoff_energy(slope_squared(lengths, &level.u)),
            contact: obstacles.map_or(0.0, |obstacles| obstacles.potential(tip(level))),
            lifting: -beam.a * beam.theta_a * mean(lengths, &level.phi),
        }
    }

    /// The balance of the step from `old` to `new`, without loads.
    pub fn balance(&self, old: &TimeLevel, new: &TimeLevel) -> Balance {
        let sums = Sums::over::<true>(&self.lengths, 1.0 / self.scheme.inertia, old, new);
        Balance::from_sums(self, &sums, [tip(old), tip(new)], new.contact_force)
    }

    /// The change of the energy from one level to another: only [`Balance::change`], at half the
    /// cost.
    pub fn energy_change(&self, old: &TimeLevel, new: &TimeLevel) -> f64 {
        let stored = contact_change(self.obstacles.as_ref(), tip(old), tip(new));
        // The weight only enters the dissipation, which is not computed here.
        change(
            self,
            &Sums::over::<false>(&self.lengths, 0.5, old, new),
            stored,
        )
    }
}

/// E^n - E^{n-1}; `stored` is the change of the contact energy.
fn change(SteppedBeam { beam, .. }: &SteppedBeam, sums: &Sums<f64>, stored: f64) -> f64 {
    sums.quadratic
        + beam.kirchhoff_energy_change(sums.slope_squared[1], sums.slope_squared[0])
        + stored
        - beam.a * beam.theta_a * sums.rotation_change
}

/// G(u(1)) - G(u0(1)), without cancellation.
fn contact_change(obstacles: Option<&Obstacles>, u0: f64, u: f64) -> f64 {
    obstacles.map_or(0.0, |obstacles| {
        obstacles.discrete_gradient(u, u0) * (u - u0)
    })
}

fn tip(level: &TimeLevel) -> f64 {
    level.u[level.u.len() - 1]
}
