//! How large an error is, and what makes it as small as wanted: both against a run of any order whose own error is known.
//!
//! * [`mod@reference`]: dG(q) on elements of degree p, refined until its own error is small enough. Its error is the difference to degree
//!   p + 4 and to half the steps.
//! * [`estimate`]: the error of a scene by any method is its difference to such a run.
//! * [`choice`]: the cheapest run with the error asked for, and what the scene's own scheme would need.
//!
//! All of it is limited in work, which is counted: unknowns times linear solves of dG, elements times steps of a one-step scheme.
//! A unit of either takes about 20 ns.

pub mod choice;
mod curves;
pub mod estimate;
pub mod reference;

use std::ops::AddAssign;

use thiserror::Error;

/// Work after which a search ends: about half a minute.
pub const MOST_WORK: f64 = 1.5e9;

/// The same where the scene's own scheme is kept: some seven minutes.
pub const MOST_WORK_KEPT: f64 = 2e10;

/// What runs have cost.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Cost {
    /// Unknowns of a step times linear solves by dG, elements times steps by a one-step scheme: the same on every machine.
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

/// What a search has done so far and may do.
pub struct Work<'a> {
    limit: f64,
    done: f64,
    spent: Cost,
    told: &'a mut dyn FnMut(f64),
}

impl<'a> Work<'a> {
    /// * `limit`: what may be done.
    /// * `told`: hears after every step which part of the limit is done.
    pub fn new(limit: f64, told: &'a mut dyn FnMut(f64)) -> Self {
        Self { limit, done: 0.0, spent: Cost::default(), told }
    }

    /// What the runs that came to their ends have cost.
    pub fn spent(&self) -> Cost {
        self.spent
    }

    fn add(&mut self, work: f64) -> Result<(), Reason> {
        self.done += work;
        (self.told)(self.done / self.limit);
        self.leaves(0.0)
    }

    /// Refuses a run of so much work.
    fn leaves(&self, work: f64) -> Result<(), Reason> {
        let Self { limit, done, .. } = *self;
        if done + work <= limit { Ok(()) } else { Err(Reason::Work { limit }) }
    }

    fn ran(&mut self, cost: &Cost) {
        self.spent += *cost;
    }
}

/// What stops a search.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum Reason {
    /// No finer elements are to be had.
    #[error("the elements are as fine as they get")]
    Finest,
    /// Refining has not helped.
    #[error("it was refined as often as is sensible")]
    Rounds,
    /// The limit of work.
    #[error("finer runs would exceed the limit of {limit:.1e} unknowns times solves (about {:.0} s)", 2e-8 * limit)]
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
    /// A run did not come to its end.
    #[error("a run failed: {0}")]
    Run(String),
}

impl Reason {
    fn of_run(failure: impl ToString) -> Self {
        Self::Run(failure.to_string())
    }
}

/// Why an error cannot be reached, or not be known.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum Unreachable {
    /// The target is not a positive number.
    #[error("target error {target}: expected a finite number > 0")]
    Target {
        /// As asked for.
        target: f64,
    },
    /// The scene's own run did not come to its end.
    #[error("the scene itself: {0}")]
    Own(Reason),
    /// Refinement came to its end.
    #[error("an error of {target:.3e} was not reached: {reason}{}", reachable(*reached, *space, *time))]
    NotReached {
        /// As asked for.
        target: f64,
        /// The smallest target that the comparisons would have met; infinite where there were none.
        reached: f64,
        /// Its part of space.
        space: f64,
        /// Its part of time.
        time: f64,
        /// What stopped it.
        reason: Reason,
    },
}

/// What can be reached, in words; nothing before the first comparison.
fn reachable(reached: f64, space: f64, time: f64) -> String {
    if reached.is_finite() {
        format!("; about {reached:.1e} can be reached (space {space:.1e}, time {time:.1e})")
    } else {
        String::new()
    }
}
