//! Where the cause of a failure may be.

use super::INITIAL_DATA;

/// Where to look for the cause, by the name of a setting or by the field that changed first.
pub const PLACES: [(&str, &str); 19] = [
    ("one-step schemes", "crates/thermobeam/src/solve"),
    (
        "any order",
        "crates/thermobeam/src/dg; THEORY.md, \"Any order\"",
    ),
    (
        "no time steps",
        "crates/thermobeam-exact/src/equilibrium, vibration",
    ),
    (
        "the fixed point",
        "crates/thermobeam/src/solve/fixed_point.rs; THEORY.md, \"Contraction of the fixed point\"",
    ),
    (
        "Newton's method",
        "crates/thermobeam/src/solve: newton.rs, sweeps.rs",
    ),
    (
        "the midpoint rule",
        "crates/thermobeam/src/scheme, solve/newton.rs",
    ),
    (
        "coupling a > 0",
        "the terms with a; THEORY.md, \"The energy and its exact balance\"",
    ),
    (
        "Kirchhoff's term, rho > 0",
        "crates/thermobeam/src: kirchhoff.rs, solve/bound.rs",
    ),
    (
        "a hot end, theta_A > 0",
        "the lifting: crates/thermobeam/src/one_step.rs, energy.rs",
    ),
    ("obstacles", "crates/thermobeam/src/contact.rs"),
    (
        "a graded mesh",
        "the lengths of elements: crates/thermobeam/src/mesh.rs, norms.rs",
    ),
    (
        "listed nodes",
        "the lengths of elements: crates/thermobeam/src/mesh.rs",
    ),
    (INITIAL_DATA, "crates/thermobeam-study/src/run/simulate.rs"),
    (
        "whole scenes",
        "crates/thermobeam-study/src/scene, crates/thermobeam-study/src/run",
    ),
    (
        "manufactured solutions",
        "crates/thermobeam-study/src/error, crates/thermobeam-exact/src",
    ),
    ("the harness", "crates/convergence-judge/src/judge"),
    ("temperature", "the third equation of (3.7)"),
    ("velocity", "the first equation of (3.7)"),
    ("rotation-rate", "the second equation of (3.7)"),
];
