//! What to do next about a column that does not pass, from its numbers where they show more than the reason.

use super::{JudgedColumn, Judgement};
use crate::input::error_table::limit;
use crate::judge::fit::Level;
use crate::judge::verdict::{Reason, Verdict};
use crate::text::number::{error_text, plain_text, short_text};

/// Largest difference of two rates that are steady.
const STEADY: f64 = 0.2;
/// Least fall of a rate that has been steady, in orders, where the error stops.
const STOP: f64 = 0.5;
/// Most levels that are predicted.
const AHEAD: usize = 3;

/// What the reason means for a column, and what to do.
pub(super) fn words(judged: &JudgedColumn<'_>, findings: &Judgement<'_>) -> String {
    let (rate, name, general) = (&judged.rate, &judged.column.name, judged.rate.kind.advice());
    let errors: Vec<f64> = judged.column.levels.iter().map(|level| level.error).collect();
    let grows = |judged: &&JudgedColumn<'_>| {
        judged.rate.pairwise.len() > 1 && judged.rate.pairwise.iter().all(|rate| *rate < 0.0)
    };
    let stays =
        matches!(rate.kind, Reason::ErrorGrows | Reason::FallsAway | Reason::TooLow) || rate.kind.wants_a_level();
    if judged.estimate.is_some() || !(stays || rate.kind == Reason::ZeroError) {
        general.to_owned()
    } else if errors.iter().position(|error| *error == 0.0).is_some_and(|zero| zero + 1 == errors.len()) {
        format!("{name} is zero on the finest level only. Is that level its own reference? Leave it out.")
    } else if findings.columns.iter().filter(|column| column.is_claimed()).all(|column| grows(&column)) {
        format!("The errors fall as `{}` grows. Do they stand beside their own steps?", findings.table.step)
    } else if let Some(level) = stop(&rate.pairwise) {
        let down_to =
            format!("{name} falls with rate {:.2} down to {}", rate.pairwise[level - 1], error_text(errors[level]));
        let causes =
            "the solver's tolerance, the reference solution, round-off (--floor), the error of the other axis?";
        format!("{down_to}, then stops. What stays there: {causes}")
    } else if let Some(limit) = limit(&errors) {
        let limit = plain_text(limit);
        format!("{name} tends to {limit}, not to zero. If it is a value and no error: --values '{name}'. {general}")
    } else {
        general.to_owned() + &next_level(judged, findings)
    }
}

/// The level down to which the error falls at a steady rate, where it does not on any finer one.
fn stop(rates: &[f64]) -> Option<usize> {
    let last = rates.last()?;
    (2..rates.len()).find(|&k| {
        let steady = rates[k - 1];
        let stops = rates[k..].iter().all(|rate| *rate < steady - STOP) && *last < 0.5 * steady && steady > STOP;
        stops && (rates[k - 2] - steady).abs() <= STEADY
    })
}

/// Which level would decide, were the rates to go on as they do: their changes shrink as the last two did.
fn next_level(judged: &JudgedColumn<'_>, findings: &Judgement<'_>) -> String {
    let (mut levels, rates) = (judged.column.levels.clone(), &judged.rate.pairwise);
    let changes: Vec<f64> = rates.windows(2).map(|two| two[1] - two[0]).collect();
    let [.., mut change] = changes[..] else { return String::new() };
    let shrinks = changes.iter().rev().nth(1).map(|before| change / before);
    let shrinks = shrinks.filter(|share| *share > 0.0 && *share < 1.0).unwrap_or(0.5);
    let mut rate = rates[rates.len() - 1];
    for ahead in 1..=AHEAD {
        let [.., before, last] = levels[..] else { return String::new() };
        let ratio = before.step / last.step;
        change *= shrinks;
        rate += change;
        levels.push(Level { step: last.step / ratio, error: last.error * ratio.powf(-rate) });
        let next = findings.judge.judge(&levels, judged.rate.order);
        if next.verdict != Verdict::Inconclusive
            && judged.rate.kind.wants_a_level()
            && rates.iter().all(|rate| *rate > 0.0)
        {
            let parts = ratio.powi(ahead as i32) / judged.column.levels[levels.len() - 1 - ahead].step;
            let is_part = findings.table.step == "h" && (parts - parts.round()).abs() < 1e-9 * parts;
            let step = if is_part { format!("1/{}", parts.round()) } else { plain_text(1.0 / parts) };
            let (which, are) = if ahead == 1 { ("Another level,", "is") } else { ("Levels down to", "are") };
            let half = |interval: [f64; 2]| short_text(0.5 * (interval[1] - interval[0]));
            let now = judged.rate.interval.map_or(String::new(), |now| format!("interval ± {} now, ", half(now)));
            let then = next.interval.map_or(String::new(), half);
            let name = &judged.column.name;
            return format!(
                " {which} {} = {step}, {are} likely to decide ({name}: {now}about ± {then} then).",
                findings.table.step
            );
        }
    }
    String::new()
}
