//! The result in words, for people.

use std::slice;

use super::{JudgedColumn, Judgement, verdict_of};
use crate::text::lists::distinct;
use crate::text::names::quoted;
use crate::text::number::{committed_rate, counted, order_text, pair_text, short_text};
use crate::text::section::section;
use crate::text::visible::visible;
use convergence_judge::claims::Claim;
use convergence_judge::shown::{self, MOST_PLACES, Shown};
use convergence_judge::verdict::{RateVerdict, Tendency, Verdict, judged_in_words};

impl JudgedColumn<'_> {
    /// Rate, claim, the reason unless it is a pass, and the limit of values.
    pub(crate) fn answer(&self) -> String {
        let rate = match (&self.claim, &self.factors) {
            (Some(claim), Some(factors)) => factor_in_words(claim, factors),
            (Some(claim), None) => claim.answer(&self.rate, &self.rate.rate_in_words(MOST_PLACES)),
            (None, _) => self.rate.answer(MOST_PLACES),
        };
        let Some(estimate) = &self.estimate else {
            return rate;
        };
        let bar = match &estimate.bar {
            Ok(bar) => bar,
            Err(refusal) => return rate + &format!("; no limit: {refusal}"),
        };
        let [low, high] = pair_text(bar.limit.into());
        let [limit, _] = pair_text([bar.extrapolated, bar.limit.high]);
        let gci = estimate.gci.as_ref().ok();
        let gci = gci.map(|gci| format!(", GCI ± {}", short_text(gci.half_width)));
        rate + &format!(
            "; limit {limit} ({low} to {high}){}",
            gci.unwrap_or_default()
        )
    }

    fn shown(&self) -> Shown<'_> {
        let late = usize::from(self.estimate.is_some());
        Shown {
            name: &self.column.name,
            levels: &self.column.levels,
            rate: self.factors.as_ref().unwrap_or(&self.rate),
            late,
        }
    }
}

