//! The bound (3.12) of Corollary 3.2.

use thermobeam::energy::Energy;
use thermobeam::norms::slope_squared;

use crate::kinds::prelude::*;

/// The constant c of Corollary 3.2, by the energy E^0 at t = 0 (THEORY.md derives it); `None` where
/// nothing is stated.
pub(super) fn stability(
    beam: &Beam,
    obstacles: Option<&Obstacles>,
    initial_energy: f64,
) -> Option<f64> {
    let Beam {
        beta, rho, theta_a, ..
    } = *beam;
    // Share of ½ (‖u_x - φ‖² + ‖φ_x‖²) that the term of the axial force leaves.
    let left = if rho > 0.0 {
        1.0
    } else {
        1.0 + beta.min(0.0) / BUCKLING
    };
    let constant = if rho > 0.0 && beta > 0.0 {
        beta * beta / (4.0 * rho)
    } else {
        0.0
    };
    let epsilon = obstacles.map_or(0.0, |obstacles| obstacles.epsilon);
    let largest = max_or_nan((1.0 + 1.0 / BUCKLING) / left, epsilon);
    (theta_a == 0.0 && left > 0.0).then_some(2.0 * largest * (initial_energy - constant))
}

/// The left side of (3.12): norms of a level, and its penetration.
///
/// * `lengths`: of the elements.
pub(super) fn left_side(
    obstacles: Option<&Obstacles>,
    lengths: &[f64],
    level: &Level,
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
