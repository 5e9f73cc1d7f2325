//! Errors beside their rates, as text: for terminals, and for the message of a test that fails.

use super::fit::Level;
use super::verdict::{Aside, RateVerdict, Verdict};
use crate::text::number::{decimals, interval_places, plain_text};

/// Most decimals of a rate.
pub const MOST_PLACES: usize = 6;

/// A column of a table: an error with what was judged of it.
#[derive(Debug, Clone, Copy)]
pub struct Shown<'a> {
    /// Its name.
    pub name: &'a str,
    /// Its levels, coarse to fine; NaN where there is no result.
    pub levels: &'a [Level],
    /// What was judged.
    pub rate: &'a RateVerdict,
    /// By how many levels its rates begin later than those of errors: 1 for values, whose differences have the rates.
    pub late: usize,
}

impl Shown<'_> {
    /// Rate, claim, and the reason where that is no pass.
    pub fn found(&self) -> String {
        let rate = self.rate.rate_in_words(MOST_PLACES);
        if self.rate.order.is_nan() {
            return format!("{rate}: no order is claimed");
        }
        let why = if self.rate.verdict.is_pass() { self.rate.excludes() } else { self.rate.because.clone() };
        format!("{rate}, claimed {}: {why}", self.rate.claim())
    }

    fn because(&self, level: usize) -> Option<Aside> {
        self.rate.set_aside.iter().find(|aside| aside.level == level).map(|aside| aside.because)
    }

    /// The error at a level, with a mark where it has no say.
    fn error(&self, level: usize) -> String {
        let mark = match self.because(level) {
            Some(Aside::AtFloor) => "_",
            Some(Aside::PreAsymptotic | Aside::Outlier) => "~",
            Some(Aside::NoResult) | None => "",
        };
        format!("{:.4e}{mark:1}", self.levels[level].error)
    }

    /// The rate between a level and the one before; a dash where there is none.
    fn pairwise(&self, level: usize) -> String {
        let before = level.checked_sub(1 + self.late);
        let places = self.rate.interval.map_or(3, |interval| interval_places(interval, MOST_PLACES));
        let rate = before.and_then(|before| self.rate.pairwise.get(before)).filter(|rate| rate.is_finite());
        rate.map_or_else(|| "-".to_owned(), |rate| decimals(*rate, places))
    }
}

/// Step, and each error with its mark and rate, coarsest level first, below their names; then what the marks mean.
///
/// * `step`: the name of the step.
/// * `floor`: that of the rule which judged.
pub fn table(step: &str, columns: &[Shown<'_>], floor: f64) -> String {
    let names = columns.iter().flat_map(|shown| [shown.name.to_owned(), "rate".to_owned()]);
    let mut rows = vec![std::iter::once(step.to_owned()).chain(names).collect::<Vec<_>>()];
    for (k, level) in columns.first().map_or(&[][..], |shown| shown.levels).iter().enumerate() {
        let cells = columns.iter().flat_map(|shown| [shown.error(k), shown.pairwise(k)]);
        rows.push(std::iter::once(plain_text(level.step)).chain(cells).collect());
    }
    let width = |column: usize| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..rows[0].len()).map(width).collect();
    let line = |row: &Vec<String>| {
        let cells: Vec<String> = row.iter().zip(&widths).map(|(cell, width)| format!("{cell:>width$}")).collect();
        cells.join("  ").trim_end().to_owned() + "\n"
    };
    rows.iter().map(line).collect::<String>() + &legend(columns, floor)
}

/// What the marks mean, as far as they occur.
fn legend(columns: &[Shown<'_>], floor: f64) -> String {
    let occurs = |because: &Aside| {
        columns.iter().any(|shown| shown.rate.set_aside.iter().any(|aside| aside.because == *because))
    };
    let marked = |because: Aside| match because {
        Aside::AtFloor => format!("_ set aside: not above the floor {floor:e}\n"),
        _ => format!("~ set aside: {}\n", because.text()),
    };
    [Aside::PreAsymptotic, Aside::Outlier, Aside::AtFloor].into_iter().filter(occurs).map(marked).collect()
}

/// Table, findings and advice, for the message of a test that fails.
pub fn explained(step: &str, columns: &[Shown<'_>], floor: f64) -> String {
    let mut text = table(step, columns, floor);
    for shown in columns {
        text += &format!("{}: {}: {}\n", shown.name, shown.rate.verdict, shown.found());
        if let (true, Some(advice)) = (shown.rate.verdict != Verdict::Pass, shown.rate.advice()) {
            text += &format!("  {}: {advice}\n", shown.rate.kind.code());
        }
    }
    text
}
