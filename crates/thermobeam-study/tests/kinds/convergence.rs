//! Levels that are added until there is a verdict.

use std::path::{Path, PathBuf};

use convergence_study::{CaseFailure, Check, FromFile, Kind, Outcome, Reason, Verdict, run_one};
use thermobeam_study::exact::norm::Norms;
use thermobeam_study::kinds::orders::Orders;
use thermobeam_study::kinds::orders::manufactured::{Convergence, Prepared};

/// The study of Theorem 3.4 in h.
fn file() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies/theorem-3.4-space.toml")
}

/// Its outcome with these elements and this tolerance.
fn outcome(elements: &str, tolerance: &str) -> Outcome {
    let text = std::fs::read_to_string(file()).unwrap();
    let listed = text
        .lines()
        .find(|line| line.starts_with("elements = "))
        .unwrap();
    assert!(text.contains("tolerance = 0.002"));
    let text = text
        .replace(listed, elements)
        // The constant is claimed of the finest mesh that the file lists.
        .replace("within = 1e-6", "within = 0.1")
        .replace("tolerance = 0.002", tolerance);
    run_one(&Orders::<Convergence>::parse(&text, &file()).unwrap())
}

#[test]
fn levels_are_added_until_every_rate_is_decided() {
    let auto =
        |tolerance: &str| outcome("elements = \"auto\"", &format!("tolerance = {tolerance}"));
    let easy = auto("0.25");
    assert_eq!(
        (easy.verdict, easy.levels.len()),
        (Verdict::Pass, 4),
        "{}",
        easy.summary
    );
    assert!(
        easy.summary
            .to_string()
            .ends_with("; decided after 4 levels"),
        "{}",
        easy.summary
    );
    let hard = auto("0.005");
    let count = hard.levels.len();
    assert!(
        (5..=8).contains(&count) && hard.verdict == Verdict::Pass,
        "{}",
        hard.summary
    );
    assert!(
        hard.summary
            .to_string()
            .contains(&format!("; decided after {count} levels; ")),
        "{}",
        hard.summary
    );
    // The same levels, listed, have the same rates; with one level fewer the verdict is weaker.
    let listed = |count: u32| {
        let elements: Vec<String> = (0..count).map(|level| (8 << level).to_string()).collect();
        outcome(
            &format!("elements = [{}]", elements.join(", ")),
            "tolerance = 0.005",
        )
    };
    assert_eq!(listed(count as u32).rates, hard.rates);
    assert_eq!(listed(count as u32 - 1).verdict, Verdict::Inconclusive);
    // The numbers of the first levels are guarded, but no rate.
    assert!(
        hard.quantities
            .iter()
            .all(|quantity| quantity.name.starts_with("error "))
    );
    assert_eq!(hard.quantities.len(), easy.quantities.len());
}

#[test]
fn a_budget_ends_a_study_without_a_verdict() {
    let spent = outcome("elements = \"auto\"\nbudget = 3000", "tolerance = 0.005");
    assert_eq!(
        (spent.verdict, spent.levels.len()),
        (Verdict::Inconclusive, 4)
    );
    let ending = "undecided after 4 levels: the next would take about 2.56e3 node-steps, more than what is left of the budget of 3000 node-steps";
    assert!(
        spent.summary.to_string().ends_with(ending),
        "{}",
        spent.summary
    );
}

#[test]
fn no_level_is_added_to_one_that_failed() {
    let mut study = Orders::<Convergence>::read(file()).unwrap();
    study.refine.elements = vec![8, 16, 32, 64];
    study.refine.budget = Some(1e7);
    study
        .expect
        .iter_mut()
        .for_each(|(_, claim)| claim.tolerance = 0.005);
    let mut runs: Vec<_> = study.run_here().into_iter().take(4).collect();
    assert_eq!(study.more(&runs).map(|case| case.data), Some((128, 20)));
    runs[1].found = Err(CaseFailure::new("planted"));
    assert_eq!(study.more(&runs), None);
    let outcome = study.judge(&runs);
    assert_eq!(outcome.verdict, Verdict::Fail);
    assert!(
        !outcome.summary.to_string().contains("decided after"),
        "{}",
        outcome.summary
    );
}

#[test]
fn on_a_grid_the_squares_of_both_errors_must_add() {
    let mut study =
        Orders::<Convergence>::read(file().with_file_name("theorem-3.4-grid.toml")).unwrap();
    study.refine.elements = vec![8, 16, 32, 64];
    study.refine.steps = vec![8, 16, 32, 64];
    let mut runs = study.run_here();
    let adds = |outcome: Outcome| {
        let of_sum = |check: &&Check| check.subject.quantity == "sum of errors";
        let checks: Vec<_> = outcome.checks.iter().filter(of_sum).cloned().collect();
        assert_eq!(checks.len(), study.expect.len());
        Verdict::worst(checks.iter().map(|check| check.verdict))
    };
    assert_eq!(adds(study.judge(&runs)), Verdict::Pass);
    for run in &mut runs {
        let (elements, steps) = run.case.data;
        let sum = 1.0 / elements as f64 + 1.0 / steps as f64;
        run.found = Ok(Norms::of(|_| sum));
    }
    assert_eq!(adds(study.judge(&runs)), Verdict::Fail);
}

