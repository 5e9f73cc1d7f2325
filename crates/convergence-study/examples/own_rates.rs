//! The rule applied to the errors of three quadrature formulas for the integral of exp.
//!
//! `cargo run -p convergence-study --example own_rates`

use convergence_study::{RateVerdict, Verdict, judge_pairs};

/// A formula for the integral over an interval of midpoint m and width h.
type Formula = fn(f64, f64) -> f64;

fn judge(formula: Formula, order: f64) -> RateVerdict {
    let exact = 1_f64.exp() - 1.0;
    let level = |n: i32| {
        let h = 1.0 / f64::from(n);
        let sum: f64 = (0..n).map(|i| formula((f64::from(i) + 0.5) * h, h)).sum();
        (h, (sum - exact).abs())
    };
    judge_pairs([4, 8, 16, 32, 64].map(level), order, 0.05)
}

fn main() {
    let left: Formula = |m, h| h * (m - 0.5 * h).exp();
    let midpoint: Formula = |m, h| h * m.exp();
    for (name, formula, order) in [
        ("left end, claimed 1", left, 1.0),
        ("midpoint, claimed 2", midpoint, 2.0),
        ("midpoint, claimed 1", midpoint, 1.0),
    ] {
        println!("{name}: {}", judge(formula, order).reason);
    }
    assert_eq!(judge(midpoint, 2.0).verdict, Verdict::Pass);
    // A better rate than claimed fails, too.
    assert_eq!(judge(midpoint, 1.0).verdict, Verdict::Fail);
}

#[test]
fn it_runs() {
    main();
}
