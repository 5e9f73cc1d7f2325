//! Error bars of values without an exact solution.

use convergence_judge::richardson::{Estimate, NoErrorBar, SAFETY_CONFIRMED, SAFETY_UNCONFIRMED};
use convergence_study::{Estimator, Interval, Reason, StepValue, Verdict};

const RATIO_2: [f64; 6] = [1.0, 0.5, 0.25, 0.125, 0.0625, 0.03125];
const UNEQUAL: [f64; 6] = [1.0, 0.7, 0.3, 0.2, 0.11, 0.05];

fn values(steps: &[f64], value: impl Fn(f64) -> f64) -> Vec<StepValue> {
    let value = |&step: &f64| StepValue {
        step,
        value: value(step),
    };
    steps.iter().map(value).collect()
}

fn estimator(tolerance: f64) -> Estimator {
    Estimator::new(tolerance).expect("a tolerance")
}

fn estimate(order: f64, values: &[StepValue]) -> Estimate {
    estimator(0.1).estimate(values, order)
}

/// Whether two numbers are this near.
fn are_near(one: f64, other: f64, within: f64) -> bool {
    (one - other).abs() < within
}

#[test]
fn a_power_law_gives_its_rate_and_its_limit_on_any_steps() {
    for steps in [&RATIO_2[..], &UNEQUAL, &RATIO_2[..4], &UNEQUAL[..4]] {
        for (p, sign) in [0.7, 1.0, 2.0, 3.3]
            .into_iter()
            .flat_map(|p| [(p, 1.0), (p, -1.0)])
        {
            let found = estimate(p, &values(steps, |h| 3.0 + sign * 0.4 * h.powf(p)));
            let bar = found.bar.unwrap();
            let error = sign * 0.4 * steps[steps.len() - 1].powf(p);
            let is_found = are_near(bar.rate, p, 1e-6)
                && are_near(bar.extrapolated, 3.0, 1e-8)
                && are_near(bar.error, error, 1e-8);
            let is_held = bar.error_interval.holds(error) && bar.limit.holds(3.0);
            assert!(
                is_found && is_held && bar.limit.width() < 1e-5,
                "{p}: {bar:?}"
            );
            assert_eq!(found.judged.verdict, Verdict::Pass);
        }
    }
}

#[test]
fn the_bar_holds_the_error_that_pollution_leaves() {
    for steps in [&RATIO_2[..], &UNEQUAL] {
        for (p, c, r) in [
            (1.0, 0.5, 1.0),
            (2.0, -0.4, 1.0),
            (2.0, 0.8, 2.0),
            (1.0, 0.3, 0.5),
            (2.0, -0.2, 1.5),
        ] {
            let error = |h: f64| h.powf(p) * (1.0 + c * h.powf(r));
            let bar = estimate(p, &values(steps, |h| 1.0 - error(h))).bar.unwrap();
            let Interval { low, high } = bar.error_interval;
            let error = -error(steps[5]);
            assert!(
                low < error && error < high,
                "{p} {c} {r}: {bar:?}, error {error}"
            );
            // 2 - 0.4 h is the widest, 2.03.
            assert!(
                high - low < 2.1 * error.abs(),
                "{p} {c} {r}: {bar:?}, error {error}"
            );
        }
    }
}

#[test]
fn three_values_lean_on_the_claim() {
    let three = values(&RATIO_2[..3], |h| 1.0 + h * h + 0.5 * h.powi(4));
    let found = estimate(2.0, &three);
    let bar = found.bar.unwrap();
    assert_eq!(
        (found.judged.verdict, found.judged.code),
        (Verdict::Inconclusive, Reason::TooFewLevels)
    );
    assert!(
        bar.rate_interval.low == 1.5 && (bar.rate_interval.high - bar.rate - 0.5).abs() < 1e-12,
        "{bar:?}"
    );
    let error = 0.0625 + 0.5 * 0.25_f64.powi(4);
    assert!(bar.error_interval.low < error && error < bar.error_interval.high);
    let slow = estimate(0.4, &values(&RATIO_2[..3], |h| h.powf(0.4))).bar;
    assert!(
        matches!(slow, Err(NoErrorBar::RateMayBeZero(low)) if (low + 0.1).abs() < 1e-12),
        "{slow:?}"
    );
}

