//! Tables that the rule once judged wrongly, or without a rate.

use convergence_judge::{
    fit::Level,
    random::SplitMix,
    verdict::{Aside, SetAside},
};
use convergence_study::{Interval, Reason, Verdict, judge};

use super::verdict_laws::{above, check, with_errors, with_rates};

/// Steps that fall by a ratio, and errors by a law.
pub(crate) fn with_error(
    first: f64,
    ratio: f64,
    levels: i32,
    mut error: impl FnMut(f64) -> f64,
) -> Vec<Level> {
    let steps = (0..levels).map(|k| first * ratio.powi(-k));
    let level = |step| Level {
        step,
        error: error(step),
    };
    steps.map(level).collect()
}

#[test]
fn rates_that_leave_the_order_at_a_growing_pace_do_not_pass() {
    for rates in [
        &[2.000, 2.000, 2.000, 1.998, 1.993, 1.973, 1.898][..],
        &[2.0, 2.0, 2.0, 1.99, 1.97, 1.94, 1.88],
        // A wrong limit that the errors have not yet reached bends them the other way.
        &[2.0, 2.0, 2.0, 2.002, 2.007, 2.027, 2.102],
    ] {
        let outcome = judge(&with_rates(rates), 2.0, 0.2);
        check(&outcome, Reason::Departs);
        assert!(outcome.fitted.is_some());
    }
}

#[test]
fn a_term_that_is_a_tenth_of_the_finest_error_does_not_pass_on_eight_levels() {
    let finest = 0.5_f64.powi(7);
    for hidden in [0.0, 1.0, 1.5] {
        let share = 0.1 / 0.9 * finest.powf(2.0 - hidden);
        let levels = with_error(1.0, 2.0, 8, |h| h * h + share * h.powf(hidden));
        assert_ne!(
            judge(&levels, 2.0, 0.1).verdict,
            Verdict::Pass,
            "h^{hidden}"
        );
        if hidden < 1.5 {
            assert_ne!(
                judge(&levels, 2.0, 0.2).verdict,
                Verdict::Pass,
                "h^{hidden}"
            );
        }
    }
}

#[test]
fn scattered_rates_about_the_order_pass() {
    let levels = with_rates(&[0.880, 0.852, 1.034, 0.975, 0.995]);
    let verdict = |order, tolerance| judge(&levels, order, tolerance).verdict;
    assert_eq!(verdict(1.0, 0.25), Verdict::Pass);
    for order in [0.7, 1.3] {
        assert_ne!(verdict(order, 0.25), Verdict::Pass, "{order}");
    }
    // The coarsest rates leave the order open by more than a tenth.
    assert_eq!(verdict(1.0, 0.1), Verdict::Inconclusive);
}

#[test]
fn a_lost_order_is_too_low_and_its_rate_is_shown() {
    let mut tables: Vec<Vec<Level>> = [-0.3, -0.1, 0.03, 0.1, 0.3]
        .map(|pollution| with_error(1.0, 2.0, 6, |h| h * (1.0 + pollution * h)))
        .into();
    let printed = [1.010e-1, 5.02e-2, 2.505e-2, 1.2512e-2];
    tables.push(with_errors(0.1, &printed));
    for levels in tables {
        let outcome = judge(&levels, 2.0, 0.05);
        check(&outcome, Reason::TooLow);
        let Interval { low, high } = outcome.interval.expect("an interval");
        let rate = outcome.fitted.expect("a rate");
        assert!((rate - 1.0).abs() < 0.02 && high - low < 0.2, "{outcome:?}");
        let said = outcome.reason.to_string();
        assert!(said.contains("from levels"), "{said}");
    }
}

#[test]
fn levels_that_tell_nothing_are_set_aside_and_steps_too_close_are_said() {
    let off = judge(&with_rates(&[1.0, -0.5, 2.5, 1.0, 1.0]), 1.0, 0.05);
    assert_eq!(
        off.set_aside,
        [0, 1, 2].map(|level| SetAside::new(level, Aside::PreAsymptotic))
    );
    // Over a range of 1.331 and of 1.464.
    for levels in [4, 5] {
        let narrow = with_error(1.0, 1.1, levels, |h| h * (1.0 + 0.03 * h));
        check(&judge(&narrow, 1.0, 0.2), Reason::LevelsTooClose);
    }
}

