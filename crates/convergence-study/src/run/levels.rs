//! Levels of a function, run and asserted in one line, for tests of a solver.

use super::{Finished, run_kind};
use crate::study::{ErrorsOverLevels, IntoErrors, NamedRate};
use convergence_judge::claims::{Bound, Claim};
use convergence_judge::fit::Level;
use convergence_judge::shown::{self, Shown};
use convergence_judge::verdict::{Floor, Verdict};

/// Judges errors against the order that theory claims, in any test; the tolerance is
/// that of [`Claim::usual`].
///
/// * `h`: the steps, in any order; `errors`: the errors at these steps.
///
/// # Panics
/// Unless the verdict is a pass; the message has the table, the rate, its interval, the reason and
/// what to do. Inconclusive is not a pass. Also if the numbers of errors and steps differ.
///
/// ```
/// let h = [0.1, 0.05, 0.025, 0.0125];
/// convergence_study::assert_order(&h, &[4.1e-3, 1.02e-3, 2.55e-4, 6.37e-5], 2.0);
/// ```
#[track_caller]
pub fn assert_order(h: &[f64], errors: &[f64], order: f64) {
    assert!(
        h.len() == errors.len(),
        "{} steps and {} errors: expected one error for each step",
        h.len(),
        errors.len()
    );
    let mut levels: Vec<Level> = h
        .iter()
        .zip(errors)
        .map(|(&step, &error)| Level { step, error })
        .collect();
    levels.sort_by(|one, other| other.step.total_cmp(&one.step));
    let rate = Claim::usual(order, Bound::Both).judge(&levels, Floor::NONE);
    let shown = Shown {
        name: "error",
        levels: &levels,
        rate: &rate,
        late: 0,
    };
    assert!(
        rate.verdict.is_pass(),
        "the order is not confirmed\n{}",
        shown::explained("h", &[shown], 0.0)
    );
}

impl<R, F> ErrorsOverLevels<F>
where
    R: IntoErrors,
    F: Fn(usize, usize) -> R + Send + Sync,
{
    /// Runs all levels, on all threads of the machine, and judges them.
    pub fn run(&self) -> Finished {
        run_kind(&self.header, self)
    }

    /// Runs and judges it, for a test.
    ///
    /// # Panics
    /// As [`Finished::assert_passes`].
    #[track_caller]
    pub fn assert_passes(&self) -> Finished {
        let finished = self.run();
        finished.assert_passes();
        finished
    }
}

impl Finished {
    /// Asserts that the study passes.
    ///
    /// # Panics
    /// Unless the verdict is a pass, with the table of errors and rates, the reasons and what to
    /// do; inconclusive is not a pass.
    #[track_caller]
    pub fn assert_passes(&self) {
        assert!(self.outcome.verdict.is_pass(), "{}", self.explained());
    }

    /// Verdict, errors with their rates, reasons and advice as text.
    pub fn explained(&self) -> String {
        let id = &self.header.id;
        let outcome = &self.outcome;
        let levels: Vec<Vec<Level>> = outcome
            .rates
            .iter()
            .map(|rate| outcome.levels_of(&rate.name))
            .collect();
        let rates = outcome.rates.iter().zip(&levels);
        let columns: Vec<Shown<'_>> = rates
            .map(|(NamedRate { name, rate, .. }, levels)| Shown {
                name,
                levels,
                rate,
                late: 0,
            })
            .collect();
        let mut text = format!(
            "{id}: {}\n{}",
            outcome.verdict,
            shown::explained("step", &columns, 0.0)
        );
        for check in outcome
            .checks
            .iter()
            .filter(|check| check.verdict != Verdict::Pass)
        {
            text += &format!(
                "{}: {}: {}\n",
                check.statement(),
                check.verdict,
                check.evidence
            );
        }
        text
    }
}
