//! The columns of a table, and what their numbers say.

use std::f64::consts::LN_2;

use super::grid::ColumnName;
use super::names::{self, Word};
use super::number::{Number, counts_rows, halves, is_dash};

/// Dimensions that a count may have.
pub(super) const DIMENSIONS: [f64; 3] = [1.0, 2.0, 3.0];
/// Largest relative difference of two equal ratios, given their digits.
const SAME: f64 = 1e-5;

/// Errors fall at least by this factor from level to level if their column has a name like one of
/// rates.
const STEEP: f64 = 0.72;

/// A column, row by row.
pub(super) struct Cells<'t> {
    /// Its name in the text.
    pub(super) head: &'t str,
    /// Its name in messages.
    pub(super) name: String,
    pub(super) word: Word,
    pub(super) texts: Vec<&'t str>,
    pub(super) numbers: Vec<Option<Number>>,
    /// NaN if there is no number.
    pub(super) values: Vec<f64>,
    /// Half a unit of the last place of each number.
    pub(super) halves: Vec<f64>,
    /// Whether `--columns`, `--values` or `--order` names it.
    pub(super) is_claimed: bool,
    /// Whether it counts the rows.
    pub(super) is_index: bool,
}

impl<'t> Cells<'t> {
    /// * `head`: the name in the text.
    pub(super) fn new(
        head: &'t str,
        ColumnName { name, word }: ColumnName,
        texts: Vec<&'t str>,
        numbers: Vec<Option<Number>>,
    ) -> Self {
        let may_count =
            matches!(word, Word::Unknown | Word::Cost | Word::Count(_)) && texts.len() > 1;
        let value = |number: &Option<Number>| number.map_or(f64::NAN, |number| number.value);
        Self {
            head,
            is_index: may_count && counts_rows(&texts, names::is_level(&name)),
            name,
            word,
            values: numbers.iter().map(value).collect(),
            halves: halves(&numbers),
            is_claimed: false,
            texts,
            numbers,
        }
    }

    /// The column with these of its rows.
    pub(super) fn select(&self, rows: &[usize]) -> Self {
        let name = ColumnName {
            name: self.name.clone(),
            word: self.word,
        };
        let texts = rows.iter().map(|row| self.texts[*row]).collect();
        let numbers = rows.iter().map(|row| self.numbers[*row]).collect();
        Self {
            is_claimed: self.is_claimed,
            halves: rows.iter().map(|row| self.halves[*row]).collect(),
            ..Self::new(self.head, name, texts, numbers)
        }
    }

    /// The errors of computed values, which a table has beside the exact ones.
    pub(super) fn difference(&self, exact: &Self) -> Self {
        let name = ColumnName {
            name: format!("|{} - {}|", self.name, exact.name),
            word: Word::Error,
        };
        let error = |row: usize| {
            let is_number = self.is_number(row) && exact.is_number(row);
            is_number.then(|| Number::exact((self.values[row] - exact.values[row]).abs()))
        };
        let numbers = (0..self.texts.len()).map(error).collect();
        let halves = self.halves.iter().zip(&exact.halves);
        Self {
            halves: halves.map(|(own, exact)| own + exact).collect(),
            ..Self::new(self.head, name, self.texts.clone(), numbers)
        }
    }

    pub(super) fn is_number(&self, row: usize) -> bool {
        self.numbers[row].is_some()
    }

    pub(super) fn has_all_numbers(&self) -> bool {
        self.values.iter().all(|value| !value.is_nan())
    }

    /// What the cells hold.
    pub(super) fn holdings(&self) -> Holdings {
        let cells = self.texts.iter().zip(&self.numbers);
        let others: Vec<&str> = cells
            .filter(|(_, number)| number.is_none())
            .map(|(cell, _)| *cell)
            .collect();
        let has_numbers = others.len() < self.texts.len();
        let is_state = |cell: &&str| names::state(cell).is_some();
        let stand_for_numbers = others
            .iter()
            .all(|cell| names::is_failure(cell) || is_dash(cell));
        let are_states = others.iter().all(|cell| is_dash(cell) || is_state(cell));
        if self.texts.iter().all(|cell| cell.is_empty()) {
            Holdings::Nothing
        } else if stand_for_numbers {
            Holdings::Numbers
        } else if has_numbers {
            Holdings::NumbersAndWords
        } else if are_states {
            Holdings::States
        } else {
            Holdings::Words
        }
    }

