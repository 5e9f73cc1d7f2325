use convergence_study::{FromFile, Verdict, internal::study::run_cases_here};
use thermobeam_study::kinds::runs::RunStudy;
use thermobeam_study::kinds::runs::solutions::{self, ROW, StepSolutions};

use super::planted::verdict_with;
use super::refused::refusal;
use super::typed::passes_but_not_without_each_case;
use super::{file, text};

type Solutions = RunStudy<solutions::Solutions>;

const FILE: &str = "solutions-of-a-step.toml";

#[test]
fn a_step_beyond_buckling_has_three_solutions_and_every_claim_can_fail() {
    let study = Solutions::read(file(FILE)).unwrap_or_else(|error| panic!("{error}"));
    let sound = passes_but_not_without_each_case(&study);
    let counts: Vec<usize> = sound
        .iter()
        .map(|ran| ran.ok().expect("a result").tips.len())
        .collect();
    assert_eq!(counts, [1, 1, 1, 3, 3]);
    type Defect = fn(&mut StepSolutions);
    let planted: [(usize, Defect); 4] = [
        (4, |found| found.tips[0] = -0.0100014),
        (4, |found| found.tips.truncate(2)),
        (4, |found| found.tips[2] = f64::NAN),
        // Several solutions where there must be one.
        (3, |found| found.lambda = 0.0),
    ];
    for (number, (case, plant)) in planted.into_iter().enumerate() {
        let verdict = verdict_with(&study, &sound, case, plant);
        assert_eq!(verdict, Verdict::Fail, "defect {number}");
    }
}

/// Each change of the step's equations: another answer, or another number of them.
#[test]
fn a_wrong_coefficient_changes_the_solutions() {
    for (from, to) in [
        ("zeta = 0.1", "zeta = 0.1001"),
        ("beta = -0.9", "beta = -0.9009"),
        ("epsilon = 1e-3", "epsilon = 1.1e-3"),
        ("rho = 1.0", "rho = 1.001"),
        ("a = 0.017", "a = 0.17"),
        ("elements = 20", "elements = 24"),
    ] {
        let changed = text(FILE).replace(from, to);
        let study = Solutions::parse(&changed, &file(FILE)).unwrap();
        let outcome = convergence_study::Kind::judge(&study, &run_cases_here(&study));
        assert_eq!(outcome.verdict, Verdict::Fail, "{to}");
    }
}

#[test]
fn files_with_errors_are_refused() {
    for (from, to, message) in [
        ("g1 = -0.01", "g1 = 0.0", "g1 < 0 < g2"),
        ("rho = 1.0", "rho = 0.0", "a heated or a linear beam"),
        ("elements = 20", "elements = 200", "elements"),
        ("[-0.010001325521308, 0.0", "[0.0, -0.01", "tips"),
    ] {
        let error = refusal(&ROW, FILE, from, to);
        assert!(error.contains(message), "{error}");
    }
}