#[test]
fn sound_but_noisy_errors_on_narrow_steps_do_not_fail() {
    let fails = |ratio: f64, levels: i32, deviation: f64| {
        let one = |seed: u64| {
            let mut random = SplitMix::new(seed);
            let noisy = |h: f64| h * h * (deviation * random.normal()).exp();
            let levels = with_error(1.0, ratio, levels, noisy);
            judge(&levels, 2.0, 0.1).verdict == Verdict::Fail
        };
        (0..200).filter(|&seed| one(seed)).count()
    };
    // Without the scatter in the fall many more of these 200 fail.
    for (ratio, levels, most) in [(1.1, 8, 5), (1.1, 6, 10), (1.3, 8, 6)] {
        let failed = fails(ratio, levels, 0.1);
        assert!(
            failed <= most,
            "ratio {ratio}, {levels} levels: {failed} of 200 fail"
        );
    }
}

#[test]
fn errors_that_do_not_converge_still_fail() {
    for error in [
        |_: f64| 0.3,
        |h: f64| 1.0 / h,
        |h: f64| h + 1e-3 / (h * h),
        |h: f64| h * h + 1e-2,
        // A consistency error of 1e-3 of the coarsest error: the first rates look perfect.
        |h: f64| h + 1e-3,
    ] {
        let outcome = judge(&with_error(1.0, 2.0, 13, error), 1.0, 0.1);
        assert_eq!(outcome.verdict, Verdict::Fail, "{outcome:?}");
    }
}

#[test]
fn narrow_steps_do_not_pass_for_a_rate_that_slow_pollution_has_shifted() {
    // On such close steps h (1 + 2 h^(1/3)) looks like order 1.22.
    for levels in [3, 4, 5] {
        let levels = with_error(1.0, 1.1, levels, |h| h * (1.0 + 2.0 * h.cbrt()));
        let seen = judge(&levels, 1.0, 0.05).pairwise[1];
        assert_ne!(
            judge(&levels, seen, 0.05).verdict,
            Verdict::Pass,
            "{} levels",
            levels.len()
        );
    }
}

#[test]
fn a_floor_means_what_it_says_and_names_the_levels_below() {
    let levels = with_error(1.0, 2.0, 7, |h| h * h);
    let judge = |floor| above(floor, 0.05);
    let just_above = judge(0.99 * levels[6].error).judge(&levels, 2.0);
    let aside = |because: Aside, levels: &[usize]| -> Vec<SetAside> {
        levels
            .iter()
            .map(|&level| SetAside::new(level, because))
            .collect()
    };
    assert_eq!(
        (&just_above.set_aside, just_above.used),
        (&aside(Aside::BeyondFive, &[0, 1]), 2..7)
    );
    let floored = judge(levels[5].error).judge(&levels, 2.0);
    assert_eq!(floored.set_aside, aside(Aside::AtFloor, &[5, 6]));
    assert_eq!((floored.used, floored.verdict), (0..5, Verdict::Pass));
    let nothing_left = judge(1.0).judge(&levels, 2.0);
    assert_eq!(
        (nothing_left.code, nothing_left.set_aside.len()),
        (Reason::RoundOffFloor, 7)
    );
    let rates = [0.3, 1.0, 1.0, 1.0, 1.0];
    let both = judge(with_rates(&rates)[5].error).judge(&with_rates(&rates), 1.0);
    let expected = [
        aside(Aside::PreAsymptotic, &[0]),
        aside(Aside::AtFloor, &[5]),
    ]
    .concat();
    assert_eq!((&both.set_aside, both.used), (&expected, 1..5));
}

#[test]
fn the_curve_of_a_rate_passes_through_the_finest_error_that_it_uses() {
    // The rates move, so the rate at h → 0 is not that of a straight line through all errors.
    let levels = with_error(1.0, 2.0, 7, |h| h * h * (1.0 + h));
    for (floor, finest) in [(0.0, 6), (levels[5].error, 4)] {
        let judged = above(floor, 0.1).judge(&levels, 2.0);
        assert_eq!(judged.used.end, finest + 1, "{judged:?}");
        let Level { step, error } = levels[finest];
        let there = judged.power_law().expect("a rate").error_at(step);
        assert!(
            (there / error - 1.0).abs() < 1e-12,
            "{there} instead of {error}"
        );
    }
}

mod laws {
    use std::panic::catch_unwind;

    use convergence_study::assert_order;
    use proptest::prelude::*;

    use super::{Level, Reason, Verdict, above, judge, with_rates};

