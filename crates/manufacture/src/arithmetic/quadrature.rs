//! Gauss-Legendre quadrature on panels of equal length.

/// Points on a panel.
pub(crate) const POINTS: usize = 10;

/// Points and weights of Gauss-Legendre quadrature on [0, 1], exact for polynomials of degree 2
/// `points` - 1.
///
/// The points are the zeros of the Legendre polynomial, found by Newton's method from the usual
/// cosines.
pub(crate) fn gauss(points: usize) -> Vec<[f64; 2]> {
    (0..points)
        .map(|index| gauss_point(index, points))
        .collect()
}

/// A point and its weight.
fn gauss_point(index: usize, points: usize) -> [f64; 2] {
    let n = points as f64;
    let mut x = (std::f64::consts::PI * (index as f64 + 0.75) / (n + 0.5)).cos();
    let mut slope = 0.0;
    for _ in 0..20 {
        let mut value = 1.0;
        let mut before = 0.0;
        for k in 0..points {
            let k = k as f64;
            let next = ((2.0 * k + 1.0) * x * value - k * before) / (k + 1.0);
            before = value;
            value = next;
        }
        slope = n * (x * value - before) / (x * x - 1.0);
        x -= value / slope;
    }
    [0.5 * (1.0 - x), 1.0 / ((1.0 - x * x) * slope * slope)]
}

/// Points and weights on an interval that is cut into panels.
pub(crate) fn panels(interval: [f64; 2], panels: usize, rule: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let [low, high] = interval;
    let width = (high - low) / panels as f64;
    let mut all = vec![];
    for panel in 0..panels {
        let left = low + panel as f64 * width;
        all.extend(
            rule.iter()
                .map(|[x, weight]| [left + width * x, width * weight]),
        );
    }
    all
}
