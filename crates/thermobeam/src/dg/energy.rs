//! The energy and its exact balance.
//!
//! Testing a step's equations with v, w and θ~ themselves gives, for every q and every step in which contact neither
//! begins nor ends,
//!
//! ```text
//! E1 - E0 + ∫ [ζ (‖v_x - w‖² + ‖w_x‖²) + ‖θ~_x‖²] + ½ (‖v(0+) - v0‖² + ‖w(0+) - w0‖² + ‖θ~(0+) - θ~0‖²) = 0,
//! ```
//!
//! with the energy of [`crate::energy`]. The balance also holds for a step that ends on an obstacle, to round-off.

use super::Level;
use super::contact_event::Phase;
use super::space::Space;
use crate::energy::{Balance, Energy};
use crate::parameters::{Beam, Obstacles};

/// The losses of a step, except those of contact.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Losses {
    pub(super) viscous: f64,
    pub(super) thermal: f64,
    pub(super) jumps: f64,
    pub(super) load: f64,
}

/// The data that an energy needs in addition to a level.
pub(super) struct Measured<'a> {
    pub(super) space: &'a Space,
    pub(super) beam: &'a Beam,
    pub(super) obstacles: Option<&'a Obstacles>,
}

impl Measured<'_> {
    /// The energy of a level, term by term.
    pub(super) fn energy(&self, level: &Level) -> Energy {
        let (space, beam) = (self.space, self.beam);
        let (places, rates) = (&level.places, &level.rates);
        let moving = |b: usize| [rates[b][0], rates[b][1], 0.0];
        let warm = |b: usize| [0.0, 0.0, rates[b][2]];
        let stretch = space.stiffness(|b| places[b][0], |b| places[b][0]);
        Energy {
            kinetic: 0.5 * space.mass(moving, moving),
            shear: 0.5 * space.shear(|b| places[b], |b| places[b]),
            bending: 0.5 * space.bending(|b| places[b][1], |b| places[b][1]),
            thermal: 0.5 * space.mass(warm, warm),
            kirchhoff: beam.kirchhoff_energy(stretch),
            contact: self.obstacles.map_or(0.0, |obstacles| obstacles.potential(self.tip(level))),
            lifting: -beam.a * beam.theta_a * self.turned(|b| places[b][1]),
        }
    }

    /// The balance of the step from `old` to `new`, during which the free end was in `phase`.
    pub(super) fn balance(&self, old: &Level, new: &Level, phase: Phase, losses: Losses) -> Balance {
        let Losses { viscous, thermal, jumps, load } = losses;
        let (space, beam) = (self.space, self.beam);
        let rates = |sign: f64| {
            move |b: usize| -> [f64; 3] { std::array::from_fn(|f| new.rates[b][f] + sign * old.rates[b][f]) }
        };
        let places = |sign: f64| {
            move |b: usize| -> [f64; 2] { std::array::from_fn(|f| new.places[b][f] + sign * old.places[b][f]) }
        };
        let stretched = |level: &Level| space.stiffness(|b| level.places[b][0], |b| level.places[b][0]);
        let difference = space.stiffness(|b| places(-1.0)(b)[0], |b| places(1.0)(b)[0]);
        let before = stretched(old);
        let (u, u0) = (self.tip(new), self.tip(old));
        let stored = self.obstacles.map_or(0.0, |obstacles| obstacles.discrete_gradient(u, u0) * (u - u0));
        let done = phase
            .obstacle(self.obstacles)
            .zip(self.obstacles)
            .map_or(0.0, |(g, obstacles)| 0.5 * (u - u0) * ((u - g) + (u0 - g)) / obstacles.epsilon);
        let change = 0.5 * space.mass(rates(-1.0), rates(1.0))
            + 0.5 * space.strain(places(-1.0), places(1.0))
            + beam.kirchhoff_energy_change(before + difference, before)
            - beam.a * beam.theta_a * self.turned(|b| places(-1.0)(b)[1])
            + stored;
        let contact = done - stored;
        let residual = change + viscous + thermal + jumps + load + contact;
        Balance { change, viscous, thermal, inertial: jumps, contact, load, residual }
    }

    fn tip(&self, level: &Level) -> f64 {
        level.places[self.space.tip()][0]
    }

    /// `∫ φ`.
    fn turned(&self, phi: impl Fn(usize) -> f64) -> f64 {
        self.space.rotation_integrals().iter().enumerate().map(|(block, integral)| integral * phi(block)).sum()
    }
}
