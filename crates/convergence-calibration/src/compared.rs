//! This rule beside what people do today, at equal shares of wrong claims that pass.
//!
//! Each of the others compares a number with the claimed order. Its *distance* from a claim is the
//! half-width of the narrowest band around the claim with which it passes. The half-width used is
//! the largest with which no more wrong claims pass than this rule passes at ±0.25 on the same
//! tables; what differs is then the share of true claims that pass.

use convergence_judge::judge::{
    fit::{Level, fit_line, pairwise_rates},
    verdict::DEFAULT_TOLERANCE,
};

use crate::draw::{CalibrationError, Draw};
use crate::fresh::FRESH;
use crate::laws::{Group, Law};
use crate::sheet::{Cell, Row, Share, Sheet};
use crate::{judge, wrong};

/// Numbers of levels, equally often.
const LEVELS: [usize; 4] = [4, 5, 6, 8];

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
    fn numbers(self, levels: &[Level]) -> Vec<f64> {
        let rates = pairwise_rates(levels);
        match self {
            Self::LastPair => rates[rates.len() - 1..].to_vec(),
            Self::LastThreeSlopes => rates[rates.len() - 3..].to_vec(),
            Self::LeastSquares => vec![fit_line(levels).map_or(f64::NAN, |line| line.slope)],
            Self::EcaHoekstra => vec![exponent_with_limit(levels)],
            Self::Richardson => vec![of_differences(levels)],
        }
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

/// The exponent of `limit + c h^p` with the smaller deviation of two weightings.
fn exponent_with_limit(levels: &[Level]) -> f64 {
    let mut best = (f64::INFINITY, f64::NAN);
    for is_weighted in [false, true] {
        let mut weights = vec![];
        for level in levels {
            weights.push(if is_weighted { 1.0 / level.step } else { 1.0 });
        }
        let total: f64 = weights.iter().sum();
        for weight in &mut weights {
            *weight *= levels.len() as f64 / total;
        }
        let (largest, count) = EXPONENTS;
        for k in 1..=count {
            let exponent = largest * k as f64 / count as f64;
            let deviation = deviation(levels, &weights, exponent);
            if deviation < best.0 {
                best = (deviation, exponent);
            }
        }
    }
    best.1
}

/// Weighted sum of squares that `limit + c h^exponent` leaves; the weights have the mean 1.
fn deviation(levels: &[Level], weights: &[f64], exponent: f64) -> f64 {
    let mut powers = vec![];
    let mut errors = vec![];
    for level in levels {
        powers.push(level.step.powf(exponent));
        errors.push(level.error);
    }
    let x = without_mean(&powers, weights);
    let y = without_mean(&errors, weights);
    let along = product(&x, &y, weights);
    product(&y, &y, weights) - along * along / product(&x, &x, weights)
}

fn without_mean(values: &[f64], weights: &[f64]) -> Vec<f64> {
    let mean = product(values, &vec![1.0; values.len()], weights) / values.len() as f64;
    values.iter().map(|value| value - mean).collect()
}

fn product(a: &[f64], b: &[f64], weights: &[f64]) -> f64 {
    let factors = a.iter().zip(b).zip(weights);
    factors.map(|((a, b), weight)| a * b * weight).sum()
}

/// Distances of one practice from the claims of all tables.
#[derive(Debug, Clone, Default)]
struct Distances {
    wrong: Vec<f64>,
    right: Vec<f64>,
    /// Of the right claims whose order the levels show.
    shown: Vec<f64>,
}

impl Distances {
    /// The half-width with which at most so many wrong claims pass.
    fn half_width(&self, wrong_passes: usize) -> f64 {
        let mut sorted = self.wrong.clone();
        sorted.sort_by(f64::total_cmp);
        sorted.get(wrong_passes).copied().unwrap_or(f64::INFINITY)
    }

    fn cells(&self, wrong_passes: usize) -> Vec<Cell> {
        let half_width = self.half_width(wrong_passes);
        let [wrong, right, shown] = [&self.wrong, &self.right, &self.shown].map(|distances| {
            let mut share = Share::default();
            for distance in distances {
                share.count(*distance < half_width);
            }
            share
        });
        cells([wrong, right, shown], half_width)
    }
}

fn cells([wrong, right, shown]: [Share; 3], half_width: f64) -> Vec<Cell> {
    vec![
        wrong.cell("wrong pass"),
        right.cell("true pass"),
        shown.cell("true pass, order shows"),
        Cell {
            column: "half-width".to_owned(),
            value: half_width,
        },
    ]
}

/// The sheet that compares this rule with the others on the [fresh laws](crate::fresh).
pub(crate) fn compared(tables: usize, draw: &mut Draw) -> Result<Sheet, CalibrationError> {
    let judge = judge(DEFAULT_TOLERANCE)?;
    let [mut wrong_pass, mut true_pass, mut shown_pass] = [Share::default(); 3];
    let mut wrong_passes = 0;
    let mut all = vec![Distances::default(); Practice::ALL.len()];
    for law in &FRESH {
        for k in 0..tables {
            let table = law.draw(LEVELS[k % LEVELS.len()], 2.0, draw.next()?);
            let reading = judge.read(&table.levels);
            let numbers = Practice::ALL.map(|practice| practice.numbers(&table.levels));
            for claim in wrong(&table, 2.0 * DEFAULT_TOLERANCE) {
                let passes = judge.decide(&reading, claim).is_pass();
                wrong_pass.count(passes);
                wrong_passes += usize::from(passes);
                for (numbers, distances) in numbers.iter().zip(&mut all) {
                    distances.wrong.push(distance(numbers, claim));
                }
            }
            let Some(order) = table.order else { continue };
            let passes = judge.decide(&reading, order).is_pass();
            true_pass.count(passes);
            if shows(law) {
                shown_pass.count(passes);
            }
            for (numbers, distances) in numbers.iter().zip(&mut all) {
                let distance = distance(numbers, order);
                distances.right.push(distance);
                if shows(law) {
                    distances.shown.push(distance);
                }
            }
        }
    }
    let own = cells([wrong_pass, true_pass, shown_pass], DEFAULT_TOLERANCE);
    let mut rows = vec![Row::new("this rule", true, own)];
    for (practice, distances) in Practice::ALL.iter().zip(&all) {
        rows.push(Row::new(
            practice.name(),
            false,
            distances.cells(wrong_passes),
        ));
    }
    let title = "This rule at ±0.25 and what people do today, at equal shares of wrong claims that pass: nine laws, 4 to 8 levels, steps halved, wrong claims half an order off";
    Ok(Sheet {
        key: "compared",
        title: title.to_owned(),
        rows,
    })
}

/// Whether the levels show the order.
fn shows(law: &Law) -> bool {
    law.group != Group::Emerging
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
        for practice in Practice::ALL {
            let away = distance(&practice.numbers(&levels), 2.0);
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
            let away = distance(&practice.numbers(&shifted), 2.0);
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
        let cells = distances.cells(1);
        assert_eq!((cells[0].value, cells[1].value), (0.25, 2.0 / 3.0));
    }
}
