//! Errors that are those of another level, or of no discretization at all: nothing may be read from
//! their rates.

use super::reason::{REPEATED, Reason};
use super::trend::Rates;
use super::words::Verdict;
use super::{FEWEST_LEVELS, Floor, RateVerdict};
use crate::fit::Level;

/// Fewest digits whose repetition is no chance.
const FEWEST_DIGITS: usize = 3;
/// Errors up to this many units of the round-off of the solution are round-off.
const ROUND_OFF: f64 = 1e3;
/// Largest rate, from the first level to the last, of errors that are round-off on all of them.
const LEVEL: f64 = 0.5;

/// Whether two errors are equal in all digits, which are enough.
///
/// * `digits`: counts those of the first one, which takes longer than to compare.
pub(super) fn is_repeated(one: f64, other: f64, digits: impl FnOnce() -> usize) -> bool {
    one == other && one != 0.0 && digits() >= FEWEST_DIGITS
}

/// Whether two errors are equal on all levels, three or more, in all digits, which are enough.
///
/// * `digits`: of the first one at a level.
pub fn are_equal(one: &[Level], other: &[Level], digits: impl Fn(usize) -> usize) -> bool {
    one.len() >= FEWEST_LEVELS
        && one == other
        && (0..one.len()).any(|k| is_repeated(one[k].error, other[k].error, || digits(k)))
}

/// What errors that are repeated, or are round-off throughout, make of a verdict.
///
/// * `levels`: above the floor, three or more, with their rates.
/// * `digits`: the number of digits of the error at a level.
/// * `floor`: what is known of round-off; errors that are none but it are found where none is set.
pub(super) fn doubted(
    decided: Reason,
    levels: &[Level],
    rates: &Rates,
    digits: impl Fn(usize) -> usize,
    floor: Floor,
) -> Reason {
    if floor.value() == 0.0 && !decided.verdict().is_pass() && is_round_off(levels, floor) {
        return Reason::NothingTested;
    }
    if rates.alternate() {
        return Reason::Alternates;
    }
    if repeated(levels, digits).is_none() {
        return decided;
    }
    if levels.iter().all(|level| level.error == levels[0].error) {
        Reason::Identical
    } else if has_levelled_off(levels) && decided.verdict() == Verdict::Fail {
        decided
    } else {
        Reason::Repeats
    }
}

/// The first level that repeats the error of the one before.
pub(super) fn repeated(levels: &[Level], digits: impl Fn(usize) -> usize) -> Option<usize> {
    (1..levels.len()).find(|k| is_repeated(levels[k - 1].error, levels[*k].error, || digits(k - 1)))
}

/// What is wrong with a level, by its number from 0, that repeats the one before.
pub(super) fn words_of_level(level: usize) -> String {
    format!("level {} repeats the one before: {REPEATED}", level + 1)
}

impl RateVerdict {
    /// The verdict if a level, by its number from 0, has the value of the one before.
    pub(crate) fn with_repeated(self, level: usize) -> Self {
        self.with_reason(Reason::Repeats, &words_of_level(level))
    }
}

/// Whether the three finest errors are equal: a plateau, and no single level that is another one.
fn has_levelled_off(levels: &[Level]) -> bool {
    matches!(levels, [.., before, middle, finest]
        if before.error == middle.error && middle.error == finest.error)
}

