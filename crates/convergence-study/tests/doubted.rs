//! Errors that are those of another level, of another column, or of no discretization: tables and
//! studies say so, and do not pass.

use convergence_study::{
    Claim, Kind, Outcome, Reason, Verdict, levels,
    rates::{Claimed, Request, Tables},
};
use serde_json::Value;

const STEPS: [&str; 5] = ["0.2", "0.1", "0.05", "0.025", "0.0125"];
const RIGHT: [&str; 5] = ["4.087e-1", "1.023e-1", "2.561e-2", "6.403e-3", "1.601e-3"];
const OTHER: [&str; 5] = ["8.123e-1", "2.036e-1", "5.095e-2", "1.274e-2", "3.186e-3"];

fn text(columns: &[(&str, [&str; 5])]) -> String {
    let names: String = columns.iter().map(|(name, _)| format!(" {name}")).collect();
    let row = |k: usize| {
        let cells: String = columns
            .iter()
            .map(|(_, cells)| format!(" {}", cells[k]))
            .collect();
        format!("{}{cells}\n", STEPS[k])
    };
    format!("h{names}\n") + &(0..STEPS.len()).map(row).collect::<String>()
}

fn request(orders: &[&str], floor: f64) -> Request {
    let claims: Vec<Claimed> = orders
        .iter()
        .map(|order| order.parse().expect("a claim"))
        .collect();
    Request {
        claims,
        floor,
        ..Request::default()
    }
}

fn judged(columns: &[(&str, [&str; 5])], orders: &[&str]) -> Value {
    let text = text(columns);
    request(orders, 0.0)
        .object("rates", Tables::Text(&text))
        .expect("a table")
}

/// The codes of the rates, and the verdict.
#[track_caller]
fn says(object: &Value, codes: &[&str], verdict: &str) {
    let rates = object["rates"].as_array().expect("rates").iter();
    let found: Vec<&str> = rates.filter_map(|rate| rate["code"].as_str()).collect();
    assert_eq!(
        (&*found, &object["verdict"]),
        (codes, &Value::from(verdict))
    );
}

#[test]
fn a_table_with_a_repeated_level_does_not_pass() {
    says(&judged(&[("L2", RIGHT)], &["2"]), &["agrees"], "pass");
    for level in 1..RIGHT.len() {
        let mut errors = RIGHT;
        errors[level] = errors[level - 1];
        let found = judged(&[("L2", errors)], &["2"]);
        says(&found, &["repeats"], "inconclusive");
    }
    // Printed with three digits, of which the number has one.
    let zeros = ["1.00", "1.00", "0.250", "0.0625", "0.015625"];
    says(
        &judged(&[("L2", zeros)], &["2"]),
        &["repeats"],
        "inconclusive",
    );
    let same = judged(&[("L2", ["4.087e-1"; 5])], &["2"]);
    says(&same, &["identical"], "fail");
}

#[test]
fn equal_columns_with_claims_do_not_pass_and_others_are_named() {
    const EQUAL: &str = "L2 and max are equal in all digits";
    let notes = |object: &Value| object["notes"].to_string().contains(EQUAL);
    let other = judged(&[("L2", RIGHT), ("max", OTHER)], &["2"]);
    says(&other, &["agrees"; 2], "pass");
    let equal = [("L2", RIGHT), ("max", RIGHT)];
    let both = judged(&equal, &["2"]);
    says(&both, &["equal-columns"; 2], "inconclusive");
    assert_eq!([&other, &both].map(notes), [false, true]);
    let one = judged(&equal, &["L2=2"]);
    says(&one, &["agrees", "unclaimed"], "pass");
    let shown = request(&["L2=2"], 0.0).page("rates", &text(&equal));
    let sentence = shown.expect("a table").sentence;
    assert!(sentence.contains(EQUAL), "{sentence}");
}

#[test]
fn zeros_below_the_floor_are_dropped_from_a_table() {
    let rows = [
        ("2", "1.3205e-8"),
        ("4", "2.0764e-10"),
        ("8", "3.2496e-12"),
        ("16", "5.0848e-14"),
        ("32", "6.6613e-16"),
        ("64", "0"),
        ("128", "0"),
    ];
    let text = rows
        .iter()
        .fold("n e\n".to_owned(), |text, (n, e)| text + n + " " + e + "\n");
    for (floor, code, verdict) in [
        (1e-14, "agrees", "pass"),
        (0.0, "round-off", "inconclusive"),
    ] {
        let mut request = request(&["6"], floor);
        request.choice.dim = Some(1.0);
        let found = request.object("rates", Tables::Text(&text));
        says(&found.expect("a table"), &[code], verdict);
    }
}

#[test]
fn a_claim_of_a_table_may_be_open() {
    let steep = ["4.087e-1", "2.561e-2", "1.601e-3", "1.0006e-4", "6.254e-6"];
    for (order, code, verdict) in [
        ("2", "too-high", "fail"),
        (">=2", "too-good", "inconclusive"),
        (">=2..", "agrees", "pass"),
        ("L2=>=2..", "agrees", "pass"),
        (">=3", "agrees", "pass"),
    ] {
        says(&judged(&[("L2", steep)], &[order]), &[code], verdict);
    }
    assert!("2..".parse::<Claimed>().is_err() && ">=2...".parse::<Claimed>().is_err());
}

fn outcome(
    errors: impl Fn(usize) -> Vec<(&'static str, f64)> + Send + Sync,
    names: &[&str],
) -> Outcome {
    let study = levels([4, 8, 16, 32, 64], errors);
    let study = names.iter().fold(study, |study, name| {
        study.claiming(*name, Claim::new(2.0, 0.25))
    });
    study.judge(&study.run_here())
}

#[test]
fn a_program_with_a_repeated_level_or_column_does_not_pass() {
    let error = |n: usize| 0.347_1 * (n as f64).powi(-2);
    let right = outcome(
        |n| vec![("L2", error(n)), ("max", 2.1 * error(n))],
        &["L2", "max"],
    );
    assert_eq!(right.verdict, Verdict::Pass);

    let stale = outcome(
        |n| vec![("L2", error(if n == 16 { 8 } else { n }))],
        &["L2"],
    );
    assert_eq!(
        (stale.verdict, stale.rates[0].rate.code),
        (Verdict::Inconclusive, Reason::Repeats)
    );

    let unused = outcome(|_| vec![("L2", error(8))], &["L2"]);
    assert_eq!(
        (unused.verdict, unused.rates[0].rate.code),
        (Verdict::Fail, Reason::Identical)
    );
    let words = unused.rates[0].rate.because.to_string();
    assert!(words.contains("does the program use {n}?"), "{words}");

    let equal = |n: usize| vec![("L2", error(n)), ("max", error(n))];
    let both = outcome(equal, &["L2", "max"]);
    assert_eq!(both.verdict, Verdict::Inconclusive);
    assert!(
        both.rates
            .iter()
            .all(|rate| rate.rate.code == Reason::EqualColumns)
    );
    let one = outcome(equal, &["L2"]);
    assert_eq!(one.verdict, Verdict::Pass);
    assert!(
        one.checks
            .iter()
            .any(|check| check.claim.to_string().contains("equal in all digits"))
    );
}
