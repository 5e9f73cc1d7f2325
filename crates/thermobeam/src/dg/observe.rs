//! Output of a simulation: fields anywhere in the last step, the energy, and the balance.

use super::energy::Measured;
use super::simulation::Simulation;
use super::{Field, Level};
use crate::energy::{Balance, Energy};
use crate::norms::max_or_nan;

impl Simulation {
    /// The s of a time in the last step; `None` outside.
    fn within(&self, t: f64) -> Option<f64> {
        if !(t >= self.old.t && t <= self.level.t) {
            return None;
        }
        Some(if self.last_dt > 0.0 { ((t - self.old.t) / self.last_dt).min(1.0) } else { 1.0 })
    }

    /// A field at x and at a time in the last step, both ends included; `None` for other times. θ is the lifted one.
    pub fn value(&self, field: Field, x: f64, t: f64) -> Option<f64> {
        let s = self.within(t)?;
        if t == self.level.t {
            return Some(self.level.value_and_slope(&self.space, field, x).0);
        }
        let at = |block, place| self.stages.coefficient(field, block, place).at(s);
        Some(self.space.evaluate(field, x, at).0)
    }

    /// Smallest and largest u(1, t) over the last step, including extrema inside it; at first, the initial value.
    pub fn tip_range(&self) -> [f64; 2] {
        let u = self.level.places[self.space.tip()][0];
        if self.last_dt == 0.0 {
            return [u, u];
        }
        let tip = self.stages.coefficient(Field::U, self.space.tip(), 0);
        let (extrema, count) = tip.derivative().sign_changes();
        let values = extrema[..count].iter().map(|&s| tip.at(s)).chain([tip.at(0.0)]);
        values.fold([u, u], |[low, high], value| [-max_or_nan(-low, -value), max_or_nan(high, value)])
    }

    /// The physical temperature, including the lifting, at x and at a time in the last step; `None` for other times.
    pub fn temperature(&self, x: f64, t: f64) -> Option<f64> {
        self.value(Field::Theta, x, t).map(|lifted| lifted + self.beam.theta_a * (1.0 - x))
    }

    /// Copies the state at a time in the last step into `level`; returns false for other times.
    pub fn level_into(&self, t: f64, level: &mut Level) -> bool {
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
    pub fn energy(&self, level: &Level) -> Energy {
        self.scene().energy(level)
    }

    /// The balance of the last step; at the start, of an empty step.
    pub fn balance(&self) -> Balance {
        let losses = self.stages.losses(&self.space, &self.beam, &self.old, self.last_dt);
        self.scene().balance(&self.old, &self.level, self.last_phase, losses)
    }

    fn scene(&self) -> Measured<'_> {
        Measured { space: &self.space, beam: &self.beam, obstacles: self.obstacles.as_ref() }
    }
}
