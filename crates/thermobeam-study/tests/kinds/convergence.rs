//! Levels that are added until there is a verdict.

use convergence_study::Check;
use thermobeam_study::kinds::orders::manufactured;
use thermobeam_study::scene::Coefficients;

use super::*;

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
    let [easy, hard] = ["0.25", "0.005"].map(auto);
    let counts = [&easy, &hard].map(|outcome| outcome.levels.len());
    assert!(counts[0] == 4 && (5..=8).contains(&counts[1]), "{counts:?}");
    for (outcome, ending) in [(&easy, ""), (&hard, "; ")] {
        let summary = outcome.summary.to_string();
        let words = format!("; decided after {} levels{ending}", outcome.levels.len());
        assert!(summary.contains(&words), "{summary}");
        assert_eq!(outcome.verdict, Verdict::Pass, "{summary}");
        // The numbers of the first levels are guarded, but no rate.
        let mut guarded = outcome.quantities.iter();
        assert!(guarded.all(|quantity| quantity.name.starts_with("error ")));
    }
    assert!(easy.summary.to_string().ends_with(" levels"));
    assert_eq!(hard.quantities.len(), easy.quantities.len());
    // The same levels, listed, have the same rates; with one level fewer the verdict is weaker.
    let listed = |count: usize| {
        let elements: Vec<u32> = (0..count).map(|level| 8 << level).collect();
        outcome(&format!("elements = {elements:?}"), "tolerance = 0.005")
    };
    assert_eq!(listed(counts[1]).rates, hard.rates);
    assert_eq!(listed(counts[1] - 1).verdict, Verdict::Inconclusive);
}

#[test]
fn a_budget_ends_a_study_without_a_verdict() {
    let spent = outcome("elements = \"auto\"\nbudget = 3000", "tolerance = 0.005");
    let found = (spent.verdict, spent.levels.len());
    assert_eq!(found, (Verdict::Inconclusive, 4));
    let ending = "undecided after 4 levels: the next would take about 2.56e3 node-steps, more than what is left of the budget of 3000 node-steps";
    let summary = spent.summary.to_string();
    assert!(summary.ends_with(ending), "{summary}");
}

#[test]
fn no_level_is_added_to_one_that_failed() {
    let mut study: Convergence = read(FILE);
    study.refine.elements = vec![8, 16, 32, 64];
    study.refine.budget = Some(1e7);
    let claims = study.expect.iter_mut();
    claims.for_each(|(_, claim)| claim.tolerance = 0.005);
    let mut runs: Vec<_> = study.run_here().into_iter().take(4).collect();
    assert_eq!(study.more(&runs).map(|case| case.data), Some((128, 20)));
    runs[1].found = Err(CaseFailure::new("planted"));
    assert_eq!(study.more(&runs), None);
    let outcome = study.judge(&runs);
    assert_eq!(outcome.verdict, Verdict::Fail);
    let summary = outcome.summary.to_string();
    assert!(!summary.contains("decided after"), "{summary}");
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
fn a_constant_is_a_claim_of_the_beam_too() {
    let claimed = |claim: &str| {
        let tolerance = format!("tolerance = 0.25\n{claim}");
        let outcome = outcome("elements = [16, 32, 64, 128]", &tolerance);
        let rate = outcome.rate("theorem-3.4").unwrap();
        (rate.code, rate.constant.unwrap())
    };
    let (reason, constant) = claimed("");
    assert_eq!(reason, Reason::Agrees);
    for (least, most, expected) in [(0.5, 2.0, Reason::Agrees), (2.0, 4.0, Reason::ConstantOff)] {
        let between = [least * constant, most * constant];
        assert_eq!(claimed(&format!("constant = {between:?}")).0, expected);
    }
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
        let failed = not_passed(&outcome);
        let is_constant = failed.len() == 1 && failed[0].contains("known before the run");
        assert!(is_constant, "{axis}: {failed:?}");
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
