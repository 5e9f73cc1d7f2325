//! Orders over a grid of h and dt, also for errors that do not add; `convergence-calibration`
//! measures how often they are right.

use convergence_judge::grid::{Adding, GridErrors};
use convergence_study::Verdict::{self, Fail, Inconclusive, Pass};
use convergence_study::{Claim, Grid, GridColumn, NamedRate, Outcome, Reason, SpaceTime};

/// Steps of a grid, the coarsest first.
struct Steps {
    h: Vec<f64>,
    dt: Vec<f64>,
}

/// A law of errors over h and dt.
type Law = fn(f64, f64) -> f64;

impl Steps {
    /// Each step half of the one before.
    fn halved(h: f64, dt: f64, levels: i32) -> Self {
        let over = |first: f64| (0..levels).map(|k| first * 0.5_f64.powi(k)).collect();
        Self {
            h: over(h),
            dt: over(dt),
        }
    }

    /// The same steps in h and dt, each so many times as small as the one before.
    fn by_ratios(first: f64, ratios: &[f64]) -> Self {
        let mut h = vec![first];
        for ratio in ratios {
            h.push(h[h.len() - 1] / ratio);
        }
        Self { dt: h.clone(), h }
    }

    /// Errors at all pairs of steps, with claims of their orders in h and dt.
    fn grid(
        &self,
        [space, time]: [f64; 2],
        tolerance: f64,
        error: impl Fn(f64, f64) -> f64,
    ) -> Grid {
        let Self { h, dt } = self;
        let pairs = h.iter().flat_map(|h| dt.iter().map(move |dt| (*h, *dt)));
        let column = GridColumn {
            name: "L2".to_owned(),
            space: Claim::new(space, tolerance),
            time: Claim::new(time, tolerance),
            errors: pairs.clone().map(|(h, dt)| error(h, dt)).collect(),
        };
        Grid {
            columns: vec![column],
            points: pairs
                .map(|(space, time)| SpaceTime { space, time })
                .collect(),
            times: dt.len(),
            squares_add: false,
        }
    }

    fn judged(&self, claims: [f64; 2], tolerance: f64, error: impl Fn(f64, f64) -> f64) -> Outcome {
        self.grid(claims, tolerance, error).judge()
    }
}

/// Of the rates in h and in dt, and on whether the errors add.
fn verdicts(outcome: &Outcome) -> [Verdict; 3] {
    let [in_h, in_dt] = [0, 1].map(|k| outcome.rates[k].rate.verdict);
    [in_h, in_dt, outcome.checks[0].verdict]
}

#[track_caller]
fn are(outcome: &Outcome, expected: [Verdict; 3]) {
    assert_eq!(verdicts(outcome), expected, "{outcome:?}");
}

/// The reasons of the rates in h and in dt.
fn codes(outcome: &Outcome) -> [Reason; 2] {
    [0, 1].map(|k| outcome.rates[k].rate.code)
}

#[test]
fn three_levels_do_not_tell() {
    let steps = Steps::halved(0.25, 0.1, 3);
    let verdict = steps.judged([2.0, 1.0], 0.2, |h, dt| h * h + dt);
    are(&verdict, [Inconclusive, Inconclusive, Pass]);
    assert_eq!(codes(&verdict), [Reason::TooFewLevels; 2]);
}

