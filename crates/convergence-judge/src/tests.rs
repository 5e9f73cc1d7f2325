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
