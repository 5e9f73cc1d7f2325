//! What to do next about a column that does not pass, from its numbers where they show more than the reason.

use super::Judged;
use crate::judge::fit::Level;
use crate::judge::verdict::{Reason, WILD};
use crate::text::number::{error_text, plain_text};

/// Largest difference of two rates that are steady.
const STEADY: f64 = 0.2;
/// Least fall of a rate that has been steady, in orders, where the error stops.
const STOP: f64 = 0.5;

/// What the reason means for a column, and what to do.
///
/// * `levels`: coarsest first.
/// * `step`: what the step is.
/// * `all_reversed`: whether all errors that are judged fall as the step grows.
pub(super) fn words(judged: &Judged<'_>, levels: &[Level], step: &str, all_reversed: bool) -> String {
    let rates = &judged.rate.pairwise;
    let shown = match judged.rate.kind {
        Reason::ErrorGrows
        | Reason::WildRate
        | Reason::TooLow
        | Reason::NotAsymptotic
        | Reason::Departs
        | Reason::IntervalTooWide
            if all_reversed && !is_of_count(step) =>
        {
            Some(format!(
                "The errors fall as `{step}` grows. Is it a count? Then give --dim D, 1 along an edge. If not: do the errors stand \
                 beside their own steps?"
            ))
        }
        Reason::ErrorGrows
        | Reason::FallsAway
        | Reason::TooLow
        | Reason::NotAsymptotic
        | Reason::Departs
        | Reason::IntervalTooWide => stop(rates).map(|level| {
            format!(
                "{} falls with rate {:.2} down to {}, then stops. What stays there: the solver's tolerance, the reference solution, \
                 round-off (--floor), the error of the other axis?",
                judged.name,
                rates[level - 1],
                error_text(levels[level].error)
            )
        }),
        Reason::ZeroError => is_own_reference(levels).then(|| {
            format!("{} is zero on the finest level only. Is that level its own reference? Leave it out.", judged.name)
        }),
        Reason::WildRate => wild(judged, levels, step),
        _ => None,
    };
    shown.unwrap_or_else(|| judged.rate.kind.advice().to_owned())
}

/// Whether a step is computed from a count already.
fn is_of_count(step: &str) -> bool {
    step.starts_with("1/") || step.contains("^(-1/")
}

/// Whether an error falls as the step grows.
pub(super) fn is_reversed(rates: &[f64]) -> bool {
    rates.len() > 1 && rates.iter().all(|rate| *rate < 0.0)
}

/// The level down to which the error falls at a steady rate, where it does not on any finer one.
fn stop(rates: &[f64]) -> Option<usize> {
    let last = rates.last()?;
    (2..rates.len()).find(|&k| {
        let steady = rates[k - 1];
        (rates[k - 2] - steady).abs() <= STEADY
            && rates[k..].iter().all(|rate| *rate < steady - STOP)
            && *last < 0.5 * steady
            && steady > STOP
    })
}

/// Whether the finest error alone is zero.
fn is_own_reference(levels: &[Level]) -> bool {
    levels
        .split_last()
        .is_some_and(|(finest, coarser)| finest.error == 0.0 && coarser.iter().all(|level| level.error > 0.0))
}

/// Which levels the first wild rate is between.
fn wild(judged: &Judged<'_>, levels: &[Level], step: &str) -> Option<String> {
    let rate = judged.rate;
    let k = rate.pairwise.iter().position(|pair| (pair - rate.order).abs() > WILD)?;
    Some(format!(
        "Between levels {} and {} ({step} = {} and {}) the rate of {} is {:.1}, more than {WILD} orders away from the claim: these \
         levels are not one family. Look at the two runs.",
        k + 1,
        k + 2,
        plain_text(levels[k].step),
        plain_text(levels[k + 1].step),
        judged.name,
        rate.pairwise[k]
    ))
}
