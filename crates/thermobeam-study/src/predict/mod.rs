//! Error estimates, and runs that reach a wanted error: both against a run of any order whose own
//! error is known.
//!
//! * `data`: nodes where the initial data have features that a mesh would miss.
//! * [`mod@reference`]: dG(q) on elements of degree p, refined until its own error is small enough.
//!   Its error is the difference to degree p + 4 and to halved steps.
//!   `first` and `refine` choose its elements, degrees and steps, by the constants in `policy`.
//! * [`estimate`]: the error of a scene by any method is its difference to such a run.
//! * [`choice`]: the cheapest run with the wanted error, and the needs of the scene's own scheme.
//!
//! All searches have a limit on their work, which is counted: unknowns times linear solves for dG,
//! elements times steps for a one-step scheme. A unit of either takes about 20 ns.

pub mod choice;
mod curves;
mod data;
pub mod estimate;
mod first;
mod policy;
pub mod reference;
mod refine;

use std::ops::AddAssign;

use thiserror::Error;

/// Work after which a search ends: about half a minute.
pub const MOST_WORK: f64 = 1.5e9;

/// The same if the scene's own scheme is kept: some seven minutes.
pub const MOST_WORK_KEPT: f64 = 2e10;

/// The cost of runs.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Cost {
    /// For dG unknowns times linear solves, for a one-step scheme elements times steps: the same on
    /// every machine.
    pub work: f64,
    /// Seconds in steps.
    pub seconds: f64,
    /// Runs.
    pub runs: usize,
}

impl AddAssign for Cost {
    fn add_assign(&mut self, other: Self) {
        self.work += other.work;
        self.seconds += other.seconds;
        self.runs += other.runs;
    }
}

/// The work that a search has done, and its limit.
pub struct Work<'a> {
    limit: f64,
    done: f64,
    spent: Cost,
    progress: &'a mut dyn FnMut(f64),
}

impl<'a> Work<'a> {
    /// * `limit`: the allowed work.
    /// * `progress`: called after every step with the part of the limit that is used.
    pub fn new(limit: f64, progress: &'a mut dyn FnMut(f64)) -> Self {
        Self {
            limit,
            done: 0.0,
            spent: Cost::default(),
            progress,
        }
    }

    /// The cost of the completed runs.
    pub fn spent(&self) -> Cost {
        self.spent
    }

    fn add(&mut self, work: f64) -> Result<(), StopReason> {
        self.done += work;
        (self.progress)(self.done / self.limit);
        self.leaves(0.0)
    }

    /// Refuses a run that needs more work than is left.
    fn leaves(&self, work: f64) -> Result<(), StopReason> {
        let Self { limit, done, .. } = *self;
        if done + work <= limit {
            Ok(())
        } else {
            Err(StopReason::Work { limit })
        }
    }

    fn ran(&mut self, cost: &Cost) {
        self.spent += *cost;
    }
}

/// The reason why a search stops.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum StopReason {
    /// Finer elements are not possible.
    #[error("the elements are as fine as they get")]
    Finest,
    /// Refinement did not help.
    #[error("it was refined as often as is sensible")]
    Rounds,
    /// The work limit was reached.
    #[error("finer runs would exceed the work limit of {limit:.1e} unknowns times solves (about {:.0} s)", 2e-8 * limit)]
    Work {
        /// Unknowns times solves, or elements times steps.
        limit: f64,
    },
    /// Finer runs differ by rounding errors.
    #[error("finer runs differ by as much: rounding errors")]
    RoundOff,
    /// A curve is infinite or NaN.
    #[error("a curve is not finite")]
    NotFinite,
    /// A run did not finish.
    #[error("a run failed: {0}")]
    Run(String),
}

impl StopReason {
    fn of_run(failure: impl ToString) -> Self {
        Self::Run(failure.to_string())
    }
}

/// Why an error cannot be reached or determined.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum Unreachable {
    /// The target is not a positive number.
    #[error("target error {target}: expected a finite number > 0")]
    Target {
        /// The given target.
        target: f64,
    },
    /// The scene's own run did not finish.
    #[error("the scene itself: {0}")]
    Own(StopReason),
    /// Refinement stopped.
    #[error("an error of {target:.3e} was not reached: {reason}{}", reachable(*reached, *space, *time))]
    NotReached {
        /// The given target.
        target: f64,
        /// The smallest target that the comparisons would have met; infinite without comparisons.
        reached: f64,
        /// The part of space in it.
        space: f64,
        /// The part of time in it.
        time: f64,
        /// The reason for stopping.
        reason: StopReason,
    },
    /// No mesh of a search resolves the initial data.
    #[error(
        "the meshes of a search do not resolve {field} near x = {x:.6}: the difference to its projection is {error:.1e}, expected at \
         most {allowed:.1e}; a wider feature is resolved, or a larger error"
    )]
    Unresolved {
        /// Name of the field.
        field: &'static str,
        /// Where they differ.
        x: f64,
        /// The difference, in the measure of the search.
        error: f64,
        /// The largest difference allowed.
        allowed: f64,
    },
    /// A finer run is further from the reference than the scene is said to be.
    #[error(
        "{name}: an error of {total:.1e} is contradicted by a run with {finer}, which differs by {difference:.1e} from the same \
         reference; neither number is trustworthy"
    )]
    Contradicted {
        /// Name of the quantity.
        name: &'static str,
        /// Its error by the reference.
        total: f64,
        /// The finer run, in words.
        finer: &'static str,
        /// The same error of the finer run.
        difference: f64,
    },
}

impl Unreachable {
    /// The result if no comparison was made.
    fn without_comparison(target: f64, reason: StopReason) -> Self {
        Self::NotReached {
            target,
            reached: f64::INFINITY,
            space: f64::NAN,
            time: f64::NAN,
            reason,
        }
    }
}

/// The reachable error, in words; empty before the first comparison.
fn reachable(reached: f64, space: f64, time: f64) -> String {
    if reached.is_finite() {
        format!("; about {reached:.1e} can be reached (space {space:.1e}, time {time:.1e})")
    } else {
        String::new()
    }
}
