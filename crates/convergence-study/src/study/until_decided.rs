//! Levels until it is decided: a study begins with four and adds the next finer one while its rates decide nothing, a level can
//! mend that, and its cost fits the budget.
//!
//! Looking again costs few wrong passes: the rule answers for its interval at every look, and a claim that is off fails at one of them.
//! `rule-calibration` has the row that measures it. A fixed number of levels at most keeps that so.

#[cfg(feature = "files")]
use crate::input::{Field, InputError, Section};
use crate::judge::verdict::{RateVerdict, Reason, Verdict};
use crate::study::levels::{Levels, Rates};
use crate::study::outcome::Outcome;

/// Levels at the first look, each twice as fine as the one before.
pub const FIRST: [usize; 4] = [8, 16, 32, 64];

/// Levels at most.
pub const MOST_LEVELS: usize = 8;

/// What a study that adds levels does next.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Next {
    /// It computes another level.
    Another,
    /// It ends: every rate has passed or failed.
    Decided,
    /// It ends: what is not decided for this reason, no finer level mends.
    Beyond(Reason),
    /// It ends with [`MOST_LEVELS`].
    Most,
    /// It ends: the next level would cost so much.
    TooDear(f64),
}

/// * `rates`: those of the levels so far.
/// * `cost`: what the next level will take, in the unit of `budget`, of which the levels so far have taken `spent`.
pub fn next(rates: &Rates, levels: usize, cost: f64, spent: f64, budget: f64) -> Next {
    let open: Vec<Reason> =
        rates.iter().map(|(_, rate)| rate.kind).filter(|kind| kind.verdict() == Verdict::Inconclusive).collect();
    let Some(&first) = open.first() else { return Next::Decided };
    if !open.iter().any(|reason| reason.wants_a_level()) {
        return Next::Beyond(first);
    }
    match levels {
        MOST_LEVELS.. => Next::Most,
        // Not `>`, which NaN would pass.
        _ if !(spent + cost <= budget) => Next::TooDear(cost),
        _ => Next::Another,
    }
}

/// The same where the cost is time: the next level takes as many times longer as the last one did, and at least twice as long.
///
/// * `seconds`: what each level took; two at least.
pub fn next_by_time(rates: &Rates, seconds: &[f64], budget: f64) -> Next {
    let [.., before, last] = seconds else { return Next::Another };
    next(rates, seconds.len(), last * (last / before).max(2.0), seconds.iter().sum(), budget)
}

/// The outcome of a study that adds levels: it says how the study ended, and guards its first levels alone, for another machine may
/// afford others.
pub fn ended(mut outcome: Outcome, next: Next, levels: &Levels, budget: f64, unit: &str) -> Outcome {
    let words = in_words(next, levels, &outcome.rates, budget, unit);
    outcome.summary =
        [outcome.summary, words].into_iter().filter(|text| !text.is_empty()).collect::<Vec<_>>().join("; ");
    let first: Vec<String> =
        levels.refinements.iter().take(FIRST.len()).map(|level| format!(", {}", level.label)).collect();
    outcome.quantities.retain(|quantity| first.iter().any(|label| quantity.name.ends_with(label)));
    outcome
}

/// How the study ended, in words: `decided after 5 levels; 4 were enough for L2`.
///
/// * `unit`: of costs and budget, such as `s`.
fn in_words(next: Next, levels: &Levels, rates: &Rates, budget: f64, unit: &str) -> String {
    let count = levels.refinements.len();
    let undecided = format!("undecided after {count} levels");
    match next {
        Next::Another | Next::Decided => {
            let fewer =
                fewer(levels, rates).into_iter().map(|(name, enough)| format!("{enough} were enough for {name}"));
            [format!("decided after {count} levels")].into_iter().chain(fewer).collect::<Vec<_>>().join("; ")
        }
        Next::Beyond(reason) => format!("{undecided}: {}, which no finer level mends", reason.text()),
        Next::Most => format!("{undecided}, the most that are tried"),
        Next::TooDear(cost) => {
            format!(
                "{undecided}: the next would take about {cost:.2e} {unit}, more than what is left of the budget of {budget} {unit}"
            )
        }
    }
}

/// Errors whose verdict has been the same since fewer levels, each with their number.
fn fewer(levels: &Levels, rates: &Rates) -> Vec<(String, usize)> {
    let looks: Vec<_> =
        (FIRST.len()..levels.refinements.len()).map(|count| (count, levels.coarsest(count).judge())).collect();
    let enough = |(index, (name, rate)): (usize, &(String, RateVerdict))| {
        let agrees = |looked: &Rates| looked.get(index).is_some_and(|(_, earlier)| earlier.verdict == rate.verdict);
        let first = looks.iter().rev().take_while(|(_, looked)| agrees(looked)).last();
        first.map(|(count, _)| (name.clone(), *count))
    };
    rates.iter().enumerate().filter_map(enough).collect()
}

/// Whether a list of counts is left to the study.
#[cfg(feature = "files")]
pub fn is_auto(field: &Field<'_>) -> bool {
    field.text().is_ok_and(|text| text == "auto")
}

/// The key `budget` of `[refine]`; `None` where no list is left to the study.
///
/// * `counts`: the keys of lists, of which all that are there must be `"auto"` or none.
/// * `usual`: the budget of a file that does not say.
/// * `allowed`: what a budget is, in words.
///
/// # Errors
/// [`InputError`] where only some lists are, or `"auto"` stands beside `grid = true`, or a budget without it.
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
        let beside =
            |field: Field<'_>| Err(field.refuse("a budget beside lists", "lists alone, or \"auto\" in their place"));
        return section.get("budget").map_or(Ok(None), beside);
    };
    if let Some(listed) = listed {
        return Err(listed.refuse(format!("{} beside \"auto\"", listed.as_written()), "\"auto\" for both"));
    }
    if grid {
        return Err(auto.refuse_as_written("lists where grid = true"));
    }
    section.get("budget").map_or(Ok(usual), |field| field.number_where(allowed, |budget| budget > 0.0)).map(Some)
}