/// What is found in all tables: each under its name if there are several, then the verdict on all.
///
/// * `shown`: a verdict as it is printed, perhaps in its colour.
pub(crate) fn text_of_all(
    findings: &[Judgement<'_>],
    quiet: bool,
    shown: fn(Verdict) -> String,
) -> String {
    if let [alone] = findings {
        return text(alone, quiet, shown);
    }
    let selected = findings
        .iter()
        .filter(|findings| !(quiet && findings.verdict().is_pass()));
    let tables = selected.map(|findings| {
        let text = text(findings, quiet, shown);
        format!("{}\n{text}\n", visible(&findings.source.name))
    });
    let tables: String = tables.collect();
    let verdict = shown(verdict_of(findings));
    format!("{tables}{verdict}: {}\n", sentence_of_all(findings))
}

/// How many tables agree, or what the only one says.
pub(crate) fn sentence_of_all(findings: &[Judgement<'_>]) -> String {
    if let [alone] = findings {
        return sentence(alone);
    }
    let passed = findings
        .iter()
        .filter(|findings| findings.verdict().is_pass());
    let tables = counted(findings.len(), "table");
    let agree = format!("{} of {tables} agree", passed.count());
    agree + &reservations(findings)
}

/// What speaks against the tables.
fn reservations(findings: &[Judgement<'_>]) -> String {
    let equals = findings.iter().flat_map(|findings| &findings.equals);
    let doubts = findings
        .iter()
        .flat_map(|findings| &findings.source.table.doubts);
    let boundaries = findings
        .iter()
        .filter_map(|findings| findings.boundary.as_ref());
    let words = equals
        .map(ToString::to_string)
        .chain(boundaries.map(|loss| loss.evidence.clone()))
        .chain(doubts.map(ToString::to_string));
    let words = distinct(words).into_iter();
    words.map(|words| format!("; {words}")).collect()
}

impl Judgement<'_> {
    /// How the table was read, and each doubt with the command that removes it.
    fn reading(&self) -> String {
        let Self {
            source, request, ..
        } = self;
        let command_line = request.command_line(self.program, &source.file);
        let mut text = format!("{}\n", source.table.reading);
        for doubt in &source.table.doubts {
            let way_out = doubt.offer.as_ref();
            let way_out = way_out.and_then(|offer| offer.line(&command_line));
            text += &format!("doubt: {doubt}{}\n", way_out.unwrap_or_default());
        }
        text
    }

    fn shown(&self) -> Vec<Shown<'_>> {
        self.columns.iter().map(JudgedColumn::shown).collect()
    }

    /// Steps, errors and rates as text: the names, then a row for each level.
    pub(super) fn rows(&self) -> Vec<Vec<String>> {
        shown::rows(&self.source.table.step, &self.shown())
    }

    /// The meaning of the marks in the rows, a line for each.
    pub(super) fn legend(&self) -> String {
        shown::legend(&self.shown(), self.floor.value())
    }
}

/// The page of the book on the reasons of verdicts.
pub(crate) const REASONS: &str = concat!(
    env!("CARGO_PKG_REPOSITORY"),
    "/blob/main/crates/convergence-study/book/src/inconclusive.md"
);

fn line(judged: &JudgedColumn<'_>, shown: fn(Verdict) -> String) -> String {
    let verdict = shown(judged.rate.verdict);
    format!("{}: {verdict}: {}\n", judged.column.name, judged.answer())
}

/// The errors with their rates, a verdict for each column, advice, and the overall verdict.
pub(super) fn text(findings: &Judgement<'_>, quiet: bool, shown: fn(Verdict) -> String) -> String {
    let table = &findings.source.table;
    let columns = &findings.columns;
    let last = format!("{}: {}\n", shown(findings.verdict()), sentence(findings));
    let mut text = findings.reading();
    if quiet {
        if table.left_out.is_empty() && table.doubts.is_empty() {
            text.clear();
        }
        let failing = findings
            .deciding()
            .filter(|judged| !judged.rate.verdict.is_pass());
        text.extend(failing.map(|judged| line(judged, shown)));
        return text + &last;
    }
    text += &shown::table(&table.step, &findings.shown(), findings.floor.value());
    text.push('\n');
    text.extend(columns.iter().map(|judged| line(judged, shown)));
    // Words common to several columns appear once.
    let mut said = vec![];
    for judged in columns {
        let Some(advice) = advice_of_claim(findings, judged) else {
            continue;
        };
        let words = (judged.rate.code.name(), advice);
        if !said.contains(&words) {
            section(&mut text, words.0, &words.1);
            said.push(words);
        }
    }
    if let Some(call) = findings.command_with_floor() {
        text += &format!("\nif the finest errors are round-off:\n  {call}\n");
    }
    if !said.is_empty() {
        text += &format!("\nevery reason, and what to try: {REASONS}\n");
    }
    if columns.iter().any(|judged| judged.claim.is_none()) {
        let command = format!("{} rates {}", findings.program, findings.source.file);
        text += &format!(
            "\nclaim what theory says: {command}: --order P for all columns, --order NAME=P for one\n"
        );
    }
    text + "\n" + &last
}

/// What the reason means for a column with a claim, and what to do; nothing of a pass.
pub(super) fn advice_of_claim(
    findings: &Judgement<'_>,
    judged: &JudgedColumn<'_>,
) -> Option<String> {
    let is_answered = judged.claim.is_none() || judged.rate.verdict.is_pass();
    (!is_answered).then(|| advice(findings, judged))
}

/// A factor with its interval and its claim: `factor 3.1 (3.0 to 3.2), claimed >=3: at least 2.34`.
fn factor_in_words(claim: &Claim, factors: &RateVerdict) -> String {
    let [claimed, least] = [claim.order, claim.order - claim.tolerance]
        .map(|order| order_text(committed_rate(order.exp())));
    let bound = if claim.bound.is_least() { ">=" } else { "" };
    let why = match factors.verdict.is_pass() {
        true if claim.bound.is_least() => format!("at least {least}"),
        true => "agrees".to_owned(),
        false => factors.because.to_string(),
    };
    let factor = format!("factor {}", factors.rate_in_words(MOST_PLACES));
    judged_in_words(&factor, &format!("{bound}{claimed}"), &why)
}

/// What the errors tend to, or what the reason means, and what to do; for a value that looks like
/// an error, how it is judged as one.
fn advice(findings: &Judgement<'_>, judged: &JudgedColumn<'_>) -> String {
    let general = judged.rate.advice().unwrap_or_default();
    let count = findings
        .source
        .table
        .step
        .strip_prefix("1/")
        .filter(|_| judged.factors.is_none());
    if let Some(count) = count.filter(|_| rises(&judged.rate.pairwise)) {
        return format!(
            "The rates rise at each level, as where errors fall by a factor for each unit of `{count}`. If theory says so: \
             --factor F --step {}, in place of --order.",
            quoted(count)
        );
    }
    match judged.rate.tendency {
        Some(Tendency::Constant { .. }) if judged.estimate.is_none() => {
            let name = &judged.column.name;
            let levels = &judged.column.levels;
            let mut errors = levels.iter().map(|level| level.error);
            if errors.all(|error| error == levels[0].error) {
                return general + &advice_to_choose(findings, name);
            }
            format!("{general} If `{name}` is a value and no error: --values '{name}'.")
        }
        _ => general,
    }
}

/// How the others are judged, if a column with one number at all levels is no error: as a value it
/// has no limit either.
fn advice_to_choose(findings: &Judgement<'_>, name: &str) -> String {
    let is_other = |other: &&JudgedColumn<'_>| other.column.name != name && other.decides;
    let others = findings.columns.iter().filter(is_other);
    let others: Vec<&str> = others.map(|other| other.column.name.as_str()).collect();
    if others.is_empty() {
        return String::new();
    }
    let others = quoted(&others.join(","));
    format!(" If `{name}` is no error: --columns {others}.")
}

/// Whether each rate is well above the one before, as of errors that fall exponentially.
fn rises(rates: &[f64]) -> bool {
    /// Least rise between two levels.
    const RISE: f64 = 0.5;
    rates.len() > 2 && rates.windows(2).all(|two| two[1] > two[0] + RISE)
}

/// The overall verdict in words.
pub(crate) fn sentence(findings: &Judgement<'_>) -> String {
    agreement(findings) + &reservations(slice::from_ref(findings))
}

/// How many columns agree with their orders.
pub(super) fn agreement(findings: &Judgement<'_>) -> String {
    let passed = findings
        .deciding()
        .filter(|judged| judged.rate.verdict.is_pass());
    let passed = passed.count();
    match findings.deciding().count() {
        0 => "no order is claimed".to_owned(),
        1 => format!("{passed} of 1 column agrees with its order"),
        count => format!("{passed} of {count} columns agree with their orders"),
    }
}
