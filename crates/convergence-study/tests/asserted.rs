//! What a test of a solver sees: a pass is silent; anything else prints the table, the rate, the
//! reason and what to do.

use std::panic::{UnwindSafe, catch_unwind};

use convergence_study::{Interval, IntoErrors, Verdict, assert_order, judge_pairs, levels};

const H: [f64; 5] = [0.25, 0.125, 0.0625, 0.03125, 0.015625];

/// The message of the panic has these parts.
#[track_caller]
fn panics(parts: &[&str], run: impl FnOnce() + UnwindSafe) {
    let panicked = catch_unwind(run).expect_err("a panic");
    let message = panicked.downcast::<String>().expect("a message");
    for part in parts {
        assert!(message.contains(part), "{part}:\n{message}");
    }
}

#[test]
fn an_order_is_asserted_or_the_message_has_all_there_is_to_know() {
    assert_order(&H, &H.map(|h| h * h), 2.0);
    let low = [
        "  0.25  1.2500e-1",
        "1.500000\n",
        "error: fail: 1.500000 ± 0.0000005, claimed 2 ± 0.25: too low",
        "too-low: The whole interval lies below the band",
    ];
    panics(&low, || assert_order(&H, &H.map(|h| h.powf(1.5)), 2.0));
    let few = [
        "error: inconclusive",
        "A rate with an interval needs three levels",
    ];
    panics(&few, || assert_order(&H[..2], &[1.0, 0.25], 2.0));
    let nan = [75.976, f64::NAN, f64::NAN, f64::NAN, f64::NAN];
    panics(&["error: fail", "NaN or infinite"], || {
        assert_order(&H, &nan, 2.0);
    });
    panics(
        &["5 steps and 1 errors: expected one error for each step"],
        || assert_order(&H, &[1.0], 2.0),
    );
}

/// The assertion of an error of second order fails with these words.
#[track_caller]
fn fails<R: IntoErrors>(
    parts: &[&str],
    name: &str,
    solve: impl Fn(usize) -> R + Send + Sync + UnwindSafe,
) {
    panics(parts, || {
        drop(
            levels([8, 16, 32, 64], solve)
                .claim(name, 2.0)
                .assert_passes(),
        );
    });
}

#[test]
fn levels_are_run_and_asserted_in_a_line() {
    let second = |n: usize| (n as f64).powi(-2);
    let solve = move |n: usize| [("L2", second(n)), ("up", 1.0)];
    let found = levels([8, 16, 32, 64], solve).claim("L2", 2.0);
    let found = found.assert_passes().outcome;
    assert_eq!(found.verdict, Verdict::Pass);
    assert_eq!(found.levels[3].step, Some(1.0 / 64.0));
    let absent = "no level has an error `L3`; there are L2, up";
    fails(&[absent], "L3", solve);
    let failed = "n = 32: an error occurred when formatting an argument";
    fails(&[failed], "L2", move |n| match n {
        32 => Err(std::fmt::Error),
        _ => Ok([("L2", second(n))]),
    });
    let panicked = ["n = 32: panicked at asserted.rs:", "pivot lost"];
    fails(&panicked, "error", move |n| match n {
        32 => panic!("pivot lost"),
        _ => second(n),
    });
    panics(&["no order of any error is claimed"], move || {
        drop(levels([8, 16, 32, 64], solve).assert_passes());
    });
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
    let [low, high] = [1.992143758083014, 2.006561137787048];
    assert_eq!(rate.fitted, Some(1.9993524479350309));
    assert_eq!(rate.interval, Some(Interval { low, high }));
}
