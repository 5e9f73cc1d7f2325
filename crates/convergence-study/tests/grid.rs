//! Orders over a grid of h and dt, also for errors that do not add; `convergence-calibration`
//! measures how often they are right.

use convergence_judge::grid::{Adding, GridErrors};
use convergence_study::Verdict::{self, Fail, Inconclusive, Pass};
use convergence_study::{Claim, Grid, GridColumn, NamedRate, Outcome, Reason, SpaceTime};

fn halved(first: f64, levels: usize) -> Vec<f64> {
    (0..levels)
        .map(|k| first * 0.5_f64.powi(k as i32))
        .collect()
}

/// Errors at all pairs of steps, with claims of their orders.
fn grid(
    h: &[f64],
    dt: &[f64],
    claims: [f64; 2],
    tolerance: f64,
    error: impl Fn(f64, f64) -> f64,
) -> Grid {
    let points = h
        .iter()
        .flat_map(|&space| dt.iter().map(move |&time| SpaceTime { space, time }));
    let points: Vec<SpaceTime<f64>> = points.collect();
    let errors = points.iter().map(|point| error(point.space, point.time));
    let column = GridColumn {
        name: "L2".to_owned(),
        space: Claim::new(claims[0], tolerance),
        time: claims[1],
        errors: errors.collect(),
    };
    Grid {
        columns: vec![column],
        points,
        times: dt.len(),
        squares_add: false,
    }
}

fn judged(
    h: &[f64],
    dt: &[f64],
    claims: [f64; 2],
    tolerance: f64,
    error: impl Fn(f64, f64) -> f64,
) -> Outcome {
    grid(h, dt, claims, tolerance, error).judge()
}

fn verdicts(verdict: &Outcome) -> [Verdict; 3] {
    [
        verdict.rates[0].rate.verdict,
        verdict.rates[1].rate.verdict,
        verdict.checks[0].verdict,
    ]
}

#[test]
fn three_levels_do_not_tell() {
    let (h, dt) = (halved(0.25, 3), halved(0.1, 3));
    let verdict = judged(&h, &dt, [2.0, 1.0], 0.2, |h, dt| h * h + dt);
    assert_eq!(verdicts(&verdict), [Inconclusive, Inconclusive, Pass]);
    let mut rates = verdict.rates.iter();
    assert!(rates.all(|named| named.rate.code == Reason::TooFewLevels));
}

/// Tables on which a surface `C_h h^p + C_t dt^q`, with Student's interval, was wrong.
#[test]
fn a_hidden_order_and_pollution_are_seen_on_four_levels() {
    let (h, dt) = (halved(0.25, 4), halved(0.05, 4));
    // First order in h, 64 % of the rest on the finest mesh.
    let hidden = judged(&h, &dt, [2.0, 1.0], 0.2, |h, dt| h * h + 0.02 * h + dt);
    assert_eq!(verdicts(&hidden), [Inconclusive, Pass, Pass], "{hidden:?}");
    for (tolerance, claims, polluted) in [
        (
            0.1,
            [2.0, 1.0],
            (|h, dt| h * h * (1.0 - h) + dt) as fn(f64, f64) -> f64,
        ),
        (0.2, [1.0, 1.0], |h, dt| {
            h * (1.0 + 2.0 * h) + 0.5 * dt * (1.0 + dt)
        }),
    ] {
        let verdict = judged(&h, &dt, claims, tolerance, polluted);
        for (NamedRate { name, rate, .. }, order) in verdict.rates.iter().zip(claims) {
            assert_ne!(rate.verdict, Fail, "{name}: {}", rate.reason);
            assert!(
                rate.interval.is_some_and(|interval| interval.holds(order)),
                "{name}: {}",
                rate.reason
            );
        }
    }
}

