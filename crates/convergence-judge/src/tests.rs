//! Levels for tests: steps that are halved, and errors at them.

use crate::fit::Level;

/// Steps that are halved, and errors by a law.
pub(crate) fn halved(first: f64, count: usize, mut error: impl FnMut(f64) -> f64) -> Vec<Level> {
    let steps = (0..count).map(|k| first * 0.5_f64.powi(k as i32));
    let level = |step| Level {
        step,
        error: error(step),
    };
    steps.map(level).collect()
}

/// The same with these errors.
pub(crate) fn with_errors(first: f64, errors: &[f64]) -> Vec<Level> {
    let mut next = errors.iter();
    halved(first, errors.len(), |_| {
        next.next().copied().unwrap_or(f64::NAN)
    })
}

/// Scatter without a trend, of standard deviation 1.
pub(crate) const SCATTER: [f64; 8] = [1.2, -0.8, 0.5, -1.1, 0.9, -0.4, 1.0, -1.2];

/// Steps that are halved from 1 on, and errors by a law of a step and its scatter.
pub(crate) fn scattered(count: usize, error: impl Fn(f64, f64) -> f64) -> Vec<Level> {
    let mut scatter = SCATTER.into_iter();
    halved(1.0, count, |h| error(h, scatter.next().expect("a number")))
}
