//! Levels that are added until there is a verdict.

use convergence_study::{CaseFailure, Check, Kind, Outcome, Reason, Verdict, run_one};
use thermobeam_study::exact::norm::Norms;
use thermobeam_study::kinds::orders::Orders;
use thermobeam_study::kinds::orders::manufactured::{self, Prepared};
use thermobeam_study::scene::Coefficients;

use super::{parsed, read, text};

type Convergence = Orders<manufactured::Convergence>;

/// The study of Theorem 3.4 in h.
const FILE: &str = "theorem-3.4-space.toml";

/// Its outcome with these elements and this tolerance.
fn outcome(elements: &str, tolerance: &str) -> Outcome {
    let text = text(FILE);
    let mut lines = text.lines();
    let listed = lines.find(|line| line.starts_with("elements = ")).unwrap();
    assert!(text.contains("tolerance = 0.002"));
    let text = text
        .replace(listed, elements)
        // The constant is claimed of the finest mesh that the file lists.
        .replace("within = 1e-6", "within = 0.1")
        .replace("tolerance = 0.002", tolerance);
    run_one(&parsed::<Convergence>(&text))
}

#[test]
fn levels_are_added_until_every_rate_is_decided() {
    let auto =
        |tolerance: &str| outcome("elements = \"auto\"", &format!("tolerance = {tolerance}"));
    let easy = auto("0.25");
    let summary = easy.summary.to_string();
    assert_eq!(
        (easy.verdict, easy.levels.len()),
        (Verdict::Pass, 4),
        "{summary}"
    );
    assert!(summary.ends_with("; decided after 4 levels"), "{summary}");
    let hard = auto("0.005");
    let (count, summary) = (hard.levels.len(), hard.summary.to_string());
    assert!(
        (5..=8).contains(&count) && hard.verdict == Verdict::Pass,
        "{summary}"
    );
    assert!(
        summary.contains(&format!("; decided after {count} levels; ")),
        "{summary}"
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
    let mut study: Convergence = read(FILE);
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
    let mut study: Convergence = read("theorem-3.4-grid.toml");
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
        (rate.code, rate.constant.unwrap())
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
        let claim = format!("order = {order}\ntolerance = 0.2");
        let text = text(FILE).replace("order = 1.0\ntolerance = 0.002", &claim);
        run_one(&parsed::<Convergence>(&text)).verdict
    };
    assert_eq!(
        (least("\">= 0.5\""), least("\">= 1.5\"")),
        (Verdict::Pass, Verdict::Fail)
    );
}

/// The study, with results of a solver whose coefficients are changed; the change also receives
/// the number of elements or of steps.
fn planted(study: &Convergence, change: impl Fn(&mut Coefficients, f64)) -> Outcome {
    let mut runs: Vec<_> = study.run_here();
    for run in &mut runs {
        let (elements, steps) = run.case.data;
        let mut solver = study.solver;
        change(&mut solver, elements.max(steps) as f64);
        let mut prepared = Prepared::new(study, elements).unwrap();
        run.found = prepared.run(steps, solver, None);
    }
    study.judge(&runs)
}

/// A viscosity that is wrong by ζ times the step: a mistake that keeps every first order.
#[test]
fn the_constant_sees_a_mistake_that_keeps_the_order() {
    for axis in ["space", "time"] {
        let study = read(&format!("theorem-3.4-{axis}.toml"));
        let outcome = planted(&study, |solver, n| solver.beam.zeta *= 1.0 + 1.0 / n);
        let rate = outcome.rate("theorem-3.4").unwrap();
        assert_eq!(rate.verdict, Verdict::Pass, "{axis}: {}", outcome.summary);
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
        let study = read(&format!("theorem-3.4-data-{axis}.toml"));
        for (factor, passes) in [(1.0, true), (1.01, false)] {
            let outcome = planted(&study, |solver, _| solver.beam.rho *= factor);
            assert_eq!(outcome.verdict == Verdict::Pass, passes, "{axis}, {factor}");
        }
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