    proptest! {
        #[test]
        fn units_of_step_error_and_floor_change_no_verdict(
            rates in prop::collection::vec(0.5..2.5_f64, 3..8), at_floor in 0..4_usize,
            step in -20..20_i32, error in -250..250_i32, order in 0.7..2.2_f64, tolerance in 0.05..0.4_f64,
        ) {
            let levels = with_rates(&rates);
            let floor = levels[levels.len() - at_floor.max(1)].error * if at_floor > 0 { 1.0 } else { 0.5 };
            // Powers of two are exact. Powers of ten change no rate but by round-off; there is no
            // floor that an error could equal then.
            for (unit, floor) in [(2.0_f64.powi(error), floor), (2.0_f64.powi(3 * error), 0.0), (10.0_f64.powi(error), 0.0)] {
                let scale = |level: &Level| Level { step: level.step * 2.0_f64.powi(step), error: unit * level.error };
                let scaled: Vec<Level> = levels.iter().map(scale).collect();
                let judged = |levels: &[Level], floor| above(floor, tolerance).judge(levels, order);
                let (a, b) = (judged(&levels, floor), judged(&scaled, floor * unit));
                prop_assert_eq!((a.verdict, a.code, &a.used, &a.set_aside, a.cause), (b.verdict, b.code, &b.used, &b.set_aside, b.cause));
                if let (Some(a), Some(b)) = (a.interval, b.interval) {
                    // Logarithms of size 600 have round-off of 1e-13.
                    prop_assert!((a.low - b.low).abs() < 1e-9 && (a.high - b.high).abs() < 1e-9, "{:?} {:?}", a, b);
                }
                let passes = |levels: &[Level]| {
                    let [steps, errors] = [|level: &Level| level.step, |level: &Level| level.error].map(|of| levels.iter().map(of).collect::<Vec<_>>());
                    catch_unwind(|| assert_order(&steps, &errors, order)).is_ok()
                };
                prop_assert_eq!(passes(&levels), passes(&scaled));
            }
        }

        /// Two of each kind: scattered rates, and rates with pollution and an emerging lower order
        /// or wrong limit. Only where six levels or more scatter about one power, a departure of
        /// fewer ones is chance.
        #[test]
        fn a_coarser_level_never_turns_a_departure_into_a_pass(
            scattered in prop::collection::vec(1.8..2.2_f64, 3..8),
            pollution in -0.9..3.0_f64, power in 1.0..2.0_f64, wrong in -0.3..0.3_f64, hidden in 0.0..1.5_f64,
            tolerance in 0.05..0.3_f64,
        ) {
            let law = |h: f64| h * h * (1.0 + pollution * h.powf(power)) + wrong * 2.0_f64.powf(7.0 * (hidden - 2.0)) * h.powf(hidden);
            let smooth: Vec<Level> = (0..8).map(|k| 0.5_f64.powi(k)).map(|step| Level { step, error: law(step).abs() }).collect();
            for (levels, scatter) in [(with_rates(&scattered), true), (smooth, false)] {
                for first in 1..levels.len() - 3 {
                    let (fine, all) = (judge(&levels[first..], 2.0, tolerance), judge(&levels, 2.0, tolerance));
                    let is_chance = scatter && all.used.len() > 5;
                    if fine.code == Reason::Departs && !is_chance {
                        prop_assert_ne!(all.verdict, Verdict::Pass, "{:?} {:?}", fine, all);
                    }
                }
            }
        }

        #[test]
        fn nan_never_passes(
            rates in prop::collection::vec(0.99..1.01_f64, 2..9), at in 0..10_usize, step in prop::bool::ANY,
        ) {
            let mut levels = with_rates(&rates);
            let at = at % levels.len();
            if step { levels[at].step = f64::NAN } else { levels[at].error = f64::NAN }
            prop_assert_ne!(judge(&levels, 1.0, 0.4).verdict, Verdict::Pass);
        }

        #[test]
        fn a_pass_at_one_tolerance_is_none_at_a_narrower_one_only(
            rates in prop::collection::vec(0.9..1.1_f64, 2..8), tolerance in 0.05..0.2_f64,
        ) {
            let levels = with_rates(&rates);
            if judge(&levels, 1.0, tolerance).verdict == Verdict::Pass {
                prop_assert_eq!(judge(&levels, 1.0, 2.0 * tolerance).verdict, Verdict::Pass);
            }
        }
    }
}
