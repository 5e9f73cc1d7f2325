//! This rule beside what people do today, at equal shares of wrong claims that pass.
//!
//! Each of the others compares a number with the claimed order. Its *distance* from a claim is the
//! half-width of the narrowest band around the claim with which it passes. The half-width used is
//! the largest with which no more wrong claims pass than this rule passes at ±0.25 on the same
//! tables; what differs is then the share of true claims that pass.

use convergence_judge::{
    fit::{Level, fit_line, pairwise_rates},
    verdict::{DEFAULT_TOLERANCE, Judge, Reading},
};

use crate::draw::{Counted, Draw};
use crate::fresh::FRESH;
use crate::laws::{Law, LawGroup};
use crate::sheet::{Sheet, SheetRow};
use crate::{judge, wrong};

/// Numbers of levels, equally often.
const LEVELS: [usize; 4] = [4, 5, 6, 8];

/// Steps of neighbouring levels.
const RATIO: f64 = 2.0;

/// Largest exponent that a fit with a free limit tries, and the number of exponents.
const EXPONENTS: (f64, usize) = (8.0, 400);

/// What people compare with the order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Practice {
    LastPair,
    LastThreeSlopes,
    LeastSquares,
    /// The exponent of `limit + c h^p` by least squares, unweighted or weighted by 1/h, whichever
    /// has the smaller deviation (Eça and Hoekstra, J. Comput. Phys. 262, 2014).
    EcaHoekstra,
    /// The exponent of the last three values, their limit unknown.
    Richardson,
}

impl Practice {
    const ALL: [Self; 5] = [
        Self::LastPair,
        Self::LastThreeSlopes,
        Self::LeastSquares,
        Self::EcaHoekstra,
        Self::Richardson,
    ];

    fn name(self) -> &'static str {
        match self {
            Self::LastPair => "last pair",
            Self::LastThreeSlopes => "last three slopes",
            Self::LeastSquares => "least squares",
            Self::EcaHoekstra => "Eça-Hoekstra",
            Self::Richardson => "Richardson",
        }
    }

    /// The numbers that must be in the band around the order.
    ///
    /// * `weightings`: for this number of levels.
    fn numbers(self, levels: &[Level], weightings: &[Weighting; 2]) -> Vec<f64> {
        let rates = pairwise_rates(levels);
        match self {
            Self::LastPair => rates[rates.len() - 1..].to_vec(),
            Self::LastThreeSlopes => rates[rates.len() - 3..].to_vec(),
            Self::LeastSquares => vec![fit_line(levels).map_or(f64::NAN, |line| line.slope)],
            Self::EcaHoekstra => vec![exponent_with_limit(levels, weightings)],
            Self::Richardson => vec![of_differences(levels)],
        }
    }
}

/// Zero for a claim that the rule lets pass, and infinite for another.
fn own_distance(judge: &Judge, reading: &Reading<'_>, claim: f64) -> f64 {
    if judge.decide(reading, claim).is_pass() {
        0.0
    } else {
        f64::INFINITY
    }
}

/// The largest distance of the numbers from a claim; infinite where a number is none.
fn distance(numbers: &[f64], claim: f64) -> f64 {
    let mut largest: f64 = 0.0;
    for number in numbers {
        let away = (number - claim).abs();
        largest = largest.max(if away.is_nan() { f64::INFINITY } else { away });
    }
    largest
}

/// The rate of the last two differences, steps halved; NaN if they have not the same sign.
fn of_differences(levels: &[Level]) -> f64 {
    let [.., coarse, middle, fine] = levels else {
        return f64::NAN;
    };
    ((coarse.error - middle.error) / (middle.error - fine.error)).log2()
}

/// The powers of all steps for one exponent.
struct Powers {
    exponent: f64,
    /// Without their weighted mean.
    centred: Vec<f64>,
    /// The weighted sum of their squares.
    square: f64,
}

/// Levels with weights whose mean is 1, and what of a fit is the same for all tables with their
/// steps.
struct Weighting {
    weights: Vec<f64>,
    /// For each exponent that is tried.
    powers: Vec<Powers>,
}

