//! The interface of a solver to a motion, and its extension for several cases in lanes.

use crate::energy::Balance;
use crate::error::StepFailure;
use crate::lanes::Lane;
use crate::motion::{StepReport, Work};
use crate::solve::TimeLevel;

/// A solver of the steps of one case (`T = f64`) or of several cases in lanes.
pub(crate) trait Stepper<T: Lane>: Send + Sync {
    /// Does one step of every case that has not failed, without allocating memory.
    ///
    /// A case that fails keeps its last level and does not affect the others. A single case may
    /// repeat the step.
    ///
    /// * `outcomes`: overwritten, one for each lane.
    fn advance(&mut self, outcomes: &mut [Result<StepReport, StepFailure>]);

    /// The loads `(F_u, F_φ, F_θ)` of the next step at the n + 1 nodes; allocated by the first
    /// call.
    fn load_mut(&mut self) -> &mut [[T; 3]];

    /// Copies the current level of case k into `level`; if the case has failed, the last level
    /// before the failure.
    fn read(&self, k: usize, level: &mut TimeLevel);

    /// u(1) at the current level of case k; if the case has failed, at the last level before the
    /// failure.
    fn tip(&self, k: usize) -> f64;

    /// Counts of the work done so far; a pass over all lanes counts once.
    fn work(&self) -> Work;
}

/// A solver of several cases in lanes.
pub(crate) trait Batch<T: Lane>: Stepper<T> {
    /// The [`Balance`] of the last step of every case that has done it; the others are left
    /// unchanged.
    fn balances(&self, balances: &mut [Balance]);

    /// The contact force of the last step of case k.
    fn contact_force(&self, k: usize) -> f64;

    /// The work for case k so far, the same as in a single run.
    fn work_of(&self, k: usize) -> Work;
}