/// The example of I. B. Celik et al., *Procedure for Estimation and Reporting of Uncertainty Due to
/// Discretization in CFD Applications*, J. Fluids Eng. 130 (2008), table 1, first column: grids of
/// 4500, 8000, 18000 cells in two dimensions, p = 1.53, an index of 2.2 %. The rate is that of the
/// values whatever is claimed, and an index that the claim does not confirm is wider.
#[test]
fn the_index_is_that_of_the_published_example() {
    let cells = [(4500.0_f64, 5.863), (8000.0, 5.972), (18000.0, 6.063)];
    let cells = cells.map(|(cells, value)| StepValue {
        step: cells.powf(-0.5),
        value,
    });
    let unclaimed = estimator(0.25).estimate_unclaimed(&cells);
    let of = |order: f64| estimate(order, &cells);
    let [index, confirmed, unconfirmed] = [unclaimed, of(1.6), of(2.0)].map(|of| of.gci.unwrap());
    assert!(are_near(index.observed, 1.53, 5e-3), "{index:?}");
    assert!(are_near(index.half_width / 6.063, 0.022, 5e-4), "{index:?}");
    assert_eq!([index.factor, SAFETY_CONFIRMED], [1.25; 2]);
    assert_eq!(confirmed, index);
    assert_eq!(unconfirmed.factor, SAFETY_UNCONFIRMED);
    assert!(are_near(
        unconfirmed.half_width / index.half_width,
        2.4,
        1e-12
    ));
    for index in [index, unconfirmed] {
        assert_eq!(index.order, index.observed);
    }
    for order in [1.0, 2.0, 3.0] {
        let rates = of(order).judged.pairwise;
        assert!(are_near(rates[0], index.observed, 1e-9), "{rates:?}");
    }
}

/// Ratios 4 and 1.2, for which the iteration of the standard diverges.
#[test]
fn the_index_finds_its_order_on_any_ratios() {
    for (steps, p) in [
        ([4.8, 1.2, 1.0], 1.0),
        ([4.8, 4.0, 1.0], 1.0),
        ([2.0, 1.4, 1.0], 3.0),
    ] {
        let index = estimate(p, &values(&steps, |h: f64| 1.0 + h.powf(p)))
            .gci
            .unwrap();
        assert!((index.observed - p).abs() < 1e-10, "{steps:?}: {index:?}");
    }
}

#[test]
fn an_order_above_the_claim_shortens_no_index() {
    let fast = estimate(1.0, &values(&RATIO_2[..3], |h: f64| h.powi(4)))
        .gci
        .unwrap();
    assert!(
        (fast.observed - 4.0).abs() < 1e-9
            && fast.order == 1.0
            && fast.factor == SAFETY_UNCONFIRMED,
        "{fast:?}"
    );
}

#[test]
fn outside_the_asymptotic_range_there_is_no_bar() {
    use NoErrorBar::*;
    // (-1)^k h^2
    let turns = |h: f64| h * h * (h.log2() * std::f64::consts::PI).cos();
    let bends = |h: f64| h * h / (1.0 + 30.0 * h * h);
    for (steps, value, reason) in [
        (&RATIO_2[..2], (|h| h) as fn(f64) -> f64, TooFewValues(2)),
        (&[], |h| h, TooFewValues(0)),
        (&RATIO_2, |h| if h == 0.5 { f64::NAN } else { h }, NotFinite),
        (&[1.0, 0.5, 0.5], |h| h, Steps),
        (&RATIO_2, |_| 1.0, NoChange),
        (&RATIO_2, |h| if h > 0.2 { 1.0 } else { h }, NoChange),
        (&RATIO_2, turns, Oscillating),
        (&RATIO_2, |h| 1.0 / h, Diverging),
        (&RATIO_2[..3], |h| 1.0 / h, Diverging),
        (&RATIO_2, f64::ln, Diverging),
        (&RATIO_2, bends, NotAsymptotic(Reason::NotAsymptotic)),
    ] {
        assert_eq!(estimate(2.0, &values(steps, value)).bar, Err(reason));
    }
    for (value, reason) in [
        (turns as fn(f64) -> f64, Oscillating),
        (|h| 1.0 / h, Diverging),
    ] {
        let index = estimate(2.0, &values(&RATIO_2, value)).gci;
        assert_eq!(index.unwrap_err(), reason);
    }
    let noise = estimate(2.0, &values(&RATIO_2, |h| 1.0 + 1e-12 * h)).bar;
    assert!(matches!(noise, Err(RoundOff { .. })), "{noise:?}");
    let claim = estimate(0.0, &values(&RATIO_2, |h| h));
    assert_eq!(claim.bar, Err(NotAsymptotic(Reason::ClaimUnusable)));
    assert_eq!(claim.gci.unwrap_err(), claim.bar.unwrap_err());
}

