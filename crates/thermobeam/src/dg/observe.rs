//! Output of a simulation: fields anywhere in the last step, the energy, and its exact balance.
//!
//! Testing a step's equations with v, w and θ~ themselves gives, for every q and every step in
//! which contact neither begins nor ends,
//!
//! ```text
//! E1 - E0 + ∫ [ζ (‖v_x - w‖² + ‖w_x‖²) + ‖θ~_x‖²] + ½ (‖v(0+) - v0‖² + ‖w(0+) - w0‖² + ‖θ~(0+) - θ~0‖²) = 0,
//! ```
//!
//! with the energy of [`crate::energy`]. The balance also holds for a step that ends on an
//! obstacle, to round-off.

use super::phase::TIP_SLACK;
use super::simulation::Dg;
use super::{DgLevel, Field};
use crate::energy::{Balance, Energy};

/// Rounding errors of a balance, in units of ε and of the energy's size: some ten terms, each a sum
/// over at most 40 degrees and a few elements.
const BALANCE_TERMS: f64 = 4096.0;

impl Dg {
    /// The s of a time in the last step; `None` outside.
    fn within(&self, t: f64) -> Option<f64> {
        if !(t >= self.old.t && t <= self.level.t) {
            return None;
        }
        Some(if self.last_dt > 0.0 {
            ((t - self.old.t) / self.last_dt).min(1.0)
        } else {
            1.0
        })
    }

    /// A field at x and at a time in the last step, both ends included; `None` for other times. θ
    /// is the lifted one.
    pub fn value(&self, field: Field, x: f64, t: f64) -> Option<f64> {
        let s = self.within(t)?;
        if t == self.level.t {
            return Some(self.level.value_and_slope(&self.space, field, x).0);
        }
        let point = self.space.locate(x);
        let (value, _) = self.space.evaluate(field, &point, |block, place| {
            self.stages.coefficient(field, block, place).at(s)
        });
        Some(value)
    }

    /// The physical temperature, including the lifting, at x and at a time in the last step; `None`
    /// for other times.
    pub fn temperature(&self, x: f64, t: f64) -> Option<f64> {
        self.value(Field::Theta, x, t)
            .map(|lifted| lifted + self.beam.theta_a * (1.0 - x))
    }

    /// Copies the state at a time in the last step into `level`; returns false for other times.
    pub fn level_into(&self, t: f64, level: &mut DgLevel) -> bool {
        match self.within(t) {
            Some(s) if self.last_dt > 0.0 && t < self.level.t => {
                self.stages.level_into(s, &self.old, self.last_dt, level);
                level.t = t;
                true
            }
            Some(_) => {
                level.copy_from(&self.level);
                true
            }
            None => false,
        }
    }

    /// The energy of a level, term by term.
    pub fn energy(&self, level: &DgLevel) -> Energy {
        let (space, beam) = (&self.space, &self.beam);
        let (places, rates) = (&level.places, &level.rates);
        let velocities = |b: usize| [rates[b][0], rates[b][1], 0.0];
        let temperatures = |b: usize| [0.0, 0.0, rates[b][2]];
        let stretch = space.stiffness(|b| places[b][0], |b| places[b][0]);
        let tip = places[space.tip()][0];
        Energy {
            kinetic: 0.5 * space.mass(velocities, velocities),
            shear: 0.5 * space.shear(|b| places[b], |b| places[b]),
            bending: 0.5 * space.bending(|b| places[b][1], |b| places[b][1]),
            thermal: 0.5 * space.mass(temperatures, temperatures),
            kirchhoff: beam.kirchhoff_energy(stretch),
            contact: self
                .obstacles
                .map_or(0.0, |obstacles| obstacles.potential(tip)),
            lifting: -beam.a * beam.theta_a * self.turned(|b| places[b][1]),
        }
    }

    /// The size of the current level's energy: the sum of the absolute values of its terms,
    /// Kirchhoff's without its constant.
    pub fn energy_scale(&self) -> f64 {
        let places = |b: usize| self.level.places[b][0];
        let stretch = self.space.stiffness(places, places);
        self.energy(&self.level).size(&self.beam, stretch)
    }

    /// Bound on the rounding errors of a balance at the current level: of its terms, and of the
    /// contact energy at a rounded position.
    pub fn rounding(&self) -> f64 {
        let contact = self.obstacles.map_or(0.0, |obstacles| {
            let u = self.level.places[self.space.tip()][0];
            let delta = TIP_SLACK * (u.abs() + obstacles.g1.abs().max(obstacles.g2));
            2.0 * (obstacles.force(u).abs() * delta + delta * delta / obstacles.epsilon)
        });
        BALANCE_TERMS * f64::EPSILON * self.energy_scale() + contact
    }

    /// The balance of the last step; at the start, of an empty step.
    pub fn balance(&self) -> Balance {
        let Self {
            space,
            beam,
            old,
            level: new,
            ..
        } = self;
        let losses = self.stages.losses(space, beam, self.last_dt);
        let rates = |sign: f64| {
            move |b: usize| -> [f64; 3] {
                std::array::from_fn(|f| new.rates[b][f] + sign * old.rates[b][f])
            }
        };
        let places = |sign: f64| {
            move |b: usize| -> [f64; 2] {
                std::array::from_fn(|f| new.places[b][f] + sign * old.places[b][f])
            }
        };
        let difference = space.stiffness(|b| places(-1.0)(b)[0], |b| places(1.0)(b)[0]);
        let before = space.stiffness(|b| old.places[b][0], |b| old.places[b][0]);
        let [u, u0] = [new, old].map(|level| level.places[space.tip()][0]);
        let stored = self.obstacles.map_or(0.0, |obstacles| {
            obstacles.discrete_gradient(u, u0) * (u - u0)
        });
        let touched = self
            .last_phase
            .obstacle(self.obstacles.as_ref())
            .zip(self.obstacles);
        let done = touched.map_or(0.0, |(g, obstacles)| {
            0.5 * (u - u0) * ((u - g) + (u0 - g)) / obstacles.epsilon
        });
        let change = 0.5 * space.mass(rates(-1.0), rates(1.0))
            + 0.5 * space.strain(places(-1.0), places(1.0))
            + beam.kirchhoff_energy_change(before + difference, before)
            - beam.a * beam.theta_a * self.turned(|b| places(-1.0)(b)[1])
            + stored;
        let contact = done - stored;
        let residual =
            change + losses.viscous + losses.thermal + losses.inertial + losses.load + contact;
        Balance {
            change,
            contact,
            residual,
            ..losses
        }
    }

    /// `∫ φ`.
    fn turned(&self, phi: impl Fn(usize) -> f64) -> f64 {
        self.space
            .rotation_integrals
            .iter()
            .enumerate()
            .map(|(block, integral)| integral * phi(block))
            .sum()
    }
}
