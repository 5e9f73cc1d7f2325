//! What may be the cause where a claim does not pass: laws that no model of the rule has. Advice,
//! no part of the verdict.

use crate::fit::{Level, POLLUTION_EXPONENTS};

/// A law explains errors that it misses by at most this share.
const EXPLAINED: f64 = 1e-3;

/// Least share by which a logarithm changes the errors between the first level and the last.
const LEAST_CHANGE: f64 = 0.05;

/// Numbers of levels that are explained: with fewer two constants explain too much, and no table of
/// errors has more.
const EXPLAINED_LEVELS: std::ops::RangeInclusive<usize> = 4..=30;

/// A law that explains the errors and the order claimed.
///
/// ```
/// use convergence_judge::{Cause, Level, judge};
///
/// let levels = [0.1, 0.05, 0.025, 0.0125, 0.00625]
///     .map(|step: f64| Level { step, error: step * step * (1.0 / step).ln() });
/// let rate = judge(&levels, 2.0, 0.1);
/// assert!(!rate.verdict.is_pass());
/// assert_eq!(rate.cause, Some(Cause::Logarithm));
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Cause {
    /// `e = |C (h^p + b h^(p + r))|`, whose terms cancel between two levels.
    SignChange,
    /// `e = C h^p (L - log h)`.
    Logarithm,
}

impl Cause {
    /// Both, for listing.
    pub const ALL: [Self; 2] = [Self::SignChange, Self::Logarithm];

    /// What the cause means, and what to do.
    pub fn advice(self) -> &'static str {
        match self {
            Self::SignChange => {
                "The error may change its sign between levels: C (h^p + b h^(p+r)), with the sign of the coarse levels \
                 turned, has the order claimed and explains all of them. Leave out the levels before the change and add \
                 finer ones, or judge a norm, which has no sign."
            }
            Self::Logarithm => {
                "A logarithm may be at work: C h^p (L - log h) has the order claimed and explains all levels. If theory \
                 has it, judge the errors divided by it; no number of levels makes their rate p to within a narrow tolerance."
            }
        }
    }

    /// The cause of errors that are not of this order as they stand; `None` if no such law explains
    /// them.
    ///
    /// * `doubt`: the share of the error at a level that its digits leave open.
    pub fn of(levels: &[Level], order: f64, doubt: impl Fn(usize) -> f64) -> Option<Self> {
        let first = levels.first()?.step;
        if !EXPLAINED_LEVELS.contains(&levels.len())
            || !levels.iter().all(has_logarithms)
            || !order.is_finite()
        {
            return None;
        }
        if is_plain(levels, &doubt) {
            return None;
        }
        // In units of h^p: a + b x(h).
        let heights: Vec<f64> = levels
            .iter()
            .map(|level| level.error / (level.step / first).powf(order))
            .collect();
        let allowed = |k: usize, unit: f64| EXPLAINED * unit + doubt(k) * heights[k];
        let logarithms: Vec<f64> = levels
            .iter()
            .map(|level| (first / level.step).ln())
            .collect();
        let [_, slope] = line(&logarithms, &heights);
        let highest = heights.iter().copied().fold(0.0, f64::max);
        let change = slope * logarithms[levels.len() - 1];
        if change > LEAST_CHANGE * highest
            && explains(&logarithms, &heights, |k| allowed(k, highest))
        {
            return Some(Self::Logarithm);
        }
        for r in POLLUTION_EXPONENTS {
            let powers: Vec<f64> = logarithms.iter().map(|x| (-r * x).exp()).collect();
            // The sign of the coarse levels turned, up to each level but the last.
            let mut signed = heights.clone();
            for k in 0..levels.len() - 1 {
                signed[k] = -heights[k];
                let [constant, _] = line(&powers, &signed);
                if explains(&powers, &signed, |k| allowed(k, constant)) {
                    return Some(Self::SignChange);
                }
            }
        }
        None
    }
}