#[test]
fn a_least_order_and_a_constant_are_claims_of_the_beam_too() {
    let elements = "elements = [16, 32, 64, 128]";
    let claimed = |claim: &str| {
        let outcome = outcome(elements, &format!("tolerance = 0.25\n{claim}"));
        let rate = outcome.rate("theorem-3.4").unwrap();
        (rate.kind, rate.constant.unwrap())
    };
    let (kind, constant) = claimed("");
    assert_eq!(kind, Reason::Agrees);
    let between = |least: f64, most: f64| {
        claimed(&format!(
            "constant = [{}, {}]",
            least * constant,
            most * constant
        ))
        .0
    };
    assert_eq!(between(0.5, 2.0), Reason::Agrees);
    assert_eq!(between(2.0, 4.0), Reason::ConstantOff);
    let least = |order: &str| {
        let text = std::fs::read_to_string(file()).unwrap();
        let text = text.replace(
            "order = 1.0\ntolerance = 0.002",
            &format!("order = {order}\ntolerance = 0.2"),
        );
        run_one(&Orders::<Convergence>::parse(&text, &file()).unwrap()).verdict
    };
    assert_eq!(
        (least("\">= 0.5\""), least("\">= 1.5\"")),
        (Verdict::Pass, Verdict::Fail)
    );
}

#[test]
fn a_claim_that_is_no_order_is_refused() {
    let refused = |from: &str, to: &str| {
        let text = std::fs::read_to_string(file()).unwrap();
        assert!(text.contains(from));
        Orders::<Convergence>::parse(&text.replacen(from, to, 1), &file())
            .expect_err("a refusal")
            .to_string()
    };
    for to in [
        "order = \"<= 1\"",
        "order = \">= 0\"",
        "order = \"1\"",
        "order = -1",
    ] {
        let message = refused("order = 1.0", to);
        assert!(
            message.contains("order") && message.contains("number > 0"),
            "{message}"
        );
    }
    let message = refused("order = 1.0", "order = 1.0\nconstant = [2.0, 1.0]");
    assert!(
        message.contains("constant") && message.contains("the smaller first"),
        "{message}"
    );
}

/// The outcome of the study of Theorem 3.4 over this axis, with a viscosity that is wrong by ζ
/// times the step: a mistake that keeps every first order.
fn with_viscosity_off_by_the_step(axis: &str) -> Outcome {
    let name = format!("theorem-3.4-{axis}.toml");
    let study = Orders::<Convergence>::read(file().with_file_name(name)).unwrap();
    let mut runs: Vec<_> = study.run_here();
    for run in &mut runs {
        let (elements, steps) = run.case.data;
        let mut solver = study.solver;
        solver.beam.zeta *= 1.0 + 1.0 / elements.max(steps) as f64;
        run.found = Prepared::new(&study, elements)
            .unwrap()
            .run(steps, solver, None);
    }
    study.judge(&runs)
}

#[test]
fn the_constant_sees_a_mistake_that_keeps_the_order() {
    for axis in ["space", "time"] {
        let outcome = with_viscosity_off_by_the_step(axis);
        let rate = outcome
            .rates
            .iter()
            .find(|rate| rate.name == "theorem-3.4")
            .unwrap();
        assert_eq!(
            rate.rate.verdict,
            Verdict::Pass,
            "{axis}: {}",
            outcome.summary
        );
        let failed: Vec<_> = failed_claims(&outcome);
        assert_eq!(failed.len(), 1, "{axis}: {failed:?}");
        assert!(
            failed[0].contains("known before the run"),
            "{axis}: {failed:?}"
        );
    }
}

/// (5.1): a coefficient that is off by a hundredth is no pass.
#[test]
fn a_mistake_in_the_papers_coefficients_fails() {
    for axis in ["space", "time"] {
        let name = format!("theorem-3.4-data-{axis}.toml");
        let study = Orders::<Convergence>::read(file().with_file_name(name)).unwrap();
        let mut runs: Vec<_> = study.run_here();
        assert_eq!(study.judge(&runs).verdict, Verdict::Pass, "{axis}");
        for run in &mut runs {
            let (elements, steps) = run.case.data;
            let mut solver = study.solver;
            solver.beam.rho *= 1.01;
            run.found = Prepared::new(&study, elements)
                .unwrap()
                .run(steps, solver, None);
        }
        assert_ne!(study.judge(&runs).verdict, Verdict::Pass, "{axis}");
    }
}

#[test]
fn a_constant_is_refused_where_none_is_known() {
    let text = std::fs::read_to_string(file()).unwrap();
    for (from, to) in [
        ("isolate = true", "isolate = false"),
        ("isolate = true", "isolate = true\nmap = \"s^2\""),
    ] {
        let message = Orders::<Convergence>::parse(&text.replace(from, to), &file())
            .unwrap_err()
            .to_string();
        assert!(
            message.contains("constant: found a study whose constant is not known"),
            "{message}"
        );
    }
}

fn failed_claims(outcome: &Outcome) -> Vec<String> {
    outcome
        .checks
        .iter()
        .filter(|check| check.verdict != Verdict::Pass)
        .map(|check| check.claim.to_string())
        .collect()
}
