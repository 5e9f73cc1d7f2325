//! Mistakes of public threads: each is named.

use crate::prelude::*;

/// A stationary file in the unit square with this solution and rest.
fn square(exact: &str, rest: &str) -> String {
    format!(
        "[manufacture]\nname = \"thread\"\ncoordinates = [\"x\", \"y\"]\n[domain]\nx = [0, 1]\ny = [0, 1]\n\
         [exact]\n{exact}\n{rest}\n"
    )
}

/// github.com/usnistgov/pfhub/issues/756: the generated C code had the formula `S_tkphd`, in which
/// both spatial terms have the wrong sign, in place of `S_stvdwtt`.
#[test]
fn the_signs_of_the_generated_source_of_pfhub_are_named() {
    foreign_tools::needs!(PYTHON);
    let source = |sign: &str| {
        format!(
            "k = 0.0004; a = 0.25 + 0.0075*t*sin(8*pi*x) + 0.03*sin(22*pi*x + 0.0625*pi*t); \
             ax = 0.06*pi*t*cos(8*pi*x) + 0.66*pi*cos(22*pi*x + 0.0625*pi*t); \
             axx = -0.48*pi**2*t*sin(8*pi*x) - 14.52*pi**2*sin(22*pi*x + 0.0625*pi*t); \
             at = 0.0075*sin(8*pi*x) + 0.001875*pi*cos(22*pi*x + 0.0625*pi*t); Z = (y - a)/sqrt(2*k); \
             f = (1 - tanh(Z)**2)/sqrt(16*k)*(sqrt(2)*at {sign} (2*sqrt(k)*tanh(Z)*ax**2 + sqrt(2)*k*axx))"
        )
    };
    let compare = |sign: &str| against(PFHUB, None, "x, y, t", "eta", &source(sign));
    assert_eq!(compare("-").cause, "equal");
    let comparison = compare("+");
    assert_eq!(comparison.cause, "sign-of-term", "{comparison:?}");
    assert_eq!(comparison.terms, ["reaction", "diffusion"]);
    assert_eq!(
        comparison.sentence,
        "eta: your source has the opposite sign in `reaction` and `diffusion`; the other term is right (test.toml:18:13)"
    );
}

/// github.com/Mantevo/miniFE/issues/16: the analytic solution is harmonic, the code's source is 1.
#[test]
fn the_constant_source_of_minife_is_named() {
    foreign_tools::needs!(PYTHON);
    let text = "[manufacture]\nname = \"minife\"\ncoordinates = [\"x\", \"y\", \"z\"]\n[domain]\nx = [0, 1]\ny = [0, 1]\nz = [0, 1]\n\
        [exact]\nT = \"sin(pi*y)*sin(pi*z)*sinh(sqrt(2)*pi*x)/sinh(sqrt(2)*pi)\"\n[equations]\nT = \"-laplacian(T)\"\n";
    assert_eq!(found(&check(text), "source-zero").len(), 1);
    let comparison = against(text, None, "x, y, z", "T", "f = 1");
    assert_eq!(
        (comparison.cause, comparison.factors.as_slice()),
        ("constant", [1.0].as_slice())
    );
}

/// github.com/Argonne-National-Laboratory/deer/pull/75: a minus forgotten on the body force, and a
/// solution whose error is round-off.
#[test]
fn the_body_force_of_deer_is_named_and_its_polynomial_noted() {
    foreign_tools::needs!(PYTHON);
    let text = square("u = \"x^2*y\"", "[equations]\nu = \"-laplacian(u)\"");
    assert_eq!(found(&check(&text), "polynomial")[0].value, Some(3.0));
    let comparison = against(&text, None, "x, y", "u", "f = 2*y");
    assert_eq!(comparison.cause, "sign-of-source");
}

/// github.com/pmgbergen/porepy/issues/146: with tractions that vanish the order is seen, with
/// others it is lost. No source is wrong there; a code that forgets its tractions is named.
#[test]
fn tractions_that_vanish_are_noted_and_forgotten_ones_are_named() {
    foreign_tools::needs!(PYTHON);
    let text = |u: &str| {
        square(
            &format!("u = {u}"),
            "[define]\nsigma = \"2*sym(grad(u)) + div(u)*identity\"\n[equations]\nbalance = \"-div(sigma)\"\n\
             [boundary.x_max]\ntraction = \"dot(sigma, n)\"",
        )
    };
    let vanishing = check(&text("[\"(1 - x)^2*sin(y)\", \"(1 - x)^2*cos(2*y)\"]"));
    assert_eq!(
        found(&vanishing, "data-zero")[0].key,
        "boundary.x_max.traction"
    );
    let other = text("[\"sin(x)*sin(y)\", \"x*cos(2*y)\"]");
    assert!(found(&check(&other), "data-zero").is_empty());
    let names = "x, y, n_x, n_y";
    let forgotten = against(&other, Some("x_max"), names, "traction_x", "f = 0.0");
    assert_eq!(
        (forgotten.cause, forgotten.factors.as_slice()),
        ("factor-of-source", [0.0].as_slice())
    );
}