/// Whether a plain power `C h^q`, of any order, explains the errors within their digits: then no
/// other law is needed.
fn is_plain(levels: &[Level], doubt: impl Fn(usize) -> f64) -> bool {
    let steps: Vec<f64> = levels.iter().map(|level| level.step.ln()).collect();
    let errors: Vec<f64> = levels.iter().map(|level| level.error.ln()).collect();
    explains(&steps, &errors, |k| EXPLAINED + doubt(k))
}

/// Whether error and step have logarithms.
fn has_logarithms(level: &Level) -> bool {
    level.error > 0.0 && level.error.is_finite() && level.step > 0.0
}

/// The least-squares line a + b x.
pub(crate) fn line(x: &[f64], heights: &[f64]) -> [f64; 2] {
    let count = x.len() as f64;
    let [mean_x, mean] = [x, heights].map(|values| values.iter().sum::<f64>() / count);
    let square: f64 = x.iter().map(|x| (x - mean_x).powi(2)).sum();
    let slope = x
        .iter()
        .zip(heights)
        .map(|(x, height)| (x - mean_x) * (height - mean))
        .sum::<f64>()
        / square;
    [mean - slope * mean_x, slope]
}

/// Whether that line misses no level by more than is allowed there.
fn explains(x: &[f64], heights: &[f64], allowed: impl Fn(usize) -> f64) -> bool {
    let [constant, slope] = line(x, heights);
    (0..x.len()).all(|k| (constant + slope * x[k] - heights[k]).abs() <= allowed(k))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::{halved, with_errors};

    fn cause(count: usize, first: f64, order: f64, error: impl Fn(f64) -> f64) -> Option<Cause> {
        let levels = halved(first, count, |h| error(h).abs());
        Cause::of(&levels, order, |_| 0.0)
    }

    #[test]
    fn errors_that_change_their_sign_and_logarithms_are_recognised_with_their_order_alone() {
        for (count, first, factor) in [(4, 0.1, 24.2), (5, 0.1, 125.0)] {
            let error = |h: f64| h * h - factor * h.powi(3);
            assert_eq!(
                cause(count, first, 2.0, error),
                Some(Cause::SignChange),
                "{factor}"
            );
            assert_eq!(cause(count, first, 1.5, error), None, "{factor}");
        }
        let logarithm = |h: f64| h * h * h.ln();
        assert_eq!(cause(7, 0.125, 2.0, logarithm), Some(Cause::Logarithm));
        assert_eq!(cause(7, 0.125, 2.1, logarithm), None);
        assert_eq!(cause(3, 0.125, 2.0, logarithm), None, "three levels");
    }

    #[test]
    fn other_laws_have_no_such_cause() {
        for error in [
            |h: f64| h * h,
            |h: f64| h * h * (1.0 + 3.0 * h),
            |h: f64| h.powf(1.8),
            |h: f64| h * h + 0.03 * h,
            |h: f64| h * h + 1e-3,
            |h: f64| h * h * (1.0 + 0.03 * (1.0 / h).sin()),
        ] {
            assert_eq!(cause(5, 0.1, 2.0, error), None);
        }
        let zero = halved(1.0, 4, |_| 0.0);
        assert_eq!(Cause::of(&zero, 2.0, |_| 0.0), None);
    }

    #[test]
    fn a_plain_law_needs_no_cause_however_few_its_digits() {
        let levels = with_errors(0.1, &[0.1, 0.05, 0.02, 0.01]);
        assert_eq!(Cause::of(&levels, 2.0, |_| 0.25), None);
    }

    #[test]
    fn digits_that_are_missing_explain_as_much_as_they_may() {
        let levels = with_errors(0.1, &[0.0142, 5.25e-4, 2.47e-4, 1.09e-4]);
        assert_eq!(Cause::of(&levels, 2.0, |_| 0.005), Some(Cause::SignChange));
    }
}
