//! The reference element [-1, 1]: hat functions and integrated Legendre polynomials.
//!
//! ```text
//! N_0 = (1 - ξ)/2,   N_1 = (1 + ξ)/2,   N_m = (P_m - P_{m-2})/√(2(2m - 1)) for m >= 2,
//! ```
//!
//! so that `N_m' = √((2m - 1)/2) P_{m-1}` are orthonormal. The stiffness of the N_m is the
//! identity, their mass couples m with m ± 2, and `C_ij = (N_j, N_i')` couples m with m ± 1. The
//! hats couple with N_2 and N_3 only. Source: Szabó and Babuška, *Finite Element Analysis*, section
//! 6.2.

use super::legendre;

/// The highest degree: above it round-off of the quadrature costs more than a degree gains.
pub const MAX_DEGREE: usize = 40;

/// `∫ P_i P_j = 2/(2i + 1)` for i = j.
fn product(i: usize, j: usize) -> f64 {
    if i == j {
        2.0 / (2 * i + 1) as f64
    } else {
        0.0
    }
}

/// N_m as a sum of at most two Legendre polynomials: degrees and factors.
fn expansion(m: usize) -> [(usize, f64); 2] {
    match m {
        0 => [(0, 0.5), (1, -0.5)],
        1 => [(0, 0.5), (1, 0.5)],
        _ => {
            let factor = 1.0 / (2.0 * (2 * m - 1) as f64).sqrt();
            [(m, factor), (m - 2, -factor)]
        }
    }
}

/// N_m' as a multiple of one Legendre polynomial.
fn slope(m: usize) -> (usize, f64) {
    match m {
        0 => (0, -0.5),
        1 => (0, 0.5),
        _ => (m - 1, (0.5 * (2 * m - 1) as f64).sqrt()),
    }
}

/// `∫ N_i N_j dξ`.
pub fn mass(i: usize, j: usize) -> f64 {
    expansion(i)
        .iter()
        .flat_map(|(k, a)| expansion(j).map(|(l, b)| a * b * product(*k, l)))
        .sum()
}

/// `∫ N_i' N_j' dξ`: 1 for i = j >= 2.
pub fn stiffness(i: usize, j: usize) -> f64 {
    if i >= 2 || j >= 2 {
        return if i == j { 1.0 } else { 0.0 };
    }
    if i == j { 0.5 } else { -0.5 }
}

/// `∫ N_j N_i' dξ`, the same on every element.
pub fn coupling(i: usize, j: usize) -> f64 {
    let (k, a) = slope(i);
    expansion(j)
        .iter()
        .map(|(l, b)| a * b * product(k, *l))
        .sum()
}

/// `∫ N_i dξ`.
pub(super) fn integral(i: usize) -> f64 {
    expansion(i).iter().map(|(k, a)| a * product(*k, 0)).sum()
}

/// N_0(ξ), ..., N_p(ξ), and their derivatives by ξ.
pub(super) struct Basis {
    /// N_m(ξ).
    pub(super) values: [f64; MAX_DEGREE + 1],
    /// N_m'(ξ).
    pub(super) slopes: [f64; MAX_DEGREE + 1],
}

impl Basis {
    /// Of degree p, at ξ.
    pub(super) fn at(xi: f64, degree: usize) -> Self {
        let mut legendre = [0.0; MAX_DEGREE + 1];
        legendre::values_into(xi, &mut legendre[..=degree]);
        let (mut values, mut slopes) = ([0.0; MAX_DEGREE + 1], [0.0; MAX_DEGREE + 1]);
        for m in 0..=degree {
            values[m] = expansion(m).iter().map(|(k, a)| a * legendre[*k]).sum();
            let (k, a) = slope(m);
            slopes[m] = a * legendre[k];
        }
        Self { values, slopes }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_entry_is_its_integral() {
        let points = legendre::gauss(13);
        let points = points
            .into_iter()
            .map(|(xi, weight)| (Basis::at(xi, 12), weight));
        let points: Vec<_> = points.collect();
        let near = |found: f64, f: &dyn Fn(&Basis) -> f64| {
            let exact: f64 = points.iter().map(|(basis, weight)| weight * f(basis)).sum();
            assert!((found - exact).abs() < 1e-14, "{found}, not {exact}");
        };
        for i in 0..=12 {
            near(integral(i), &|b| b.values[i]);
            for j in 0..=12 {
                near(mass(i, j), &|b| b.values[i] * b.values[j]);
                near(stiffness(i, j), &|b| b.slopes[i] * b.slopes[j]);
                near(coupling(i, j), &|b| b.slopes[i] * b.values[j]);
            }
        }
    }
}
