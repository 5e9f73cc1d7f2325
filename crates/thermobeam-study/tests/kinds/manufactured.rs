//! The three designs, compared with an independent implementation and tested with deliberate
//! mistakes.

use super::*;

fn errors(study: &Orders<Convergence>, elements: usize, steps: usize) -> Norms {
    let mut prepared = Prepared::new(study, elements).unwrap();
    prepared.run(steps, study.solver, None).unwrap()
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

#[test]
fn the_errors_are_those_of_the_independent_implementation() {
    let space: &[f64] = &[
        4.454e-8, 2.341e-4, 1.437e-8, 4.662e-5, 6.309e-8, 2.349e-4, 2.879e-8,
    ];
    let time: &[f64] = &[1.169e-3, 4.223e-4, 1.122e-4, 2.851e-4, 1.774e-5, 1.197e-3];
    for (name, elements, steps, expected) in [
        ("theorem-3.4-space.toml", 4096, 20, space),
        ("theorem-3.4-time.toml", 8, 1024, time),
    ] {
        let found = errors(&read(name), elements, steps);
        for (norm, expected) in TABLE.into_iter().zip(expected) {
            let found = found[norm];
            let is_met = (found - expected).abs() < 5e-4 * expected;
            assert!(is_met, "{}: {found} for {expected}", norm.name());
        }
    }
}

#[test]
fn isolation_is_exact_whatever_the_other_axis() {
    // In the time design the space error is zero: the errors depend on the mesh only through the
    // interpolant of the exact solution. With negligible time error they vanish.
    let mut study = read::<Orders<Convergence>>("midpoint-time.toml");
    study.refine.t_end = 1e-3;
    let found = errors(&study, 8, 200);
    assert!(found.iter().all(|(_, error)| error < 1e-11), "{found:?}");
}

#[test]
fn space_errors_do_not_depend_on_the_step_in_the_isolated_design() {
    // No time error at all: with a tenth of the steps the errors keep their size instead of growing
    // tenfold.
    let study = read("theorem-3.4-space.toml");
    let (few, many) = (errors(&study, 64, 4), errors(&study, 64, 40));
    for (norm, few) in few.iter() {
        let many = many[norm];
        let is_alike = few / many < 3.0 && many / few < 3.0;
        assert!(is_alike, "{}: {few} {many}", norm.name());
    }
}

#[test]
fn a_failed_case_fails_its_study_and_keeps_its_reason() {
    for name in ["theorem-3.4-time.toml", "theorem-3.4-grid.toml"] {
        let mut study = read::<Orders<Convergence>>(name);
        if study.refine.grid {
            (study.refine.elements, study.refine.steps) = (vec![8, 16, 32], vec![8, 16, 32]);
        }
        let mut ran = study.run_here();
        ran[3].found = Err(CaseFailure::new("step 7 went astray"));
        let outcome = study.judge(&ran);
        let failed = outcome.checks.iter().find(|check| {
            let evidence = check.evidence.to_string();
            evidence.contains("step 7 went astray")
        });
        let verdicts = [outcome.verdict, failed.expect("a check").verdict];
        assert_eq!(verdicts, [Verdict::Fail; 2]);
        let mut errors = outcome.levels[3].errors.iter();
        assert!(errors.all(|error| error.value.is_nan()));
    }
}

#[test]
fn an_error_that_is_nan_fails_in_every_norm_even_where_no_order_is_expected() {
    let mut study = read::<Orders<Convergence>>("theorem-3.4-time.toml");
    study.expect.truncate(1);
    let sound = Sound::checked(study);
    for norm in Norm::ALL {
        let outcome = sound.at(1, |found| found[norm] = f64::NAN);
        assert_eq!(outcome.verdict, Verdict::Fail, "{}", norm.name());
    }
}
