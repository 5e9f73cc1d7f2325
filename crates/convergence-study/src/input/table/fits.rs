//! Whether printed numbers are the rates, or the factors, of an error over the step.

use super::cell::{Cell, Number};
use super::grid::Cells;
use crate::interval::Interval;

/// Rates are looked for among this many columns on either side.
const NEAR: usize = 40;

/// Steps of the levels in the order of the rows.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Steps {
    pub(super) sizes: Vec<f64>,
    /// Half a unit of the last printed place of each; 0 without rounding.
    pub(super) halves: Vec<f64>,
}

/// What is printed beside an error.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Printed {
    /// ln(e/e') / ln(h/h').
    Rates,
    /// e/e', or e'/e.
    Factors,
}

impl Steps {
    /// * `exact`: without rounding.
    pub(super) fn exact(sizes: impl IntoIterator<Item = f64>) -> Self {
        let sizes: Vec<f64> = sizes.into_iter().collect();
        Self {
            halves: vec![0.0; sizes.len()],
            sizes,
        }
    }

    /// The step of each row over the one before.
    pub(super) fn ratios(&self) -> impl Iterator<Item = f64> + Clone {
        self.sizes.windows(2).map(|two| two[1] / two[0])
    }

    /// Whether the rounding of the steps says nothing: their ratios are regular, all alike or of
    /// whole numbers.
    pub(super) fn are_regular(&self) -> bool {
        let ratios = self.ratios().map(|ratio| ratio.max(1.0 / ratio));
        let least = ratios.clone().fold(f64::INFINITY, f64::min);
        let smallest = self.sizes.iter().copied().fold(f64::INFINITY, f64::min);
        let largest = self.sizes.iter().copied().fold(0.0, f64::max);
        let is_whole = |ratio: f64| (ratio - ratio.round()).abs() < 0.005 * ratio;
        ratios.clone().all(|ratio| ratio / least < 1.02)
            || self.sizes.iter().all(|size| is_whole(size / smallest))
            || self.sizes.iter().all(|size| is_whole(largest / size))
    }

    /// By how much rounding may change a step, relative to it: at most 0.5 %.
    pub(super) fn share(&self, level: usize) -> f64 {
        (self.halves[level] / self.sizes[level]).min(0.005)
    }
}

/// What a column prints of an error near it, if it does: of the one whose rates the table says that
/// it has, if it says so.
///
/// * `may_be_error`: whether a column, by number, may be judged.
pub(super) fn printed<'c>(
    columns: &'c [Cells],
    column: usize,
    may_be_error: impl Fn(usize) -> bool,
    steps: &Steps,
) -> impl Iterator<Item = (Printed, &'c Cells)> {
    let near = column.saturating_sub(NEAR)..(column + NEAR + 1).min(columns.len());
    let own = columns[column].rates_of.as_deref();
    near.filter(move |k| *k != column && may_be_error(*k))
        .map(|k| &columns[k])
        .filter(move |error| own.is_none_or(|own| error.name == own) && !error.is_named_rates())
        .filter_map(move |error| Some((fit(&columns[column], error, steps)?, error)))
}

/// What is printed, if it belongs to the errors at every level that has a level before: in the row
/// above, or below in a table that begins with the finest level. Where two levels say so, the
/// number of a column named like rates at the coarsest level is that over a level which is not
/// printed.
pub(super) fn fit(printed: &Cells, errors: &Cells, steps: &Steps) -> Option<Printed> {
    let downwards: Vec<usize> = (0..errors.cells.len()).collect();
    let upwards: Vec<usize> = downwards.iter().rev().copied().collect();
    [Printed::Rates, Printed::Factors].into_iter().find(|kind| {
        [&downwards, &upwards]
            .iter()
            .any(|rows| fits(printed, errors, steps, *kind, rows))
    })
}

/// * `rows`: each with the level before it in front.
fn fits(printed: &Cells, errors: &Cells, steps: &Steps, kind: Printed, rows: &[usize]) -> bool {
    let first = &printed.cells[rows[0]];
    let says_nothing = first.value().is_none_or(|value| value == 0.0) && !first.is_broken();
    let is_coarsest = rows.len() > 1 && steps.sizes[rows[0]] > steps.sizes[rows[1]];
    let begins_late = is_coarsest && first.number.is_some() && printed.may_begin_late();
    if !says_nothing && !begins_late {
        return false;
    }
    let mut fitting = 0;
    for pair in rows.windows(2) {
        let [coarse, fine] = [pair[0], pair[1]].map(|row| size(&errors.cells[row]));
        let factor = coarse.zip(fine).map(|(coarse, fine)| Interval {
            low: coarse.low / fine.high,
            high: coarse.high / fine.low.max(f64::MIN_POSITIVE),
        });
        let belongs = match (&printed.cells[pair[1]].number, factor) {
            (Some(number), Some(factor)) => {
                fitting += 1;
                match kind {
                    Printed::Rates => is_rate(number, factor, steps, pair),
                    Printed::Factors => is_factor(number, factor),
                }
            }
            (None, None) => true,
            _ => false,
        };
        if !belongs {
            return false;
        }
    }
    fitting > usize::from(!says_nothing)
}

/// The size of an error that is not zero.
fn size(cell: &Cell) -> Option<Interval> {
    let number = cell.number.as_ref().filter(|number| number.value != 0.0)?;
    Some(Interval::around(number.value.abs(), number.half()))
}

/// Whether a number is ln(e/e') / ln(h/h'), but for the rounding of all.
fn is_rate(number: &Number, factor: Interval, steps: &Steps, pair: &[usize]) -> bool {
    let logarithm = (steps.sizes[pair[0]] / steps.sizes[pair[1]]).ln();
    let doubt = steps.share(pair[0]) + steps.share(pair[1]);
    let slack = slack(number) * logarithm.abs() + number.value.abs() * doubt;
    let range = factor.map(|end| end.max(f64::MIN_POSITIVE).ln());
    logarithm.abs() > doubt && is_near(number.value * logarithm, range, slack)
}

/// Whether a number is e/e' or e'/e, but for the rounding of all.
fn is_factor(number: &Number, factor: Interval) -> bool {
    let inverse = Interval {
        low: factor.high.recip(),
        high: factor.low.recip(),
    };
    let slack = slack(number);
    [factor, inverse].map(|range| is_near(number.value, range, slack)) != [false; 2]
}

/// By how much a printed number may be wrong: its last place, and the rounding of the errors from
/// which it was computed.
fn slack(number: &Number) -> f64 {
    1.02 * number.half() + 1e-3 * number.value.abs()
}

fn is_near(number: f64, range: Interval, slack: f64) -> bool {
    (range.low - slack..=range.high + slack).contains(&number)
}
