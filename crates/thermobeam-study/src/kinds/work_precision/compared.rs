//! Runs of several methods compared: the cheapest for an error, the front, and slopes, all from
//! what was measured.

use convergence_judge::fit::{Level as Point, fit_line};

use super::method::METHODS;
use convergence_study::chart::{Axis, Chart};

/// A run with its cost: counted work, or seconds.
#[derive(Debug, Clone, PartialEq)]
pub struct Costed {
    /// The method's name.
    pub method: String,
    /// Elements and steps in words.
    pub resolution: String,
    /// The error.
    pub error: f64,
    /// The cost.
    pub cost: f64,
}

/// The cheapest run of a method whose error is at most `error`.
pub fn cheapest<'r>(runs: &'r [Costed], method: &str, error: f64) -> Option<&'r Costed> {
    runs.iter()
        .filter(|run| run.method == method && run.error <= error)
        .min_by(|a, b| a.cost.total_cmp(&b.cost))
}

/// The runs, as (cost, error), that no other run beats in both, from cheapest to most expensive.
pub fn front(runs: impl IntoIterator<Item = (f64, f64)>) -> Vec<(f64, f64)> {
    let mut sorted: Vec<(f64, f64)> = runs.into_iter().collect();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let mut front: Vec<(f64, f64)> = vec![];
    for (cost, error) in sorted {
        if front.last().is_none_or(|&(_, best)| error < best) {
            front.push((cost, error));
        }
    }
    front
}

/// The slope of log error over log cost, by least squares over the finer half of a front; `None`
/// for fewer than three points.
///
/// A description of what was measured, used in legends alone.
fn slope(front: &[(f64, f64)]) -> Option<f64> {
    let half = &front[(front.len() / 2).min(front.len().saturating_sub(3))..];
    if half.len() < 3 {
        return None;
    }
    let points: Vec<Point> = half
        .iter()
        .map(|&(cost, error)| Point { step: cost, error })
        .collect();
    fit_line(&points).map(|line| line.slope)
}

/// Error over cost, all methods. The legend has the order in the cost, which is the power by which
/// the error of a one-step method falls; along the front of dG the degrees change, so that no power
/// describes it.
///
/// * `title`: what one should see.
/// * `cost`, `error`: labels of the axes.
pub fn figure(title: &str, cost: &str, error: &str, runs: &[Costed]) -> String {
    let mut chart = Chart::empty(Axis::log(cost), Axis::log(error)).titled(title);
    for (k, method) in METHODS.iter().enumerate() {
        let own = runs.iter().filter(|run| run.method == method.name);
        let points = front(
            own.map(|run| (run.cost, run.error))
                .filter(|(cost, error)| *cost > 0.0 && *error > 0.0 && error.is_finite()),
        );
        if points.is_empty() {
            continue;
        }
        let in_words = method.in_words;
        let power = method.one_step.and_then(|_| slope(&points));
        let label = match power {
            Some(power) => format!("{in_words}: order {:.2} in the cost", -power),
            None => in_words.to_owned(),
        };
        let curve = chart.curve(label, points);
        *curve = curve.clone().marked().styled(k);
    }
    chart.svg()
}