#[test]
fn pure_powers_pass_on_any_steps_and_wrong_claims_fail() {
    let h = [0.25, 0.2, 0.125, 0.1, 0.0625, 0.01];
    for (power, dt) in [
        (1.0, [0.1, 0.05, 0.025, 0.0125, 0.00625]),
        (2.0, [0.1, 0.07, 0.03, 0.02, 0.001]),
    ] {
        let error = |h: f64, dt: f64| {
            ((3.0 * h * h).powf(power) + (0.2 * dt).powf(power)).powf(1.0 / power)
        };
        let verdict = judged(&h, &dt, [2.0, 1.0], 0.05, error);
        assert_eq!(verdicts(&verdict), [Pass; 3], "{verdict:?}");
        let [p, q] = [0, 1].map(|k| verdict.rates[k].rate.fitted.expect("a rate"));
        assert!((p - 2.0).abs() < 1e-6 && (q - 1.0).abs() < 1e-6, "{p} {q}");
        assert_eq!(verdict.rates[0].name, "L2 in h");
        assert_eq!(verdict.rates[1].name, "L2 in dt");
        let wrong = judged(&h, &dt, [1.0, 2.0], 0.2, error);
        assert_eq!(verdicts(&wrong), [Fail, Fail, Pass], "{wrong:?}");
        assert_eq!(
            [wrong.rates[0].rate.code, wrong.rates[1].rate.code],
            [Reason::TooHigh, Reason::TooLow]
        );
    }
}

/// One contribution by itself is what the curve shows: its constant is C_h.
#[test]
fn the_constant_is_that_of_one_contribution() {
    let (h, dt) = (halved(0.25, 6), halved(0.1, 6));
    let verdict = judged(&h, &dt, [2.0, 1.0], 0.05, |h, dt| {
        (3.0 * h * h).hypot(0.2 * dt)
    });
    for (NamedRate { rate, .. }, constant) in verdict.rates.iter().zip([3.0, 0.2]) {
        assert!(
            (rate.constant.expect("a rate") / constant - 1.0).abs() < 1e-6,
            "{rate:?}"
        );
        assert_eq!(rate.pairwise.len(), 4);
    }
}

/// Each line over h has an exact power of its own: of the finest dt, the interval reaches to that
/// of the next one.
#[test]
fn the_interval_holds_the_rate_at_the_next_time_step() {
    let (h, dt) = (halved(0.25, 6), halved(0.1, 6));
    let exponent = |dt: f64| 2.0 + 0.5 * dt;
    let verdict = judged(&h, &dt, [2.0, 1.0], 0.2, |h, dt| h.powf(exponent(dt)) + dt);
    let interval = verdict.rates[0].rate.interval.expect("an interval");
    let [finest, next] = [dt[5], dt[4]].map(exponent);
    assert!(next - finest > 1e-3);
    for rate in [next, 2.0 * finest - next] {
        assert!(interval.holds(rate), "{rate} in {interval:?}");
    }
}

#[test]
fn errors_that_do_not_add_are_inconclusive() {
    let (h, dt) = (halved(0.5, 6), halved(0.5, 6));
    for error in [
        (|h, dt| h * dt) as fn(f64, f64) -> f64,
        |h, dt| h.min(dt),
        |h, dt| (h - dt).abs() + 1e-3 * h,
    ] {
        let verdict = judged(&h, &dt, [1.0, 1.0], 0.2, error);
        assert_eq!(verdict.checks[0].verdict, Inconclusive, "{verdict:?}");
    }
    // At an angle of 84 degrees: neither of the two models, and the squares very nearly.
    let verdict = judged(&h, &dt, [1.0, 1.0], 0.2, |h, dt| {
        (h * h + dt * dt + 0.2 * h * dt).sqrt()
    });
    assert!(
        verdicts(&verdict).iter().all(|verdict| *verdict != Fail),
        "{verdict:?}"
    );
}

#[test]
fn contributions_of_opposite_signs_are_judged_where_one_of_them_prevails() {
    let (h, dt) = (halved(0.5, 6), halved(0.1, 6));
    let prevails = judged(&h, &dt, [1.0, 1.0], 0.1, |h, dt| h - 0.1 * dt);
    assert_eq!(verdicts(&prevails), [Pass; 3], "{prevails:?}");
    // On the finest meshes the error in dt is larger: e falls, then grows.
    let changes = judged(&h, &dt, [1.0, 1.0], 0.1, |h, dt| (h - 10.0 * dt).abs());
    assert_ne!(changes.rates[0].rate.verdict, Pass, "{changes:?}");
}

