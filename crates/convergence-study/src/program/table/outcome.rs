//! From the tables of a file to an outcome: rates as `rates` judges them, doubts, and what is
//! guarded.

use super::{ExistingTable, Read};
use crate::column::MAX;
use crate::input::advice::CommandLine;
use crate::rates::{self, Judgement};
use crate::study::over_levels::{self, ErrorColumn, Levels, Refinement};
use crate::study::{Check, Figure, NamedRate, Outcome, Ran, RefinedIn, Subject};
use crate::text::named::NamedNumber;
use crate::text::number::plain_text;
use convergence_judge::verdict::Verdict;

pub(super) fn judge(study: &ExistingTable, ran: &[Ran<(), Read>]) -> Outcome {
    let completion = Check::completion(ran, |_| vec![]);
    let Some(read) = ran.first().and_then(Ran::ok) else {
        return Outcome::new("the table has not been read", vec![], vec![completion]);
    };
    // No command is offered.
    let found = match rates::judgements("convergence-study", &read.tables, &study.request) {
        Ok(found) => found,
        Err(refusal) => {
            let words = refusal.words(&CommandLine::default());
            let check = Check::that(false, "the claims are about its columns", &*words);
            let check = check.about(Subject::of("claims"));
            return Outcome::new(words, vec![], vec![completion, check]);
        }
    };
    let mut all = Outcome::new("", vec![], vec![completion]);
    for (k, judgement) in found.iter().enumerate() {
        all.extend(of_table(judgement, k + 1, found.len() > 1));
    }
    let readings = read.tables.iter().map(|one| one.table.reading.as_str());
    let readings = readings.collect::<Vec<_>>().join("; ");
    let summary = [over_levels::summary(&all.rates), readings].join("; ");
    Outcome {
        summary: summary.trim_start_matches("; ").into(),
        sources: Some(read.sources.clone()),
        ..all
    }
}

/// * `number`: of the table, from 1; `is_one_of_several`: whether names need that of the table.
fn of_table(judgement: &Judgement<'_>, number: usize, is_one_of_several: bool) -> Outcome {
    let table = match judgement.source.table.name.as_str() {
        _ if !is_one_of_several => String::new(),
        "" => format!("Table {number}: "),
        heading => format!("{heading}: "),
    };
    let judged = &judgement.columns;
    let step = &judgement.source.table.step;
    // All columns of a table have its levels.
    let steps = judged
        .first()
        .into_iter()
        .flat_map(|one| &one.column.levels);
    let steps = steps.map(|level| level.step);
    let refinements: Vec<Refinement> = steps
        .map(|size| Refinement {
            label: format!("{step} = {}", plain_text(size)),
            parameters: vec![NamedNumber::new(step, size)],
            step: size,
        })
        .collect();
    let rates: Vec<NamedRate> = judged
        .iter()
        .filter(|one| one.claim.is_some())
        .map(|one| NamedRate::new(format!("{table}{}", one.column.name), one.rate.clone()))
        .collect();
    let columns = judged.iter().map(|one| {
        let numbers = one.column.levels.iter().map(|level| Some(level.error));
        let noun = if one.estimate.is_some() {
            "value"
        } else {
            "error"
        };
        ErrorColumn {
            noun,
            claim: one.claim,
            ..ErrorColumn::without_claim(format!("{table}{}", one.column.name), numbers)
        }
    });
    let levels = Levels::new(RefinedIn::Space, refinements.clone(), columns);
    let mut quantities = levels.quantities(&rates);
    quantities.retain(|quantity| quantity.value.is_finite());
    let what = if is_one_of_several {
        format!("errors-{number}")
    } else {
        "errors".to_owned()
    };
    let figure = Figure::new(
        &what,
        "Errors over steps.",
        rates::figure_without_verdict(judgement),
    );
    let mut outcome = Outcome {
        levels: levels.errors(),
        quantities,
        figures: vec![figure],
        ..Outcome::new("", rates, checks(judgement, &table))
    };
    // What the reader and the rule say of the whole table.
    outcome.verdict = Verdict::worst([outcome.verdict, judgement.verdict()]);
    outcome
}

/// An inconclusive check for each doubt, and for a table of which nothing is claimed; and what its
/// columns say of each other.
///
/// * `table`: what is in front of the names of its columns.
fn checks(judgement: &Judgement<'_>, table: &str) -> Vec<Check> {
    let doubts = judgement.doubts_that_count();
    let mut checks: Vec<Check> = doubts
        .map(|doubt| inconclusive("the table is read without a doubt", doubt.to_string()))
        .collect();
    if judgement.columns.iter().all(|one| one.claim.is_none()) {
        let words = "no order of a column is claimed".to_owned();
        checks.push(inconclusive("an order is claimed of each table", words));
    }
    let idle = judgement.equals.iter().filter(|equal| !equal.are_claimed);
    let names = idle.map(|equal| equal.names.each_ref().map(|name| format!("{table}{name}")));
    checks.extend(names.map(|names| Check::of_equal(names.each_ref().map(|name| &**name))));
    let boundary = judgement.boundary.clone().map(Check::from);
    checks.extend(boundary.map(|check| check.about(Subject::of(format!("{table}{MAX}")))));
    checks
}

fn inconclusive(claim: &str, words: String) -> Check {
    Check::new(Verdict::Inconclusive, claim, words).about(Subject::of("table"))
}
