//! The bound (3.12) of Corollary 3.2, and that of the losses.

use thermobeam::{
    energy::Energy,
    kirchhoff::BUCKLING,
    parameters::{Beam, Obstacles},
    solve::TimeLevel,
};

use crate::exact::norm::slope_squared;
use crate::kinds::prelude::*;

/// What the energy at t = 0 bounds (THEORY.md, "The energy and its exact balance", derives both).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Stability {
    /// The energy above its lower bound: all losses together are at most this, (2.9) and (2.11).
    pub(super) available: f64,
    /// The constant c of Corollary 3.2.
    pub(super) constant: f64,
}

impl Stability {
    /// * `initial_energy`: E^0, with the term of the heated end.
    /// * Returns `None` where nothing is stated: a linear beam beyond its buckling value.
    pub(super) fn of(
        beam: &Beam,
        obstacles: Option<&Obstacles>,
        initial_energy: f64,
    ) -> Option<Self> {
        let Beam {
            beta,
            rho,
            theta_a,
            a,
            ..
        } = *beam;
        // Share of ½ (‖u_x - φ‖² + ‖φ_x‖²) that the term of the axial force leaves.
        let left = if rho > 0.0 {
            1.0
        } else {
            1.0 + beta.min(0.0) / BUCKLING
        };
        if !(left > 0.0) {
            return None;
        }
        let axial = if rho > 0.0 && beta > 0.0 {
            beta * beta / (4.0 * rho)
        } else {
            0.0
        };
        // The heated end takes half of that share, at the price of a constant.
        let heating = a * theta_a;
        let (share, heat) = if heating == 0.0 {
            (left, 0.0)
        } else {
            (0.5 * left, heating * heating / (3.0 * left))
        };
        let epsilon = obstacles.map_or(0.0, |obstacles| obstacles.epsilon);
        let largest = max_or_nan((1.0 + 1.0 / BUCKLING) / share, epsilon);
        let available = initial_energy - axial + heat;
        Some(Self {
            available,
            constant: 2.0 * largest * available,
        })
    }
}

/// The left side of (3.12): norms of a level, and its penetration.
///
/// * `lengths`: of the elements.
pub(super) fn left_side(
    obstacles: Option<&Obstacles>,
    lengths: &[f64],
    level: &TimeLevel,
    energy: &Energy,
) -> f64 {
    let penetration = obstacles.map_or(0.0, |obstacles| 2.0 * obstacles.epsilon * energy.contact);
    let Energy {
        kinetic,
        shear,
        bending,
        thermal,
        ..
    } = energy;
    2.0 * (kinetic + shear + bending + thermal) + slope_squared(lengths, &level.u) + penetration
}
