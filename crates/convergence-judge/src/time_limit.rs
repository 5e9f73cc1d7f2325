//! The time limit and the work limit of a case.
//!
//! A case is computed by one thread from start to end, so the limit belongs to the thread: the
//! runner sets it around a case, and every time loop asks its own [`Patience`] before a step. The
//! clock is read about once a millisecond, and never without a limit. The limit does not affect the
//! results.
//!
//! Rounds are counted, too. A limit on that work ends a case at the same step on every machine.

use std::cell::Cell;
use std::time::{Duration, Instant};

use thiserror::Error;

use crate::text::number::plain_text;

/// The limit was reached.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[error("stopped at the {}, after step {step}, t = {}", self.allowed(), plain_text(*t))]
pub struct TimeUp {
    /// Steps done, or whatever the case counts.
    pub step: usize,
    /// Simulated time reached.
    pub t: f64,
    /// The time limit; zero if the work limit was reached.
    pub limit: Duration,
    /// The work limit, if that was reached.
    pub work: Option<u64>,
}

impl TimeUp {
    fn allowed(&self) -> String {
        match self.work {
            Some(work) => {
                format!(
                    "work limit of {work} passes over a node, three times what it took when blessed (a blessing limits nothing)"
                )
            }
            None => format!("time limit of {} s", self.limit.as_secs_f64()),
        }
    }
}

/// What tells the time: [`Instant::now`], or that of a test.
pub type Clock = fn() -> Instant;

#[derive(Debug, Clone, Copy)]
struct Deadline {
    clock: Clock,
    at: Instant,
    limit: Duration,
}

thread_local! {
    static DEADLINE: Cell<Option<Deadline>> = const { Cell::new(None) };
    static REACHED: Cell<Option<TimeUp>> = const { Cell::new(None) };
    /// Work that this thread has counted for its case, and the most that the case may do.
    static WORK: Cell<(u64, Option<u64>)> = const { Cell::new((0, None)) };
}

/// Runs a case on this thread, with or without a limit on its work.
///
/// * Returns the result of `case`, and the work that its loops have counted: the same at every run.
pub fn counted<T>(most: Option<u64>, case: impl FnOnce() -> T) -> (T, u64) {
    let before = WORK.replace((0, most));
    let result = case();
    (result, WORK.replace(before).0)
}

/// Runs a case on this thread, with or without a limit.
///
/// * Returns the result of `case`, and [`TimeUp`] if the limit was reached, even if the case
///   ignored it.
pub fn within<T>(limit: Option<Duration>, case: impl FnOnce() -> T) -> (T, Option<TimeUp>) {
    within_by(Instant::now, limit, case)
}

/// The same by another clock.
pub fn within_by<T>(
    clock: Clock,
    limit: Option<Duration>,
    case: impl FnOnce() -> T,
) -> (T, Option<TimeUp>) {
    let now = clock();
    // A limit that the clock cannot represent is no limit.
    let deadline = limit.and_then(|limit| {
        Some(Deadline {
            clock,
            at: now.checked_add(limit)?,
            limit,
        })
    });
    let before = DEADLINE.replace(deadline);
    REACHED.set(None);
    let result = case();
    DEADLINE.set(before);
    (result, REACHED.take())
}

/// The limit of the case that this thread computes, for a case that cannot be asked before each
/// round; `None` without one.
pub fn granted() -> Option<Duration> {
    DEADLINE.get().map(|deadline| deadline.limit)
}

/// A loop asks this before each of its rounds whether there is time for it.
#[derive(Debug, Clone)]
pub struct Patience {
    /// Work of a round and work since the last sum, in units of about 10 to 100 ns.
    round: usize,
    since: usize,
    /// Whether the clock has been read.
    begun: bool,
}

impl Patience {
    /// Work between two looks at the clock: about a millisecond.
    const WORK: usize = 1 << 15;
    /// Cost of a step in addition to its elements.
    const STEP: usize = 8;

    /// For rounds that each advance `elements` elements by a step.
    pub fn new(elements: usize) -> Self {
        let round = elements.saturating_add(Self::STEP);
        Self {
            round,
            since: 0,
            begun: false,
        }
    }

    /// For rounds of another kind, each long enough to look at the clock.
    pub fn of_long_rounds() -> Self {
        Self::new(Self::WORK)
    }