/// Differences cancel a constant: none of these errors tends to zero.
#[test]
fn errors_that_tend_to_a_wrong_limit_fail_and_its_size_is_named() {
    let (h, dt) = (halved(0.25, 6), halved(0.1, 6));
    for (claims, error, size) in [
        (
            [2.0, 1.0],
            (|h, dt| 5.0 - h * h - dt) as fn(f64, f64) -> f64,
            "5.000e0",
        ),
        ([2.0, 1.0], |h, dt| 1.0 + h * h + dt, "1.000e0"),
        ([2.0, 1.0], |h, dt| (h * h + dt - 0.5).abs(), "5.000e-1"),
        (
            [2.0, 1.0],
            |h, dt| (1.0 + h.powi(4) + dt * dt).sqrt(),
            "1.000e0",
        ),
        ([1.0, 1.0], |h, dt| h + dt + 2e-3, "2.000e-3"),
    ] {
        let verdict = judged(&h, &dt, claims, 0.2, error);
        for NamedRate { name, rate, .. } in &verdict.rates {
            assert_eq!(
                (rate.code, rate.verdict),
                (Reason::WrongLimit, Fail),
                "{name}: {rate:?}"
            );
            assert!(
                rate.because.to_string().contains(size) && rate.reason.to_string().contains(size),
                "{size}: {rate:?}"
            );
            assert!(rate.reason.to_string().contains("claimed"), "{rate:?}");
        }
    }
    // Half a per cent of the finest error is negligible, 2 % may not be.
    let finest = h[5] + dt[5];
    for (share, kind) in [
        (0.004, Reason::Agrees),
        (0.006, Reason::LeftOver),
        (0.09, Reason::LeftOver),
        (0.12, Reason::WrongLimit),
    ] {
        let verdict = judged(&h, &dt, [1.0, 1.0], 0.2, |h, dt| {
            h + dt + share * finest / (1.0 - share)
        });
        assert!(
            verdict.rates.iter().all(|named| named.rate.code == kind),
            "{share}: {verdict:?}"
        );
    }
}

#[test]
fn negative_errors_fail_though_their_differences_have_the_orders() {
    let (h, dt) = (halved(0.125, 4), halved(0.125, 4));
    for offset in [0.002, 0.2] {
        let verdict = judged(&h, &dt, [2.0, 1.0], 0.25, |h, dt| 0.3 * h * h - offset * dt);
        let codes = [0, 1].map(|k| verdict.rates[k].rate.code);
        assert_eq!(codes, [Reason::NegativeError; 2], "{verdict:?}");
    }
}

/// The finest mesh is that of the level before, and the error in dt hides what is left of it.
#[test]
fn a_finest_level_that_repeats_the_one_before_does_not_pass() {
    let (h, dt) = (halved(0.125, 5), halved(0.125, 5));
    let last_but_one = h[3];
    let stale = |h: f64, dt: f64| 0.3 * h.max(last_but_one).powi(2) + 2.0 * dt;
    let verdict = judged(&h, &dt, [2.0, 1.0], 0.25, stale);
    assert_eq!(verdicts(&verdict), [Inconclusive, Pass, Pass]);
    let rate = &verdict.rates[0].rate;
    assert_eq!(rate.code, Reason::Repeats);
    assert!(rate.because.to_string().starts_with("level 5 repeats"));
    let true_errors = judged(&h, &dt, [2.0, 1.0], 0.25, |h, dt| 0.3 * h * h + 2.0 * dt);
    assert_eq!(verdicts(&true_errors), [Pass; 3]);
}

/// An error that falls and grows in turns has a difference of the claimed order, and no limit that
/// a rate could show.
#[test]
fn differences_that_change_their_sign_do_not_pass() {
    let (h, dt) = (halved(0.25, 6), halved(8.0, 6));
    let sign = |h: f64| {
        if (h.log2() as i32) % 2 == 0 {
            1.0
        } else {
            -1.0
        }
    };
    let verdict = judged(&h, &dt, [1.0, 1.0], 0.2, |h, dt| dt + 0.1 * h * sign(h));
    assert_eq!(
        verdicts(&verdict),
        [Inconclusive, Pass, Pass],
        "{verdict:?}"
    );
    assert_eq!(verdict.rates[0].rate.code, Reason::NotAsymptotic);
}

