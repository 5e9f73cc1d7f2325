//! Tables that referees have put to the rule, each with its verdict: what the rule says of them
//! today, right or wrong.

use convergence_judge::verdict::Cause;
use convergence_study::{Verdict, judge};

use crate::rows::rows;
use crate::verdict_laws::{numbers_of, with_errors};
use crate::verdict_rule::with_error;

#[test]
fn each_table_has_its_verdict_and_cause() {
    for [from, first, tolerance, errors, reason, cause, _] in
        rows(include_str!("verdict_tables.md"))
    {
        let [first, tolerance] = [first, tolerance].map(|cell| numbers_of(cell)[0]);
        let levels = with_errors(first, &numbers_of(errors));
        let judged = judge(&levels, 2.0, tolerance);
        let found = serde_json::to_value(judged.cause).expect("a cause");
        let found = [judged.code.name(), found.as_str().unwrap_or_default()];
        assert_eq!(found, [reason, cause], "{from}: {judged:?}");
        let advice = judged.advice().unwrap_or_default();
        let is_explained = |cause: Cause| advice.ends_with(cause.advice());
        assert!(judged.cause.is_none_or(is_explained), "{from}: {advice}");
    }
}

/// The errors 0.0406, 0.0103, 0.00265, 0.0007 are of first order, h² + 0.003 h.
#[test]
fn no_three_of_four_levels_pass_where_the_four_do_not() {
    let four = with_error(0.2, 2.0, 4, |h| h * h + 0.003 * h);
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
    let judged = judge(&with_error(0.1, 2.0, 5, |h| h.powf(1.8)), 2.0, 0.25);
    assert!(
        judged.verdict.is_pass() && judged.answer(2).ends_with(": 2, not 1.5 or 2.5"),
        "{judged:?}"
    );
}
