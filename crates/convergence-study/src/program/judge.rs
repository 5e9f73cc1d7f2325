//! From answers to an outcome: errors, and values without a known error, with their rate, their
//! limit and the distance to it.

use std::collections::BTreeSet;

use super::answer::Answer;
use super::expectation::Expectation;
use super::{CaseRun, Program, refine, samples, values};
use crate::chart::{self, Chart, Series};
use crate::study::grid::{Grid, GridColumn};
use crate::study::over_levels::{ErrorColumn, Levels};
use crate::study::sampled::Sampled;
use crate::study::until_decided::{Looks, Next};
use crate::study::{
    Budget, Case, CaseFailure, Check, Figure, LevelErrors, Must, NamedRate, Outcome, Quantity, Ran,
    RefinedIn, Sort, Subject,
};
use crate::text::number::{error_text, plain_text};
use convergence_judge::claims;
use convergence_judge::grid::SpaceTime;
use convergence_judge::verdict::Verdict;

pub(super) fn judge(study: &Program, ran: &[CaseRun]) -> Outcome {
    let mut outcome = judge_answers(study, ran);
    let mut answers = ran.iter().filter_map(CaseRun::ok);
    outcome.reused = answers.clone().filter(|answer| answer.is_reused).count();
    if let Some(differs) = answers.find_map(|answer| answer.differs.as_ref()) {
        let advice = "what changed is not in program.files, or the program does not repeat its numbers; \
                      the kept answers are not of this version: remove them, or run with --bless";
        let claim = "the cheapest case answers what it has answered before";
        let check = Check::that(false, claim, format!("{differs}: {advice}"));
        outcome
            .checks
            .push(check.about(Subject::of("kept answers")));
        outcome.verdict = Verdict::Fail;
    }
    outcome
}

fn judge_answers(study: &Program, ran: &[CaseRun]) -> Outcome {
    let Some(count) = study.refine.samples else {
        return judge_levels(study, ran, None);
    };
    let (ran, sampled) = samples::levels(study, ran, count);
    let mut outcome = judge_levels(study, &ran, Some(&sampled));
    outcome.add_to_summary(&Sampled::words(count));
    outcome
}

/// Judges one answer for each level.
///
/// * `sampled`: the samples of the levels that have a result, if there are some.
fn judge_levels(study: &Program, ran: &[CaseRun], sampled: Option<&Sampled>) -> Outcome {
    if let Some(mixed) = mixed_steps(study, ran) {
        let check = Check::that(
            false,
            "every level answers its step, or none does",
            mixed.clone(),
        )
        .about(Subject::of("step"));
        return Outcome::new(mixed, vec![], vec![check, completion(ran)]);
    }
    let mut levels = levels(study, ran);
    if let Some(sampled) = sampled {
        levels = sampled.judging(levels, &|name| study.of(name));
    }
    let mut outcome = if study.refine.grid {
        over_grid(study, ran, &levels)
    } else {
        along_path(study, ran, &levels)
    };
    let several = several_answers(ran);
    if !several.is_empty() {
        outcome.add_to_summary(&several);
    }
    // Answered numbers are finite. An answer may lack some numbers, and a failed case fails its
    // check; the baseline notices a guarded number that is missing.
    outcome
        .quantities
        .retain(|quantity| quantity.value.is_finite());
    outcome
}

/// Both orders of each error at once.
fn over_grid(study: &Program, ran: &[CaseRun], levels: &Levels) -> Outcome {
    let columns = study.expect.iter().map(|expected| GridColumn {
        name: expected.name.clone(),
        space: expected.claim,
        time: expected.time,
        errors: ran.iter().map(|ran| number(ran, expected)).collect(),
    });
    let grid = Grid {
        points: ran
            .iter()
            .map(|ran| SpaceTime {
                space: step(ran, RefinedIn::Space),
                time: step(ran, RefinedIn::Time),
            })
            .collect(),
        times: study.refine.times(),
        columns: columns.collect(),
        squares_add: false,
    };
    let pairs = levels.equal_pairs();
    let mut outcome =
        grid.judge_unless(|judged, rate| levels.unless_equal(&pairs, &judged.name, rate));
    let mut checks = levels.equal_columns();
    checks.extend(levels.boundary_of_grid(&grid, &outcome.rates));
    checks.push(completion(ran));
    outcome.extend(Outcome::new("", vec![], checks));
    outcome.figures = grid.figures(&outcome.rates, |name| format!("error {name}"));
    outcome.figures.extend(work_precision(levels, ran));
    outcome.quantities = levels.quantities(&outcome.rates);
    outcome.levels = levels.errors();
    add_work(&mut outcome.levels, ran);
    for level in &mut outcome.levels {
        // They are not judged over either step alone.
        level.step = None;
    }
    outcome
}

