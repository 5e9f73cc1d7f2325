//! Laws about what a manufactured solution does not test.

use convergence_study::{FromFile, Kind, Untested};
use thermobeam_study::kinds::orders::Orders;
use thermobeam_study::kinds::orders::manufactured::Convergence;

use super::{file, text};

fn untested(text: &str) -> Vec<Untested> {
    Orders::<Convergence>::parse(text, &file("own.toml"))
        .unwrap_or_else(|error| panic!("{error}"))
        .untested()
}

#[track_caller]
fn of(text: &str, expected: &[(&str, &str)]) {
    let found = untested(text);
    let found: Vec<(&str, &str)> = found
        .iter()
        .map(|one| (one.what.as_str(), one.why.as_str()))
        .collect();
    let alike = found.len() == expected.len()
        && found
            .iter()
            .zip(expected)
            .all(|(found, expected)| found.0 == expected.0 && found.1.contains(expected.1));
    assert!(alike, "{found:?}");
}

/// A study of space on few levels, with the given values of `[beam]`, `[obstacles]` and the exact
/// solution.
fn own(beam: &str, obstacles: &str, u: &str, theta: &str) -> String {
    format!(
        "[study]\nid = \"own\"\nclaim = \"mine\"\ntier = \"quick\"\n[beam]\n{beam}\n{obstacles}\n[exact]\n\
         u = [{{ x = \"{u}\", t = \"cos(3*t)\" }}]\nphi = [{{ x = \"0.4*x*exp(-x)\", t = \"sin(2*t) + 0.5\" }}]\n\
         theta = [{{ x = \"{theta}\", t = \"exp(-t)\" }}]\n[refine]\naxis = \"space\"\nisolate = true\n\
         elements = [64, 128, 256, 512]\nsteps = 20\nt_end = 1.0\ntolerance = 1e-13\n\
         [[expect]]\nnorm = \"superclose\"\norder = 2.0\ntolerance = 0.05\n"
    )
}

const BEAM: &str = "a = 0.5\nrho = 2.0\nbeta = 0.5";
const OBSTACLES: &str = "[obstacles]\nepsilon = 0.01\ng1 = -0.01\ng2 = 0.1";
const WAVE: &str = "0.3*sin(1.3*pi*x)";
const WARM: &str = "(1+x)*sin(pi*x)";

#[test]
fn a_solution_that_exercises_every_term_leaves_only_what_is_zero() {
    of(
        &own(BEAM, OBSTACLES, WAVE, WARM),
        &[("theta_a", "it is zero")],
    );
    // Unchanged from the repository.
    of(
        &text("theorem-3.4-space.toml"),
        &[("theta_a", "it is zero")],
    );
}

#[test]
fn obstacles_that_the_free_end_never_touches_are_not_tested() {
    let far = OBSTACLES
        .replace("g1 = -0.01", "g1 = -0.5")
        .replace("g2 = 0.1", "g2 = 0.6");
    let expected = [
        ("theta_a", "it is zero"),
        ("epsilon", "touches nothing"),
        ("g1", "stays above it"),
        ("g2", "stays below it"),
    ];
    of(&own(BEAM, &far, WAVE, WARM), &expected);
    let none = [
        ("theta_a", "zero"),
        ("epsilon", "no obstacles"),
        ("g1", "no obstacles"),
        ("g2", "no obstacles"),
    ];
    of(&own(BEAM, "", WAVE, WARM), &none);
    let lower = OBSTACLES.replace("g2 = 0.1", "g2 = 0.6");
    of(
        &own(BEAM, &lower, WAVE, WARM),
        &[
            ("theta_a", "it is zero"),
            ("g2", "stays below it: u(1) <= 0.2403"),
        ],
    );
}

#[test]
fn a_coefficient_whose_error_passes_is_not_tested() {
    // A force of a millionth changes no judged number, and neither does an error in it.
    let slight = BEAM.replace("beta = 0.5", "beta = 1e-6");
    of(
        &own(&slight, OBSTACLES, WAVE, WARM),
        &[("beta", "an error of 1e-4"), ("theta_a", "it is zero")],
    );
}

#[test]
fn a_norm_in_which_the_solution_has_no_error_is_not_tested() {
    // Without coupling the scheme's space contains a linear temperature, and nothing disturbs it.
    let cold = BEAM.replace("a = 0.5\n", "a = 0.0\ntheta_a = 1.0\n");
    let steady = own(&cold, OBSTACLES, WAVE, "1-x").replace("exp(-t)", "1");
    of(
        &steady,
        &[("a", "it is zero"), ("temperature", "round-off")],
    );
}

#[test]
fn a_study_that_does_not_pass_or_is_wrong_on_purpose_is_not_looked_at() {
    let wrong = own(BEAM, OBSTACLES, WAVE, WARM).replace("order = 2.0", "order = 3.0");
    of(&wrong, &[]);
    of(
        &(own(BEAM, OBSTACLES, WAVE, WARM) + "[control]\nzeta = 0.11\n"),
        &[],
    );
}
