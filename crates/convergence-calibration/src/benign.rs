//! What a user of smooth problems gets: a power with small pollution, and finite differences of
//! random smooth problems.
//!
//! Seen twice, when the last two constants of the rule were chosen, and not fitted.

use convergence_judge::{fit::Level, random::SplitMix, verdict::DEFAULT_TOLERANCE};
use convergence_study::Verdict;

use crate::draw::{Counted, Draw};
use crate::judge;
use crate::laws::{Law, polluted};
use crate::sheet::{Sheet, SheetRow};

/// A smooth power.
pub const BENIGN: [Law; 1] = [polluted(
    "h^p (1 + a h^r), r 1 to 4, |a| < 0.5",
    [-0.5, 0.5],
    [1.0, 4.0],
)];

/// Numbers of levels: 8 cells on the coarsest, twice as many on the next.
const LEVELS: [usize; 3] = [4, 5, 6];
/// Cells on the coarsest level.
const COARSEST: usize = 8;

/// The problem -u'' + b u' + c u = f on (0, 1) with u given at both ends, for a solution of three
/// sines.
struct BenignProblem {
    b: f64,
    c: f64,
    /// Amplitude, wave number and phase of each sine.
    sines: [[f64; 3]; 3],
}

impl BenignProblem {
    fn draw(random: &mut SplitMix) -> Self {
        let sines = std::array::from_fn(|_| {
            [
                random.within([-1.0, 1.0]),
                random.within([0.5, 6.0]),
                random.within([0.0, std::f64::consts::TAU]),
            ]
        });
        Self {
            b: random.within([-10.0, 10.0]),
            c: random.within([0.0, 20.0]),
            sines,
        }
    }

    /// u, u' and u''.
    fn solution(&self, x: f64) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for [a, k, w] in self.sines {
            sum[0] += a * (k * x + w).sin();
            sum[1] += a * k * (k * x + w).cos();
            sum[2] -= a * k * k * (k * x + w).sin();
        }
        sum
    }

    /// The largest error and the root mean square error at the nodes of n cells.
    ///
    /// * `upwind`: u' by the one-sided difference against the flow, of first order; otherwise by
    ///   the central one, of second.
    fn errors(&self, n: usize, upwind: bool) -> [f64; 2] {
        let h = 1.0 / n as f64;
        let (below, above) = match (upwind, self.b > 0.0) {
            (false, _) => (-0.5 * self.b / h, 0.5 * self.b / h),
            (true, true) => (-self.b / h, 0.0),
            (true, false) => (0.0, self.b / h),
        };
        let west = -1.0 / (h * h) + below;
        let east = -1.0 / (h * h) + above;
        let middle = 2.0 / (h * h) + self.c - below - above;
        // Thomas' algorithm.
        let [left, ..] = self.solution(0.0);
        let [right, ..] = self.solution(1.0);
        let mut upper = vec![0.0; n];
        let mut value = vec![0.0; n + 1];
        value[0] = left;
        for i in 1..n {
            let [u, du, ddu] = self.solution(i as f64 * h);
            let f = -ddu + self.b * du + self.c * u;
            let pivot = middle - west * if i > 1 { upper[i - 1] } else { 0.0 };
            upper[i] = east / pivot;
            value[i] = (f - west * value[i - 1]) / pivot;
        }
        value[n] = right;
        let mut largest: f64 = 0.0;
        let mut sum = 0.0;
        for i in (1..n).rev() {
            value[i] -= upper[i] * value[i + 1];
            let error = value[i] - self.solution(i as f64 * h)[0];
            largest = largest.max(error.abs());
            sum += h * error * error;
        }
        [largest, sum.sqrt()]
    }
}

/// How often the orders of finite differences pass and fail, and claims half an order off pass, at
/// the default tolerance.
///
/// * `problems`: for each number of levels.
pub(crate) fn differences(problems: usize, draw: &mut Draw) -> Counted {
    let judge = judge(DEFAULT_TOLERANCE)?;
    let mut rows = vec![];
    for levels in LEVELS {
        let columns = ["true pass", "true fail", "wrong pass"];
        let mut row = SheetRow::new(format!("{levels} levels"), true, &columns);
        for _ in 0..problems {
            let problem = BenignProblem::draw(draw.next()?);
            for (upwind, order) in [(false, 2.0), (true, 1.0)] {
                let counts = (0..levels).map(|k| COARSEST << k);
                let errors: Vec<(f64, [f64; 2])> = counts
                    .map(|n| (1.0 / n as f64, problem.errors(n, upwind)))
                    .collect();
                for norm in [0, 1] {
                    let table: Vec<Level> = errors
                        .iter()
                        .map(|(step, errors)| Level {
                            step: *step,
                            error: errors[norm],
                        })
                        .collect();
                    let reading = judge.read(&table);
                    let verdict = judge.decide(&reading, order);
                    row.count("true pass", verdict.is_pass());
                    row.count("true fail", verdict == Verdict::Fail);
                    for off in [-0.5, 0.5] {
                        let wrong = judge.decide(&reading, order + off);
                        row.count("wrong pass", wrong.is_pass());
                    }
                }
            }
        }
        rows.push(row);
    }
    Ok(Sheet {
        key: "differences",
        title: "Share of claims that pass or fail at ±0.25, finite differences of random smooth problems, central and upwind, two norms"
            .to_owned(),
        rows,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_differences_have_their_orders() {
        let mut random = SplitMix::new(3);
        for _ in 0..20 {
            let problem = BenignProblem::draw(&mut random);
            for (upwind, order) in [(false, 2.0), (true, 1.0)] {
                let [coarse, fine] = [512, 1024].map(|n| problem.errors(n, upwind));
                for norm in [0, 1] {
                    let rate = (coarse[norm] / fine[norm]).log2();
                    assert!((rate - order).abs() < 0.05, "{upwind} {norm}: {rate}");
                }
            }
        }
    }
}