    /// Adds the work of further passes of the round that was done, such as iterations after the
    /// first.
    pub fn also(&mut self, passes: usize) {
        self.since = self.since.saturating_add(self.round.saturating_mul(passes));
    }

    /// Whether the round after number `step` may begin.
    ///
    /// * `t`: the simulated time reached, for the message.
    ///
    /// # Errors
    /// [`TimeUp`] if the limit is reached.
    pub fn check(&mut self, step: usize, t: impl FnOnce() -> f64) -> Result<(), TimeUp> {
        self.since = self.since.saturating_add(self.round);
        // A loop of few, long rounds must not run on until the first look.
        if self.since < Self::WORK && self.begun {
            return Ok(());
        }
        let (done, most) = WORK.get();
        let done = done + self.since as u64;
        WORK.set((done, most));
        (self.since, self.begun) = (0, true);
        let work = most.filter(|most| done > *most);
        let late = DEADLINE
            .get()
            .filter(|deadline| (deadline.clock)() >= deadline.at);
        if work.is_none() && late.is_none() {
            return Ok(());
        }
        let up = TimeUp {
            step,
            t: t(),
            limit: late.map_or(Duration::ZERO, |deadline| deadline.limit),
            work,
        };
        REACHED.set(Some(up));
        Err(up)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A clock that gains a millisecond each time it is read.
    fn ticking() -> Instant {
        thread_local!(static NEXT: Cell<Instant> = Cell::new(Instant::now()));
        NEXT.replace(NEXT.get() + Duration::from_millis(1))
    }

    /// Rounds done until stopped, at most `most`.
    fn rounds(limit: Option<Duration>, most: usize) -> (usize, Option<TimeUp>) {
        within_by(ticking, limit, || {
            let mut patience = Patience::new(100);
            let mut done = 0;
            while done < most && patience.check(done, || 0.5).is_ok() {
                done += 1;
            }
            done
        })
    }

    #[test]
    fn without_a_limit_nothing_is_stopped() {
        assert_eq!(rounds(None, 1_000_000), (1_000_000, None));
        assert_eq!(rounds(Some(Duration::MAX), 1_000_000), (1_000_000, None));
    }

    #[test]
    fn a_limit_is_reported_with_step_and_time_and_ends_with_its_case() {
        let limit = Duration::from_millis(20);
        let (done, up) = rounds(Some(limit), usize::MAX);
        // The clock is read before the first round, then every 304 of them, and 20 ms after the
        // start the 20th time.
        assert_eq!(
            (done, up),
            (
                19 * 304,
                Some(TimeUp {
                    step: done,
                    t: 0.5,
                    limit,
                    work: None
                })
            )
        );
        assert!(
            up.unwrap()
                .to_string()
                .starts_with("stopped at the time limit of 0.02 s, after step ")
        );
        assert_eq!(rounds(None, 1000), (1000, None));
    }

    #[test]
    fn a_limit_on_work_ends_a_case_at_the_same_round_every_time() {
        let run = |most| counted(most, || rounds(None, 100_000));
        let (whole, work) = run(None);
        assert_eq!(whole, (100_000, None));
        assert!((10_700_000..10_800_000).contains(&work), "{work}");
        let (stopped, done) = run(Some(1_000_000));
        let up = stopped.1.expect("a limit");
        assert!(
            up.work == Some(1_000_000) && done > 1_000_000 && stopped.0 < 10_000,
            "{up}"
        );
        assert_eq!(run(Some(1_000_000)), (stopped, done));
        assert!(
            up.to_string().ends_with("t = 0.5") && up.to_string().contains("work limit"),
            "{up}"
        );
    }

    #[test]
    fn a_loop_that_was_set_up_before_the_limit_obeys_it() {
        let mut patience = Patience::new(100);
        let limit = Duration::from_millis(1);
        let (done, up) = within(Some(limit), || {
            (0..usize::MAX).find(|&step| patience.check(step, || 0.5).is_err())
        });
        assert!(
            done.is_some() && up.is_some_and(|up| up.limit == limit),
            "{done:?} {up:?}"
        );
    }

    #[test]
    fn a_limit_of_nothing_stops_before_the_first_round() {
        assert_eq!(rounds(Some(Duration::ZERO), 10).0, 0);
    }
}
