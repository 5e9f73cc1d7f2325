//! Errors over the degree of the elements, or over another count: each more divides them by a factor.

use crate::fit::Level;
use crate::verdict::{RateVerdict, Reason, line, squares};

/// The step for judging an error over degrees: `e = C F^-p` is a power `e = C step^(log F)` of it.
///
/// * `degree`: p or q of the elements, or another count; each increment divides the error by the
///   factor.
pub fn step_of_degree(degree: f64) -> f64 {
    (-degree).exp()
}

/// The order in [`step_of_degree`] of an error that falls by this factor per degree; > 0 for a
/// factor > 1.
pub fn order_of_factor(factor: f64) -> f64 {
    factor.ln()
}

/// The same rate over [steps of degrees](step_of_degree): it does not pass where the errors fall
/// like a power of the degree, whose factors tend to 1. Then log e is nearer to a straight line
/// over log p than to one over p.
pub fn unless_algebraic(levels: &[Level], rate: RateVerdict) -> RateVerdict {
    let used = levels.get(rate.used.clone()).unwrap_or_default();
    let degrees: Vec<f64> = used.iter().map(|level| -level.step.ln()).collect();
    let logarithms: Vec<f64> = degrees.iter().map(|degree| degree.ln()).collect();
    let heights: Vec<f64> = used.iter().map(|level| level.error.ln()).collect();
    let left_by_line = |x: &[f64]| {
        let [constant, slope] = line(x, &heights);
        squares(&heights, |k| constant + slope * x[k])
    };
    if rate.verdict.is_pass() && left_by_line(&logarithms) < left_by_line(&degrees) {
        let because = "the errors fall like a power of the degree, whose factors tend to 1";
        rate.with_reason(Reason::Departs, because)
    } else {
        rate
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::claims::any_above;
    use crate::verdict::{Verdict, judge};

    fn judged(levels: &[Level], order: f64) -> RateVerdict {
        judge(levels, order, 0.25)
    }

    #[test]
    fn errors_over_degrees_have_a_factor() {
        let by_factor = |factor: f64| {
            let levels = (1..6).map(f64::from).map(|p| Level {
                step: step_of_degree(p),
                error: 3.0 * factor.powf(-p),
            });
            levels.collect::<Vec<_>>()
        };
        let passes = |levels: &[Level], factor| {
            let rate = any_above(judged(levels, order_of_factor(factor)));
            assert!(rate.verdict.is_pass(), "{rate:?}");
            unless_algebraic(levels, rate).verdict.is_pass()
        };
        assert!(passes(&by_factor(5.0), 5.0));
        let algebraic = [2.0, 4.0, 8.0, 16.0, 32.0_f64].map(|p| Level {
            step: step_of_degree(p),
            error: p.powi(-6),
        });
        assert!(!passes(&algebraic, 1.5));
        assert_eq!(
            judged(&by_factor(5.0), order_of_factor(5.0)).verdict,
            Verdict::Pass
        );
        assert_eq!(
            judged(&by_factor(3.0), order_of_factor(5.0)).code,
            Reason::TooLow
        );
        assert_eq!(
            any_above(judged(&by_factor(9.0), order_of_factor(5.0))).verdict,
            Verdict::Pass
        );
    }
}
