//! Factors, floors that are offered, default tolerances and samples.

use convergence_judge::random::SplitMix;
use convergence_study::rates::{Choice, Page, Refusal, Request};
use convergence_study::{Of, Verdict};

use super::request;

fn judged(text: &str, request: &Request) -> Result<Page, Refusal> {
    request.page("rates", text)
}

fn sheet(text: &str, request: &Request) -> Page {
    judged(text, request).expect("a table")
}

fn answer(sheet: &Page) -> &str {
    &sheet.tables[0].columns[0].answer
}

/// A claim of a factor.
fn factor(claim: &str) -> Request {
    Request {
        by_factor: true,
        ..request(&[claim], Choice::default())
    }
}

/// Errors that fall by a factor for each unit of a count.
fn exponential(name: &str, counts: &[i32], factor: f64) -> String {
    let rows = counts
        .iter()
        .map(|n| format!("{n},{:.6e}\n", 0.7 * factor.powi(-n)));
    format!("{name},L2\n") + &rows.collect::<String>()
}

#[test]
fn errors_that_fall_by_a_factor_are_judged_by_it() {
    for name in ["n", "p", "degree", "N", "level"] {
        let text = exponential(name, &[2, 4, 6, 8, 10], 4.0);
        for (claim, verdict) in [
            ("4", Verdict::Pass),
            (">=4", Verdict::Pass),
            (">=3", Verdict::Pass),
            ("3", Verdict::Fail),
            (">=6", Verdict::Fail),
            ("L2=4", Verdict::Pass),
        ] {
            let sheet = sheet(&text, &factor(claim));
            assert_eq!(sheet.verdict, verdict, "{name} {claim}: {}", sheet.text);
            let typed = claim.trim_start_matches("L2=");
            let words = answer(&sheet);
            assert!(words.starts_with("factor 4.0"), "{words}");
            assert!(words.contains(&format!("claimed {typed}")), "{words}");
            assert!(sheet.text.contains(&format!("step: `exp(-{name})`")));
        }
    }
    // A factor is more than 1, and is about one count.
    let text = exponential("n", &[2, 4, 6, 8], 4.0);
    assert!(judged(&text, &factor("0.9")).is_err());
    assert!(judged("h,L2\n0.4,0.1\n0.2,0.01\n0.1,0.001\n", &factor("2")).is_err());
    // Algebraic errors have no factor.
    let rows = (2..9).map(|n| format!("{n},{:.6e}\n", f64::from(n).powi(-4)));
    let text = "n,L2\n".to_owned() + &rows.collect::<String>();
    assert!(!sheet(&text, &factor(">=2")).verdict.is_pass());
}

#[test]
fn rates_that_rise_at_each_level_are_told_of_factors() {
    let text = exponential("n", &[4, 8, 16, 32], 1.5);
    let orders = Request {
        choice: Choice {
            dim: Some(1.0),
            ..Choice::default()
        },
        ..request(&["4"], Choice::default())
    };
    let sheet = sheet(&text, &orders);
    assert!(!sheet.verdict.is_pass());
    assert!(sheet.text.contains("--factor F --step n"), "{}", sheet.text);
}

/// Errors of order 6 down to round-off, or to a wrong limit.
fn table(limit: f64, random: &mut SplitMix) -> String {
    let row = |k: i32| {
        let h = 0.5_f64.powi(k);
        let error = 0.3 * h.powi(6) + limit + 4e-16 * random.normal();
        format!("{h},{:.4e}\n", error.abs())
    };
    "h,L2\n".to_owned() + &(1..11).map(row).collect::<String>()
}

#[test]
fn a_floor_is_offered_by_a_command_which_passes_and_none_above_a_wrong_limit() {
    let mut random = SplitMix::new(75);
    let claims = request(&["6"], Choice::default());
    for _ in 0..40 {
        let text = table(0.0, &mut random);
        let found = sheet(&text, &claims);
        assert_eq!(found.verdict, Verdict::Inconclusive, "{}", found.text);
        assert!(answer(&found).contains("round-off, if the solution is of size 1"));
        let (_, call) = found
            .text
            .split_once("rates FILE --order 6 --floor ")
            .expect("a command");
        let floor = call.lines().next().and_then(|floor| floor.parse().ok());
        let with_floor = Request {
            floor: floor.expect("a floor"),
            ..claims.clone()
        };
        assert!(sheet(&text, &with_floor).verdict.is_pass());
        // A small solution is no round-off.
        let small = Request {
            scale: Some(1e-9),
            ..claims.clone()
        };
        assert!(!sheet(&text, &small).text.contains("--floor"));
        for limit in [1e-10, 1e-8] {
            let found = sheet(&table(limit, &mut random), &claims);
            assert!(!found.verdict.is_pass() && !found.text.contains("--floor"));
        }
    }
}

