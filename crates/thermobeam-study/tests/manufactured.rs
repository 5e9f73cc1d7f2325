//! The three designs against numbers of an independent implementation, and against mistakes made on purpose.

use std::path::Path;

use crate::study::untyped::Measured;
use convergence_study::judge::verdict::Verdict;
use convergence_study::study::CaseFailure;
use thermobeam_study::error::design::{Defect, Disagreement, Prepared};
use thermobeam_study::kinds::controls::Controls;
use thermobeam_study::kinds::convergence::Convergence;
use thermobeam_study::kinds::convergence::file::ConvergenceSpec;
use thermobeam_study::kinds::energy::EnergyDecay;
use thermobeam_study::kinds::tables::Norm;
use thermobeam_study::kinds::{FromFile, Study};

fn file(name: &str) -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies").join(name)
}

fn spec(name: &str) -> ConvergenceSpec {
    ConvergenceSpec::read(file(name)).unwrap()
}

fn errors(spec: &ConvergenceSpec, elements: usize, steps: usize, defect: Option<Defect>) -> [f64; 8] {
    let (beam, obstacles) = spec.solver_coefficients();
    Prepared::new(spec, elements).unwrap().run(steps, Disagreement { beam, obstacles, defect }).unwrap()
}

fn results(study: &dyn Study) -> Vec<Result<Measured, CaseFailure>> {
    (0..study.cases().len()).map(|index| study.run(index)).collect()
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

fn meets(found: &[f64; 8], expected: &[f64]) {
    for (norm, expected) in TABLE.iter().zip(expected) {
        let index = Norm::ALL.iter().position(|other| other == norm).unwrap();
        let found = found[index];
        assert!((found - expected).abs() < 5e-4 * expected, "{}: {found} for {expected}", norm.name());
    }
}

#[test]
fn the_errors_are_those_of_the_independent_implementation() {
    let space = [4.454e-8, 2.341e-4, 1.437e-8, 4.662e-5, 6.309e-8, 2.349e-4, 2.879e-8];
    meets(&errors(&spec("theorem-3.4-space.toml"), 4096, 20, None), &space);
    let time = [1.169e-3, 4.223e-4, 1.122e-4, 2.851e-4, 1.774e-5, 1.197e-3];
    meets(&errors(&spec("theorem-3.4-time.toml"), 8, 1024, None), &time);
}

#[test]
fn isolation_is_exact_whatever_the_other_axis() {
    // In the time design the space error is zero: the errors do not depend on how coarse the mesh is, but for what the
    // coarse interpolant itself is. With as good as no time error they vanish.
    let mut spec = spec("midpoint-time.toml");
    spec.refine.t_end = 1e-3;
    let found = errors(&spec, 8, 200, None);
    assert!(found.iter().all(|error| *error < 1e-11), "{found:?}");
}

#[test]
fn space_errors_do_not_depend_on_the_step_in_the_isolated_design() {
    // No time error at all: with a tenth of the steps the errors are of the same size, not ten times larger.
    let spec = spec("theorem-3.4-space.toml");
    let (few, many) = (errors(&spec, 64, 4, None), errors(&spec, 64, 40, None));
    for (few, many) in few.iter().zip(many) {
        assert!(few / many < 3.0 && many / few < 3.0, "{few} {many}");
    }
}

#[test]
fn every_defect_leaves_a_mark_that_no_refinement_removes() {
    let spec = spec("theta-a-20-space.toml");
    let superclose = 7;
    let honest = errors(&spec, 512, 20, None)[superclose];
    for defect in Defect::ALL {
        let found = errors(&spec, 512, 20, Some(defect))[superclose];
        assert!(found > 20.0 * honest, "{}: {found} against {honest}", defect.name());
    }
}

#[test]
fn a_study_with_a_wrong_coefficient_fails_and_says_why() {
    let mut wrong = spec("theorem-3.4-space.toml");
    wrong.refine.elements = vec![64, 128, 256, 512];
    let honest = Convergence::new(wrong.clone());
    assert_eq!(honest.conclude(&results(&honest)).verdict, Verdict::Pass);
    let text = std::fs::read_to_string(file("theorem-3.4-space.toml")).unwrap() + "\n[control]\nzeta = 0.10001\n";
    wrong.control = ConvergenceSpec::parse(&text, "wrong.toml").unwrap().control;
    let study = Convergence::new(wrong);
    let outcome = study.conclude(&results(&study));
    assert_eq!(outcome.verdict, Verdict::Fail);
    assert!(outcome.summary.contains("superclose"), "{}", outcome.summary);
}

#[test]
fn a_failed_case_fails_its_study_and_keeps_its_reason() {
    let study = Convergence::new(spec("theorem-3.4-time.toml"));
    let mut results = results(&study);
    results[3] = Err(CaseFailure { reason: "step 7 went astray".to_owned() });
    let outcome = study.conclude(&results);
    assert_eq!(outcome.verdict, Verdict::Fail);
    assert!(outcome.summary.contains("step 7 went astray"), "{}", outcome.summary);
    assert!(outcome.levels[3].errors.iter().all(|(_, error)| error.is_nan()));
}

#[test]
fn an_unseen_control_fails_the_controls_and_so_does_a_study_that_fails_without_one() {
    let study = Controls::read(file("negative-controls.toml")).unwrap();
    let honest = results(&study);
    assert_eq!(study.conclude(&honest).verdict, Verdict::Pass);
    // What the run with a wrong rho measures is replaced by what the honest run measures: nobody sees rho then.
    let replaced = |from: &'static str, to: &'static str| -> Vec<Result<Measured, CaseFailure>> {
        honest
            .iter()
            .map(|result| {
                let mut measured = result.as_ref().unwrap().clone();
                for index in 0..measured.values.len() {
                    if let Some(norm) = measured.values[index].0.strip_prefix(to).filter(|rest| rest.starts_with(" | "))
                    {
                        measured.values[index].1 = measured.value(&format!("{from}{norm}"));
                    }
                }
                Ok(measured)
            })
            .collect()
    };
    let blind = study.conclude(&replaced("none", "rho"));
    assert_eq!(blind.verdict, Verdict::Fail);
    let unseen: Vec<_> = blind.checks.iter().filter(|check| check.verdict == Verdict::Fail).collect();
    assert_eq!(unseen.len(), 1);
    assert!(unseen[0].claim.contains("rho"));
    assert_eq!(study.conclude(&replaced("rho", "none")).verdict, Verdict::Fail);
}

/// Every number of every case in turn is replaced by NaN; no outcome may pass.
fn no_nan_passes(study: &dyn Study, judged: impl Fn(&str) -> bool) {
    let honest = results(study);
    assert_eq!(study.conclude(&honest).verdict, Verdict::Pass, "{}", study.conclude(&honest).summary);
    for case in 0..honest.len() {
        let names: Vec<String> = honest[case].as_ref().unwrap().values.iter().map(|(name, _)| name.clone()).collect();
        for (index, name) in names.iter().enumerate().filter(|(_, name)| judged(name)) {
            let mut planted = honest.clone();
            planted[case].as_mut().unwrap().values[index].1 = f64::NAN;
            assert_ne!(study.conclude(&planted).verdict, Verdict::Pass, "case {case}, {name}");
        }
        let mut planted = honest.clone();
        planted[case] = Err(CaseFailure { reason: "broken".to_owned() });
        assert_eq!(study.conclude(&planted).verdict, Verdict::Fail, "case {case}");
    }
}

#[test]
fn no_nan_passes_for_a_fall_of_the_energy() {
    let study = EnergyDecay::read(file("energy-decay.toml")).unwrap();
    no_nan_passes(&study, |name| name.starts_with("largest"));
}

#[test]
fn an_energy_that_rises_and_a_balance_that_stays_open_fail() {
    let study = EnergyDecay::read(file("energy-decay.toml")).unwrap();
    for name in ["largest increase", "largest residual"] {
        let mut planted = results(&study);
        let value = planted[2].as_mut().unwrap().values.iter_mut().find(|(key, _)| key == name).unwrap();
        value.1 = 2e-14;
        assert_eq!(study.conclude(&planted).verdict, Verdict::Fail, "{name}");
    }
}
