//! A column by its numbers: what falls by regular ratios, what are rates, what tends to a limit.

use std::f64::consts::LN_2;

use super::names::Word;
use super::number::Number;

/// Largest relative difference of two ratios that are the same, by their digits.
const SAME: f64 = 1e-5;
/// How far numbers that tend to a limit are from each other at most, as a ratio.
const NEAR: f64 = 1.5;

/// A column of the grid, row by row.
pub(super) struct Cells {
    /// As messages show it.
    pub(super) name: String,
    pub(super) word: Word,
    pub(super) numbers: Vec<Option<Number>>,
    /// Half a unit of the last place of each number.
    pub(super) halves: Vec<f64>,
    /// Whether `--columns`, `--values` or `--order` names it.
    pub(super) is_claimed: bool,
    /// Whether it counts the rows.
    pub(super) is_index: bool,
}

impl Cells {
    pub(super) fn value(&self, row: usize) -> Option<f64> {
        self.numbers[row].map(|number| number.value)
    }

    /// All numbers, if there are no other cells.
    pub(super) fn values(&self) -> Option<Vec<f64>> {
        self.numbers.iter().map(|number| number.map(|number| number.value)).collect()
    }

    pub(super) fn is_constant(&self) -> bool {
        let first = self.value(0);
        first.is_some() && self.numbers.len() > 1 && (1..self.numbers.len()).all(|row| self.value(row) == first)
    }

    pub(super) fn widest_half(&self) -> f64 {
        self.halves.iter().copied().fold(0.0, f64::max)
    }

    /// The least ratio by which the column falls or grows, if they all are the same or its numbers whole multiples or
    /// parts of one of them.
    pub(super) fn regular(&self) -> Option<f64> {
        let mut values = self.values()?;
        values.sort_by(f64::total_cmp);
        let (least, most) = (*values.first()?, *values.last()?);
        let same = SAME.max(2.0 * self.widest_half() / least).min(0.02);
        let ratios: Vec<f64> = values.windows(2).map(|two| two[1] / two[0]).collect();
        let ratio = ratios.iter().copied().fold(f64::INFINITY, f64::min);
        let is_whole = |multiple: f64| (multiple / multiple.round() - 1.0).abs() < SAME;
        let is_regular = ratios.iter().all(|one| (one / ratio - 1.0).abs() < same)
            || values.iter().all(|value| is_whole(most / value))
            || values.iter().all(|value| is_whole(value / least));
        (ratios.len() > 1 && is_regular && ratio > 1.0 && ratio.is_finite() && least > 0.0).then_some(ratio)
    }

    /// Whether two columns are the steps of one mesh in several directions, or of space and time.
    pub(super) fn is_in_proportion(&self, other: &Self) -> bool {
        let (Some(a), Some(b)) = (self.values(), other.values()) else { return false };
        a.iter().zip(&b).all(|(x, y)| (x * b[0] / (y * a[0]) - 1.0).abs() < SAME)
    }

    /// Whether these are the rates or the reductions of an error, to its digits, on the finer or on the coarser level of
    /// each two.
    ///
    /// * `steps`: of the rows, the coarsest first.
    pub(super) fn are_rates_of(&self, error: &Self, steps: &[f64]) -> bool {
        let last = steps.len() - 1;
        let falls = |values: Vec<f64>| values.iter().all(|value| *value > 0.0) && values[last] < 0.7 * values[0];
        if last < 2 || !error.values().is_some_and(falls) {
            return false;
        }
        let half = 1.2 * self.widest_half();
        let matches = |shift: usize, measure: usize| {
            let same = |k: usize| {
                let (above, below) = (error.value(k)?, error.value(k + 1)?);
                let doubt = error.halves[k] / above + error.halves[k + 1] / below;
                let unit = [(steps[k] / steps[k + 1]).ln(), LN_2][measure % 2];
                let (value, doubt) = match measure {
                    0 | 1 => ((above / below).ln() / unit, doubt / unit),
                    _ => (above / below, doubt * above / below),
                };
                let off = (self.value(k + shift)? - value).abs();
                Some(off <= (half + doubt).min(0.25) + SAME * value.abs())
            };
            (0..last).all(|k| same(k) == Some(true))
        };
        // Three rates are proof enough; two need a name, or an end without one.
        let is_end =
            |row: usize| self.value(row).is_none_or(|value| !value.is_finite() || value == 0.0 || value == 1.0);
        let may = |shift: &usize| last > 2 || self.word.is_rate() || is_end(if *shift == 1 { 0 } else { last });
        [1, 0].into_iter().filter(may).any(|shift| (0..3).any(|measure| matches(shift, measure)))
    }
}

/// What numbers tend to, where it is near the last of them and not zero.
pub fn limit(numbers: &[f64]) -> Option<f64> {
    let [.., a, b, c] = *numbers else { return None };
    let shrinks = (c - b) / (b - a);
    let limit = if shrinks.abs() < 0.95 { c + (c - b) * shrinks / (1.0 - shrinks) } else { c };
    let sizes = || numbers.iter().map(|value| value.abs());
    let is_near = sizes().fold(0.0, f64::max) < NEAR * sizes().fold(f64::INFINITY, f64::min) && b != c;
    let settles = b != a && shrinks.abs() < 0.95 && limit / c > 0.7;
    (numbers.iter().all(|value| value * c > 0.0) && (settles || is_near) && limit.is_finite()).then_some(limit)
}