#[test]
fn a_tolerance_is_less_than_the_order_and_small_orders_have_small_ones() {
    let rows = (1..6).map(|k| format!("{},{:.6e}\n", 0.5_f64.powi(k), 0.5_f64.powi(k).powf(0.05)));
    let slow = "h,L2\n".to_owned() + &rows.collect::<String>();
    for order in [">=0.27", "0.27", ">=0.1", "0.1"] {
        let found = sheet(&slow, &request(&[order], Choice::default()));
        assert!(!found.verdict.is_pass(), "{order}: {}", found.text);
    }
    let wide = Request {
        tolerance: Some(0.3),
        ..request(&["0.27"], Choice::default())
    };
    assert!(judged(&slow, &wide).is_err());
}

/// Rows of samples: `numbers` of each of five halved steps.
fn samples(count: usize, mut number: impl FnMut(f64, usize) -> f64) -> String {
    let mut text = "h,seed,error\n".to_owned();
    for k in 0..5 {
        let h = 0.5_f64.powi(k);
        for seed in 0..count {
            text += &format!("{h},{seed},{:.6e}\n", number(h, seed));
        }
    }
    text
}

fn of(of: Of, order: &str) -> Request {
    let choice = Choice {
        samples: Some(of),
        ..Choice::default()
    };
    request(&[order], choice)
}

#[test]
fn rows_with_equal_steps_are_samples_where_the_caller_says_so() {
    let mut random = SplitMix::new(3);
    let text = samples(30, |h, _| h * (1.0 + 0.2 * random.normal()));
    assert!(judged(&text, &request(&["1"], Choice::default())).is_err());
    let found = sheet(&text, &of(Of::Mean, "1"));
    assert!(found.verdict.is_pass(), "{}", found.text);
    assert!(
        found.text.contains("`seed` (numbers of the samples)"),
        "{}",
        found.text
    );
    assert!(found.text.contains("the mean of 30 rows at each step"));
    assert!(!sheet(&text, &of(Of::Mean, "1.5")).verdict.is_pass());
    assert!(sheet(&text, &of(Of::RootMeanSquare, "1")).verdict.is_pass());
    // Too few rows of a step, and one that failed.
    let few = samples(9, |h, _| h);
    assert!(judged(&few, &of(Of::Mean, "1")).is_err());
    let mut lines: Vec<&str> = text.lines().collect();
    lines.remove(30);
    assert!(
        sheet(&lines.join("\n"), &of(Of::Mean, "1"))
            .verdict
            .is_pass()
    );
    for word in ["nan", "diverged", "-1.0e-3", ""] {
        let (first, _) = lines[40].rsplit_once(',').expect("a row");
        let row = format!("{first},{word}");
        let mut broken = lines.clone();
        broken[40] = &row;
        assert!(
            !sheet(&broken.join("\n"), &of(Of::Mean, "1"))
                .verdict
                .is_pass(),
            "{word}"
        );
    }
}

#[test]
fn a_weak_error_is_the_size_of_a_mean_and_a_lost_level_says_how_many_samples_would_do() {
    let mut random = SplitMix::new(4);
    let mut signed = |scatter: f64| samples(900, |h, _| -h * h * (1.0 + scatter * random.normal()));
    let text = signed(0.5);
    let found = sheet(&text, &of(Of::Weak, "2"));
    assert!(found.verdict.is_pass(), "{}", found.text);
    assert!(!sheet(&text, &of(Of::Mean, "2")).verdict.is_pass());
    let lost = sheet(&signed(40.0), &of(Of::Weak, "2"));
    assert!(!lost.verdict.is_pass());
    assert!(answer(&lost).contains("samples would"), "{}", answer(&lost));
}