    /// The number of coarsest levels that have no number, as a dash or a blank says.
    pub(super) fn missing(&self) -> usize {
        let mut cells = self.texts.iter().zip(&self.numbers);
        let first = cells.position(|(cell, number)| number.is_some() || !is_dash(cell));
        first.unwrap_or(0)
    }

    /// Whether a level has no result in place of a number: only a blank may be a mistake of the
    /// reader.
    pub(super) fn has_failed(&self, row: usize) -> bool {
        let cell = self.texts[row];
        !self.is_number(row) && (names::is_failure(cell) || is_dash(cell) && !cell.is_empty())
    }

    pub(super) fn is_constant(&self) -> bool {
        self.values.len() > 1 && self.values.iter().all(|value| *value == self.values[0])
    }

    pub(super) fn is_whole(&self) -> bool {
        self.values
            .iter()
            .all(|value| *value >= 1.0 && value.fract() == 0.0)
    }

    /// Whether each number is positive and much smaller than the previous one.
    pub(super) fn is_steep(&self) -> bool {
        self.values.len() > 2
            && self
                .values
                .windows(2)
                .all(|two| 0.0 < two[1] && two[1] <= STEEP * two[0])
    }

    fn widest_half(&self) -> f64 {
        self.halves.iter().copied().fold(0.0, f64::max)
    }

    /// The least ratio by which the column falls or grows, if all ratios are equal or its numbers
    /// are whole multiples or fractions of one of them.
    pub(super) fn regular(&self) -> Option<f64> {
        let mut values = self.values.clone();
        values.sort_by(f64::total_cmp);
        let least = *values.first()?;
        let most = *values.last()?;
        let same = SAME.max(2.0 * self.widest_half() / least).min(0.02);
        let ratios: Vec<f64> = values.windows(2).map(|two| two[1] / two[0]).collect();
        let ratio = ratios.iter().copied().fold(f64::INFINITY, f64::min);
        let is_regular = ratios.iter().all(|one| (one / ratio - 1.0).abs() < same)
            || values.iter().all(|value| is_almost_whole(most / value))
            || values.iter().all(|value| is_almost_whole(value / least));
        (ratios.len() > 1 && is_regular && ratio > 1.0 && ratio.is_finite() && least > 0.0)
            .then_some(ratio)
    }

    /// Whether two columns are the steps of one mesh in several directions, or of space and time.
    pub(super) fn is_in_proportion(&self, other: &Self) -> bool {
        let a = &self.values;
        let b = &other.values;
        a.iter()
            .zip(b)
            .all(|(x, y)| (x * b[0] / (y * a[0]) - 1.0).abs() < SAME)
    }

    /// Whether it has whole numbers that grow from level to level.
    pub(super) fn is_count_over(&self, steps: &[f64]) -> bool {
        self.is_whole()
            && self.values.len() == steps.len()
            && self.values.windows(2).all(|two| two[0] < two[1])
    }

    /// Whether it counts cells or nodes of meshes with these steps: its D-th root grows with 1/h
    /// along a line, as n or n + 1 along an edge do.
    pub(super) fn counts_meshes(&self, steps: &[f64]) -> bool {
        const NEAR_LINE: f64 = 1e-3;
        let is_line = |dim: &f64| {
            let points = self.values.iter().zip(steps);
            let points: Vec<[f64; 2]> = points
                .map(|(count, step)| [step.recip(), count.powf(dim.recip())])
                .collect();
            let slopes = points
                .windows(2)
                .map(|two| (two[1][1] - two[0][1]) / (two[1][0] - two[0][0]));
            let slopes: Vec<f64> = slopes.collect();
            slopes
                .iter()
                .all(|slope| (slope / slopes[0] - 1.0).abs() < NEAR_LINE)
        };
        steps.len() > 2 && self.is_count_over(steps) && DIMENSIONS.iter().any(is_line)
    }

