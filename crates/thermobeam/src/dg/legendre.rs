//! Legendre polynomials: values, Gauss points, and polynomials in time on the unit interval.

/// P_0(x), P_1(x), ... for x in [-1, 1].
fn values(x: f64) -> impl Iterator<Item = f64> {
    let mut previous = 0.0;
    let mut next = 1.0;
    (0..).map(move |n: u32| {
        let n = f64::from(n);
        let value = next;
        next = ((2.0 * n + 1.0) * x * value - n * previous) / (n + 1.0);
        previous = value;
        value
    })
}

/// P_0(x), P_1(x), ... up to the length of `places`, for x in [-1, 1].
pub(super) fn values_into(x: f64, places: &mut [f64]) {
    for (place, value) in places.iter_mut().zip(values(x)) {
        *place = value;
    }
}

/// P_0'(x), P_1'(x), ... from the values: `P_{n+1}' = P_{n-1}' + (2n + 1) P_n`.
pub(super) fn derivatives_into(values: &[f64], derivatives: &mut [f64]) {
    for n in 0..derivatives.len() {
        derivatives[n] = match n {
            0 => 0.0,
            1 => 1.0,
            _ => derivatives[n - 2] + (2 * n - 1) as f64 * values[n - 1],
        };
    }
}

/// Points and weights on [-1, 1] that integrate polynomials of degree 2 `count` - 1 exactly.
pub(super) fn gauss(count: usize) -> Vec<(f64, f64)> {
    let half = (1..=count / 2).map(|i| {
        // Newton's method from Tricomi's estimate reaches round-off within four steps for every
        // count.
        let mut x = (std::f64::consts::PI * (i as f64 - 0.25) / (count as f64 + 0.5)).cos();
        for _ in 0..6 {
            let (value, slope) = value_and_slope(count, x);
            x -= value / slope;
        }
        x
    });
    let mut points: Vec<f64> = half.flat_map(|x| [x, -x]).collect();
    if count % 2 == 1 {
        points.push(0.0);
    }
    points.sort_by(f64::total_cmp);
    points
        .into_iter()
        .map(|x| (x, gauss_weight(count, x)))
        .collect()
}

/// The weight of a Gauss point x.
fn gauss_weight(count: usize, x: f64) -> f64 {
    let (_, slope) = value_and_slope(count, x);
    2.0 / ((1.0 - x * x) * slope * slope)
}

/// P_n(x) and P_n'(x).
fn value_and_slope(n: usize, x: f64) -> (f64, f64) {
    let mut values = vec![0.0; n + 1];
    let mut derivatives = vec![0.0; n + 1];
    values_into(x, &mut values);
    derivatives_into(&values, &mut derivatives);
    (values[n], derivatives[n])
}

/// `Σ_j c_j L_j(s)`, with `L_j(s) = P_j(2s - 1)` the Legendre polynomials of [0, 1].
pub(super) fn sum(coefficients: &[f64], s: f64) -> f64 {
    let products = coefficients.iter().zip(values(2.0 * s - 1.0));
    products
        .map(|(coefficient, value)| coefficient * value)
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gauss_points_integrate_powers_exactly() {
        for count in 1..=60 {
            let points = gauss(count);
            for power in 0..(2 * count).min(90) {
                let integral: f64 = points
                    .iter()
                    .map(|(x, weight)| weight * x.powi(power as i32))
                    .sum();
                let exact = if power % 2 == 0 {
                    2.0 / (power + 1) as f64
                } else {
                    0.0
                };
                assert!(
                    (integral - exact).abs() < 4e-15,
                    "{count} points, x^{power}: {integral}"
                );
            }
        }
    }
}