/// The error in h is invisible next to that in dt, which is known to one part in a thousand.
#[test]
fn what_scatter_hides_is_inconclusive() {
    let (h, dt) = (halved(0.25, 6), halved(0.1, 6));
    let scatter = |h: f64, dt: f64| 1.0 + 1e-3 * (1e4 * (h + 7.0 * dt)).sin();
    let verdict = judged(&h, &dt, [2.0, 1.0], 0.2, |h, dt| {
        (1e-3 * h * h + dt) * scatter(h, dt)
    });
    assert_eq!(
        verdicts(&verdict),
        [Inconclusive, Pass, Pass],
        "{verdict:?}"
    );
    assert_eq!(verdict.rates[0].rate.code, Reason::RoundOffFloor);
}

#[test]
fn the_misfit_is_that_of_the_errors_beside_the_finest_row_and_column() {
    let (h, dt) = ([0.5, 0.25], [0.1, 0.05]);
    // 5 = 4 + 3 - 2, and 6 instead of 5.
    let misfit = |corner: f64, adding| {
        GridErrors {
            h: &h,
            dt: &dt,
            errors: &[corner, 4.0, 3.0, 2.0],
        }
        .misfit(adding)
    };
    assert!(misfit(5.0, Adding::Plain) < 1e-15);
    assert!((misfit(6.0, Adding::Plain) - 1.2_f64.ln()).abs() < 1e-15);
    assert!((misfit(5.0, Adding::Squares) - 0.5 * (25.0_f64 / 21.0).ln()).abs() < 1e-15);
    assert!(misfit(f64::NAN, Adding::Plain).is_nan());
    // 1 + 1 - 2
    let none = GridErrors {
        h: &h,
        dt: &dt,
        errors: &[1.0, 1.0, 1.0, 2.0],
    };
    assert_eq!(none.misfit(Adding::Plain), f64::INFINITY);
    assert!(
        GridErrors {
            h: &h[..1],
            dt: &dt,
            errors: &[1.0, 1.0]
        }
        .misfit(Adding::Plain)
        .is_nan()
    );
}

#[test]
fn an_error_that_is_nan_fails_and_tolerances_that_tell_nothing_are_refused() {
    let (h, dt) = (halved(0.25, 5), halved(0.1, 5));
    let broken = judged(&h, &dt, [1.0, 1.0], 0.1, |h, dt| {
        if h < 0.02 && dt < 0.01 {
            f64::NAN
        } else {
            h + dt
        }
    });
    assert_eq!(verdicts(&broken)[..2], [Fail, Fail]);
    let errors = &grid(&h, &dt, [1.0; 2], 0.1, |h, dt| h + dt).columns[0].errors;
    let grid = GridErrors {
        h: &h,
        dt: &dt,
        errors,
    };
    let orders = SpaceTime {
        space: 1.0,
        time: 1.0,
    };
    assert!(grid.judge(Adding::Plain, orders, 0.5).is_err());
    let refused = judged(&h, &dt, [1.0, 1.0], 0.7, |h, dt| h + dt);
    assert!(
        refused.rates.is_empty() && refused.checks[0].verdict == Fail,
        "{refused:?}"
    );
}

#[test]
fn steps_that_differ_within_a_row_are_no_grid() {
    let mut grid = grid(&halved(0.25, 5), &halved(0.1, 5), [1.0; 2], 0.1, |h, dt| {
        h + dt
    });
    grid.points[7].time *= 1.01;
    let verdict = grid.judge();
    assert!(verdict.rates.is_empty(), "{verdict:?}");
    let check = &verdict.checks[0];
    assert_eq!(check.verdict, Inconclusive);
    let found = "expected h = 0.125, dt = 0.025, found h = 0.125, dt = 0.02525";
    assert_eq!(check.evidence.to_string(), found);
}

#[test]
fn squares_that_theory_claims_must_fit_better_than_the_sum() {
    let (h, dt) = (halved(0.25, 5), halved(0.1, 5));
    let model = |error: fn(f64, f64) -> f64| {
        let grid = Grid {
            squares_add: true,
            ..grid(&h, &dt, [1.0; 2], 0.1, error)
        };
        grid.judge()
    };
    assert_eq!(verdicts(&model(f64::hypot)), [Pass; 3]);
    assert_eq!(model(|h, dt| h + dt).checks[0].verdict, Fail);
}
