//! Laws of work-precision studies: they pass, they are reproducible, and planted defects make them fail.

use super::file;
use super::typed::passes_but_not_without_each_case;
use convergence_study::judge::verdict::Verdict;
use convergence_study::run::run_one;
use convergence_study::study::kind::judge;
use convergence_study::study::outcome::Outcome;
use convergence_study::study::outcome::settle;
use convergence_study::study::{CaseFailure, FromFile, Kind, Ran, run_cases_here};
use thermobeam_study::kinds::work_precision::method::Measurement;
use thermobeam_study::kinds::work_precision::{Runs, WorkPrecision};

/// Steps of the study's runs.
const STEPS: [usize; 4] = [16, 64, 256, 1024];

fn read(text: &str) -> Result<WorkPrecision, String> {
    WorkPrecision::parse(text, &file("study.toml")).map_err(|error| error.to_string())
}

type Results = Vec<Ran<Runs, Vec<Measurement>>>;

fn quick() -> WorkPrecision {
    WorkPrecision::read(file("work-precision-manufactured.toml")).unwrap()
}

fn failed(outcome: &Outcome) -> Vec<&str> {
    outcome
        .checks
        .iter()
        .filter(|c| c.verdict == Verdict::Fail)
        .map(|c| c.claim.as_str())
        .collect()
}

#[test]
fn midpoint_is_a_hundred_times_cheaper_and_the_outcome_repeats() {
    let study = quick();
    let outcome = judge(&study, &passes_but_not_without_each_case(&study));
    assert!(
        outcome
            .checks
            .iter()
            .any(|check| check.claim.contains("100 times cheaper"))
    );
    let again = quick();
    assert_eq!(settle("study", outcome), run_one(&again));
}

#[test]
fn planted_defects_fail() {
    let study = quick();
    let honest = run_cases_here(&study);
    // The defect depends on the number of steps.
    let plant = |only: &str, defect: &dyn Fn(usize, &mut Measurement)| {
        let mut planted = honest.clone();
        for ran in planted
            .iter_mut()
            .filter(|ran| ran.case.label.starts_with(only))
        {
            let runs = ran.found.as_mut().unwrap();
            assert_eq!(runs.len(), STEPS.len());
            STEPS
                .into_iter()
                .zip(runs)
                .for_each(|(steps, run)| defect(steps, run));
        }
        study.judge(&planted).verdict
    };
    let [superclose, tip] = [1, 2];
    assert_eq!(plant("midpoint", &|_, _| ()), Verdict::Pass);
    for wrong in [f64::NAN, f64::INFINITY] {
        let one = |steps: usize, run: &mut Measurement| {
            if steps == 64 {
                run.errors[superclose] = wrong;
            }
        };
        assert_eq!(plant("midpoint, n = 16", &one), Verdict::Fail);
        assert_eq!(
            plant("richardson, n = 16", &|_, run| run.spent.node_steps = wrong),
            Verdict::Fail
        );
    }
    assert_eq!(
        plant("midpoint", &|_, run| run.errors[tip] =
            run.errors[tip].max(1e-3)),
        Verdict::Fail,
        "a floor"
    );
    // Loss of second order: 256 and 1024 steps give the error of 64.
    let first_order = |steps: usize, run: &mut Measurement| {
        run.errors[superclose] *= match steps {
            256 => 8.0,
            1024 => 64.0,
            _ => 1.0,
        }
    };
    assert_eq!(plant("midpoint", &first_order), Verdict::Fail);
    let mut missing = honest.clone();
    missing[2].found = Err(CaseFailure::new("planted"));
    let outcome = study.judge(&missing);
    assert_eq!(outcome.verdict, Verdict::Fail);
    assert!(
        outcome.checks[0].evidence.contains("planted"),
        "{}",
        outcome.checks[0].evidence
    );
}

