//! What a variant does to the exact fields.

use std::collections::BTreeMap;

/// Exact fields that are replaced by others made of them, one step after the other.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Variation {
    pub(crate) steps: Vec<Step>,
    /// The one field that is changed; all are without it.
    pub(crate) field: Option<String>,
    /// Added to the components of a field, so that what must be positive stays so.
    pub(crate) lifts: BTreeMap<String, Vec<f64>>,
}

/// A change of a function.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Step {
    /// A variable set to a value.
    Fix { variable: usize, at: f64 },
    /// The polynomial subtracted that has the function's derivatives at the ends.
    Flatten(Flattening),
}

/// A function u becomes u - H u, which vanishes at each end of an interval with its derivatives up
/// to `degree`.
///
/// At one end a H is the Taylor polynomial. At two ends a and b with m = `degree` it is Hermite's:
/// with w_a(x) = (x - b)^(m+1) and w_b alike, H u is the sum over the ends of w_e T_e(u/w_e), T_e
/// the Taylor polynomial of degree m. Each summand has the derivatives of u at its own end, and
/// those of zero at the other.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Flattening {
    pub(crate) variable: usize,
    /// One or two.
    pub(crate) ends: Vec<f64>,
    pub(crate) degree: usize,
}

/// The polynomial that belongs to a derivative at an end: (x - other)^power times a polynomial in
/// x - end.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Carrier {
    pub(crate) other: f64,
    pub(crate) power: usize,
    /// By the power of x - end.
    pub(crate) coefficients: Vec<f64>,
}

impl Variation {
    /// Whether it changes that field.
    pub(crate) fn concerns(&self, field: &str) -> bool {
        self.field.as_deref().is_none_or(|only| only == field)
    }
}

impl Flattening {
    /// The polynomial whose derivative of that order at an end is 1, and all others at the ends 0.
    pub(crate) fn carrier(&self, end: f64, derivative: usize) -> Carrier {
        let factorial: f64 = (1..=derivative).map(|k| k as f64).product();
        let other = self.ends.iter().find(|other| **other != end);
        let Some(&other) = other else {
            let mut coefficients = vec![0.0; derivative + 1];
            coefficients[derivative] = 1.0 / factorial;
            return Carrier {
                other: end,
                power: 0,
                coefficients,
            };
        };
        let power = self.degree + 1;
        // Taylor coefficients of (x - other)^-power at the end.
        let length = end - other;
        let mut inverse = length.powi(-(power as i32)) / factorial;
        let mut coefficients = vec![0.0; derivative];
        for k in 0..=self.degree - derivative {
            coefficients.push(inverse);
            inverse *= -((power + k) as f64) / ((k + 1) as f64 * length);
        }
        Carrier {
            other,
            power,
            coefficients,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The derivatives of a carrier at a point, by differences of its polynomial.
    fn taylor(carrier: &Carrier, end: f64, at: f64, count: usize) -> Vec<f64> {
        // Coefficients in x - at, by repeated division of values on Chebyshev-like points would
        // lose digits: the polynomial is shifted instead.
        let shifted = |roots: f64, power: usize| {
            let mut product = vec![1.0];
            for _ in 0..power {
                let mut next = vec![0.0; product.len() + 1];
                for (k, c) in product.iter().enumerate() {
                    next[k] += c * (at - roots);
                    next[k + 1] += c;
                }
                product = next;
            }
            product
        };
        let weight = shifted(carrier.other, carrier.power);
        let mut sum = vec![0.0; count.max(weight.len() + carrier.coefficients.len())];
        for (power, coefficient) in carrier.coefficients.iter().enumerate() {
            for (i, a) in shifted(end, power).iter().enumerate() {
                for (j, b) in weight.iter().enumerate() {
                    sum[i + j] += coefficient * a * b;
                }
            }
        }
        let mut factorial = 1.0;
        let mut derivatives = vec![];
        for (k, c) in sum.iter().take(count).enumerate() {
            factorial *= k.max(1) as f64;
            derivatives.push(c * factorial);
        }
        derivatives
    }

    #[test]
    fn a_carrier_has_one_derivative_at_its_end_and_none_elsewhere() {
        for ends in [vec![0.5], vec![2.5], vec![0.5, 2.5]] {
            let flattening = Flattening {
                variable: 0,
                ends: ends.clone(),
                degree: 3,
            };
            for end in &ends {
                for order in 0..=3 {
                    let carrier = flattening.carrier(*end, order);
                    for at in &ends {
                        let found = taylor(&carrier, *end, *at, 4);
                        for (k, value) in found.iter().enumerate() {
                            let expected = f64::from(u8::from(at == end && k == order));
                            let difference = (value - expected).abs();
                            assert!(difference < 1e-11, "{ends:?} {end} {order} {at}: {found:?}");
                        }
                    }
                }
            }
        }
    }
}
