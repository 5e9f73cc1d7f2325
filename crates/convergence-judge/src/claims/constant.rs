//! The constant of an error `C h^p`, which a mistake of the scheme's own order changes.

use crate::fit::{Level, MOST_USED};
use crate::interval::Interval;
use crate::verdict::{RateVerdict, Reason, against_claim};

/// Half-width of the interval of a constant, in half-widths of the interval of the rate over the
/// finest refinement: it then holds the constant of errors with noise and pollution at least 9
/// times in 10 for any number of levels.
const DOUBT_OF_A_CONSTANT: f64 = 5.0;

/// The interval of the constant C of `e = C h^p` at h → 0, p being the order claimed; `None`
/// without a rate or a claim.
///
/// Beyond the finest level, h and e, the rates are assumed to approach p from q, the finest, as
/// under pollution of first order: of `e = C h^p (1 + b h)` the finest refinement, by ρ, has
/// `(q - p) log ρ = b h (ρ - 1)`, so that `log C` is `log(e / h^p) - (q - p) log ρ / (ρ - 1)`. Five
/// half-widths of the rate's interval, times log ρ, and over ρ - 1 where that is less than 1, allow
/// for slower pollution and for scatter. Where more than five levels are used, they scatter: e and
/// q are those of their line.
pub fn constant(levels: &[Level], rate: &RateVerdict) -> Option<Interval> {
    let order = rate.order()?;
    let interval = rate.interval?;
    let [.., before, finest] = levels.get(rate.used.clone())? else {
        return None;
    };
    let ratio = (before.step / finest.step).ln();
    let polluted = ratio / ratio.exp_m1();
    let scatters = rate.used.len() > MOST_USED;
    let law = rate.power_law().filter(|_| scatters);
    let pair = (before.error / finest.error).ln() / ratio;
    let [error, last] = law.map_or([finest.error, pair], |law| {
        [law.error_at(finest.step), law.rate]
    });
    let middle = error.ln() - order * finest.step.ln() + (order - last) * polluted;
    let half = DOUBT_OF_A_CONSTANT * 0.5 * interval.width() * ratio.max(polluted);
    Some(Interval::around(middle, half).map(f64::exp))
}

/// The same rate, whose constant must also lie between two numbers: a mistake of the scheme's own
/// order changes nothing else.
pub fn with_constant(levels: &[Level], rate: RateVerdict, claimed: Interval) -> RateVerdict {
    if !rate.verdict.is_pass() {
        return rate;
    }
    let Some(Interval { low, high }) = constant(levels, &rate) else {
        return rate;
    };
    let kind = if high < claimed.low || low > claimed.high {
        Reason::ConstantOff
    } else if low < claimed.low || high > claimed.high {
        Reason::ConstantUnsure
    } else {
        return rate;
    };
    let interval = format!("{low:.4} to {high:.4}");
    let numbers = against_claim(&interval, &format!("{} to {}", claimed.low, claimed.high));
    rate.with_reason(kind, &format!("{} ({numbers})", kind.text()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::claims::any_above;
    use crate::tests::halved;
    use crate::verdict::judge;

    fn judged(levels: &[Level]) -> RateVerdict {
        judge(levels, 2.0, 0.25)
    }

    #[test]
    fn a_constant_is_held_against_its_interval() {
        let with = |levels: &[Level], least: f64, most: f64| {
            let between = Interval {
                low: least,
                high: most,
            };
            with_constant(levels, judged(levels), between).code
        };
        let smooth = halved(0.5, 6, |h| 3.0 * h * h * (1.0 + 0.3 * h));
        let Interval { low, high } = constant(&smooth, &judged(&smooth)).expect("a rate");
        assert!(low < 3.0 && 3.0 < high && high / low < 1.1, "{low} {high}");
        assert_eq!(with(&smooth, 2.7, 3.3), Reason::Agrees);
        assert_eq!(with(&smooth, 3.3, 4.0), Reason::ConstantOff);
        assert_eq!(with(&smooth, 2.0, 2.7), Reason::ConstantOff);
        assert_eq!(with(&smooth, 3.0, 4.0), Reason::ConstantUnsure);
        assert_eq!(with(&smooth, 2.0, 3.0), Reason::ConstantUnsure);
        let lost = halved(0.5, 6, |h| 3.0 * h);
        assert_eq!(with(&lost, 2.7, 3.3), Reason::TooLow);
        assert_eq!(constant(&smooth, &judged(&smooth[..2])), None);
    }

    #[test]
    fn the_constant_of_steps_of_any_ratio_is_that_at_zero() {
        for ratio in [1.2_f64, 1.5, 2.0, 10.0] {
            for r in [1.0 / 3.0, 0.5, 1.0] {
                let level = |k: i32| {
                    let step = 0.1 * ratio.powi(-k);
                    let error = step.powi(2) * (1.0 + 0.5 * step.powf(r));
                    Level { step, error }
                };
                let levels: Vec<Level> = (0..5).map(level).collect();
                let rate = any_above(judged(&levels));
                let found = constant(&levels, &rate).expect("a rate");
                assert!(
                    found.low < 1.0 && 1.0 < found.high,
                    "{ratio} {r}: {found:?}"
                );
            }
        }
    }
}