/// dG compared with midpoint along a diagonal, with half of midpoint's runs: the finest take seconds here.
fn along_a_diagonal() -> (WorkPrecision, Results) {
    let text = super::text("any-order-cost.toml")
        .replace(", 500, 1000]", "]")
        .replace(", 4000, 8000]", "]");
    let study = read(&text).unwrap();
    let honest = passes_but_not_without_each_case(&study);
    (study, honest)
}

#[test]
fn a_thousandth_of_the_cost_by_dg_and_planted_defects_fail() {
    let (study, honest) = along_a_diagonal();
    let plant = |only: &str, defect: &dyn Fn(&mut Measurement)| {
        let mut planted = honest.clone();
        for ran in planted
            .iter_mut()
            .filter(|ran| ran.case.label.starts_with(only))
        {
            ran.found.as_mut().unwrap().iter_mut().for_each(defect);
        }
        failed(&study.judge(&planted)).len()
    };
    let tip = 2;
    assert_eq!(plant("dg", &|_| ()), 0);
    assert_eq!(
        plant("dg", &|run| run.errors[tip] *= 100.0),
        1,
        "inaccurate"
    );
    assert_eq!(plant("dg", &|run| run.spent.node_solves *= 10.0), 1, "dear");
    assert!(
        plant("dg", &|run| run.errors[tip] = f64::NAN) > 0,
        "not finite"
    );
    // Twice the error in the coarser run gives a ratio of eight, in the finer one a ratio of two.
    for worse in ["midpoint, n = 125", "midpoint, n = 250"] {
        assert_eq!(
            plant(worse, &|run| run.errors[tip] *= 2.0),
            1,
            "no second order"
        );
    }
    // Other quantities are not measured.
    let outcome = study.judge(&honest);
    assert_eq!(outcome.figures.len(), 1);
    assert_eq!(outcome.quantities.len(), 1, "{:?}", outcome.quantities);
}

#[test]
fn dg_is_measured_as_the_others_are() {
    let study = quick();
    let honest = run_cases_here(&study);
    let fronts = |ran: &Results| {
        let outcome = study.judge(ran);
        let svg = &outcome.figures[1].svg;
        let line = svg
            .lines()
            .find(|line| line.contains("data-series=\"dg\""))
            .expect("a line");
        (
            outcome.verdict,
            line.split("data-points=")
                .nth(1)
                .expect("points")
                .split_whitespace()
                .count(),
        )
    };
    let (verdict, points) = fronts(&honest);
    assert_eq!(verdict, Verdict::Pass);
    // A run as expensive as all others together appears in no figure, and removes dG's advantage.
    let mut planted = honest.clone();
    for ran in planted
        .iter_mut()
        .filter(|ran| ran.case.label.starts_with("dg, p = 10"))
    {
        ran.found.as_mut().unwrap()[0].spent.node_solves *= 1e3;
    }
    let (verdict, fewer) = fronts(&planted);
    assert_eq!(
        (verdict, fewer),
        (Verdict::Pass, points - 1),
        "the next run reaches the error, too"
    );
    for ran in planted
        .iter_mut()
        .filter(|ran| ran.case.label.starts_with("dg"))
    {
        ran.found.as_mut().unwrap()[0].errors[1] += 1e-5;
    }
    assert_eq!(
        fronts(&planted).0,
        Verdict::Fail,
        "an error that all runs share"
    );
}

#[test]
fn a_claim_that_is_too_bold_fails() {
    let text = super::text("work-precision-manufactured.toml");
    let study = read(&text.replace("times = 100", "times = 100000")).unwrap();
    let outcome = run_one(&study);
    assert_eq!(outcome.verdict, Verdict::Fail);
    assert_eq!(failed(&outcome).len(), 1);
}

