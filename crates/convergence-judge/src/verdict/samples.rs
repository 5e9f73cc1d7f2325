//! Samples: several numbers at each level, as of Monte Carlo, whose scatter says how well the level
//! is known.

use std::collections::BTreeSet;
use std::fmt::{self, Display, Formatter};
use std::str::FromStr;

use super::lower_order::{BELOW, LEAST_CHANGE, hides_below};
use super::reading::compare;
use super::reason::REPEATED;
use super::{Floor, Level, Printed, RateVerdict, Reading, Reason};
use crate::claims::Claim;
use crate::fit::{FACTOR, POLLUTION_EXPONENTS, RateInterval};
use crate::interval::Interval;

/// Fewest numbers of a sample: with fewer its scatter is not known.
pub const FEWEST_NUMBERS: usize = 10;
/// Fewest levels whose scatter decides; with fewer the ordinary rule does.
const FEWEST_LEVELS_OF_SAMPLES: usize = 4;
/// The quantile of a normal number that 95 % lie below in size.
const NORMAL: f64 = 1.96;
/// A normal number that 99 % lie below.
const NORMAL_99: f64 = 2.326_35;
/// Standard errors up to which a term beside the power law is chance.
const CHANCE: f64 = 2.8;
/// Standard errors above which a lower order keeps a claim from passing.
const LOWER_ORDER: f64 = 2.0;

/// How the numbers of a sample make an error.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Of {
    /// Their mean: a strong error.
    #[default]
    Mean,
    /// The root of the mean of their squares.
    RootMeanSquare,
    /// The size of the mean of signed numbers: a weak error.
    Weak,
}

impl Of {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Mean, Self::RootMeanSquare, Self::Weak];

    /// The name in files and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Mean => "mean",
            Self::RootMeanSquare => "rms",
            Self::Weak => "weak",
        }
    }

    /// The error that these numbers make.
    pub fn error(self, numbers: &[f64]) -> f64 {
        Moments::of(numbers, self).error
    }
}

impl FromStr for Of {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let known = Self::ALL.into_iter().find(|of| of.name() == text);
        known.ok_or_else(|| "expected mean, rms or weak".to_owned())
    }
}

impl Display for Of {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// The numbers of all samples, and what they are.
#[derive(Debug, Clone, PartialEq)]
pub struct Samples {
    /// Those of each level, coarsest first; [`FEWEST_NUMBERS`] or more each.
    pub numbers: Vec<Vec<f64>>,
    /// How they make an error.
    pub of: Of,
    /// The seed of each number: those of one seed belong together. Empty if none is known.
    pub seeds: Vec<Vec<usize>>,
}

/// A level as its sample shows it.
#[derive(Debug, Clone, Copy)]
struct Known {
    error: f64,
    /// The variance of its logarithm.
    variance: f64,
}

/// A straight line through weighted logarithms.
struct WeightedLine {
    rate: f64,
    /// Of the rate, from the scatter of the samples.
    standard_error: f64,
    /// Weighted squares of what is left.
    chi_square: f64,
}

impl Samples {
    /// The errors of all levels, and how well they are known.
    ///
    /// * `without`: the seed to leave out at each level that has it.
    fn known(&self, without: Option<usize>) -> Vec<Known> {
        let is_kept = |level: usize, k: usize| without.is_none() || self.seed(level, k) != without;
        let levels = self.numbers.iter().enumerate().map(|(level, numbers)| {
            let kept = numbers.iter().enumerate();
            let kept = kept.filter(|(k, _)| is_kept(level, *k)).map(|(_, x)| *x);
            kept.collect::<Vec<f64>>()
        });
        let moments: Vec<Moments> = levels
            .map(|numbers| Moments::of(&numbers, self.of))
            .collect();
        // One relative variance for all levels; of signed numbers the absolute one is of one size.
        let squares: f64 = moments.iter().map(|one| one.squares).sum();
        let freedom: f64 = moments.iter().map(|one| one.count - 1.0).sum();
        let known = moments.iter().map(|one| Known {
            error: one.error,
            variance: match self.of {
                Of::Weak => one.squares / (one.count - 1.0) / one.count,
                Of::Mean | Of::RootMeanSquare => squares / freedom / one.count,
            },
        });
        known.collect()
    }

    /// The seed of a number, if it is known.
    fn seed(&self, level: usize, k: usize) -> Option<usize> {
        self.seeds.get(level)?.get(k).copied()
    }

    /// The first level whose numbers are all equal: none of them depends on its seed.
    fn level_without_scatter(&self) -> Option<usize> {
        let mut levels = self.numbers.iter();
        levels.position(|numbers| numbers.iter().all(|number| *number == numbers[0]))
    }

