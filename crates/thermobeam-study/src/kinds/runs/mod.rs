//! Studies of runs: a list of runs of beams, and a list of checks on what they show.
//!
//! The numbers of a run are declared once, as [`Measured`]s: these give completion, table and
//! guarded numbers. `judged` does for all kinds of this sort what does not depend on the kind;
//! their claims are the checks of [`checks`].

pub mod cases;
pub mod checks;
pub mod energy;
pub mod scenes;
pub(crate) mod side_by_side;
pub(crate) mod watch;

use super::prelude::*;

/// A run of a study, and what it shows.
pub(crate) type Shown<'r, K> = (&'r <K as Kind>::Data, &'r <K as Kind>::Found);

/// The outcome of a study whose runs show these numbers. If a run has no result, nothing else is
/// judged.
///
/// * `table`: the title of a table with a row for each run and its numbers, whose guarded numbers
///   count, and the head of its first column; `None` if the rows of all tables combine runs.
/// * `numbers`: of a run, without a case: none may be NaN or infinite. A number that the run lacks
///   has no value.
/// * `judge`: the checks, and what else the results show, but for completion.
pub(crate) fn judged<K: Kind<Data: PartialEq>>(
    study: &K,
    ran: &[Ran<K::Data, K::Found>],
    table: Option<[&str; 2]>,
    numbers: impl Fn(&K::Data, &K::Found) -> Vec<Measured>,
    judge: impl FnOnce(&[Shown<'_, K>]) -> Outcome,
) -> Outcome {
    let mut all = vec![];
    for case in study.cases() {
        let found = match ran.iter().find(|ran| ran.case.data == case.data) {
            Some(ran) => ran.found.as_ref().map_err(CaseFailure::clone),
            None => Err(CaseFailure::new("it was not run")),
        };
        let found = found.map(|shown| numbers(&case.data, shown));
        let case = Case::new(case.label, case.cost, ());
        all.push(Ran { case, found });
    }
    let lacking = all.iter().filter(|ran| ran.ok().is_none()).count();
    let own = if lacking > 0 || all.is_empty() {
        let have = if lacking == 1 { "has" } else { "have" };
        let runs = counted(all.len(), "run");
        let words = format!("{lacking} of {runs} {have} no result, so nothing else is judged");
        Outcome::new(words, vec![], vec![])
    } else {
        let shown = ran
            .iter()
            .filter_map(|ran| Some((&ran.case.data, ran.ok()?)));
        judge(&shown.collect::<Vec<_>>())
    };
    let completion = Check::completion(&all, |numbers| Measured::not_finite(numbers));
    let mut outcome = Outcome::of_parts(completion, [own]);
    if let Some([title, first]) = table {
        let of_run = |ran: Ran<(), Vec<Measured>>| {
            let case = ran.case.label;
            let numbers = ran.found.unwrap_or_default().into_iter();
            numbers.map(move |mut one| {
                one.case.clone_from(&case);
                one
            })
        };
        let sheet = Sheet::new(title, first, all.into_iter().flat_map(of_run));
        outcome.tables.splice(0..0, sheet.table());
        outcome.quantities.splice(0..0, sheet.quantities());
    }
    outcome
}