/// Six digits: without the floor the last differences are noise, but would be used.
#[test]
fn a_floor_takes_the_say_from_digits_that_were_not_printed() {
    let printed = values(&RATIO_2, |h| ((1.0 + 1e-4 * h * h) * 1e6).round() / 1e6);
    let floored = estimator(0.1).with_floor(1e-4).unwrap();
    let found = floored.estimate(&printed, 2.0);
    assert!(
        matches!(
            found.bar,
            Err(NoErrorBar::RoundOff { .. } | NoErrorBar::NoChange)
        ),
        "{:?}",
        found.bar
    );
    assert!(estimator(0.1).with_floor(-1.0).is_err() && Estimator::new(0.6).is_err());
}

#[test]
fn a_wrong_order_is_judged_and_has_a_bar_all_the_same() {
    let found = estimate(2.0, &values(&RATIO_2, |h| 1.0 + h));
    assert_eq!(
        (found.judged.verdict, found.judged.code),
        (Verdict::Fail, Reason::TooLow)
    );
    assert!((found.bar.unwrap().extrapolated - 1.0).abs() < 1e-9);
    assert_eq!(found.gci.unwrap().factor, SAFETY_UNCONFIRMED);
}

#[test]
fn values_without_a_claim_have_a_limit_and_no_verdict() {
    let steps = [0.2, 0.1, 0.05, 0.025];
    let mut values = values(&steps, |h| 3.0 + h * h);
    let unclaimed = |values: &[StepValue]| estimator(0.25).estimate_unclaimed(values);
    let found = unclaimed(&values);
    let bar = found.bar.expect("a limit");
    assert!(
        bar.limit.holds(3.0) && are_near(bar.rate, 2.0, 1e-6),
        "{bar:?}"
    );
    let judged = (found.judged.verdict, found.gci.is_ok());
    assert_eq!(judged, (Verdict::Inconclusive, true));
    let zigzag = values.iter_mut().zip([1.0, 2.0, 1.0, 2.0]);
    zigzag.for_each(|(level, value)| level.value = value);
    assert_eq!(unclaimed(&values).bar, Err(NoErrorBar::Oscillating));
}

#[test]
fn a_value_that_repeats_that_of_the_level_before_does_not_pass() {
    for steps in [RATIO_2, UNEQUAL] {
        let mut stale = values(&steps, |h| 3.0 + 0.3 * h * h);
        assert_eq!(estimate(2.0, &stale).judged.verdict, Verdict::Pass);
        stale[5].value = stale[4].value;
        let judged = estimate(2.0, &stale).judged;
        assert_eq!(judged.code, Reason::Repeats);
        assert!(judged.because.to_string().starts_with("level 6 repeats"));
    }
    // Round-off may make two values one.
    let steps: Vec<f64> = (1..15).map(|k| 0.5_f64.powi(k)).collect();
    let round_off = values(&steps, |h| 3.0 + 0.3 * h.powi(4));
    assert_eq!(round_off[13].value, round_off[12].value);
    assert_eq!(estimate(4.0, &round_off).judged.verdict, Verdict::Pass);
}
