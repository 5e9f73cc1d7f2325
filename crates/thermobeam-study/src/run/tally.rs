//! What is observed of a run at one time, and summed up over its steps, by whatever scheme.

use std::fmt::Display;

use convergence_study::text::number::max_or_nan;
use serde::Serialize;
use thiserror::Error;

/// Observed quantities at one time; the JSON object of a run has them, except the contact force.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Sample {
    /// Time.
    pub t: f64,
    /// u(1).
    pub u_tip: f64,
    /// φ(1).
    pub phi_tip: f64,
    /// u_t(1); of a one-step scheme û(1).
    pub u_t_tip: f64,
    /// φ_t(1); of a one-step scheme φ̂(1).
    pub phi_t_tip: f64,
    /// The physical temperature at x = 1/2.
    pub theta_mid: f64,
    /// The contact force, positive on the upper obstacle: g(u(1)); of a one-step scheme that of the step that led here.
    #[serde(skip)]
    pub contact_force: f64,
    /// The energy (3.9), with the term of θ_A.
    pub energy: f64,
}

/// Iterations of all steps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
pub struct Iterations {
    /// Their sum.
    pub total: usize,
    /// Those of the step that took most.
    pub max: usize,
}

/// The free end's range over all times looked at, the start included.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Extremes {
    /// Smallest u(1).
    pub u_tip_min: f64,
    /// Largest u(1).
    pub u_tip_max: f64,
}

/// The energy over a run.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct EnergySummary {
    /// E^0.
    pub initial: f64,
    /// E^n of the last level.
    #[serde(rename = "final")]
    pub last: f64,
    /// Largest `E^n - E^{n-1}`; negative where the energy always falls, NaN where no step was done.
    pub largest_increase: f64,
    /// Largest defect of the exact discrete balance, over all steps.
    pub largest_balance_residual: f64,
}

/// The part of the energy, at the start or at the end, or of 1 where both are less, that neither round-off nor a loose tolerance
/// explains: every step of every scheme lowers the energy, or leaves it, and balances what it loses. Without a term in ρ the
/// energy of a buckled beam falls without bound, and rounding errors grow with it.
const UNEXPLAINED: f64 = 1e-3;

/// Why the numbers of a run mean nothing, although every step of it was done.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum Unsound {
    /// The energy is infinite or NaN.
    #[error("the energy is {0}: {EXPECTED}")]
    NotFinite(f64),
    /// The energy rose by this.
    #[error("the energy rose by {0:.3e} in a step, where no exactly solved step raises it: {EXPECTED}")]
    Rise(f64),
    /// The balance of the energy is violated by this.
    #[error(
        "the balance of the energy is violated by {0:.3e} in a step, where every exactly solved step keeps it: {EXPECTED}"
    )]
    Imbalance(f64),
}

const EXPECTED: &str =
    "expected coefficients of less extreme size, or a smaller tolerance; the numbers of this run mean nothing";

impl EnergySummary {
    /// Whether the energy is finite, and has not risen or broken its balance far beyond what rounding and tolerance explain.
    /// Without a step only the energy counts.
    ///
    /// # Errors
    /// [`Unsound`], with the number.
    pub fn sound(&self, steps: usize) -> Result<(), Unsound> {
        let most = UNEXPLAINED * self.initial.abs().max(self.last.abs()).max(1.0);
        match (self.largest_increase, self.largest_balance_residual) {
            _ if !self.initial.is_finite() => Err(Unsound::NotFinite(self.initial)),
            _ if !self.last.is_finite() => Err(Unsound::NotFinite(self.last)),
            _ if steps == 0 => Ok(()),
            (rise, _) if !(rise <= most) => Err(Unsound::Rise(rise)),
            (_, residual) if !(residual <= most) => Err(Unsound::Imbalance(residual)),
            _ => Ok(()),
        }
    }

    /// Why the numbers of a run cannot be used, in words: it failed, or they mean nothing.
    pub fn complaint(&self, steps: usize, failure: Option<&impl Display>) -> Option<String> {
        let unsound = || self.sound(steps).err().map(|unsound| unsound.to_string());
        failure.map(ToString::to_string).or_else(unsound)
    }
}

/// The energy of a motion without loads, step by step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct EnergyLaw {
    initial: f64,
    /// The energy now: that at the start and its changes.
    last: f64,
}

