//! Errors next to their rates, as text: for terminals, and for the message of a failing test.

use super::fit::Level;
use super::verdict::{Aside, RateVerdict, Verdict};
use crate::text::number::{decimals, interval_places, plain_text};

/// Most decimals of a rate.
pub const MOST_PLACES: usize = 6;

/// A column of a table: an error with its judgement.
#[derive(Debug, Clone, Copy)]
pub struct Shown<'a> {
    /// Its name.
    pub name: &'a str,
    /// Its levels, coarse to fine; NaN for a missing result.
    pub levels: &'a [Level],
    /// Its judgement.
    pub rate: &'a RateVerdict,
    /// How many levels later its rates begin than those of errors: 1 for values, whose differences
    /// have the rates.
    pub late: usize,
}

impl Shown<'_> {
    /// Why a level was set aside; `None` if it was used.
    fn reason(&self, level: usize) -> Option<Aside> {
        self.rate
            .set_aside
            .iter()
            .find(|aside| aside.level == level)
            .map(|aside| aside.because)
    }

    /// The error at a level, with a mark if it was not used.
    fn error(&self, level: usize) -> String {
        let mark = match self.reason(level) {
            Some(Aside::AtFloor) => "_",
            Some(Aside::PreAsymptotic) => "~",
            Some(Aside::BeyondFive) => "'",
            Some(Aside::NoResult) | None => "",
        };
        format!("{:.4e}{mark:1}", self.levels[level].error)
    }

    /// The rate between a level and the one before; a dash if there is none.
    fn pairwise(&self, level: usize) -> String {
        let before = level.checked_sub(1 + self.late);
        let places = self
            .rate
            .interval
            .map_or(3, |interval| interval_places(interval, MOST_PLACES));
        let rate = before
            .and_then(|before| self.rate.pairwise.get(before))
            .filter(|rate| rate.is_finite());
        rate.map_or_else(|| "-".to_owned(), |rate| decimals(*rate, places))
    }
}

/// Names, then step and each error with its mark and rate, coarsest level first, then the meaning
/// of the marks.
///
/// * `step`: the name of the step.
/// * `floor`: of the rule that judged; 0 if it had none, or several.
pub fn table(step: &str, columns: &[Shown<'_>], floor: f64) -> String {
    let rows = rows(step, columns);
    let widths: Vec<usize> = (0..rows[0].len())
        .map(|column| {
            let lengths = rows.iter().map(|row| row[column].chars().count());
            lengths.max().unwrap_or(0)
        })
        .collect();
    let mut text = String::new();
    for row in &rows {
        let cells: Vec<String> = row
            .iter()
            .zip(&widths)
            .map(|(cell, width)| format!("{cell:>width$}"))
            .collect();
        text += cells.join("  ").trim_end();
        text += "\n";
    }
    text + &legend(columns, floor)
}

/// The names, and the cells of each level, coarsest first; a mark, or a blank, ends each error.
pub fn rows(step: &str, columns: &[Shown<'_>]) -> Vec<Vec<String>> {
    let mut head = vec![step.to_owned()];
    for column in columns {
        head.extend([column.name.to_owned(), "rate".to_owned()]);
    }
    let mut rows = vec![head];
    let longest = columns.iter().map(|column| column.levels);
    let levels = longest
        .max_by_key(|levels| levels.len())
        .unwrap_or_default();
    for (k, level) in levels.iter().enumerate() {
        let mut row = vec![plain_text(level.step)];
        for column in columns {
            // Some columns lack coarse levels.
            row.extend(match (k + column.levels.len()).checked_sub(levels.len()) {
                Some(k) => [column.error(k), column.pairwise(k)],
                None => ["-", "-"].map(str::to_owned),
            });
        }
        rows.push(row);
    }
    rows
}

/// The meaning of the marks that occur.
pub fn legend(columns: &[Shown<'_>], floor: f64) -> String {
    let mut legend = String::new();
    for reason in [Aside::PreAsymptotic, Aside::BeyondFive, Aside::AtFloor] {
        let mut set_aside = columns.iter().flat_map(|column| &column.rate.set_aside);
        if !set_aside.any(|aside| aside.because == reason) {
            continue;
        }
        legend += &match reason {
            Aside::AtFloor if floor > 0.0 => {
                format!("_ set aside: not above the floor {floor:e}\n")
            }
            Aside::AtFloor => format!("_ set aside: {}\n", reason.text()),
            Aside::BeyondFive => format!("' set aside: {}\n", reason.text()),
            _ => format!("~ set aside: {}\n", reason.text()),
        };
    }
    legend
}

/// Table, findings and advice, for the message of a failing test.
pub fn explained(step: &str, columns: &[Shown<'_>], floor: f64) -> String {
    let mut text = table(step, columns, floor);
    for shown in columns {
        text += &format!(
            "{}: {}: {}\n",
            shown.name,
            shown.rate.verdict,
            shown.rate.answer(MOST_PLACES)
        );
        if let (true, Some(advice)) = (shown.rate.verdict != Verdict::Pass, shown.rate.advice()) {
            text += &format!("  {}: {advice}\n", shown.rate.code.name());
        }
    }
    text
}
