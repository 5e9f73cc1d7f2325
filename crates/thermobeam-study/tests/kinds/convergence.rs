//! Levels that are added until it is decided.

use std::path::Path;

use convergence_study::judge::verdict::Verdict;
use convergence_study::study::{FromFile, Outcome, run_here};
use thermobeam_study::kinds::convergence::Convergence;

/// The outcome of the study of Theorem 3.4 in h with these elements and this tolerance.
fn outcome(elements: &str, tolerance: &str) -> Outcome {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies/theorem-3.4-space.toml");
    let text = std::fs::read_to_string(&file).unwrap();
    let listed = text.lines().find(|line| line.starts_with("elements = ")).unwrap();
    assert!(text.contains("tolerance = 0.002"));
    let text = text.replace(listed, elements).replace("tolerance = 0.002", tolerance);
    run_here(&Convergence::parse(&text, &file).unwrap())
}

#[test]
fn levels_are_added_until_every_rate_is_decided() {
    let auto = |tolerance: &str| outcome("elements = \"auto\"", &format!("tolerance = {tolerance}"));
    let easy = auto("0.25");
    assert_eq!((easy.verdict, easy.levels.len()), (Verdict::Pass, 4), "{}", easy.summary);
    assert!(easy.summary.ends_with("; decided after 4 levels"), "{}", easy.summary);
    let hard = auto("0.005");
    let count = hard.levels.len();
    assert!((5..=8).contains(&count) && hard.verdict == Verdict::Pass, "{}", hard.summary);
    assert!(hard.summary.contains(&format!("; decided after {count} levels; ")), "{}", hard.summary);
    // The same levels, listed, have the same rates; one level fewer decides less.
    let listed = |count: u32| {
        let elements: Vec<String> = (0..count).map(|level| (8 << level).to_string()).collect();
        outcome(&format!("elements = [{}]", elements.join(", ")), "tolerance = 0.005")
    };
    assert_eq!(listed(count as u32).rates, hard.rates);
    assert_eq!(listed(count as u32 - 1).verdict, Verdict::Inconclusive);
    // The numbers of the first levels are guarded, and no rate.
    assert!(hard.quantities.iter().all(|quantity| quantity.name.starts_with("error ")));
    assert_eq!(hard.quantities.len(), easy.quantities.len());
}

#[test]
fn a_budget_ends_a_study_without_a_verdict() {
    let spent = outcome("elements = \"auto\"\nbudget = 3000", "tolerance = 0.005");
    assert_eq!((spent.verdict, spent.levels.len()), (Verdict::Inconclusive, 4));
    let told = "undecided after 4 levels: the next would take about 2.56e3 node-steps, more than what is left of the budget of 3000 node-steps";
    assert!(spent.summary.ends_with(told), "{}", spent.summary);
}