/// Tables on which a surface `C_h h^p + C_t dt^q`, with Student's interval, was wrong.
#[test]
fn a_hidden_order_and_pollution_are_seen_on_four_levels() {
    let steps = Steps::halved(0.25, 0.05, 4);
    // First order in h, 64 % of the rest on the finest mesh.
    let hidden = steps.judged([2.0, 1.0], 0.2, |h, dt| h * h + 0.02 * h + dt);
    are(&hidden, [Inconclusive, Pass, Pass]);
    for (tolerance, claims, polluted) in [
        (0.1, [2.0, 1.0], (|h, dt| h * h * (1.0 - h) + dt) as Law),
        (0.2, [1.0, 1.0], |h, dt| {
            h * (1.0 + 2.0 * h) + 0.5 * dt * (1.0 + dt)
        }),
    ] {
        let verdict = steps.judged(claims, tolerance, polluted);
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
    for (power, dt) in [
        (1.0, [0.1, 0.05, 0.025, 0.0125, 0.00625]),
        (2.0, [0.1, 0.07, 0.03, 0.02, 0.001]),
    ] {
        let steps = Steps {
            h: vec![0.25, 0.2, 0.125, 0.1, 0.0625, 0.01],
            dt: dt.to_vec(),
        };
        let error = |h: f64, dt: f64| {
            ((3.0 * h * h).powf(power) + (0.2 * dt).powf(power)).powf(1.0 / power)
        };
        let verdict = steps.judged([2.0, 1.0], 0.05, error);
        are(&verdict, [Pass; 3]);
        let [p, q] = [0, 1].map(|k| verdict.rates[k].rate.fitted.expect("a rate"));
        assert!((p - 2.0).abs() < 1e-6 && (q - 1.0).abs() < 1e-6, "{p} {q}");
        assert_eq!(verdict.rates[0].name, "L2 in h");
        assert_eq!(verdict.rates[1].name, "L2 in dt");
        let wrong = steps.judged([1.0, 2.0], 0.2, error);
        are(&wrong, [Fail, Fail, Pass]);
        assert_eq!(codes(&wrong), [Reason::TooHigh, Reason::TooLow]);
    }
}

/// One contribution by itself is what the curve shows: its constant is C_h.
#[test]
fn the_constant_is_that_of_one_contribution() {
    let steps = Steps::halved(0.25, 0.1, 6);
    let verdict = steps.judged([2.0, 1.0], 0.05, |h, dt| (3.0 * h * h).hypot(0.2 * dt));
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
    let steps = Steps::halved(0.25, 0.1, 6);
    let exponent = |dt: f64| 2.0 + 0.5 * dt;
    let verdict = steps.judged([2.0, 1.0], 0.2, |h, dt| h.powf(exponent(dt)) + dt);
    let interval = verdict.rates[0].rate.interval.expect("an interval");
    let [finest, next] = [steps.dt[5], steps.dt[4]].map(exponent);
    assert!(next - finest > 1e-3);
    for rate in [next, 2.0 * finest - next] {
        assert!(interval.holds(rate), "{rate} in {interval:?}");
    }
}

#[test]
fn errors_that_do_not_add_are_inconclusive() {
    let steps = Steps::halved(0.5, 0.5, 6);
    for error in [
        (|h, dt| h * dt) as Law,
        |h, dt| h.min(dt),
        |h, dt| (h - dt).abs() + 1e-3 * h,
    ] {
        let verdict = steps.judged([1.0, 1.0], 0.2, error);
        assert_eq!(verdict.checks[0].verdict, Inconclusive, "{verdict:?}");
    }
    // At an angle of 84 degrees: neither of the two models, and the squares very nearly.
    let verdict = steps.judged([1.0, 1.0], 0.2, |h, dt| {
        (h * h + dt * dt + 0.2 * h * dt).sqrt()
    });
    assert!(
        verdicts(&verdict).iter().all(|verdict| *verdict != Fail),
        "{verdict:?}"
    );
}

/// What is lacking grows with h and dt: one run that went wrong does not.
#[test]
fn one_wrong_error_is_named_and_a_product_of_the_steps_is_not() {
    let steps = Steps::halved(0.5, 0.5, 6);
    let error = |h: f64, dt: f64| h * h + 0.02 * dt;
    let wrong = |factor: f64| {
        let at = |h: f64, dt: f64| if [h, dt] == [0.125; 2] { factor } else { 1.0 };
        steps.judged([2.0, 1.0], 0.25, |h, dt| at(h, dt) * error(h, dt))
    };
    for (factor, verdict) in [(1.2, Pass), (1.5, Inconclusive), (0.6, Inconclusive)] {
        let outcome = wrong(factor);
        are(&outcome, [Pass, Pass, verdict]);
        let evidence = outcome.checks[0].evidence.to_string();
        let named = evidence.contains("of the error at h = 0.125, dt = 0.125, at most 0.3");
        assert_eq!(named, verdict != Pass, "{evidence}");
    }
    let product = steps.judged([2.0, 1.0], 0.25, |h, dt| {
        error(h, dt) * (1.0 + 1.5 * h * dt)
    });
    are(&product, [Pass; 3]);
}

#[test]
fn contributions_of_opposite_signs_are_judged_where_one_of_them_prevails() {
    let steps = Steps::halved(0.5, 0.1, 6);
    let prevails = steps.judged([1.0, 1.0], 0.1, |h, dt| h - 0.1 * dt);
    are(&prevails, [Pass; 3]);
    // On the finest meshes the error in dt is larger: e falls, then grows.
    let changes = steps.judged([1.0, 1.0], 0.1, |h, dt| (h - 10.0 * dt).abs());
    assert_ne!(changes.rates[0].rate.verdict, Pass, "{changes:?}");
}

/// Differences cancel a constant: none of these errors tends to zero.
#[test]
fn errors_that_tend_to_a_wrong_limit_fail_and_its_size_is_named() {
    let steps = Steps::halved(0.25, 0.1, 6);
    for (claims, error, size) in [
        ([2.0, 1.0], (|h, dt| 5.0 - h * h - dt) as Law, "5.000e0"),
        ([2.0, 1.0], |h, dt| 1.0 + h * h + dt, "1.000e0"),
        ([2.0, 1.0], |h, dt| (h * h + dt - 0.5).abs(), "5.000e-1"),
        (
            [2.0, 1.0],
            |h, dt| (1.0 + h.powi(4) + dt * dt).sqrt(),
            "1.000e0",
        ),
        ([1.0, 1.0], |h, dt| h + dt + 2e-3, "2.000e-3"),
    ] {
        let verdict = steps.judged(claims, 0.2, error);
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
    let finest = steps.h[5] + steps.dt[5];
    for (share, kind) in [
        (0.004, Reason::Agrees),
        (0.006, Reason::LeftOver),
        (0.09, Reason::LeftOver),
        (0.12, Reason::WrongLimit),
    ] {
        let verdict = steps.judged([1.0, 1.0], 0.2, |h, dt| {
            h + dt + share * finest / (1.0 - share)
        });
        assert_eq!(codes(&verdict), [kind; 2], "{share}: {verdict:?}");
    }
}

/// The finest level tells most of what is left, and its step may be far below the others.
#[test]
fn nothing_is_left_of_true_orders_on_any_steps() {
    let far = [2.0, 2.0, 2.0, 16.0];
    for (first, ratios) in [(0.5, far), (0.125, far), (0.125, [2.0; 4])] {
        let steps = Steps::by_ratios(first, &ratios);
        let verdict = steps.judged([1.0, 1.0], 0.25, |h, dt| {
            h * (1.0 + h) + 0.4 * dt * (1.0 + 0.6 * dt)
        });
        are(&verdict, [Pass; 3]);
    }
}

/// What is left is that of the rate read where the order claimed is not that of the errors; and a
/// limit is seen then as well.
#[test]
fn orders_within_the_tolerance_leave_nothing_and_a_limit_is_seen_beside_them() {
    for levels in [5, 6] {
        let steps = Steps::halved(0.5, 0.5, levels);
        for (claimed, order) in [(0.5, 0.4), (1.0, 0.8), (1.0, 0.9), (1.0, 1.1), (1.0, 1.2)] {
            let error = |h: f64, dt: f64| h * h + 0.3 * dt.powf(order);
            are(&steps.judged([2.0, claimed], 0.25, error), [Pass; 3]);
            let finest = error(steps.h[steps.h.len() - 1], steps.dt[steps.dt.len() - 1]);
            for share in [-3.0, -0.1, 0.1, 0.3] {
                let verdict = steps.judged([2.0, claimed], 0.25, |h, dt| {
                    (error(h, dt) + share * finest).abs()
                });
                let is_pass = |verdict: Verdict| verdict == Pass;
                let pass = verdicts(&verdict)[..2].iter().copied().all(is_pass);
                assert!(!pass, "{order} {share}: {verdict:?}");
            }
        }
    }
}

/// A term of a lower order and the other sign hides in differences at unequal ratios, unless each
/// is taken at its mean step.
#[test]
fn a_half_order_does_not_hide_in_unequal_ratios_and_true_orders_pass_there() {
    for ratios in [[1.25, 2.0, 2.0, 2.0], [2.0, 1.5, 2.0, 1.5], [2.0; 4]] {
        let steps = Steps::by_ratios(0.5, &ratios);
        let half = 0.3 * steps.h[4].sqrt();
        let hidden = steps.judged([2.0, 1.0], 0.25, |h, dt| {
            (h * h - half * h.powf(1.5)).hypot(0.16 * dt * (1.0 + 0.5 * dt * dt))
        });
        assert_ne!(hidden.rates[0].rate.verdict, Pass, "{ratios:?}");
    }
    // At steps so close the rate read absorbs the term; that at the order claimed does not.
    let close = [3.0, 3.5, 6.5, 7.0, 7.5].map(|count| 0.5 / count);
    let steps = Steps {
        h: close.to_vec(),
        dt: close.to_vec(),
    };
    let space = |h: f64| h * h - 0.2 * close[4].sqrt() * h.powf(1.5);
    let hidden = steps.judged([2.0, 1.0], 0.25, |h, dt| {
        space(h).hypot(space(close[4]) / close[4] * dt * (1.0 + 0.3 * dt))
    });
    assert_ne!(hidden.rates[0].rate.verdict, Pass, "{hidden:?}");
    let steps = Steps::by_ratios(0.25, &[2.0, 1.5, 2.0, 1.5]);
    let verdict = steps.judged([2.0, 1.0], 0.25, |h, dt| {
        h * h * (1.0 + 0.4 * h) + 0.3 * dt * (1.0 + 0.3 * dt)
    });
    are(&verdict, [Pass; 3]);
}

#[test]
fn negative_errors_fail_though_their_differences_have_the_orders() {
    let steps = Steps::halved(0.125, 0.125, 4);
    for offset in [0.002, 0.2] {
        let verdict = steps.judged([2.0, 1.0], 0.25, |h, dt| 0.3 * h * h - offset * dt);
        assert_eq!(codes(&verdict), [Reason::NegativeError; 2], "{verdict:?}");
    }
}

/// The finest mesh is that of the level before, and the error in dt hides what is left of it.
#[test]
fn a_finest_level_that_repeats_the_one_before_does_not_pass() {
    let steps = Steps::halved(0.125, 0.125, 5);
    let last_but_one = steps.h[3];
    let stale = |h: f64, dt: f64| 0.3 * h.max(last_but_one).powi(2) + 2.0 * dt;
    let verdict = steps.judged([2.0, 1.0], 0.25, stale);
    are(&verdict, [Inconclusive, Pass, Pass]);
    let rate = &verdict.rates[0].rate;
    assert_eq!(rate.code, Reason::Repeats);
    assert!(rate.because.to_string().starts_with("level 5 repeats"));
    let true_errors = steps.judged([2.0, 1.0], 0.25, |h, dt| 0.3 * h * h + 2.0 * dt);
    are(&true_errors, [Pass; 3]);
}

/// An error that falls and grows in turns has a difference of the claimed order, and no limit that
/// a rate could show.
#[test]
fn differences_that_change_their_sign_do_not_pass() {
    let steps = Steps::halved(0.25, 8.0, 6);
    let sign = |h: f64| {
        if (h.log2() as i32) % 2 == 0 {
            1.0
        } else {
            -1.0
        }
    };
    let verdict = steps.judged([1.0, 1.0], 0.2, |h, dt| dt + 0.1 * h * sign(h));
    are(&verdict, [Inconclusive, Pass, Pass]);
    assert_eq!(codes(&verdict)[0], Reason::NotAsymptotic);
}

/// The error in h is invisible next to that in dt, which is known to one part in a thousand.
#[test]
fn what_scatter_hides_is_inconclusive() {
    let steps = Steps::halved(0.25, 0.1, 6);
    let scatter = |h: f64, dt: f64| 1.0 + 1e-3 * (1e4 * (h + 7.0 * dt)).sin();
    let verdict = steps.judged([2.0, 1.0], 0.2, |h, dt| {
        (1e-3 * h * h + dt) * scatter(h, dt)
    });
    are(&verdict, [Inconclusive, Pass, Pass]);
    assert_eq!(codes(&verdict)[0], Reason::RoundOffFloor);
}

#[test]
fn the_misfit_is_that_of_the_errors_beside_the_finest_row_and_column() {
    let misfit = |h: &[f64], errors: &[f64], adding| {
        let dt = &[0.1, 0.05];
        GridErrors { h, dt, errors }.misfit(adding)
    };
    let of_corner = |corner: f64, adding| misfit(&[0.5, 0.25], &[corner, 4.0, 3.0, 2.0], adding);
    // 5 = 4 + 3 - 2, and 6 instead of 5.
    assert!(of_corner(5.0, Adding::Plain) < 1e-15);
    assert!((of_corner(6.0, Adding::Plain) - 1.2_f64.ln()).abs() < 1e-15);
    assert!((of_corner(5.0, Adding::Squares) - 0.5 * (25.0_f64 / 21.0).ln()).abs() < 1e-15);
    assert!(of_corner(f64::NAN, Adding::Plain).is_nan());
    // 1 + 1 - 2
    let none = misfit(&[0.5, 0.25], &[1.0, 1.0, 1.0, 2.0], Adding::Plain);
    assert_eq!(none, f64::INFINITY);
    assert!(misfit(&[0.5], &[1.0, 1.0], Adding::Plain).is_nan());
}

#[test]
fn an_error_that_is_nan_fails_and_tolerances_that_tell_nothing_are_refused() {
    let steps = Steps::halved(0.25, 0.1, 5);
    let broken = steps.judged([1.0, 1.0], 0.1, |h, dt| {
        if h < 0.02 && dt < 0.01 {
            f64::NAN
        } else {
            h + dt
        }
    });
    assert_eq!(verdicts(&broken)[..2], [Fail, Fail]);
    let grid = GridErrors {
        h: &steps.h,
        dt: &steps.dt,
        errors: &steps.grid([1.0; 2], 0.1, |h, dt| h + dt).columns[0].errors,
    };
    let wide = Claim::new(1.0, 0.5).band();
    let claims = SpaceTime {
        space: wide,
        time: wide,
    };
    assert!(grid.judge(Adding::Plain, claims).is_err());
    let refused = steps.judged([1.0, 1.0], 0.7, |h, dt| h + dt);
    assert!(
        refused.rates.is_empty() && refused.checks[0].verdict == Fail,
        "{refused:?}"
    );
}

#[test]
fn steps_that_differ_within_a_row_are_no_grid() {
    let mut grid = Steps::halved(0.25, 0.1, 5).grid([1.0; 2], 0.1, |h, dt| h + dt);
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
    let steps = Steps::halved(0.25, 0.1, 5);
    let model = |error: fn(f64, f64) -> f64| {
        let grid = Grid {
            squares_add: true,
            ..steps.grid([1.0; 2], 0.1, error)
        };
        grid.judge()
    };
    are(&model(f64::hypot), [Pass; 3]);
    assert_eq!(model(|h, dt| h + dt).checks[0].verdict, Fail);
}
