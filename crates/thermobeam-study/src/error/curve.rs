//! Errors of curves: numbers over time, at the same times.

use convergence_study::text::number::max_or_nan;

/// Largest difference of two curves at the same times; NaN where there is one, or where the curves do not match.
pub(crate) fn distance(a: &[f64], b: &[f64]) -> f64 {
    if a.len() != b.len() || a.is_empty() {
        return f64::NAN;
    }
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, max_or_nan)
}
