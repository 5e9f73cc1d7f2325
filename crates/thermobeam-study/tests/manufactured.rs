//! The three designs, compared with an independent implementation and tested with deliberate
//! mistakes.

use std::path::Path;

use convergence_study::{CaseFailure, FromFile as _, Kind as _, Verdict, run_one};
use thermobeam_study::exact::norm::{Norm, Norms};
use thermobeam_study::kinds::orders::Orders;
use thermobeam_study::kinds::orders::manufactured::{Convergence, Defect, Prepared};

fn file(name: &str) -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../studies")
        .join(name)
}

fn convergence(name: &str) -> Orders<Convergence> {
    Orders::read(file(name)).unwrap()
}

fn errors(study: &Convergence, elements: usize, steps: usize, defect: Option<Defect>) -> Norms {
    Prepared::new(study, elements)
        .unwrap()
        .run(steps, study.solver, defect)
        .unwrap()
}

/// Norms of the table, in its order; errors to the digits given.
const TABLE: [Norm; 7] = [
    Norm::Velocity,
    Norm::Shear,
    Norm::RotationRate,
    Norm::Curvature,
    Norm::Temperature,
    Norm::Theorem34,
    Norm::Superclose,
];

fn meets(found: &Norms, expected: &[f64]) {
    for (norm, expected) in TABLE.into_iter().zip(expected) {
        let found = found[norm];
        assert!(
            (found - expected).abs() < 5e-4 * expected,
            "{}: {found} for {expected}",
            norm.name()
        );
    }
}

#[test]
fn the_errors_are_those_of_the_independent_implementation() {
    let space = [
        4.454e-8, 2.341e-4, 1.437e-8, 4.662e-5, 6.309e-8, 2.349e-4, 2.879e-8,
    ];
    meets(
        &errors(&convergence("theorem-3.4-space.toml"), 4096, 20, None),
        &space,
    );
    let time = [1.169e-3, 4.223e-4, 1.122e-4, 2.851e-4, 1.774e-5, 1.197e-3];
    meets(
        &errors(&convergence("theorem-3.4-time.toml"), 8, 1024, None),
        &time,
    );
}

#[test]
fn isolation_is_exact_whatever_the_other_axis() {
    // In the time design the space error is zero: the errors depend on the mesh only through the
    // interpolant of the exact solution. With negligible time error they vanish.
    let mut study = convergence("midpoint-time.toml");
    study.refine.t_end = 1e-3;
    let found = errors(&study, 8, 200, None);
    assert!(found.iter().all(|(_, error)| error < 1e-11), "{found:?}");
}

#[test]
fn space_errors_do_not_depend_on_the_step_in_the_isolated_design() {
    // No time error at all: with a tenth of the steps the errors keep their size instead of growing
    // tenfold.
    let study = convergence("theorem-3.4-space.toml");
    let (few, many) = (errors(&study, 64, 4, None), errors(&study, 64, 40, None));
    for (norm, few) in few.iter() {
        let many = many[norm];
        assert!(
            few / many < 3.0 && many / few < 3.0,
            "{}: {few} {many}",
            norm.name()
        );
    }
}

#[test]
fn every_defect_leaves_a_mark_that_no_refinement_removes() {
    // Two studies, because one heats the clamped end and the other touches the upper obstacle.
    let studies = ["theta-a-20-space.toml", "theorem-3.4-space.toml"].map(convergence);
    for (defect, name) in Defect::ALL {
        let marks = studies.each_ref().map(|study| {
            let honest = errors(study, 512, 20, None)[Norm::Superclose];
            errors(study, 512, 20, Some(defect))[Norm::Superclose] / honest
        });
        assert!(
            marks.iter().any(|mark| *mark > 20.0),
            "{name}: {marks:?} times the error without it"
        );
    }
}

#[test]
fn a_study_with_a_wrong_coefficient_fails_and_says_why() {
    let mut study = convergence("theorem-3.4-space.toml");
    study.refine.elements = vec![64, 128, 256, 512];
    assert_eq!(run_one(&study).verdict, Verdict::Pass);
    let text = std::fs::read_to_string(file("theorem-3.4-space.toml")).unwrap()
        + "\n[control]\nzeta = 0.10001\n";
    study.solver = Orders::<Convergence>::parse(&text, "wrong.toml".as_ref())
        .unwrap()
        .solver;
    let outcome = run_one(&study);
    assert_eq!(outcome.verdict, Verdict::Fail);
    assert!(
        outcome.summary.to_string().contains("superclose"),
        "{}",
        outcome.summary
    );
}

#[test]
fn a_failed_case_fails_its_study_and_keeps_its_reason() {
    for name in ["theorem-3.4-time.toml", "theorem-3.4-grid.toml"] {
        let mut study = convergence(name);
        if study.refine.grid {
            (study.refine.elements, study.refine.steps) = (vec![8, 16, 32], vec![8, 16, 32]);
        }
        let mut ran = study.run_here();
        ran[3].found = Err(CaseFailure::new("step 7 went astray"));
        let outcome = study.judge(&ran);
        assert_eq!(outcome.verdict, Verdict::Fail);
        let failed = outcome
            .checks
            .iter()
            .filter(|check| check.verdict == Verdict::Fail);
        assert!(
            failed
                .into_iter()
                .any(|check| check.evidence.to_string().contains("step 7 went astray")),
            "{:?}",
            outcome.checks
        );
        assert!(
            outcome.levels[3]
                .errors
                .iter()
                .all(|error| error.value.is_nan())
        );
    }
}

#[test]
fn an_error_that_is_nan_fails_in_every_norm_even_where_no_order_is_expected() {
    let mut study = convergence("theorem-3.4-time.toml");
    study.expect.truncate(1);
    let sound = study.run_here();
    assert_eq!(study.judge(&sound).verdict, Verdict::Pass);
    for norm in Norm::ALL {
        let mut ran = sound.clone();
        ran[1].found.as_mut().unwrap()[norm] = f64::NAN;
        assert_eq!(study.judge(&ran).verdict, Verdict::Fail, "{}", norm.name());
    }
}