    /// Half the width of the interval by leaving out each seed, if levels share seeds.
    fn jackknife(&self, x: &[f64]) -> f64 {
        let all = self.seeds.iter().take(self.numbers.len()).flatten();
        let distinct: BTreeSet<usize> = all.clone().copied().collect();
        if distinct.len() == all.count() {
            return 0.0;
        }
        let count = distinct.len() as f64;
        let without = distinct.iter().map(|seed| self.known(Some(*seed)));
        let rates: Vec<f64> = without.map(|known| line(x, &known).rate).collect();
        let mean = rates.iter().sum::<f64>() / count;
        let squares: f64 = rates.iter().map(|rate| (rate - mean).powi(2)).sum();
        FACTOR * NORMAL * (squares * (count - 1.0) / count).sqrt()
    }
}

/// What the numbers of a level say.
struct Moments {
    count: f64,
    error: f64,
    /// Sum of squares of the deviations of the logarithm.
    squares: f64,
}

impl Moments {
    fn of(numbers: &[f64], of: Of) -> Self {
        let squared: Vec<f64> = numbers.iter().map(|x| x * x).collect();
        let values = if of == Of::RootMeanSquare {
            &squared
        } else {
            numbers
        };
        let count = values.len() as f64;
        let mean = values.iter().sum::<f64>() / count;
        let squares = values.iter().map(|x| (x / mean - 1.0).powi(2)).sum();
        let negative = numbers.iter().copied().find(|x| *x < 0.0);
        match of {
            // No size of an error is negative.
            Of::Mean => Self {
                count,
                error: negative.unwrap_or(mean),
                squares,
            },
            Of::Weak => Self {
                count,
                error: mean.abs(),
                squares,
            },
            Of::RootMeanSquare => Self {
                count,
                error: mean.sqrt(),
                squares: squares / 4.0,
            },
        }
    }
}

impl Claim {
    /// The rate of samples, coarsest level first, held against the order claimed.
    ///
    /// * `steps`: as many as samples.
    pub fn judge_samples(&self, steps: &[f64], samples: &Samples) -> RateVerdict {
        let known = samples.known(None);
        let levels: Vec<Level> = steps
            .iter()
            .zip(&known)
            .map(|(&step, known)| Level {
                step,
                error: known.error,
            })
            .collect();
        let reading = Reading::new(&levels, Floor::NONE);
        let unsampled = || {
            let doubt = doubt_of_finest(&levels, &known);
            let printed = Printed { doubt, digits: &[] };
            self.judge_printed(&levels, Floor::NONE, printed)
        };
        if let Some(level) = samples.level_without_scatter() {
            return without_scatter(unsampled(), level);
        }
        let is_usable = reading.is_usable()
            && self.is_usable()
            && known.iter().all(|level| level.variance > 0.0);
        if !is_usable {
            return unsampled();
        }
        if let Some((level, many)) = unknown_level(samples, &known) {
            let words = format!(
                "level {} tells nothing: two standard errors exceed its mean; more than {many} samples would",
                level + 1
            );
            return unsampled().with_reason(Reason::Samples, &words);
        }
        let x: Vec<f64> = steps.iter().map(|step| step.ln()).collect();
        let model = line(&x, &known);
        let freedom = (levels.len().saturating_sub(2)) as f64;
        let lower = Term::of_lower_orders(&x, &known, self.order);
        let mut others = Term::of_others(&x, &known)
            .into_iter()
            .chain(lower.iter().copied());
        let is_power = levels.len() >= FEWEST_LEVELS_OF_SAMPLES
            && model.chi_square <= chi_square_99(freedom)
            && others.all(|term| term.size.abs() <= CHANCE);
        if !is_power {
            return unsampled();
        }
        let spread = (model.chi_square / freedom).sqrt().max(1.0);
        let half = FACTOR * NORMAL * spread * model.standard_error;
        let half = half.max(samples.jackknife(&x));
        let interval = Interval::around(model.rate, half);
        let least = LEAST_CHANGE * self.tolerance;
        let hides = lower
            .iter()
            .any(|term| term.size > LOWER_ORDER && term.slope > least)
            || self.bound.is_least() && hides_below(&levels, self.order, self.tolerance);
        let reason = compare(interval, self.order, self.tolerance);
        let reading = reading.with_fit(RateInterval::of_samples(model.rate, interval));
        let rate = RateVerdict::new(&reading, Some(self.band()), reason);
        let rate = self.bound.held_against(rate).unless_lower_order(hides);
        self.with_constant_if(&levels, rate)
    }
}

/// The verdict on samples that are all equal at a level, counted from 0: one run stands for many.
///
/// * `judged`: that of the ordinary rule.
fn without_scatter(judged: RateVerdict, level: usize) -> RateVerdict {
    if !judged.verdict.is_pass() {
        return judged;
    }
    let words = format!("the samples of level {} are equal: {REPEATED}", level + 1);
    judged.with_reason(Reason::Repeats, &words)
}

/// The first level whose two standard errors exceed its mean, and the number of samples above which
/// they do not.
fn unknown_level(samples: &Samples, known: &[Known]) -> Option<(usize, usize)> {
    let share = |known: &Known| 2.0 * known.variance.sqrt();
    let level = known.iter().position(|known| share(known) > 1.0)?;
    let many = samples.numbers[level].len() as f64 * share(&known[level]).powi(2);
    Some((level, many.ceil() as usize))
}

/// By how much the scatter of the two finest levels may move their rate.
fn doubt_of_finest(levels: &[Level], known: &[Known]) -> f64 {
    let ([.., before, finest], [.., one, other]) = (levels, known) else {
        return 0.0;
    };
    let doubt = NORMAL * (one.variance + other.variance).sqrt() / (before.step / finest.step).ln();
    if doubt.is_finite() { doubt } else { 0.0 }
}

/// The quantile of χ² that 99 % lie below, by Wilson and Hilferty.
fn chi_square_99(freedom: f64) -> f64 {
    let share = 2.0 / (9.0 * freedom);
    freedom * (1.0 - share + NORMAL_99 * share.sqrt()).powi(3)
}

/// Products of columns, weighted by how well each level is known.
fn product(known: &[Known], a: &[f64], b: &[f64]) -> f64 {
    let terms = known.iter().zip(a.iter().zip(b));
    terms.map(|(known, (a, b))| a * b / known.variance).sum()
}

/// What a column leaves without its weighted projection on another.
fn without(known: &[Known], column: &[f64], direction: &[f64]) -> Vec<f64> {
    let factor = product(known, column, direction) / product(known, direction, direction);
    let rest = column.iter().zip(direction);
    rest.map(|(value, along)| value - factor * along).collect()
}

/// Columns of x and of the logarithms of the errors, without their weighted means.
fn columns(x: &[f64], known: &[Known]) -> [Vec<f64>; 2] {
    let y: Vec<f64> = known.iter().map(|known| known.error.ln()).collect();
    let ones = vec![1.0; x.len()];
    [without(known, x, &ones), without(known, &y, &ones)]
}

fn line(x: &[f64], known: &[Known]) -> WeightedLine {
    let [x, y] = columns(x, known);
    let square = product(known, &x, &x);
    let rest = without(known, &y, &x);
    WeightedLine {
        rate: product(known, &x, &y) / square,
        standard_error: square.sqrt().recip(),
        chi_square: product(known, &rest, &rest),
    }
}

/// A term beside the power law.
#[derive(Clone, Copy)]
struct Term {
    /// Its change of the finest rate, for a power.
    slope: f64,
    /// In its standard errors; 0 where the levels do not show it.
    size: f64,
}

impl Term {
    /// Of orders below the one claimed.
    fn of_lower_orders(x: &[f64], known: &[Known], order: f64) -> Vec<Self> {
        let exponents = BELOW.iter().copied().chain([order]);
        exponents.map(|d| Self::of_power(x, known, -d)).collect()
    }

