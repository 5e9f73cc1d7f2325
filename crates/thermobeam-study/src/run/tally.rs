//! Sums over the steps of a run, by any method.

use std::ops::ControlFlow;

use convergence_study::text::number::{max_or_nan, min_or_nan};
use serde::Serialize;
use thermobeam::energy::Balance;

use super::motion::{Motion, Report, RunError, Sample, Unsound, Watch};

/// Iterations of all steps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
pub struct Iterations {
    /// Their sum.
    pub total: usize,
    /// The largest number in a step.
    pub max: usize,
}

/// The free end's range over all observed times, including the start.
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
    /// Largest `E^n - E^{n-1}`; negative if the energy always falls, NaN without steps.
    pub largest_increase: f64,
    /// Largest defect of the exact discrete balance, over all steps.
    pub largest_balance_residual: f64,
}

/// Neither round-off nor a loose tolerance explains an error of the energy above this share of its values at start and end (of
/// 1 if both are less): every step of every scheme keeps or lowers the energy, and balances its loss. Without a term in ρ the
/// energy of a buckled beam falls without bound, and rounding errors grow with it.
const UNEXPLAINED: f64 = 1e-3;

impl EnergySummary {
    /// Checks that the energy is finite, does not rise, and keeps its balance, allowing for rounding and tolerance.
    ///
    /// # Errors
    /// [`Unsound`], with the number.
    pub fn sound(&self) -> Result<(), Unsound> {
        let most = UNEXPLAINED * self.initial.abs().max(self.last.abs()).max(1.0);
        match (self.largest_increase, self.largest_balance_residual) {
            _ if !self.initial.is_finite() => Err(Unsound::NotFinite(self.initial)),
            _ if !self.last.is_finite() => Err(Unsound::NotFinite(self.last)),
            (rise, _) if !(rise <= most) => Err(Unsound::Rise(rise)),
            (_, residual) if !(residual <= most) => Err(Unsound::Imbalance(residual)),
            _ => Ok(()),
        }
    }
}

/// The sums over the completed steps.
#[derive(Debug, Clone)]
pub(super) struct Tally {
    pub(super) iterations: Iterations,
    pub(super) extremes: Extremes,
    pub(super) contact_steps: usize,
    initial: f64,
    /// The current energy: its initial value plus the changes.
    now: f64,
    largest_increase: Option<f64>,
    largest_residual: f64,
}

impl Tally {
    pub(super) fn new(start: &Sample) -> Self {
        Self {
            iterations: Iterations::default(),
            extremes: Extremes { u_tip_min: start.u_tip, u_tip_max: start.u_tip },
            contact_steps: 0,
            initial: start.energy,
            now: start.energy,
            largest_increase: None,
            largest_residual: 0.0,
        }
    }

    /// Adds a step: its report, its balance, and the range of u(1).
    ///
    /// # Errors
    /// [`Unsound`] if it raised the energy, violated its balance, or made it infinite or NaN.
    pub(super) fn add(&mut self, report: &Report, balance: &Balance, [low, high]: [f64; 2]) -> Result<(), Unsound> {
        self.iterations.total += report.iterations;
        self.iterations.max = self.iterations.max.max(report.iterations);
        self.contact_steps += usize::from(report.in_contact);
        self.extremes.u_tip_max = max_or_nan(self.extremes.u_tip_max, high);
        self.extremes.u_tip_min = min_or_nan(self.extremes.u_tip_min, low);
        // Not the difference of two totals, which would lose the digits that separate a small fall from a small rise.
        let (change, residual) = (balance.change, balance.residual.abs());
        self.largest_increase = Some(self.largest_increase.map_or(change, |most| max_or_nan(most, change)));
        self.largest_residual = max_or_nan(self.largest_residual, residual);
        self.now += change;
        let step =
            EnergySummary { largest_increase: change, largest_balance_residual: residual, ..self.energy(self.now) };
        step.sound()
    }

    pub(super) fn energy(&self, last: f64) -> EnergySummary {
        EnergySummary {
            initial: self.initial,
            last,
            largest_increase: self.largest_increase.unwrap_or(f64::NAN),
            largest_balance_residual: self.largest_residual,
        }
    }
}

impl Watch for Tally {
    fn see(&mut self, motion: &mut dyn Motion, report: &Report) -> Result<ControlFlow<()>, RunError> {
        let (balance, extremes) = (motion.balance(), motion.extremes());
        let unsound = |unsound| RunError::unsound(motion.steps(), motion.t(), report.dt, unsound);
        self.add(report, &balance, extremes).map_err(unsound)?;
        Ok(ControlFlow::Continue(()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rise_of_the_energy_or_an_imbalance_beyond_rounding_is_unsound_and_so_is_what_is_not_finite() {
        let sound = |initial, last, largest_increase, largest_balance_residual| {
            EnergySummary { initial, last, largest_increase, largest_balance_residual }.sound()
        };
        for rise in [-1.0, 0.0, 1e-12, 9e-4] {
            assert_eq!(sound(0.5, 0.0, rise, 9e-4), Ok(()), "{rise}");
        }
        assert_eq!(sound(0.5, 0.0, 2e-3, 0.0), Err(Unsound::Rise(2e-3)));
        assert_eq!(sound(100.0, 0.0, 2e-3, 2e-3), Ok(()));
        assert_eq!(sound(0.5, 0.0, 1e264, 0.0), Err(Unsound::Rise(1e264)));
        assert_eq!(sound(0.5, 0.0, -1.0, 2e-3), Err(Unsound::Imbalance(2e-3)));
        assert!(matches!(sound(0.5, 0.0, f64::NAN, 0.0), Err(Unsound::Rise(rise)) if rise.is_nan()));
        assert!(matches!(sound(0.5, 0.0, 0.0, f64::NAN), Err(Unsound::Imbalance(residual)) if residual.is_nan()));
        assert_eq!(sound(1.0, -1e21, -1.0, 1e6), Ok(()));
        assert_eq!(sound(1.0, 1.0, -1.0, 1e6), Err(Unsound::Imbalance(1e6)));
        for last in [f64::INFINITY, f64::NEG_INFINITY] {
            assert_eq!(sound(1.0, last, -1.0, 0.0), Err(Unsound::NotFinite(last)));
            assert_eq!(sound(last, 1.0, -1.0, 0.0), Err(Unsound::NotFinite(last)));
        }
        assert!(matches!(sound(1.0, f64::NAN, -1.0, 0.0), Err(Unsound::NotFinite(_))));
    }
}
