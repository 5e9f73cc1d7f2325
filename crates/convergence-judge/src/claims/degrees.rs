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

/// A law of the degree p whose factors tend to 1.
struct SlowerLaw {
    words: &'static str,
    /// The number over which log e is a straight line.
    over: fn(f64) -> f64,
}

const SLOWER: [SlowerLaw; 2] = [
    SlowerLaw {
        words: "a power of the degree",
        over: f64::ln,
    },
    // Elements of rising degree on meshes graded towards a corner.
    SlowerLaw {
        words: "exp(-c √p) of the degree p",
        over: f64::sqrt,
    },
];

/// The same rate over [steps of degrees](step_of_degree): it does not pass where the errors fall
/// like a power of the degree p, or like exp(-c √p), whose factors tend to 1. Then log e is nearer
/// to a straight line over log p, or √p, than to one over p.
pub fn unless_algebraic(levels: &[Level], rate: RateVerdict) -> RateVerdict {
    let used = levels.get(rate.used.clone()).unwrap_or_default();
    let degrees: Vec<f64> = used.iter().map(|level| -level.step.ln()).collect();
    let heights: Vec<f64> = used.iter().map(|level| level.error.ln()).collect();
    let left_by_line = |over: fn(f64) -> f64| {
        let x: Vec<f64> = degrees.iter().copied().map(over).collect();
        let [constant, slope] = line(&x, &heights);
        squares(&heights, |k| constant + slope * x[k])
    };
    let by_factor = left_by_line(|degree| degree);
    let mut slower = SLOWER.iter();
    match slower.find(|law| left_by_line(law.over) < by_factor) {
        Some(SlowerLaw { words, .. }) if rate.verdict.is_pass() => {
            let because = format!("the errors fall like {words}, whose factors tend to 1");
            rate.with_reason(Reason::Departs, &because)
        }
        _ => rate,
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
        let of_root = |p: f64| Level {
            step: step_of_degree(p),
            error: 3.0 * (-2.0 * p.sqrt()).exp(),
        };
        let roots: Vec<Level> = (1..9).map(f64::from).map(of_root).collect();
        assert!(!passes(&roots, 1.4));
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