impl Weighting {
    /// Unweighted and weighted by 1/h, for steps halved from 1, as all tables have them.
    fn both(levels: usize) -> [Self; 2] {
        let steps: Vec<f64> = (0..levels).map(|k| RATIO.powi(-(k as i32))).collect();
        [false, true].map(|is_weighted| Self::new(&steps, is_weighted))
    }

    fn new(steps: &[f64], is_weighted: bool) -> Self {
        let mut weights = vec![];
        for step in steps {
            weights.push(if is_weighted { 1.0 / step } else { 1.0 });
        }
        let total: f64 = weights.iter().sum();
        for weight in &mut weights {
            *weight *= steps.len() as f64 / total;
        }
        let (largest, count) = EXPONENTS;
        let mut powers = vec![];
        for k in 1..=count {
            let exponent = largest * k as f64 / count as f64;
            let values = steps.iter().map(|step| step.powf(exponent));
            let centred = without_mean(values.collect(), &weights);
            powers.push(Powers {
                exponent,
                square: product(&centred, &centred, &weights),
                centred,
            });
        }
        Self { weights, powers }
    }

    /// What each exponent of `limit + c h^p` leaves.
    fn deviations(&self, levels: &[Level]) -> impl Iterator<Item = Deviation> {
        let errors = levels.iter().map(|level| level.error).collect();
        let errors = without_mean(errors, &self.weights);
        let square_of_errors = product(&errors, &errors, &self.weights);
        self.powers.iter().map(move |powers| {
            let along = product(&powers.centred, &errors, &self.weights);
            Deviation {
                square: square_of_errors - along * along / powers.square,
                exponent: powers.exponent,
            }
        })
    }
}

/// The weighted sum of squares that an exponent leaves.
struct Deviation {
    square: f64,
    exponent: f64,
}

/// The exponent of `limit + c h^p` with the smallest deviation of two weightings.
fn exponent_with_limit(levels: &[Level], weightings: &[Weighting; 2]) -> f64 {
    let deviations = weightings.iter().flat_map(|one| one.deviations(levels));
    let best = deviations.min_by(|one, other| one.square.total_cmp(&other.square));
    best.map_or(f64::NAN, |best| best.exponent)
}

fn without_mean(mut values: Vec<f64>, weights: &[f64]) -> Vec<f64> {
    let weighted = values
        .iter()
        .zip(weights)
        .map(|(value, weight)| value * weight);
    let mean = weighted.sum::<f64>() / values.len() as f64;
    for value in &mut values {
        *value -= mean;
    }
    values
}

/// `Σ a b w`; a plain loop, since it runs some million times in a build with little optimisation.
fn product(a: &[f64], b: &[f64], weights: &[f64]) -> f64 {
    let mut sum = 0.0;
    for i in 0..weights.len() {
        sum += a[i] * b[i] * weights[i];
    }
    sum
}

const COLUMNS: [&str; 4] = [
    "wrong pass",
    "true pass",
    "true pass, order shows",
    "half-width",
];

/// Distances from the claims of all tables: of one practice, or of this rule, which are 0 where it
/// passes and infinite where it does not.
#[derive(Debug, Clone, Default)]
struct Distances {
    wrong: Vec<f64>,
    right: Vec<f64>,
    /// Of the right claims whose order the levels show.
    shown: Vec<f64>,
}

impl Distances {
    /// * `distance`: from the order of a table of this law.
    fn push_right(&mut self, law: &Law, distance: f64) {
        self.right.push(distance);
        if law.group != LawGroup::Emerging {
            self.shown.push(distance);
        }
    }

    /// The wrong claims that pass with this half-width.
    fn wrong_passes(&self, half_width: f64) -> usize {
        let passing = self.wrong.iter().filter(|distance| **distance < half_width);
        passing.count()
    }

    /// The half-width with which at most so many wrong claims pass.
    fn half_width(&self, wrong_passes: usize) -> f64 {
        let mut sorted = self.wrong.clone();
        sorted.sort_by(f64::total_cmp);
        sorted.get(wrong_passes).copied().unwrap_or(f64::INFINITY)
    }

