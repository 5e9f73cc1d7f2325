//! Where the cause of a failure may be.

use convergence_study::SourcePlace;

use super::INITIAL_DATA;

/// Where to look for the cause, by the name of a setting or by the field that changed first.
pub const PLACES: [SourcePlace; 19] = [
    SourcePlace {
        word: "one-step schemes",
        place: "crates/thermobeam/src/solve",
    },
    SourcePlace {
        word: "any order",
        place: "crates/thermobeam/src/dg; THEORY.md, \"Any order\"",
    },
    SourcePlace {
        word: "no time steps",
        place: "crates/thermobeam-exact/src/equilibrium, vibration",
    },
    SourcePlace {
        word: "the fixed point",
        place: "crates/thermobeam/src/solve/fixed_point.rs; THEORY.md, \"Contraction of the fixed point\"",
    },
    SourcePlace {
        word: "Newton's method",
        place: "crates/thermobeam/src/solve: newton.rs, sweeps.rs",
    },
    SourcePlace {
        word: "the midpoint rule",
        place: "crates/thermobeam/src/scheme, solve/newton.rs",
    },
    SourcePlace {
        word: "coupling a > 0",
        place: "the terms with a; THEORY.md, \"The energy and its exact balance\"",
    },
    SourcePlace {
        word: "Kirchhoff's term, rho > 0",
        place: "crates/thermobeam/src: kirchhoff.rs, solve/bound.rs",
    },
    SourcePlace {
        word: "a hot end, theta_A > 0",
        place: "the lifting: crates/thermobeam/src/one_step.rs, energy.rs",
    },
    SourcePlace {
        word: "obstacles",
        place: "crates/thermobeam/src/contact.rs",
    },
    SourcePlace {
        word: "a graded mesh",
        place: "the lengths of elements: crates/thermobeam/src/mesh.rs, norms.rs",
    },
    SourcePlace {
        word: "listed nodes",
        place: "the lengths of elements: crates/thermobeam/src/mesh.rs",
    },
    SourcePlace {
        word: INITIAL_DATA,
        place: "crates/thermobeam-study/src/run/simulate.rs",
    },
    SourcePlace {
        word: "whole scenes",
        place: "crates/thermobeam-study/src/scene, crates/thermobeam-study/src/run",
    },
    SourcePlace {
        word: "manufactured solutions",
        place: "crates/thermobeam-study/src/error, crates/thermobeam-exact/src",
    },
    SourcePlace {
        word: "the harness",
        place: "crates/convergence-judge/src/judge",
    },
    SourcePlace {
        word: "temperature",
        place: "the third equation of (3.7)",
    },
    SourcePlace {
        word: "velocity",
        place: "the first equation of (3.7)",
    },
    SourcePlace {
        word: "rotation-rate",
        place: "the second equation of (3.7)",
    },
];
