//! What is summed up over the steps of a run, by whatever scheme.

use convergence_study::text::number::max_or_nan;
use serde::Serialize;

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

/// The rise of the energy in one step that is no longer taken for round-off or a loose tolerance, in parts of the initial
/// energy, or of 1 where that is less: every step of every scheme lowers the energy, or leaves it.
const RISE: f64 = 1e-3;

impl EnergySummary {
    /// The largest rise of the energy in a step where it is far beyond what rounding and tolerance explain: the numbers of such a
    /// run mean nothing. `None` for a sound run, and where no step was done.
    pub fn rise(&self, steps: usize) -> Option<f64> {
        let is_sound = self.largest_increase <= RISE * self.initial.abs().max(1.0);
        (steps > 0 && !is_sound).then_some(self.largest_increase)
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
    fn a_rise_of_the_energy_beyond_rounding_is_found_and_nan_is_one() {
        let rise = |initial, largest_increase, steps| {
            EnergySummary { initial, last: 0.0, largest_increase, largest_balance_residual: 0.0 }.rise(steps)
        };
        for sound in [-1.0, 0.0, 1e-12, 9e-4] {
            assert_eq!(rise(0.5, sound, 1), None, "{sound}");
        }
        assert_eq!([rise(0.5, 2e-3, 1), rise(100.0, 2e-3, 1), rise(0.5, 1e264, 7)], [Some(2e-3), None, Some(1e264)]);
        assert!(rise(0.5, f64::NAN, 1).is_some_and(f64::is_nan));
        assert_eq!(rise(0.5, f64::NAN, 0), None, "no step was done");
    }
}
