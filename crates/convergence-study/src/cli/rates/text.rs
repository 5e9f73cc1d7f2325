//! The result for people.

use std::fmt::Write;

use super::advice::{is_reversed, words};
use super::{Findings, Judged};
use crate::cli::screen;
use crate::explain::section;
use crate::judge::verdict::{Aside, Reason, Verdict};
use crate::text::number::{decimals, interval_places};

/// Most decimals of a rate.
const MOST_PLACES: usize = 6;

/// The mark of a level without a say.
pub(super) fn mark(judged: &Judged<'_>, level: usize) -> &'static str {
    match judged.rate.set_aside.iter().find(|aside| aside.level == level).map(|aside| aside.because) {
        Some(Aside::AtFloor) => "_",
        Some(Aside::PreAsymptotic | Aside::Outlier) => "~",
        // A table has a number, or NaN, on every level.
        Some(Aside::NoResult) | None => "",
    }
}

/// What the marks mean, as far as they occur.
pub(super) fn legend(findings: &Findings<'_>) -> String {
    let occurs = |because| {
        findings.columns.iter().any(|column| column.rate.set_aside.iter().any(|aside| aside.because == because))
    };
    let mut text = String::new();
    for because in [Aside::PreAsymptotic, Aside::Outlier].into_iter().filter(|because| occurs(*because)) {
        let _ = writeln!(text, "~ set aside: {}", because.text());
    }
    if occurs(Aside::AtFloor) {
        let _ = writeln!(text, "_ set aside: not above the floor {:e}", findings.floor);
    }
    text
}

/// Decimals of the rates of a column.
pub(super) fn places(judged: &Judged<'_>) -> usize {
    judged.rate.interval.map_or(3, |interval| interval_places(interval, MOST_PLACES))
}

/// The rate between a level and the one before; a dash where there is none.
pub(super) fn pairwise(judged: &Judged<'_>, level: usize) -> String {
    let rate = level.checked_sub(1).and_then(|before| judged.rate.pairwise.get(before));
    rate.filter(|rate| rate.is_finite()).map_or_else(|| "-".to_owned(), |rate| decimals(*rate, places(judged)))
}

/// The rate with its interval; that between the finest levels where there is no interval.
pub(super) fn rate(judged: &Judged<'_>) -> String {
    judged.rate.rate_in_words(MOST_PLACES)
}

/// Rate, claim, and the reason where that is not a pass.
pub(super) fn found(judged: &Judged<'_>) -> String {
    let claim = if judged.is_claimed() { format!(", claimed {}", judged.rate.claim()) } else { String::new() };
    let passes = judged.rate.verdict == Verdict::Pass;
    let reason = match passes {
        true if judged.is_claimed() => format!(": {}", judged.rate.excludes()),
        true => String::new(),
        false => format!(": {}", judged.reason()),
    };
    format!("{}{claim}{reason}", rate(judged))
}

/// Verdict, rate, claim and reason of a column.
fn line(judged: &Judged<'_>) -> String {
    format!("{}: {}: {}\n", judged.name, screen::verdict(judged.rate.verdict), found(judged))
}

/// The errors with the rates beside them, a verdict for each column, and that of all.
pub(super) fn text(findings: &Findings<'_>, quiet: bool) -> String {
    let mut text: String = findings.table.notes.iter().map(|note| format!("{note}\n")).collect();
    if !quiet {
        text += &errors(findings);
    }
    for judged in &findings.columns {
        let is_told = !quiet || (judged.decides && judged.rate.verdict != Verdict::Pass);
        if is_told {
            text += &line(judged);
        }
    }
    if !quiet {
        text += &advice(findings);
        for (name, why) in &findings.table.not_errors {
            let _ = writeln!(text, "{name}: not judged: {why}");
        }
        if findings.columns.iter().any(|column| !column.is_claimed()) {
            let command = findings.project.command;
            let _ = writeln!(
                text,
                "\nclaim what theory says: {command} rates {}: --order P for all columns, --order NAME=P for one",
                findings.source
            );
        }
        text.push('\n');
    }
    text + &format!("{}: {}\n", screen::verdict(findings.verdict), sentence(findings))
}

/// What the reasons mean for which columns do not pass, each once, and what to do next.
fn advice(findings: &Findings<'_>) -> String {
    let claimed = || findings.columns.iter().zip(&findings.table.columns).filter(|(column, _)| column.is_claimed());
    let all_reversed = claimed().all(|(column, _)| is_reversed(&column.rate.pairwise));
    let missed = claimed().filter(|(column, _)| column.rate.verdict != Verdict::Pass);
    let mut advice: Vec<(Reason, String)> = missed
        .map(|(column, (_, levels))| (column.rate.kind, words(column, levels, &findings.table.step, all_reversed)))
        .collect();
    // The same words for several columns stand side by side.
    advice.sort_by(|(a, text), (b, other)| (a.text(), text).cmp(&(b.text(), other)));
    advice.dedup();
    let mut text = String::new();
    for (reason, means) in advice {
        section(&mut text, reason.code(), &means);
    }
    text
}

/// The overall verdict in words.
pub(super) fn sentence(findings: &Findings<'_>) -> String {
    let deciding = findings.columns.iter().filter(|column| column.decides);
    let (count, passed) = deciding.fold((0, 0), |(count, passed), column| {
        (count + 1, passed + usize::from(column.rate.verdict == Verdict::Pass))
    });
    match count {
        0 => "no order is claimed".to_owned(),
        1 => format!("{passed} of 1 column agrees with its order"),
        _ => format!("{passed} of {count} columns agree with their orders"),
    }
}

/// Step, and each error with its rate and mark, coarsest level first.
fn errors(findings: &Findings<'_>) -> String {
    let table = findings.table;
    // Two blanks at least before each name.
    let wide = |name: &str, least: usize| least.max(name.chars().count() + 2);
    let first = wide(&table.step, 12);
    let widths: Vec<[usize; 2]> =
        findings.columns.iter().map(|judged| [wide(judged.name, 16), places(judged) + 5]).collect();
    let mut text = format!("{:>first$}", table.step);
    let rate_name = "rate";
    for ((name, _), [width, rate]) in table.columns.iter().zip(&widths) {
        let _ = write!(text, "{name:>width$}{rate_name:>rate$}");
    }
    text.push('\n');
    for level in 0..table.columns.first().map_or(0, |(_, levels)| levels.len()) {
        let mut line = format!("{:>first$.4e}", table.columns[0].1[level].step);
        for (((_, levels), judged), [width, rate]) in table.columns.iter().zip(&findings.columns).zip(&widths) {
            let error = format!("{:.4e}{:1}", levels[level].error, mark(judged, level));
            let _ = write!(line, "{error:>width$}{:>rate$}", pairwise(judged, level));
        }
        let _ = writeln!(text, "{}", line.trim_end());
    }
    text + &legend(findings) + "\n"
}
