//! Tables that referees have put to the rule, each with its verdict: what the rule says of them
//! today, right or wrong.

use convergence_judge::verdict::Cause;
use convergence_study::Reason::{self, *};
use convergence_study::{Level, Verdict, judge};

/// A table and what the rule says of it if the order 2 is claimed.
struct Row {
    /// The errors in words.
    name: &'static str,
    /// The coarsest step; the others are halved.
    first: f64,
    levels: usize,
    /// With or without its sign.
    error: fn(f64) -> f64,
    tolerance: f64,
    kind: Reason,
    cause: Option<Cause>,
}

const fn row(
    name: &'static str,
    [first, levels]: [f64; 2],
    error: fn(f64) -> f64,
    kind: Reason,
) -> Row {
    Row {
        name,
        first,
        levels: levels as usize,
        error,
        tolerance: 0.25,
        kind,
        cause: None,
    }
}

const fn explained(row: Row, cause: Cause) -> Row {
    Row {
        cause: Some(cause),
        ..row
    }
}

/// An error that is larger and smaller by 30 % in turns; 0.1, 0.05, ... are the steps.
fn odd_even(h: f64) -> f64 {
    let is_odd = (0.1 / h).log2().round() as i32 % 2 == 1;
    h * h * if is_odd { 1.3 } else { 0.7 }
}

const SIGN: Cause = Cause::SignChange;

const ROWS: [Row; 23] = [
    // Sound, of an order that the levels show with another cause, or not yet.
    explained(
        row(
            "|h² - 24.2 h³|",
            [0.1, 4.0],
            |h| h * h - 24.2 * h.powi(3),
            TooLow,
        ),
        SIGN,
    ),
    row(
        "|h² - 24.2 h³|",
        [0.1, 8.0],
        |h| h * h - 24.2 * h.powi(3),
        Agrees,
    ),
    explained(
        row(
            "|h² - 125 h³|",
            [0.1, 5.0],
            |h| h * h - 125.0 * h.powi(3),
            NotAsymptotic,
        ),
        SIGN,
    ),
    row("h² |log h|", [0.125, 5.0], |h| h * h * h.ln(), Agrees),
    row("h² |log h|", [0.125, 7.0], |h| h * h * h.ln(), Agrees),
    Row {
        tolerance: 0.05,
        ..explained(
            row(
                "h² |log h|",
                [0.125, 7.0],
                |h| h * h * h.ln(),
                IntervalTooWide,
            ),
            Cause::Logarithm,
        )
    },
    row(
        "h² (1 ± 0.3), odd and even",
        [0.1, 6.0],
        odd_even,
        NotAsymptotic,
    ),
    row("h² (1 + h)", [0.25, 4.0], |h| h * h * (1.0 + h), Agrees),
    row("1e-9 h²", [0.1, 5.0], |h| 1e-9 * h * h, Agrees),
    row("h^1.8", [0.1, 5.0], |h| h.powf(1.8), Agrees),
    // First order, or a wrong limit: three levels decide no more than the four or five that they
    // are part of.
    row("h² + 0.003 h", [0.2, 5.0], |h| h * h + 0.003 * h, Departs),
    row("h² + 0.003 h", [0.2, 4.0], |h| h * h + 0.003 * h, Departs),
    row("h² + 0.003 h", [0.1, 3.0], |h| h * h + 0.003 * h, AtTheEdge),
    row(
        "h² + 0.003 h",
        [0.2, 3.0],
        |h| h * h + 0.003 * h,
        NotAsymptotic,
    ),
    row("h² + 9e-6", [0.1, 4.0], |h| h * h + 9e-6, Departs),
    row("h² + 9e-6", [0.05, 3.0], |h| h * h + 9e-6, IntervalTooWide),
    row("h² + 3.77e-5", [0.1, 5.0], |h| h * h + 3.77e-5, FallsAway),
    row(
        "h² + 3.77e-5",
        [0.1, 3.0],
        |h| h * h + 3.77e-5,
        IntervalTooWide,
    ),
    row(
        "h² + 0.0033 h",
        [0.1, 3.0],
        |h| h * h + 0.0033 * h,
        AtTheEdge,
    ),
    row(
        "h² + 1e-4, a fifth less in turns",
        [1.0, 9.0],
        |h| h * h + if h.log2() as i32 % 2 == 0 { 1e-4 } else { 8e-5 },
        FallsAway,
    ),
    row(
        "a rate of 76, then 1",
        [1.0, 4.0],
        |h| if h < 1.0 { h * h } else { 2e22 },
        Agrees,
    ),
    // First order that these levels do not show: the rule is wrong about it. A wrong limit.
    row(
        "h² - 4.106 h³ + 0.001813 h",
        [0.1, 5.0],
        |h| h * h * (1.0 - 4.106 * h) + 0.001813 * h,
        Agrees,
    ),
    row(
        "h² (1 - 5.671 h) + 1.717e-6",
        [0.1, 6.0],
        |h| h * h * (1.0 - 5.671 * h) + 1.717e-6,
        LowerOrderLikely,
    ),
];

fn table(first: f64, levels: usize, error: fn(f64) -> f64) -> Vec<Level> {
    let steps = (0..levels).map(|k| first * 0.5_f64.powi(k as i32));
    steps
        .map(|step| Level {
            step,
            error: error(step).abs(),
        })
        .collect()
}

#[test]
fn each_table_has_its_verdict_and_cause() {
    for Row {
        name,
        first,
        levels,
        error,
        tolerance,
        kind,
        cause,
    } in ROWS
    {
        let judged = judge(&table(first, levels, error), 2.0, tolerance);
        assert_eq!(
            (judged.code, judged.cause),
            (kind, cause),
            "{name}, {levels} levels, ± {tolerance}: {judged:?}"
        );
        let advice = judged.advice().unwrap_or_default();
        assert!(
            cause.is_none_or(|cause| advice.ends_with(cause.advice())),
            "{name}: {advice}"
        );
    }
}

/// The errors 0.0406, 0.0103, 0.00265, 0.0007 are of first order, h² + 0.003 h.
#[test]
fn no_three_of_four_levels_pass_where_the_four_do_not() {
    let four = table(0.2, 4, |h| h * h + 0.003 * h);
    for levels in [&four[..], &four[1..], &four[..3]] {
        assert_eq!(
            judge(levels, 2.0, 0.25).verdict,
            Verdict::Inconclusive,
            "{levels:?}"
        );
    }
}

/// The largest tolerances leave half an order on either side.
#[test]
fn a_pass_says_which_orders_it_excludes() {
    let judged = judge(&table(0.1, 5, |h| h.powf(1.8)), 2.0, 0.25);
    assert!(
        judged.verdict.is_pass() && judged.answer(2).ends_with(": 2, not 1.5 or 2.5"),
        "{judged:?}"
    );
}