impl EnergyLaw {
    pub(crate) fn new(initial: f64) -> Self {
        Self { initial, last: initial }
    }

    /// A step that changes the energy, and leaves a residual in its balance.
    ///
    /// # Errors
    /// [`Unsound`] by the bound of [`EnergySummary::sound`].
    pub(crate) fn step(&mut self, change: f64, residual: f64) -> Result<(), Unsound> {
        self.last += change;
        let Self { initial, last } = *self;
        EnergySummary { initial, last, largest_increase: change, largest_balance_residual: residual.abs() }.sound(1)
    }
}

/// The sums of the steps done so far.
pub(super) struct Tally {
    pub(super) iterations: Iterations,
    pub(super) extremes: Extremes,
    largest_increase: Option<f64>,
    largest_residual: f64,
}

impl Tally {
    pub(super) fn new(u_tip: f64) -> Self {
        Self {
            iterations: Iterations::default(),
            extremes: Extremes { u_tip_min: u_tip, u_tip_max: u_tip },
            largest_increase: None,
            largest_residual: 0.0,
        }
    }

    /// A step: its iterations, the change of the energy, and the residual of its balance.
    pub(super) fn add(&mut self, iterations: usize, change: f64, residual: f64) {
        self.iterations.total += iterations;
        self.iterations.max = self.iterations.max.max(iterations);
        // Not the difference of two totals, which would lose the digits that tell a small fall from a small rise.
        self.largest_increase = Some(self.largest_increase.map_or(change, |most| max_or_nan(most, change)));
        self.largest_residual = max_or_nan(self.largest_residual, residual.abs());
    }

    /// A position of the free end.
    pub(super) fn include(&mut self, u_tip: f64) {
        self.extremes.u_tip_max = max_or_nan(self.extremes.u_tip_max, u_tip);
        self.extremes.u_tip_min = -max_or_nan(-self.extremes.u_tip_min, -u_tip);
    }

    pub(super) fn energy(&self, initial: f64, last: f64) -> EnergySummary {
        EnergySummary {
            initial,
            last,
            largest_increase: self.largest_increase.unwrap_or(f64::NAN),
            largest_balance_residual: self.largest_residual,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rise_of_the_energy_or_an_imbalance_beyond_rounding_is_unsound_and_so_is_nan() {
        let sound = |initial, largest_increase, largest_balance_residual, steps| {
            EnergySummary { initial, last: 0.0, largest_increase, largest_balance_residual }.sound(steps)
        };
        for rise in [-1.0, 0.0, 1e-12, 9e-4] {
            assert_eq!(sound(0.5, rise, 9e-4, 1), Ok(()), "{rise}");
        }
        assert_eq!(sound(0.5, 2e-3, 0.0, 1), Err(Unsound::Rise(2e-3)));
        assert_eq!(sound(100.0, 2e-3, 2e-3, 1), Ok(()));
        assert_eq!(sound(0.5, 1e264, 0.0, 7), Err(Unsound::Rise(1e264)));
        assert_eq!(sound(0.5, -1.0, 2e-3, 1), Err(Unsound::Imbalance(2e-3)));
        assert!(matches!(sound(0.5, f64::NAN, 0.0, 1), Err(Unsound::Rise(rise)) if rise.is_nan()));
        assert!(matches!(sound(0.5, 0.0, f64::NAN, 1), Err(Unsound::Imbalance(residual)) if residual.is_nan()));
        assert_eq!(sound(0.5, f64::NAN, 0.0, 0), Ok(()), "no step was done");
        let ends_at = |last, residual| {
            EnergySummary { initial: 1.0, last, largest_increase: -1.0, largest_balance_residual: residual }.sound(1)
        };
        assert_eq!(ends_at(-1e21, 1e6), Ok(()));
        assert_eq!(ends_at(1.0, 1e6), Err(Unsound::Imbalance(1e6)));
        // An infinite energy would allow any rise.
        for energy in [f64::INFINITY, f64::NEG_INFINITY, f64::NAN] {
            assert!(matches!(ends_at(energy, 0.0), Err(Unsound::NotFinite(_))), "{energy}");
            assert!(matches!(sound(energy, -1.0, 0.0, 1), Err(Unsound::NotFinite(_))), "{energy}");
            assert!(matches!(sound(energy, f64::NAN, 0.0, 0), Err(Unsound::NotFinite(_))), "{energy}");
        }
    }
}
