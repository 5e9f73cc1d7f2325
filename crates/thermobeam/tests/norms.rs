//! Norms of P1 functions and a maximum that keeps NaN, by formulas that are not the solver's.

/// The larger of two numbers; NaN if either is NaN, which `f64::max` would drop.
pub(crate) fn max_or_nan(a: f64, b: f64) -> f64 {
    if a.is_nan() || a >= b { a } else { b }
}

/// `‖y‖²`, by `h (y0² + y0 y1 + y1²)/3` on each element.
///
/// * `lengths`: the n element lengths; `y`: the n + 1 nodal values.
pub(crate) fn l2_squared(lengths: &[f64], y: &[f64]) -> f64 {
    let elements = lengths.iter().zip(y.windows(2));
    elements
        .map(|(h, y)| h * (y[0] * y[0] + y[0] * y[1] + y[1] * y[1]) / 3.0)
        .sum()
}

/// `‖y_x‖²`; arguments as in [`l2_squared`].
pub(crate) fn slope_squared(lengths: &[f64], y: &[f64]) -> f64 {
    let elements = lengths.iter().zip(y.windows(2));
    elements.map(|(h, y)| (y[1] - y[0]).powi(2) / h).sum()
}

/// `a - b`, value by value.
pub(crate) fn minus(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}
