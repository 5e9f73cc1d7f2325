//! Whether printed numbers are the rates, or the factors, of an error over the step.

use super::cell::{Cell, Number};
use super::grid::Cells;
use crate::interval::Interval;

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
    pub(super) fn exact(sizes: Vec<f64>) -> Self {
        Self {
            halves: vec![0.0; sizes.len()],
            sizes,
        }
    }

    /// The same without rounding, if the ratios of the printed steps are regular: all alike, or of
    /// whole numbers.
    pub(super) fn unrounded(self) -> Self {
        let ratios = self
            .sizes
            .windows(2)
            .map(|two| two[0].max(two[1]) / two[0].min(two[1]));
        let least = ratios.clone().fold(f64::INFINITY, f64::min);
        let fold = |start: f64, of: fn(f64, f64) -> f64| self.sizes.iter().copied().fold(start, of);
        let ends = [fold(f64::INFINITY, f64::min), fold(0.0, f64::max)];
        let is_whole = |ratio: f64| (ratio - ratio.round()).abs() < 0.005 * ratio;
        let is_regular = ratios.clone().all(|ratio| ratio / least < 1.02)
            || self.sizes.iter().all(|size| is_whole(size / ends[0]))
            || self.sizes.iter().all(|size| is_whole(ends[1] / size));
        if is_regular {
            Self::exact(self.sizes)
        } else {
            self
        }
    }

    /// ln(h/h') and by how much the rounding of the steps may change it: at most 0.5 % of each.
    fn logarithm(&self, before: usize, level: usize) -> Interval {
        let share = |k: usize| (self.halves[k] / self.sizes[k]).min(0.005);
        let doubt = share(before) + share(level);
        let logarithm = (self.sizes[before] / self.sizes[level]).ln();
        Interval {
            low: logarithm - doubt,
            high: logarithm + doubt,
        }
    }
}

/// What is printed, if it belongs to the errors at every level that has a level before: in the row
/// above, or below in a table that begins with the finest level.
pub(super) fn fit(printed: &Cells, errors: &Cells, steps: &Steps) -> Option<Printed> {
    let kinds = [Printed::Rates, Printed::Factors].into_iter();
    kinds.into_iter().find(|kind| {
        [true, false]
            .into_iter()
            .any(|above| fits(printed, errors, steps, *kind, above))
    })
}

/// * `above`: whether the level before stands above.
fn fits(printed: &Cells, errors: &Cells, steps: &Steps, kind: Printed, above: bool) -> bool {
    let count = errors.cells.len();
    let mut fitting = 0;
    for level in 0..count {
        let before = if above {
            level.checked_sub(1)
        } else {
            Some(level + 1).filter(|k| *k < count)
        };
        let cell = &printed.cells[level];
        let Some(before) = before else {
            let says_nothing = cell.value().is_none_or(|value| value == 0.0);
            if !says_nothing || cell.is_broken() {
                return false;
            }
            continue;
        };
        let pair = [&errors.cells[before], &errors.cells[level]].map(size);
        match (&cell.number, pair) {
            (Some(number), [Some(coarse), Some(fine)]) => {
                let range = match kind {
                    Printed::Rates => rate(&coarse, &fine, &steps.logarithm(before, level)),
                    Printed::Factors => factor(&coarse, &fine),
                };
                let inverse = Interval {
                    low: 1.0 / range.high,
                    high: 1.0 / range.low,
                };
                if !is_within(number, &range)
                    && (kind == Printed::Rates || !is_within(number, &inverse))
                {
                    return false;
                }
                fitting += 1;
            }
            (None, [Some(_), Some(_)]) | (Some(_), _) => return false,
            (None, _) => {}
        }
    }
    fitting > 0
}

/// The ends of the size of an error that is not zero.
fn size(cell: &Cell) -> Option<Interval> {
    let number = cell.number.as_ref().filter(|number| number.value != 0.0)?;
    let size = number.value.abs();
    Some(Interval {
        low: size - number.half,
        high: size + number.half,
    })
}

fn factor(coarse: &Interval, fine: &Interval) -> Interval {
    Interval {
        low: coarse.low / fine.high,
        high: coarse.high / fine.low.max(f64::MIN_POSITIVE),
    }
}

fn rate(coarse: &Interval, fine: &Interval, steps: &Interval) -> Interval {
    if steps.low * steps.high <= 0.0 {
        return Interval {
            low: f64::NAN,
            high: f64::NAN,
        };
    }
    let factor = factor(coarse, fine);
    let ends = [factor.low, factor.high].map(|end| end.max(f64::MIN_POSITIVE).ln());
    let rates = ends
        .into_iter()
        .flat_map(|end| [end / steps.low, end / steps.high]);
    let fold = |range: Interval, rate: f64| Interval {
        low: range.low.min(rate),
        high: range.high.max(rate),
    };
    rates.fold(
        Interval {
            low: f64::INFINITY,
            high: f64::NEG_INFINITY,
        },
        fold,
    )
}

/// Whether a printed number lies in a range, but for the last place.
fn is_within(number: &Number, range: &Interval) -> bool {
    /// Rates that are printed may have been computed from rounded errors.
    const SLACK: f64 = 1e-3;
    let slack = 1.02 * number.half + SLACK * range.low.abs().max(range.high.abs());
    (range.low - slack..=range.high + slack).contains(&number.value)
}
