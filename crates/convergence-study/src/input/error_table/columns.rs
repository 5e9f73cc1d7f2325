//! The columns of a table, and what their numbers say.

use std::f64::consts::{LN_2, LN_10};

use super::grid::ColumnName;
use super::names::{self, Word};
use super::number::{Number, counts_rows, halves, is_dash};

/// Dimensions that a count may have.
pub(super) const DIMENSIONS: [f64; 3] = [1.0, 2.0, 3.0];
/// Largest relative difference of two equal ratios, given their digits.
const SAME: f64 = 1e-5;
/// Largest relative error of a step that is printed with few digits.
const ROUNDED: f64 = 5e-3;

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

    /// Whether each number is smaller than the previous one.
    pub(super) fn falls(&self) -> bool {
        self.values.windows(2).all(|two| two[1] < two[0])
    }

    /// Whether its numbers are whole, and are written without a point and without an exponent.
    pub(super) fn is_without_point(&self) -> bool {
        let mut cells = self.texts.iter().zip(&self.values);
        cells.all(|(cell, value)| value.fract() == 0.0 && !cell.contains(['.', 'e', 'E', 'd', 'D']))
    }

    /// Whether its name is that of a count, a level, a dimension or a cost.
    pub(super) fn may_be_parameter(&self) -> bool {
        let is_listed = matches!(
            self.word,
            Word::Step | Word::Count(_) | Word::Cost | Word::Rate | Word::State | Word::Group
        );
        is_listed || names::is_group(&self.name)
    }

    /// Whether its numbers may be those of a cost: positive, and at least twice as large on the
    /// finest level as on the coarsest.
    pub(super) fn is_cost(&self) -> bool {
        let ends = self.values.first().zip(self.values.last());
        self.values
            .iter()
            .all(|value| *value > 0.0 && value.is_finite())
            && ends.is_some_and(|(first, last)| *last >= 2.0 * first)
    }

    /// Whether its name, and numbers that agree, say that it is no error in a table of its own, whose
    /// rows may stand in either order.
    pub(super) fn is_no_error(&self) -> bool {
        let is_whole = self.is_without_point();
        let rises = self.is_cost();
        match self.word {
            Word::Error | Word::Unknown | Word::Residual | Word::Value => false,
            Word::Logarithm => true,
            Word::Step => self.values.iter().all(|value| *value > 0.0),
            Word::Rate => !self.is_steep() && self.missing() > 0,
            Word::Group => is_whole && self.is_constant(),
            Word::State => is_whole,
            Word::Count(_) => is_whole,
            Word::Cost => is_whole || rises,
        }
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
        are_in_proportion(&self.values, &other.values)
    }

    /// Whether its distance from another column is an error, absolute or relative, to the digits. A
    /// level without a result says nothing.
    pub(super) fn is_off_by(&self, other: &Self, error: &Self) -> bool {
        let is_known = |row: &usize| !error.values[*row].is_nan();
        let rows: Vec<usize> = (0..self.values.len()).filter(is_known).collect();
        let distance = |row: usize| (self.values[row] - other.values[row]).abs();
        let half = |row: usize| self.halves[row] + other.halves[row];
        let is_near = |row: usize, scale: f64| {
            let own = half(row) + scale * error.halves[row];
            (distance(row) - scale * error.values[row]).abs() <= 1.2 * own + SAME * distance(row)
        };
        let scales: [&dyn Fn(usize) -> f64; 3] =
            [&|_| 1.0, &|row| other.values[row].abs(), &|row| {
                self.values[row].abs()
            }];
        let agree =
            |scale: &dyn Fn(usize) -> f64| rows.iter().all(|row| is_near(*row, scale(*row)));
        let is_proof = rows.len() > 2 && distance(rows[0]) > 5.0 * half(rows[0]);
        is_proof && scales.into_iter().any(agree)
    }

    /// Whether its distance from a constant is an error, to the digits.
    pub(super) fn is_off_a_constant_by(&self, error: &Self) -> bool {
        let rows = || self.values.iter().zip(&error.values);
        let halves = self.halves.iter().zip(&error.halves);
        let half = halves.map(|(a, b)| a + b).fold(0.0, f64::max);
        let is_constant = |sign: f64| {
            let limits: Vec<f64> = rows().map(|(value, error)| value - sign * error).collect();
            let least = limits.iter().copied().fold(f64::INFINITY, f64::min);
            let most = limits.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            let is_one = most - least <= 2.4 * half + SAME * least.abs();
            // An error is not its own distance from zero, and a level without a number has failed.
            let is_far = error
                .values
                .iter()
                .all(|error| least.abs().min(most.abs()) > 2.0 * error);
            is_one && is_far && limits.iter().all(|limit| limit.is_finite())
        };
        let moved = rows()
            .map(|(value, _)| (value - self.values[0]).abs())
            .fold(0.0, f64::max);
        let is_proof = self.values.len() > 2 && moved > 20.0 * (half + SAME * self.values[0].abs());
        is_proof && [1.0, -1.0].into_iter().any(is_constant)
    }

    /// Whether these are logarithms of another column, to any base.
    pub(super) fn is_logarithm_of(&self, other: &Self) -> bool {
        let logarithms: Vec<f64> = other.values.iter().map(|value| value.ln()).collect();
        let Some((last, first)) = logarithms.last().zip(logarithms.first()) else {
            return false;
        };
        let own = &self.values;
        let factor = (own[own.len() - 1] - own[0]) / (last - first);
        let half = |row: usize| {
            let relative = other.halves[row] / other.values[row].abs();
            1.2 * (self.halves[row] + factor.abs() * relative) + SAME * own[row].abs()
        };
        let is_near = |row: usize| {
            let expected = own[0] + factor * (logarithms[row] - first);
            (own[row] - expected).abs() <= half(row) + half(0) + half(own.len() - 1)
        };
        let is_base = [1.0, LN_2, LN_10]
            .iter()
            .any(|base| (factor * base - 1.0).abs() < 0.02);
        own.len() > 2 && is_base && (0..own.len()).all(is_near)
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

/// Whether the numbers of two columns have the same ratio in each row.
pub(super) fn are_in_proportion(a: &[f64], b: &[f64]) -> bool {
    let mut rows = a.iter().zip(b);
    rows.all(|(x, y)| (x * b[0] / (y * a[0]) - 1.0).abs() < ROUNDED)
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
                let value = reduction.ln() / ratio;
                DerivedValue {
                    value,
                    doubt: (doubt + ROUNDED * value.abs()) / ratio,
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
