//! Levels until there is a decision: a study begins with four and adds the next finer one while its
//! rates decide nothing, another level can help, and its cost fits the budget.
//!
//! Looking again causes few wrong passes: the rule stands by its interval at every look, and a
//! wrong claim fails at one of them. `rule-calibration` has a row that measures this. A limit on
//! the number of levels keeps it so.

#[cfg(feature = "files")]
use crate::input::{Field, InputError, Section};
use crate::judge::verdict::{Reason, Verdict};
use crate::study::outcome::{NamedRate, Outcome};
use crate::study::over_levels::Levels;

/// Levels at the first look, each twice as fine as the previous one.
pub const FIRST: [usize; 4] = [8, 16, 32, 64];

/// Most levels.
pub const MOST_LEVELS: usize = 8;

/// What a study that adds levels does next.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Next {
    /// It computes another level.
    Another,
    /// It ends: every rate has passed or failed.
    Decided,
    /// It ends: no finer level can resolve this reason.
    Beyond(Reason),
    /// It ends with [`MOST_LEVELS`].
    Most,
    /// It ends: the next level would cost this much.
    TooDear(f64),
}

/// * `rates`: those of the levels so far.
/// * `cost`: of the next level, in the unit of `budget`; the levels so far have cost `spent`.
pub fn next(rates: &[NamedRate], levels: usize, cost: f64, spent: f64, budget: f64) -> Next {
    let open: Vec<Reason> = rates
        .iter()
        .map(|named| named.rate.kind)
        .filter(|kind| kind.verdict() == Verdict::Inconclusive)
        .collect();
    let Some(&first) = open.first() else {
        return Next::Decided;
    };
    if !open.iter().any(|reason| reason.wants_a_level()) {
        return Next::Beyond(first);
    }
    if levels >= MOST_LEVELS {
        return Next::Most;
    }
    // Not `>`, which would let NaN pass.
    if !(spent + cost <= budget) {
        return Next::TooDear(cost);
    }
    Next::Another
}

/// The same with time as cost: the next level takes longer by the same factor as the last one did,
/// and by at least two.
///
/// * `seconds`: time of each level; at least two.
pub fn next_by_time(rates: &[NamedRate], seconds: &[f64], budget: f64) -> Next {
    let [.., before, last] = seconds else {
        return Next::Another;
    };
    next(
        rates,
        seconds.len(),
        last * (last / before).max(2.0),
        seconds.iter().sum(),
        budget,
    )
}

/// The outcome of a study that adds levels. It says how the study ended. It guards only the first
/// levels, because another machine may afford others.
pub fn conclude(
    mut outcome: Outcome,
    next: Next,
    levels: &Levels,
    budget: f64,
    unit: &str,
) -> Outcome {
    let words = in_words(next, levels, &outcome.rates, budget, unit);
    outcome.add_to_summary(&words);
    let first: Vec<&String> = levels
        .refinements
        .iter()
        .take(FIRST.len())
        .map(|level| &level.label)
        .collect();
    outcome.quantities.retain(|quantity| {
        let level = quantity.subject.level.as_ref();
        level.is_some_and(|level| first.contains(&level))
    });
    outcome
}

/// How the study ended, in words: `decided after 5 levels; 4 were enough for L2`.
///
/// * `unit`: of costs and budget, such as `s`.
fn in_words(next: Next, levels: &Levels, rates: &[NamedRate], budget: f64, unit: &str) -> String {
    let count = levels.refinements.len();
    let undecided = format!("undecided after {count} levels");
    match next {
        Next::Another | Next::Decided => {
            let mut words = format!("decided after {count} levels");
            for (name, enough) in levels_that_were_enough(levels, rates) {
                words += &format!("; {enough} were enough for {name}");
            }
            words
        }
        Next::Beyond(reason) => {
            format!("{undecided}: {}, which no finer level mends", reason.text())
        }
        Next::Most => format!("{undecided}, the most that are tried"),
        Next::TooDear(cost) => {
            format!(
                "{undecided}: the next would take about {cost:.2e} {unit}, more than what is left of the budget of {budget} {unit}"
            )
        }
    }
}

/// Errors whose verdict has not changed since fewer levels, each with that number of levels.
fn levels_that_were_enough<'r>(levels: &Levels, rates: &'r [NamedRate]) -> Vec<(&'r str, usize)> {
    let all = levels.refinements.len();
    let mut enough = vec![all; rates.len()];
    for count in (FIRST.len()..all).rev() {
        let earlier = levels.coarsest(count).judge();
        for ((enough, last), earlier) in enough.iter_mut().zip(rates).zip(&earlier) {
            if *enough == count + 1 && earlier.rate.verdict == last.rate.verdict {
                *enough = count;
            }
        }
    }
    let names = rates.iter().map(|rate| rate.name.as_str());
    names
        .zip(enough)
        .filter(|(_, enough)| *enough < all)
        .collect()
}

/// Whether a list of counts is left to the study.
#[cfg(feature = "files")]
pub fn is_auto(field: &Field<'_>) -> bool {
    field.text().is_ok_and(|text| text == "auto")
}

/// The key `budget` of `[refine]`; `None` if no list is left to the study.
///
/// * `counts`: the keys of lists; all lists present must be `"auto"`, or none.
/// * `usual`: the default budget.
/// * `allowed`: what a budget may be, in words.
///
/// # Errors
/// [`InputError`] if only some lists are `"auto"`, if `"auto"` occurs together with `grid = true`,
/// or a budget without it.
#[cfg(feature = "files")]
pub fn budget(
    section: &Section<'_>,
    counts: &[&str],
    grid: bool,
    usual: f64,
    allowed: &str,
) -> Result<Option<f64>, InputError> {
    let lists: Vec<Field<'_>> = counts.iter().filter_map(|key| section.get(key)).collect();
    let listed = lists.iter().find(|field| field.is_list());
    let Some(auto) = lists.iter().find(|field| is_auto(field)) else {
        return match section.get("budget") {
            None => Ok(None),
            Some(field) => Err(field.refuse(
                "a budget beside lists",
                "lists alone, or \"auto\" in their place",
            )),
        };
    };
    if let Some(listed) = listed {
        return Err(listed.refuse(
            format!("{} beside \"auto\"", listed.as_written()),
            "\"auto\" for both",
        ));
    }
    if grid {
        return Err(auto.refuse_as_written("lists where grid = true"));
    }
    section
        .get("budget")
        .map_or(Ok(usual), |field| {
            field.number_where(allowed, |budget| budget > 0.0)
        })
        .map(Some)
}
