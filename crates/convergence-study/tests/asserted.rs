//! What a test of a solver sees: a pass is silent; anything else prints the table, the rate, the
//! reason and what to do.

use std::panic::catch_unwind;

use convergence_study::{Interval, Verdict, assert_order, judge_pairs, levels};

const H: [f64; 5] = [0.25, 0.125, 0.0625, 0.03125, 0.015625];

/// The message of the panic.
fn panics(run: impl FnOnce() + std::panic::UnwindSafe) -> String {
    *catch_unwind(run)
        .expect_err("a panic")
        .downcast::<String>()
        .expect("a message")
}

#[test]
fn an_order_is_asserted_or_the_message_has_all_there_is_to_know() {
    assert_order(&H, &H.map(|h| h * h), 2.0);
    let low = panics(|| assert_order(&H, &H.map(|h| h.powf(1.5)), 2.0));
    for part in [
        "  0.25  1.2500e-1",
        "1.500000\n",
        "error: fail: 1.500000 ± 0.0000005, claimed 2 ± 0.25: too low",
        "too-low: The whole interval lies below the band",
    ] {
        assert!(low.contains(part), "{part}:\n{low}");
    }
    let few = panics(|| assert_order(&H[..2], &[1.0, 0.25], 2.0));
    assert!(
        few.contains("error: inconclusive")
            && few.contains("A rate with an interval needs three levels"),
        "{few}"
    );
    let nan = panics(|| assert_order(&H, &[75.976, f64::NAN, f64::NAN, f64::NAN, f64::NAN], 2.0));
    assert!(
        nan.contains("error: fail") && nan.contains("NaN or infinite"),
        "{nan}"
    );
    let unequal = panics(|| assert_order(&H, &[1.0], 2.0));
    assert_eq!(
        unequal,
        "5 steps and 1 errors: expected one error for each step"
    );
}

#[test]
fn levels_are_run_and_asserted_in_a_line() {
    let solve = |n: usize| [("L2", (n as f64).powi(-2)), ("up", 1.0)];
    let found = levels([8, 16, 32, 64], solve)
        .claim("L2", 2.0)
        .assert_passes();
    assert_eq!(
        (found.outcome.verdict, found.outcome.levels[3].step),
        (Verdict::Pass, Some(1.0 / 64.0))
    );
    let absent = panics(|| {
        drop(
            levels([8, 16, 32, 64], solve)
                .claim("L3", 2.0)
                .assert_passes(),
        );
    });
    assert!(
        absent.contains("no level has an error `L3`; there are L2, up"),
        "{absent}"
    );
    let breaks = |n: usize| {
        if n == 32 {
            Err(std::fmt::Error)
        } else {
            Ok([("L2", (n as f64).powi(-2))])
        }
    };
    let failed = panics(move || {
        drop(
            levels([8, 16, 32, 64], breaks)
                .claim("L2", 2.0)
                .assert_passes(),
        );
    });
    assert!(
        failed.contains("n = 32: an error occurred when formatting an argument"),
        "{failed}"
    );
    let panicked = |n: usize| {
        if n == 32 {
            panic!("pivot lost")
        } else {
            (n as f64).powi(-2)
        }
    };
    let failed = panics(move || {
        drop(
            levels([8, 16, 32, 64], panicked)
                .claim("error", 2.0)
                .assert_passes(),
        );
    });
    assert!(
        failed.contains("n = 32: panicked at asserted.rs:") && failed.contains("pivot lost"),
        "{failed}"
    );
    let nothing = panics(move || drop(levels([8, 16, 32, 64], solve).assert_passes()));
    assert!(
        nothing.contains("no order of any error is claimed"),
        "{nothing}"
    );
}

/// `tests/test_package.py` of the Python package has the same numbers.
#[test]
fn the_bits_of_a_rate_are_those_that_python_has() {
    let table = [
        (0.25, 0.041),
        (0.125, 0.0103),
        (0.0625, 0.00257),
        (0.03125, 0.000642),
    ];
    let rate = judge_pairs(table, 2.0, 0.25);
    assert_eq!(
        (rate.fitted, rate.interval),
        (
            Some(1.9993524479350309),
            Some(Interval {
                low: 1.992143758083014,
                high: 2.006561137787048
            })
        )
    );
}