/// Whether no error is above round-off, and they do not fall.
fn is_round_off(levels: &[Level], floor: Floor) -> bool {
    let (Some(coarse), Some(fine)) = (levels.first(), levels.last()) else {
        return false;
    };
    let falls = (coarse.error / fine.error).ln() > LEVEL * (coarse.step / fine.step).ln();
    let most = ROUND_OFF * floor.unit();
    !falls && levels.iter().all(|level| level.error <= most)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::claims::{Bound, Claim};
    use crate::tests::with_errors;
    use crate::verdict::{Printed, judge};

    fn halved(errors: &[f64]) -> Vec<Level> {
        with_errors(1.0, errors)
    }

    fn found(errors: &[f64]) -> RateVerdict {
        judge(&halved(errors), 2.0, 0.25)
    }

    const RIGHT: [f64; 6] = [1.6321, 0.4087, 0.1023, 0.025_61, 0.006_403, 0.001_601];

    #[test]
    fn a_level_that_repeats_the_one_before_is_a_doubt_wherever_it_stands() {
        assert_eq!(found(&RIGHT).code, Reason::Agrees);
        for level in 1..RIGHT.len() {
            let mut errors = RIGHT;
            errors[level] = errors[level - 1];
            let judged = found(&errors);
            assert_eq!(judged.code, Reason::Repeats, "{errors:?}");
            let expected = format!(
                "level {} repeats the one before: a stale file, or an argument that is not used?",
                level + 1
            );
            assert_eq!(judged.because.to_string(), expected);
            assert!(judged.reason.to_string().starts_with(&expected));
        }
    }

    #[test]
    fn two_digits_may_repeat_by_chance_and_three_may_not() {
        let coarse = |error: f64| found(&[error, error, 0.4, 0.1023, 0.025_61, 0.006_403]).code;
        assert_eq!([coarse(1.0), coarse(0.92)], [Reason::Agrees; 2]);
        assert_eq!(coarse(0.921), Reason::Repeats);
        // As printed: 0.9200 has four digits, 0.92 two.
        let levels = halved(&[0.92, 0.92, 0.4, 0.1023, 0.025_61, 0.006_403]);
        let printed = |digits: usize| {
            let printed = Printed {
                doubt: 0.0,
                digits: &[digits; 6],
            };
            Claim::new(2.0, 0.25)
                .judge_printed(&levels, Floor::NONE, printed)
                .code
        };
        assert_eq!([printed(2), printed(4)], [Reason::Agrees, Reason::Repeats]);
    }

    #[test]
    fn errors_that_are_all_equal_or_level_off_fail() {
        let judged = found(&[0.0699; 4]);
        assert_eq!(
            (judged.code, judged.verdict),
            (Reason::Identical, Verdict::Fail)
        );
        assert!(judged.because.to_string().contains("{n}"));
        let plateau = found(&[0.4087, 0.1023, 0.0256, 0.0256, 0.0256]);
        assert_eq!(plateau.verdict, Verdict::Fail, "{:?}", plateau.code);
        assert_ne!(plateau.code, Reason::Identical);
    }

    #[test]
    fn two_levels_that_are_one_run_are_told_by_their_rates() {
        let twice = [1.6321, 1.6321, 0.4087, 0.4087, 0.1023, 0.1023];
        assert_eq!(found(&twice).code, Reason::Alternates);
        let nearly = [1.6321, 1.61, 0.4087, 0.401, 0.1023, 0.1003];
        assert_eq!(found(&nearly).code, Reason::Alternates);
    }

    #[test]
    fn errors_of_round_off_on_all_levels_test_nothing() {
        let noise = [3.3e-16, 5.6e-16, 2.2e-16, 4.4e-16];
        assert_eq!(found(&noise).code, Reason::NothingTested);
        // In a small unit, errors that fall are judged.
        let right = RIGHT.map(|error| 1e-14 * error);
        assert_eq!(found(&right).code, Reason::Agrees);
        let first = [8.1e-14, 4.05e-14, 2.02e-14, 1.01e-14];
        assert_eq!(found(&first).code, Reason::TooLow);
        // So are those of a solution whose round-off the caller knows, and a plateau above it.
        let floor = Floor::new(1e-20).expect("a floor");
        let known = Claim::new(2.0, 0.25).judge(&halved(&noise), floor).code;
        assert_ne!(known, Reason::NothingTested);
        assert_eq!(
            found(&noise.map(|error| 1e4 * error)).verdict,
            found(&noise.map(|error| 1e9 * error)).verdict
        );
    }

    #[test]
    fn zeros_up_to_the_floor_are_dropped_and_no_others() {
        let errors = [
            1.3205e-8, 2.0764e-10, 3.2496e-12, 5.0848e-14, 6.6613e-16, 0.0, 0.0,
        ];
        let kind = |errors: &[f64], floor: f64| {
            let floor = Floor::new(floor).expect("a floor");
            let levels = with_errors(0.5, errors);
            Claim::new(6.0, 0.25).judge(&levels, floor)
        };
        let judged = kind(&errors, 1e-14);
        assert_eq!((judged.code, judged.set_aside.len()), (Reason::Agrees, 3));
        assert_eq!(kind(&errors, 0.0).code, Reason::RoundOff);
        let mut middle = errors;
        middle[1] = 0.0;
        assert_eq!(kind(&middle, 1e-14).code, Reason::ZeroError);
        assert_eq!(kind(&errors, 1e-7).code, Reason::RoundOffFloor);
        assert_eq!(
            kind(&[1e-3, f64::NAN, 0.0], 1e-14).code,
            Reason::NonFiniteError
        );
    }

    #[test]
    fn a_rate_above_the_least_is_too_good_beyond_superconvergence() {
        let kind = |rate: f64, bound: Bound| {
            let errors: Vec<f64> = (0..5)
                .map(|k| 0.3 * 2_f64.powf(-rate * f64::from(k)))
                .collect();
            let claim = Claim {
                bound,
                ..Claim::new(2.0, 0.25)
            };
            claim.judge(&halved(&errors), Floor::NONE).code
        };
        for rate in [1.9, 2.0, 3.0, 3.2] {
            assert_eq!(kind(rate, Bound::AtLeast), Reason::Agrees, "{rate}");
        }
        for rate in [3.3, 4.0, 26.6] {
            assert_eq!(kind(rate, Bound::AtLeast), Reason::TooGood, "{rate}");
            assert_eq!(kind(rate, Bound::AnyAbove), Reason::Agrees, "{rate}");
            assert_eq!(kind(rate, Bound::Both), Reason::TooHigh, "{rate}");
        }
        assert_eq!(kind(1.5, Bound::AnyAbove), Reason::TooLow);
    }

    #[test]
    fn a_claim_is_read_with_its_bound() {
        use crate::claims::order_from_text as read;
        for (text, order, bound) in [
            ("2", 2.0, Bound::Both),
            (">=2", 2.0, Bound::AtLeast),
            (" >= 2. ", 2.0, Bound::AtLeast),
            (">=2..", 2.0, Bound::AnyAbove),
            (">= 1.5 ..", 1.5, Bound::AnyAbove),
        ] {
            assert_eq!(read(text), Some((order, bound)), "{text}");
            let written = bound.written(order);
            assert_eq!(read(&written), Some((order, bound)), "{written}");
        }
        for text in ["2..", ">=2...", ">=..", ">=-1..", "..", ">=2..3"] {
            assert_eq!(read(text), None, "{text}");
        }
    }
}