/// Whether another level is run.
pub(super) fn goes_on(study: &Program, ran: &[CaseRun]) -> bool {
    let limit = study.refine.budget;
    match study.most_levels {
        Some(most) => {
            let budget = budget(ran, limit.unwrap_or(refine::BUDGET));
            ran.len() < most && budget.is_some_and(|budget| budget.has_room())
        }
        None => limit
            .and_then(|limit| budget(ran, limit))
            .is_some_and(|budget| {
                let now = rates(study, ran);
                budget.after(&looks(study, ran, &now), ran.len()) == Next::Another
            }),
    }
}

/// What the next level may cost; `None` if a case has failed.
fn budget(ran: &[CaseRun], limit: f64) -> Option<Budget> {
    let seconds = ran.iter().map(|ran| Some(ran.ok()?.seconds));
    let seconds = seconds.collect::<Option<Vec<f64>>>()?;
    Some(Budget::of_seconds(&seconds, limit))
}

/// The rates of errors and values, and what they were with one level fewer.
///
/// * `now`: the rates of these levels.
fn looks<'r>(study: &Program, ran: &[CaseRun], now: &'r [NamedRate]) -> Looks<'r> {
    let looks = Looks::new(now, ran.len(), |count| rates(study, &ran[..count]));
    looks.of_errors(&levels(study, ran))
}

/// The rates of errors and of values over these levels.
fn rates(study: &Program, ran: &[CaseRun]) -> Vec<NamedRate> {
    let levels = levels(study, ran);
    let values = values::judge(study, ran, &levels.refinements);
    [levels.judge(), values.rates].concat()
}

fn along_path(study: &Program, ran: &[CaseRun], levels: &Levels) -> Outcome {
    let mut checks = exact(study, ran);
    checks.push(completion(ran));
    let mut outcome = levels.outcome_without_figure(checks);
    claim_exactness(study, &mut outcome.quantities);
    if levels.columns.is_empty() {
        outcome.levels.clear();
    }
    add_work(&mut outcome.levels, ran);
    // The figure is over h.
    if !levels.columns.is_empty() && !by_degree(study) {
        let caption = "Errors over levels of refinement.".to_owned();
        let errors = levels.figure("errors", None, caption, &outcome.rates);
        outcome.figures.push(errors);
        outcome.figures.extend(work_precision(levels, ran));
    }
    let mut values = values::judge(study, ran, &levels.refinements);
    if values.rates.is_empty() {
        // Nothing is claimed of them.
        values.verdict = outcome.verdict;
    }
    let limits = values.summary.clone();
    outcome.extend(values);
    let outcome = outcome.summed_up_by_rates(limits);
    let limit = study.refine.budget.filter(|_| study.most_levels.is_none());
    match limit.and_then(|limit| budget(ran, limit)) {
        Some(budget) => {
            let now = outcome.rates.clone();
            budget.conclude_after(outcome, &looks(study, ran, &now), levels)
        }
        None => outcome,
    }
}

/// Whether n is a degree.
fn by_degree(study: &Program) -> bool {
    study.expect.iter().any(|expected| expected.by_degree)
}

/// A check for each error that should vanish.
fn exact(study: &Program, ran: &[CaseRun]) -> Vec<Check> {
    let checks = study.expect.iter().filter_map(|expected| {
        let bound = expected.exact?;
        let (largest, is_exact) = claims::exact(ran.iter().map(|ran| number(ran, expected)), bound);
        let claim = format!("{} is exact: at most {}", expected.name, plain_text(bound));
        let evidence = format!("largest {}", error_text(largest));
        Some(Check::that(is_exact, claim, evidence).about(Subject::of(&expected.name)))
    });
    checks.collect()
}

/// Claims of each error that should vanish that it is at most its bound.
fn claim_exactness(study: &Program, quantities: &mut [Quantity]) {
    for quantity in quantities {
        let mut expected = study.expect.iter();
        let own = expected.find(|expected| expected.name == quantity.subject.quantity);
        if let (Sort::Error, Some(bound)) = (quantity.sort, own.and_then(|own| own.exact)) {
            quantity.claim = Some(Must::AtMost(bound));
        }
    }
}

/// The number that a case answered; NaN if it did not.
fn number(ran: &CaseRun, expected: &Expectation) -> f64 {
    ran.ok()
        .and_then(|answer| answer.number(expected))
        .unwrap_or(f64::NAN)
}

/// A case that answered less than required counts as failed.
fn completion(ran: &[CaseRun]) -> Check {
    let names: BTreeSet<&str> = ran.iter().filter_map(CaseRun::ok).flat_map(names).collect();
    let whole: Vec<_> = ran.iter().map(|ran| with_all(&names, ran)).collect();
    Check::completion(&whole, |()| vec![])
}

/// The case, failed if its answer lacks one of the names.
fn with_all(wanted: &BTreeSet<&str>, Ran { case, found }: &CaseRun) -> Ran<(), ()> {
    let answered = found.as_ref().map_err(Clone::clone);
    let found = answered.and_then(|answer| {
        let own: BTreeSet<&str> = names(answer).collect();
        let missing = || wanted.difference(&own).next().map(|name| lacks(name));
        answer.failure.clone().or_else(missing).map_or(Ok(()), Err)
    });
    Ran {
        case: Case::new(case.label.clone(), case.cost, ()),
        found,
    }
}