    /// Of pollution, and of the finest level alone.
    fn of_others(x: &[f64], known: &[Known]) -> Vec<Self> {
        let pollution = POLLUTION_EXPONENTS.map(|r| Self::of_power(x, known, r));
        let is_finest = |k: usize| f64::from(u8::from(k + 1 == x.len()));
        let finest = Self::of_column(x, known, is_finest);
        pollution.into_iter().chain([finest]).collect()
    }

    /// b (h/h_m)^r: its size has the sign of b.
    fn of_power(x: &[f64], known: &[Known], r: f64) -> Self {
        let finest = x[x.len() - 1];
        let term = Self::of_column(x, known, |k| (r * (x[k] - finest)).exp());
        Self {
            slope: -r * term.slope,
            ..term
        }
    }

    fn of_column(x: &[f64], known: &[Known], column: impl Fn(usize) -> f64) -> Self {
        let column: Vec<f64> = (0..x.len()).map(column).collect();
        let [x, y] = columns(x, known);
        let column = without(known, &column, &vec![1.0; x.len()]);
        let column = without(known, &column, &x);
        let square = product(known, &column, &column);
        let slope = product(known, &column, &y) / square;
        let size = slope * square.sqrt();
        Self {
            slope,
            size: if size.is_finite() { size } else { 0.0 },
        }
    }
}

#[cfg(test)]
mod tests;
