//! The result of a run by any method: its sums over the steps, and where it ended.

use std::ops::ControlFlow;
use std::time::Duration;

use convergence_judge::text::number::{max_or_nan, min_or_nan};
use serde::Serialize;
use thermobeam::dg::{ContactEvent, Phase};
use thermobeam::energy::Balance;
use thermobeam::motion::{StepReport, TipRange, Work};
use thermobeam::solve::Stopping;

use super::energy::EnergySummary;
use super::history::RunHistory;
use super::{AnyMotion, EnergySize, RunError, Sample, Unsound, Watch};

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

/// Size of a motion, in units of the tolerance, below which fewer than three digits are sure.
const RESOLVED: f64 = 1e3;

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
    /// Steps in contact, see [`StepReport::in_contact`].
    pub contact_steps: usize,
    /// The energy.
    pub energy: EnergySummary,
    /// Counts of the solver's work.
    pub work: Work,
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
    ///
    /// * `size`: of the energy at t = 0.
    /// * `is_loaded`: whether loads act on the beam.
    pub(super) fn start(first: Sample, size: f64, is_loaded: bool) -> Self {
        let (initial, u_tip) = (first.energy, first.u_tip);
        let (largest_increase, largest_balance_residual) = (f64::NAN, 0.0);
        Self {
            steps: 0,
            iterations: Iterations::default(),
            wall: Duration::ZERO,
            first,
            last: first,
            extremes: Extremes {
                u_tip_min: u_tip,
                u_tip_max: u_tip,
            },
            contact_steps: 0,
            energy: EnergySummary {
                initial,
                last: initial,
                largest_increase,
                largest_balance_residual,
                size,
                is_loaded,
            },
            work: Work::default(),
            is_heated: true,
            contact: None,
            failure: None,
            history: None,
        }
    }

    /// Adds a step: its report, its balance, and the range of u(1).
    ///
    /// * `now`: the size of the energy after it, see [`EnergySummary::sound`].
    ///
    /// # Errors
    /// [`Unsound`] if it raised the energy, violated its balance, or made it infinite or NaN.
    pub(super) fn add(
        &mut self,
        report: &StepReport,
        balance: &Balance,
        tip: TipRange,
        now: impl FnOnce() -> EnergySize,
    ) -> Result<(), Unsound> {
        self.iterations.total += report.iterations;
        self.iterations.max = self.iterations.max.max(report.iterations);
        self.contact_steps += usize::from(report.in_contact);
        self.extremes.u_tip_max = max_or_nan(self.extremes.u_tip_max, tip.high);
        self.extremes.u_tip_min = min_or_nan(self.extremes.u_tip_min, tip.low);
        // Not the difference of two totals, which would lose the digits that separate a small fall
        // from a small rise.
        let change = balance.change;
        let residual = balance.residual.abs();
        let energy = &mut self.energy;
        energy.largest_increase = if self.steps == 0 {
            change
        } else {
            max_or_nan(energy.largest_increase, change)
        };
        energy.largest_balance_residual = max_or_nan(energy.largest_balance_residual, residual);
        energy.last += change;
        self.steps += 1;
        EnergySummary {
            largest_increase: change,
            largest_balance_residual: residual,
            ..*energy
        }
        .sound(now)
    }

    /// Ends the run at its last level.
    pub(super) fn end(&mut self, last: Sample, work: Work, is_heated: bool) {
        (self.last, self.work, self.is_heated) = (last, work, is_heated);
        self.energy.last = last.energy;
    }

    /// What to tell a user whose motion is hardly larger than the tolerance, in words.
    ///
    /// Iterations stop at an increment below the tolerance in the norm of (3.14), whose square is
    /// at most twice the energy's size.
    ///
    /// * `stopping`: of the iterations; a fixed number of them has no tolerance.
    pub fn note(&self, stopping: Stopping) -> Option<String> {
        let tolerance = stopping.tolerance()?;
        let EnergySummary {
            initial,
            last,
            size,
            ..
        } = self.energy;
        let motion = (2.0 * max_or_nan(size, (last - initial).abs())).sqrt();
        (motion > 0.0 && motion < RESOLVED * tolerance).then(|| {
            // Half of what is enough, because it is rounded.
            let [motion, advice] = [motion, 0.5 * motion / RESOLVED].map(|value| format!("{value:.1e}"));
            format!(
                "the motion has a size of {motion} in the norm of Theorem 3.4, and iterations may leave errors of the tolerance, \
                 {tolerance:e}, in that norm: fewer than three digits are sure; expected a tolerance of {advice}"
            )
        })
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
        let mut phases = if self.started_in == Phase::Free {
            vec![]
        } else {
            vec![(start, end)]
        };
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

/// The change of the energy over a step of a beam with loads, whose balance is not known.
fn without_balance(change: f64) -> Balance {
    Balance {
        change,
        residual: f64::NAN,
        ..Balance::default()
    }
}

impl Watch for Run {
    fn see(
        &mut self,
        motion: &mut AnyMotion,
        report: &StepReport,
    ) -> Result<ControlFlow<()>, RunError> {
        let balance = if motion.motion().is_loaded() {
            let change = motion.sample().energy - self.energy.last;
            without_balance(change)
        } else {
            motion.balance()?
        };
        let extremes = motion.motion().tip_range();
        let outcome = self.add(report, &balance, extremes, || motion.energy_size());
        match outcome {
            Ok(()) => Ok(ControlFlow::Continue(())),
            Err(unsound) => Err(RunError::unsound(motion.motion(), report.dt, unsound)),
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::run::simulate::ran;

    /// Its energy and balance are sums of numbers below the least normal one.
    #[test]
    fn a_motion_whose_energy_underflows_ends_without_a_complaint() {
        for exponent in (156..164).chain([300]) {
            let speed = format!("3e-{exponent}");
            let text = format!(
                "[beam]\na = 0.5\nzeta = 0.1\n[initial]\nu_t = \"{speed}*x*(2-x)\"\nphi_t = \"{speed}*x*x*(3-x)\"\n\
                 [mesh]\nelements = 20\n[time]\ndt = 0.01\nt_end = 1.0\n"
            );
            assert_eq!(ran(&text).1.failure, None, "{speed}");
        }
    }

    #[test]
    fn a_motion_hardly_larger_than_the_tolerance_is_noted() {
        let note = |speed: f64, solver: &str| {
            let text = format!(
                "[beam]\nrho = 0.0\na = 0.5\n[initial]\nu_t = \"{speed:e}*x\"\n[mesh]\nelements = 20\n[time]\ndt = 0.01\n\
                 t_end = 1.0\n{solver}"
            );
            let (scene, run) = ran(&text);
            assert_eq!(run.failure, None);
            (run.note(scene.method.stopping()), run.last.theta_mid)
        };
        let fixed_point = "solver = \"fixed-point\"\n";
        let (words, theta) = note(1e-9, fixed_point);
        let words = words.expect("a note");
        // ‖1e-9 x‖ = 5.8e-10.
        assert!(
            words.contains("a size of 5.8e-10 ")
                && words.contains("1e-10,")
                && words.contains("2.9e-13"),
            "{words}"
        );
        let (_, exact) = note(1.0, "tolerance = 1e-14\n");
        assert!(
            (theta / (1e-9 * exact) - 1.0).abs() > 0.02,
            "{theta} {exact}"
        );
        let (none, theta) = note(1e-9, &format!("{fixed_point}tolerance = 2.9e-13\n"));
        assert!(
            none.is_none() && (theta / (1e-9 * exact) - 1.0).abs() < 1e-3,
            "{none:?} {theta} {exact}"
        );
        assert_eq!(note(1e-6, fixed_point).0, None);
    }
}
