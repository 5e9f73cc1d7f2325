//! Richardson's estimate of an error from solutions at several steps.
//!
//! With `q_h = q + C h^p` two steps of ratio r, rh and h, give `q_{rh} - q_h = (r^p - 1) C h^p`: the difference is `r^p - 1`
//! times the error at the finer step.

use convergence_study::text::number::max_or_nan;

/// Below this an observed rate says that the sequence does not converge yet.
const LOWEST_RATE: f64 = 0.5;

/// `r^p - 1`: how many times the error at the finer step the difference of the two is.
pub(crate) fn growth(ratio: f64, order: f64) -> f64 {
    ratio.powf(order) - 1.0
}

/// The same in a norm in which the interpolation error is orthogonal to all the rest, so that squares add: `√(r^2p - 1)`.
pub(crate) fn orthogonal_growth(ratio: f64, order: f64) -> f64 {
    growth(ratio * ratio, order).sqrt()
}

/// What has to be added to the value at the finer step for the limit, steps being of the given ratio.
pub(crate) fn correction(coarse: f64, fine: f64, ratio: f64, order: f64) -> f64 {
    (fine - coarse) / growth(ratio, order)
}

/// The error at h from the differences of h against 2h (`fine`) and of 2h against 4h (`coarse`), and the observed rate.
///
/// A rate above the `order` of theory is not believed: near a zero of `fine` it would promise an error of nothing. It is
/// cut at the order, and the error is then read off `coarse`. Below ½ it is cut too.
pub(crate) fn error_and_rate(fine: f64, coarse: f64, order: f64) -> (f64, Option<f64>) {
    let rate = Some((coarse / fine).log2()).filter(|rate| rate.is_finite());
    let p = rate.map_or(order, |rate| rate.clamp(LOWEST_RATE, order));
    (max_or_nan(fine, coarse / 2f64.powf(p)) / growth(2.0, p), rate)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_clean_sequence_gives_its_error() {
        for p in [1.0_f64, 1.5, 2.0] {
            let q = |h: f64| 1.0 + 0.3 * h.powf(p);
            let (error, rate) = error_and_rate((q(0.2) - q(0.1)).abs(), (q(0.4) - q(0.2)).abs(), 2.0);
            assert!((error - 0.3 * 0.1_f64.powf(p)).abs() < 1e-12);
            assert!((rate.unwrap() - p).abs() < 1e-10);
            for ratio in [2.0, 3.0] {
                let limit = q(0.1) + correction(q(0.1 * ratio), q(0.1), ratio, p);
                assert!((limit - 1.0).abs() < 1e-14, "{limit}");
            }
        }
    }

    #[test]
    fn orthogonal_errors_add_by_their_squares() {
        // An error 3 h^p at h, orthogonal to that of the other mesh's interpolation: differences by Pythagoras.
        let (coarse, fine) = (3.0 * 4.0_f64, 3.0_f64);
        let difference = (coarse * coarse - fine * fine).sqrt();
        assert!((difference / orthogonal_growth(2.0, 2.0) - fine).abs() < 1e-14);
    }

    #[test]
    fn an_accidental_agreement_promises_nothing() {
        let (error, _) = error_and_rate(1e-9, 1e-3, 1.0);
        assert!(error > 4e-4, "{error}");
        let (error, rate) = error_and_rate(1e-3, 1e-3, 2.0);
        assert!(error > 2e-3 && rate == Some(0.0), "{error}");
    }

    #[test]
    fn nothing_moves_and_nothing_is_hidden() {
        assert_eq!(error_and_rate(0.0, 0.0, 2.0), (0.0, None));
        assert!(error_and_rate(f64::NAN, 1.0, 2.0).0.is_nan());
        assert!(error_and_rate(1.0, f64::NAN, 2.0).0.is_nan());
    }
}
