//! Stumpff functions: cosine, sine and their divided remainders, smooth for arguments of either
//! sign.
//!
//! `c_k(x) = Σ_i (-x)^i / (k + 2i)!`, so that `c_0(k²) = cos k`, `c_0(-k²) = cosh k`,
//! `c_1(k²) = sin k / k` and `c_{k+2} = (1/k! - c_k)/x`. All are entire. In terms of them the
//! solution of a beam equation whose characteristic roots pass from real to imaginary needs no case
//! distinction and no division by zero.
//!
//! Each has an error of a few units of round-off of 1/k!, its size near x = 0. c_3 and c_5 are
//! meant for x > -10.
//!
//! Source: K. Stumpff, *Himmelsmechanik* I (1959), chapter V.

/// Up to this |x| the series of c_3 and c_5 lose no digits, and beyond it the recurrence loses
/// none.
const SERIES_UP_TO: f64 = 10.0;

/// Number of terms: the last is below 1e-40 for |x| <= 10.
const TERMS: usize = 24;

/// `cos √x`, or `cosh √-x`.
pub(crate) fn c0(x: f64) -> f64 {
    if x >= 0.0 {
        x.sqrt().cos()
    } else {
        (-x).sqrt().cosh()
    }
}

/// `sin √x / √x`, or `sinh √-x / √-x`; 1 at 0.
pub(crate) fn c1(x: f64) -> f64 {
    let root = x.abs().sqrt();
    if root == 0.0 {
        1.0
    } else if x > 0.0 {
        root.sin() / root
    } else {
        root.sinh() / root
    }
}

/// `(1 - cos √x) / x`; 1/2 at 0.
pub(crate) fn c2(x: f64) -> f64 {
    // The half-angle formula, because 1 - cos cancels for small x.
    0.5 * c1(0.25 * x).powi(2)
}

/// `(1 - c_1(x)) / x`; 1/6 at 0.
pub(crate) fn c3(x: f64) -> f64 {
    if x.abs() <= SERIES_UP_TO {
        series(1.0 / 6.0, 3.0, x)
    } else {
        (1.0 - c1(x)) / x
    }
}

/// `(1/6 - c_3(x)) / x`; 1/120 at 0.
pub(crate) fn c5(x: f64) -> f64 {
    if x.abs() <= SERIES_UP_TO {
        series(1.0 / 120.0, 5.0, x)
    } else {
        (1.0 / 6.0 - c3(x)) / x
    }
}

/// The defining series, from its first term 1/k!.
fn series(first: f64, k: f64, x: f64) -> f64 {
    let (mut term, mut sum) = (first, first);
    for i in 0..TERMS {
        let n = k + 2.0 * i as f64;
        term *= -x / ((n + 1.0) * (n + 2.0));
        sum += term;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn close(found: f64, expected: f64, tolerance: f64) {
        assert!(
            (found - expected).abs() <= tolerance,
            "{found} is not {expected} to {tolerance}"
        );
    }

    #[test]
    fn the_recurrence_holds_on_both_sides_of_zero() {
        for i in -90..=900 {
            let x = f64::from(i) * 0.1;
            close(x * c2(x), 1.0 - c0(x), 4e-15 * (1.0 + c0(x).abs()));
            close(x * c3(x), 1.0 - c1(x), 4e-15);
            close(x * c5(x), 1.0 / 6.0 - c3(x), 4e-15);
        }
    }

    #[test]
    fn series_and_recurrence_agree_where_they_meet() {
        let (below, above) = (SERIES_UP_TO, SERIES_UP_TO * (1.0 + f64::EPSILON));
        close(c3(below), c3(above), 2e-16);
        close(c5(below), c5(above), 2e-17);
    }

    #[test]
    fn values_at_zero_are_inverse_factorials() {
        let found = [c0(0.0), c1(0.0), c2(0.0), c3(0.0), c5(0.0)];
        assert_eq!(found, [1.0, 1.0, 0.5, 1.0 / 6.0, 1.0 / 120.0]);
    }
}