#[test]
fn references_that_do_not_agree_fail() {
    let text = super::text("work-precision-paper.toml")
        .replace("elements = [16, 32, 64, 128]", "elements = [4, 8]")
        .replace("steps = [128, 256, 512, 1024, 2048]", "steps = [128, 256]");
    let reasons = |text: &str| -> Vec<String> {
        let ran = run_cases_here(&read(text).unwrap());
        ran.into_iter()
            .filter_map(|ran| ran.found.err())
            .map(|failure| failure.reason)
            .collect()
    };
    assert_eq!(reasons(&text), Vec::<String>::new());
    // Two elements of degree 3 do not qualify as a reference.
    let coarse = reasons(&text.replace("degree = 26", "degree = 3"));
    assert_eq!(coarse.len(), 16, "eight of one-step methods, eight of dG");
    assert!(
        coarse
            .iter()
            .all(|reason| reason.contains("the two references are")),
        "{coarse:?}"
    );
}

#[test]
fn seconds_are_there_for_benchmarks_only() {
    let study = quick();
    let timed = thermobeam_study::timing::timed(&study).unwrap();
    assert!(timed.iter().all(|run| run.seconds > 0.0));
    let mut slow = run_cases_here(&study);
    let outcome = study.judge(&slow);
    for run in slow.iter_mut().flat_map(|ran| ran.found.as_mut().unwrap()) {
        run.spent.seconds *= 2.0;
    }
    assert_eq!(study.judge(&slow), outcome);
}

#[test]
fn mistakes_are_named() {
    let head = "[study]\nid = \"w\"\nclaim = \"c\"\ntier = \"quick\"\nkind = \"work-precision\"\n[work-precision]\n";
    let grid = "elements = [4, 8]\nsteps = [8, 16]\n";
    let diagonal = "elements = [4, 8]\nscene = \"scenes/paper-1-beta-0.toml\"\nt_end = 1\ndiagonal = \"midpoint\"";
    for (body, piece) in [
        (
            "elements = [4, 8]\nsteps = [8, 12]\nsolution = \"midpoint-coupled.toml\"",
            "work-precision.steps",
        ),
        (
            "elements = [8, 4]\nsteps = [8, 16]\nsolution = \"midpoint-coupled.toml\"",
            "work-precision.elements",
        ),
        (grid, "exactly one of"),
        (
            &format!("{grid}vibration = [0]\nzeta = 0.1\nt_end = 1\nagreement = 1e-6"),
            "agreement without scene",
        ),
        (
            &format!("{grid}vibration = [0]\nzeta = 0.1\nt_end = 1\n[[reference]]\nelements = 1"),
            "reference without scene",
        ),
        (
            &format!("{grid}scene = \"scenes/paper-1-beta-0.toml\"\nt_end = 1"),
            "[[reference]]",
        ),
        (
            &format!("{grid}solution = \"midpoint-coupled.toml\"\n[[advantage]]\nnorm = \"tipp\""),
            "did you mean",
        ),
        (
            &format!("{diagonal}\nsteps = [250, 750]"),
            "each twice the one before",
        ),
        (
            &format!("{diagonal}\nsteps = [100, 200]"),
            "multiples of 250",
        ),
        (
            &format!("{diagonal}\nsteps = [250, 500]\nagreement = 1e-6"),
            "beside diagonal",
        ),
        (
            &format!("{diagonal}\nsteps = [250, 500]\ndg = [[10, 1]]"),
            "degree p, degree q, largest step",
        ),
        (
            &format!("{diagonal}\nsteps = [250, 500]\ndg = [[10, 6, 0.02]]"),
            "work-precision.dg[0][1]",
        ),
        (
            &format!("{diagonal}\nsteps = [250, 500]"),
            "at least one table [[advantage]]",
        ),
        (
            "elements = [4, 8]\nsteps = [250, 500]\nvibration = [0]\nzeta = 0.1\nt_end = 1\ndiagonal = \"midpoint\"",
            "diagonal without scene",
        ),
    ] {
        let error = read(&format!("{head}{body}"))
            .err()
            .unwrap_or_else(|| panic!("{body} was accepted"));
        assert!(
            error.contains("study.toml:") && error.contains(piece),
            "{piece}: {error}"
        );
    }
}
