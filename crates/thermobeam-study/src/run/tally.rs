//! The result of a run by any method: its sums over the steps, and where it ended.

use std::ops::ControlFlow;
use std::time::Duration;

use convergence_study::text::number::{max_or_nan, min_or_nan};
use serde::Serialize;
use thermobeam::dg::{ContactEvent, Phase};
use thermobeam::energy::Balance;

use super::history::RunHistory;
use super::{Motion, Report, RunError, Sample, Solves, Unsound, Watch};

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

/// A finished run, or the completed part of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
    /// Steps done.
    pub steps: usize,
    /// Iterations of these steps.
    pub iterations: Iterations,
    /// Time spent stepping, without observation.
    pub wall: Duration,
    /// The start.
    pub first: Sample,
    /// The last level.
    pub last: Sample,
    /// The free end's range.
    pub extremes: Extremes,
    /// Steps in contact, see [`Report::in_contact`].
    pub contact_steps: usize,
    /// The energy.
    pub energy: EnergySummary,
    /// Counts of the solver's work.
    pub work: Solves,
    /// Whether the temperature was computed: it is omitted if nothing heats the beam.
    pub is_heated: bool,
    /// Where contact began and ended, if the method locates it.
    pub contact: Option<Contact>,
    /// Why the run ended early, if it did.
    pub failure: Option<RunError>,
    /// History and frames, if requested.
    pub history: Option<RunHistory>,
}

/// Contact, located to round-off.
#[derive(Debug, Clone, PartialEq)]
pub struct Contact {
    /// What the free end touched at the start.
    pub started_in: Phase,
    /// Where contact began and ended.
    pub events: Vec<ContactEvent>,
}

impl Run {
    /// A run before its first step.
    pub(super) fn start(first: Sample) -> Self {
        let (initial, u_tip) = (first.energy, first.u_tip);
        let (largest_increase, largest_balance_residual) = (f64::NAN, 0.0);
        Self {
            steps: 0,
            iterations: Iterations::default(),
            wall: Duration::ZERO,
            first,
            last: first,
            extremes: Extremes { u_tip_min: u_tip, u_tip_max: u_tip },
            contact_steps: 0,
            energy: EnergySummary { initial, last: initial, largest_increase, largest_balance_residual },
            work: Solves::default(),
            is_heated: true,
            contact: None,
            failure: None,
            history: None,
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
        let (change, residual, energy) = (balance.change, balance.residual.abs(), &mut self.energy);
        energy.largest_increase = if self.steps == 0 { change } else { max_or_nan(energy.largest_increase, change) };
        energy.largest_balance_residual = max_or_nan(energy.largest_balance_residual, residual);
        energy.last += change;
        self.steps += 1;
        EnergySummary { largest_increase: change, largest_balance_residual: residual, ..*energy }.sound()
    }

    /// Ends the run at its last level.
    pub(super) fn end(&mut self, last: Sample, work: Solves, is_heated: bool) {
        (self.last, self.work, self.is_heated) = (last, work, is_heated);
        self.energy.last = last.energy;
    }

    /// Why the results of the run cannot be used, in words.
    pub fn complaint(&self) -> Option<String> {
        self.failure.as_ref().map(ToString::to_string)
    }

    /// The run, if it finished.
    ///
    /// # Errors
    /// The [`RunError`] that ended it.
    pub fn finished(self) -> Result<Self, RunError> {
        match self.failure {
            Some(failure) => Err(failure),
            None => Ok(self),
        }
    }

    /// (t, u(1, t)) of the history.
    pub fn tip(&self) -> Vec<(f64, f64)> {
        self.history.as_ref().map_or(vec![], RunHistory::tip)
    }

    /// Time intervals in contact: as located, or from the rows of the history.
    pub fn contact_phases(&self) -> Vec<(f64, f64)> {
        match (&self.contact, &self.history) {
            (Some(contact), _) => contact.phases(self.first.t, self.last.t),
            (None, Some(history)) => history.contact_phases(),
            (None, None) => vec![],
        }
    }
}

impl Contact {
    /// Time intervals in contact, between the start and the end of a run.
    fn phases(&self, start: f64, end: f64) -> Vec<(f64, f64)> {
        let mut phases = if self.started_in == Phase::Free { vec![] } else { vec![(start, end)] };
        for event in &self.events {
            if let Some(phase) = phases.last_mut().filter(|_| event.from != Phase::Free) {
                phase.1 = event.t;
            }
            if event.to != Phase::Free {
                phases.push((event.t, end));
            }
        }
        phases
    }
}

impl Watch for Run {
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
