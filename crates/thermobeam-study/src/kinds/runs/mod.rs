//! Studies of runs: a list of runs of beams, and a list of checks on what they show.
//!
//! The numbers of a run are declared once, as [`Measured`]s: these give completion, table and
//! guarded numbers. Their claims are the checks of [`checks`].

pub mod cases;
pub mod checks;
pub mod energy;
pub mod scenes;
pub(crate) mod side_by_side;
pub(crate) mod watch;

use super::prelude::*;

/// A run of a study, and what it shows.
pub(crate) type Shown<'r, K> = (&'r <K as Kind>::Data, &'r <K as Kind>::Found);

/// An outcome with a table: a row for each run that has a result, and its numbers.
///
/// * `first`: the head of the first column.
/// * `numbers`: of a run, without a case. A number that the run lacks has no value.
pub(crate) fn with_table_of_runs<D, F>(
    outcome: Outcome,
    ran: &[Ran<D, F>],
    [title, first]: [&str; 2],
    numbers: impl Fn(&D, &F) -> Vec<Measured>,
) -> Outcome {
    let mut all = vec![];
    for run in ran {
        let found = run.ok().map(|found| numbers(&run.case.data, found));
        for mut one in found.into_iter().flatten() {
            one.case.clone_from(&run.case.label);
            all.push(one);
        }
    }
    outcome.with_sheets([Sheet::new(title, first, all)])
}

/// Words in that table.
pub(crate) fn in_words(name: &str, words: impl ToString) -> Measured {
    measured("", name, None).words(words.to_string())
}