    /// Whether it holds zeros and ones.
    pub(super) fn is_flag(&self) -> bool {
        self.values
            .iter()
            .all(|value| *value == 0.0 || *value == 1.0)
    }

    /// The number of steps in which both fall or both grow, minus those in which one falls and the
    /// other grows.
    pub(super) fn together(&self, other: &Self) -> f64 {
        let signs = self.values.windows(2).zip(other.values.windows(2));
        signs
            .map(|(a, b)| sign(a[1] - a[0]) * sign(b[1] - b[0]))
            .sum()
    }

    /// Whether these are the rates or the reduction factors of an error, to its digits, on the
    /// finer or on the coarser level of each pair.
    ///
    /// * `steps`: of the rows, the coarsest first.
    pub(super) fn derived_from(&self, error: &Self, steps: &[f64]) -> Option<Derived> {
        let last = steps.len() - 1;
        let errors = &error.values;
        if last < 1 || !errors.iter().all(|value| *value > 0.0) || errors[last] >= 0.7 * errors[0] {
            return None;
        }
        let half = 1.2 * self.widest_half();
        // Each rate stands on the finer level of its pair, or on the coarser one. Three rates are
        // proof enough, fewer need a name or an end without a number; so does a column of one
        // number, for an error that stands still at 1 looks like a rate of 1.
        let is_named = self.word == Word::Rate && last > 1;
        let is_end = |row: usize| {
            let value = self.values[row];
            let is_proof = is_named || last > 2 && !self.is_constant();
            is_proof || !value.is_finite() || last > 1 && value == 0.0
        };
        [
            Derived::Rates,
            Derived::RatesOfHalvedSteps,
            Derived::Factors,
        ]
        .into_iter()
        .find(|derived| {
            let agree = |printed: &[f64]| {
                let mut rows = printed.iter().enumerate();
                rows.all(|(k, value)| derived.value(error, steps, k).is_near(*value, half))
            };
            is_end(0) && agree(&self.values[1..]) || is_end(last) && agree(&self.values[..last])
        })
    }
}

/// -1, 0 or 1; NaN has none.
pub(super) fn sign(number: f64) -> f64 {
    if number == 0.0 { 0.0 } else { number.signum() }
}

/// Whether a number is a whole one, but for its digits.
fn is_almost_whole(number: f64) -> bool {
    (number / number.round() - 1.0).abs() < SAME
}

/// What somebody has computed from the errors of another column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Derived {
    /// `log(e_k / e_(k+1)) / log(h_k / h_(k+1))`.
    Rates,
    /// `log2(e_k / e_(k+1))`.
    RatesOfHalvedSteps,
    /// `e_k / e_(k+1)`.
    Factors,
}

/// A number that is computed from the errors of two levels.
struct DerivedValue {
    value: f64,
    /// By how much the digits of the errors may have changed it.
    doubt: f64,
}

impl DerivedValue {
    /// Whether a printed number agrees with it.
    ///
    /// * `half`: of the last printed place.
    fn is_near(&self, printed: f64, half: f64) -> bool {
        (printed - self.value).abs() <= (half + self.doubt).min(0.25) + SAME * self.value.abs()
    }
}

impl Derived {
    /// What levels k and k + 1 of an error give.
    fn value(self, error: &Cells<'_>, steps: &[f64], k: usize) -> DerivedValue {
        let errors = &error.values;
        let reduction = errors[k] / errors[k + 1];
        let doubt = error.halves[k] / errors[k] + error.halves[k + 1] / errors[k + 1];
        match self {
            Self::Factors => DerivedValue {
                value: reduction,
                doubt: doubt * reduction,
            },
            Self::RatesOfHalvedSteps => DerivedValue {
                value: reduction.log2(),
                doubt: doubt / LN_2,
            },
            Self::Rates => {
                let ratio = (steps[k] / steps[k + 1]).ln();
                DerivedValue {
                    value: reduction.ln() / ratio,
                    doubt: doubt / ratio,
                }
            }
        }
    }
}

/// What the cells of a column hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Holdings {
    /// Blanks.
    Nothing,
    /// Words that say whether a level was solved.
    States,
    /// Other words.
    Words,
    /// Numbers, or what stands for a number that a code did not find.
    Numbers,
    NumbersAndWords,
}