    fn row(&self, name: &str, declared: bool, half_width: f64) -> SheetRow {
        let mut row = SheetRow::new(name, declared, &COLUMNS);
        for (column, distances) in COLUMNS.iter().zip([&self.wrong, &self.right, &self.shown]) {
            for distance in distances {
                row.count(column, *distance < half_width);
            }
        }
        row.add("half-width", half_width);
        row
    }
}

/// The sheet that compares this rule with the others on the [fresh laws](crate::fresh).
pub(crate) fn compared(tables: usize, draw: &mut Draw) -> Counted {
    let judge = judge(DEFAULT_TOLERANCE)?;
    let weightings = LEVELS.map(Weighting::both);
    let mut own = Distances::default();
    let mut others = vec![Distances::default(); Practice::ALL.len()];
    for law in &FRESH {
        for k in 0..tables {
            let place = k % LEVELS.len();
            let table = law.draw(LEVELS[place], RATIO, draw.next()?);
            let reading = judge.read(&table.levels);
            let numbers =
                Practice::ALL.map(|practice| practice.numbers(&table.levels, &weightings[place]));
            for claim in wrong(&table, 2.0 * DEFAULT_TOLERANCE) {
                own.wrong.push(own_distance(&judge, &reading, claim));
                for (numbers, distances) in numbers.iter().zip(&mut others) {
                    distances.wrong.push(distance(numbers, claim));
                }
            }
            let Some(order) = table.order else { continue };
            own.push_right(law, own_distance(&judge, &reading, order));
            for (numbers, distances) in numbers.iter().zip(&mut others) {
                distances.push_right(law, distance(numbers, order));
            }
        }
    }
    let wrong_passes = own.wrong_passes(DEFAULT_TOLERANCE);
    let mut rows = vec![own.row("this rule", true, DEFAULT_TOLERANCE)];
    for (practice, distances) in Practice::ALL.iter().zip(&others) {
        let half_width = distances.half_width(wrong_passes);
        rows.push(distances.row(practice.name(), false, half_width));
    }
    let title = "This rule at ±0.25 and what people do today, at equal shares of wrong claims that pass: nine laws, 4 to 8 levels, steps halved, wrong claims half an order off";
    Ok(Sheet {
        key: "compared",
        title: title.to_owned(),
        rows,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_practice_finds_the_exponent_of_a_pure_power() {
        let levels: Vec<Level> = (0..5)
            .map(|k| 0.5_f64.powi(k))
            .map(|step| Level {
                step,
                error: step * step,
            })
            .collect();
        let weightings = Weighting::both(levels.len());
        for practice in Practice::ALL {
            let away = distance(&practice.numbers(&levels, &weightings), 2.0);
            assert!(away < 1e-9, "{practice:?}: {away}");
        }
        // A constant error leaves the free limit as it is, and spoils the others.
        let shifted: Vec<Level> = levels
            .iter()
            .map(|level| Level {
                error: level.error + 1.0,
                ..*level
            })
            .collect();
        for practice in Practice::ALL {
            let is_blind = matches!(practice, Practice::EcaHoekstra | Practice::Richardson);
            let away = distance(&practice.numbers(&shifted, &weightings), 2.0);
            assert_eq!(away < 1e-9, is_blind, "{practice:?}: {away}");
        }
        assert_eq!(distance(&[f64::NAN], 2.0), f64::INFINITY);
    }

    #[test]
    fn a_half_width_lets_no_more_wrong_claims_pass() {
        let distances = Distances {
            wrong: vec![0.5, 0.1, 0.3, 0.2],
            right: vec![0.05, 0.15, 0.25],
            shown: vec![],
        };
        assert_eq!(distances.half_width(2), 0.3);
        assert_eq!(distances.half_width(4), f64::INFINITY);
        let half_width = distances.half_width(1);
        assert_eq!(distances.wrong_passes(half_width), 1);
        let row = distances.row("", false, half_width);
        let columns = ["wrong pass", "true pass", "half-width"];
        assert_eq!(
            columns.map(|column| row.value(column)),
            [Some(0.25), Some(2.0 / 3.0), Some(0.2)]
        );
    }
}
