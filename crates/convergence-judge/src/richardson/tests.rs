//! Values at unequal ratios of steps, beside the errors at the same steps.

use super::{Estimate, Estimator, NoErrorBar, StepValue};
use crate::fit::Level;
use crate::interval::Interval;
use crate::random::SplitMix;
use crate::verdict::{Judge, Verdict};

const LIMIT: f64 = 3.0;
const TOLERANCE: f64 = 0.25;
const PARTS: [f64; 8] = [1.0, 2.0, 3.0, 5.0, 8.0, 12.0, 20.0, 30.0];
const TABLES: u64 = 200;

/// Values of this error, judged as of order 2.
fn estimate(steps: &[f64], error: impl Fn(f64) -> f64) -> Estimate {
    let values = steps.iter().map(|&step| StepValue {
        step,
        value: LIMIT + error(step),
    });
    let estimator = Estimator::new(TOLERANCE).expect("a tolerance");
    estimator.estimate(&values.collect::<Vec<_>>(), 2.0)
}

/// The verdict on the errors themselves.
fn of_errors(steps: &[f64], error: impl Fn(f64) -> f64) -> Verdict {
    let levels = steps.iter().map(|&step| Level {
        step,
        error: error(step).abs(),
    });
    let judge = Judge::new(TOLERANCE).expect("a tolerance");
    judge.judge(&levels.collect::<Vec<_>>(), 2.0).verdict
}

/// Steps of a fifth over 1, 2, 3, 5, 8, ...
fn of_parts(count: usize) -> Vec<f64> {
    PARTS[..count].iter().map(|part| 0.2 / part).collect()
}

fn random_steps(count: usize, random: &mut SplitMix) -> Vec<f64> {
    let mut part = 1.0;
    let parts = (0..count).map(|_| {
        part += random.within([0.3, 3.0]);
        0.2 / part
    });
    parts.collect()
}

#[test]
fn a_lower_order_of_the_other_sign_does_not_hide_in_unequal_ratios() {
    let steps = [0.2, 0.1, 0.0667, 0.04, 0.025];
    let found = estimate(&steps, |h| h * h - 0.01 * h);
    assert!(!found.judged.verdict.is_pass(), "{}", found.judged.line());
    for count in [4, 5, 6, 8] {
        let (mut by_chance, mut errors) = (0, 0);
        for seed in 0..TABLES {
            let mut random = SplitMix::new(seed);
            for steps in [of_parts(count), random_steps(count, &mut random)] {
                let lower = random.within([0.1, 0.8]) * steps[count - 1];
                let error = |h: f64| h * h - lower * h;
                let found = estimate(&steps, error);
                by_chance += u64::from(found.judged.verdict.is_pass());
                errors += u64::from(of_errors(&steps, error).is_pass());
            }
        }
        assert!(by_chance <= errors + TABLES / 50, "{count}: {by_chance}");
    }
}

#[test]
fn a_true_order_passes_at_unequal_ratios_as_its_errors_do_and_its_limit_is_held() {
    let laws: [fn(f64, f64) -> f64; 3] = [
        |h, c| h * h * (1.0 + c * h),
        |h, c| h * h * (1.0 + 9.0 * c * h * h),
        |h, c| h * h * (1.0 + 0.1 * c * h.sqrt()),
    ];
    for (count, share) in [(5, 0.85), (6, 0.95), (8, 0.97)] {
        for (place, law) in laws.into_iter().enumerate() {
            let (mut passes, mut errors) = (0.0, 0.0);
            for seed in 0..TABLES {
                let mut random = SplitMix::new(seed);
                let steps = random_steps(count, &mut random);
                let c = random.normal();
                let error = |h: f64| law(h, c);
                let found = estimate(&steps, error);
                if of_errors(&steps, error).is_pass() {
                    errors += 1.0;
                }
                if found.judged.verdict.is_pass() {
                    passes += 1.0;
                    let limit = found.bar.map(|bar| bar.limit);
                    let is_held = limit.is_ok_and(|limit: Interval| limit.holds(LIMIT));
                    assert!(is_held, "{place}, {count}, {seed}: {limit:?}");
                }
            }
            assert!(
                passes >= share * errors,
                "{place}, {count}: {passes} of {errors}"
            );
        }
    }
}

#[test]
fn finest_values_that_hardly_differ_have_no_error_bar() {
    let estimator = Estimator::new(TOLERANCE).expect("a tolerance");
    // A power of two, which 1 + TINY holds exactly.
    const TINY: f64 = 1.0 / 4_194_304.0;
    let floor = 1e-6;
    let estimator = estimator.with_floor(floor).expect("a floor");
    for (difference, why) in [
        (0.0, NoErrorBar::NoChange),
        (
            TINY,
            NoErrorBar::RoundOff {
                difference: TINY,
                floor,
            },
        ),
    ] {
        let values = [(0.4, 8.0), (0.2, 2.0), (0.1, 1.0 + difference), (0.05, 1.0)];
        let values = values.map(|(step, value)| StepValue { step, value });
        let found = estimator.estimate(&values, 2.0);
        assert_eq!((found.bar, found.gci), (Err(why), Err(why)));
    }
}