/// The names of the errors of an answer.
pub(super) fn names(answer: &Answer) -> impl Iterator<Item = &str> {
    answer.errors.iter().map(|error| error.name.as_str())
}

/// Why a level has failed whose answer has not the errors of others.
fn lacks(name: &str) -> CaseFailure {
    CaseFailure::new(format!(
        "its answer has no error `{name}`, which that of another level has"
    ))
}

/// What is said of programs that print several answers, one a time step.
fn several_answers(ran: &[CaseRun]) -> String {
    let answers = ran.iter().filter_map(CaseRun::ok);
    let printed = answers.map(|answer| answer.printed);
    match (printed.clone().min(), printed.max()) {
        (Some(least), Some(most)) if most > 1 && least == most => {
            format!("each level printed {most} answers, of which the last counts")
        }
        (Some(least), Some(most)) if most > 1 => {
            format!("the levels printed {least} to {most} answers, of which the last counts")
        }
        _ => String::new(),
    }
}

/// Which levels answer a step that the rates need, if others do not: nominal steps cannot replace
/// the missing ones.
fn mixed_steps(study: &Program, ran: &[CaseRun]) -> Option<String> {
    let space = study.refine.space.is_some();
    let time = study.refine.time.is_some() && (study.refine.grid || !space);
    let h = space.then(|| mixed(ran, "h", |answer| answer.h)).flatten();
    let dt = time.then(|| mixed(ran, "dt", |answer| answer.dt)).flatten();
    h.or(dt)
}

/// The complaint, if some levels answer the step and others do not.
fn mixed(ran: &[CaseRun], name: &str, step: fn(&Answer) -> Option<f64>) -> Option<String> {
    let [with, without] = [true, false].map(|has| {
        let answered = ran
            .iter()
            .filter(|ran| ran.ok().is_some_and(|answer| step(answer).is_some() == has));
        let labels: Vec<&str> = answered.map(|ran| ran.case.label.as_str()).collect();
        labels.join("; ")
    });
    let is_mixed = !with.is_empty() && !without.is_empty();
    let expected = format!("expected {name} in the answers of all levels or of none");
    is_mixed.then(|| format!("{expected}; found it in those of {with}, not in those of {without}"))
}

/// The step of a case: as reported by the program, otherwise the nominal one.
fn step(Ran { case, found }: &CaseRun, axis: RefinedIn) -> f64 {
    let answered = found.as_ref().ok();
    match axis {
        RefinedIn::Space | RefinedIn::Both => {
            answered.and_then(|answer| answer.h).unwrap_or(case.data.h)
        }
        RefinedIn::Time => answered
            .and_then(|answer| answer.dt)
            .unwrap_or(case.data.dt),
    }
}

/// Every error of every answer.
fn levels(study: &Program, ran: &[CaseRun]) -> Levels {
    let axis = study.refine.axis();
    let found: Vec<_> = ran
        .iter()
        .map(|ran| ran.ok().map(|answer| answer.errors.as_slice()))
        .collect();
    let refinements = ran.iter().map(|ran| {
        let step = step(ran, axis);
        let over = match by_degree(study) {
            true => claims::step_of_degree(step.recip()),
            false => step,
        };
        ran.case.data.refinement(over)
    });
    Levels::new(
        axis,
        refinements,
        ErrorColumn::of(&study.claims(false), &found),
    )
    .of_answers()
    .printed()
    .over_degrees(by_degree(study))
    .with_floor(study.floor)
}

/// Adds the work that the program counts to the errors of each level.
fn add_work(levels: &mut [LevelErrors], ran: &[CaseRun]) {
    for (level, ran) in levels.iter_mut().zip(ran) {
        level.work = ran.ok().and_then(|answer| answer.work);
    }
}

/// The column of the work, and its axis.
const WORK: &str = "work, as the program counts it";

/// Errors over the work that the program counts, if every answer contains it.
fn work_precision(levels: &Levels, ran: &[CaseRun]) -> Option<Figure> {
    let answers = ran.iter().map(CaseRun::ok);
    let work = answers.map(|answer| answer.map_or(Some(f64::NAN), |answer| answer.work));
    let work: Vec<f64> = work.collect::<Option<_>>()?;
    let mut table = levels.rows();
    table.push(WORK, work);
    let claimed = levels
        .columns
        .iter()
        .filter(|column| column.claim.is_some());
    let series = claimed.map(|column| Series::new(&column.name, WORK, &column.name).marked());
    let chart = Chart {
        series: series.collect(),
        ..Chart::new(table, chart::Axis::log(WORK), chart::Axis::log("error"))
    };
    let drawn = chart.titled("Errors over the work that they cost").svg();
    Some(Figure::new(
        "work",
        "Errors over the work that they cost: the lower and the further left, the better.",
        drawn,
    ))
}
