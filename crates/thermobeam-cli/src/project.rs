//! The beam as a project of the harness.

use convergence_study::{Front, Project, Statement, Template, file::schema};
use thermobeam_study::kinds::{KINDS, TERMS};
use thermobeam_study::scene::SceneFile;

/// The beam's kinds of study and words, under the command that users type: `thermobeam`, or
/// `cargo xtask` in a checkout.
pub const fn project(command: &'static str) -> Project {
    Project {
        name: "thermobeam",
        command,
        about: "Simulate the beam between its obstacles, and verify the scheme that does",
        kinds: &KINDS,
        studies: &[],
        groups: &[
            "space",
            "time",
            "coupled",
            "contact",
            "energy",
            "steady states",
            "vibrations",
            "robustness",
            "cost",
            "the harness",
        ],
        terms: &TERMS,
        tables: || vec![("scene", schema::<SceneFile>())],
        templates: TEMPLATES,
        front: FRONT,
        seconds_per_cost: Some(NODE_STEP),
    }
}

/// Seconds that a one-step scheme takes for an element and a step: the unit of all costs. Measured:
/// 20 ns (100 000 steps of 100 elements in 0.2 s).
pub(crate) const NODE_STEP: f64 = 2e-8;

const FRONT: Front = Front {
    subject: "The free end of a viscoelastic Timoshenko beam: clamped at the left, its right end free to move between two \
              obstacles, and heat spreads along it.",
    picture: "section-5-figure-3.svg",
    finding: "The paper sees evidence in an experiment that \"for beta < -1/2, there are multiple steady-state solutions\". That does not hold between -0.7116 and \
               -1/2, where the straight beam is the only one; below -0.7116 there are several (section-5, bifurcation). \
               These counts are theorems: `equilibria` proves them with interval arithmetic (THEORY.md, Proven steady states).",
    plot: "theorem-3.4-space-rates.svg",
    verified: "Theorem 3.4 of Bernardi and Copetti bounds the error of their scheme by c (h + dt), for solutions that are smooth. Each order is \
               measured with solutions that are known exactly, with the other error isolated, and is judged by the interval of its rate at \
               h -> 0, not by a fit through coarse levels. A rate agrees only where its whole interval lies in the claim's tolerance. \
               Loads and errors call no formula of the solver. So an error of 1e-4 in any coefficient of the equations makes an order \
               study fail, and so does each mistake that is planted in a function: half of rho in the axial force, an obstacle that is \
               missing, a contact force with the other sign, and those in the table of negative-controls.",
    statements: &[
        Statement {
            text: "Section 5: the paper's statements",
            study: "section-5",
            rate: "",
        },
        Statement {
            text: "The paper's figures, against the exact solution",
            study: "experiments-error",
            rate: "",
        },
        Statement {
            text: "Theorem 3.4, in h: the scheme, to the interpolant",
            study: "theorem-3.4-space",
            rate: "superclose",
        },
        Statement {
            text: "Theorem 3.4, in h: its own norm, which is interpolation",
            study: "theorem-3.4-space",
            rate: "theorem-3.4",
        },
        Statement {
            text: "Theorem 3.4, in dt",
            study: "theorem-3.4-time",
            rate: "theorem-3.4",
        },
        Statement {
            text: "Theorem 3.4, over a grid, in h",
            study: "theorem-3.4-grid",
            rate: "theorem-3.4 in h",
        },
        Statement {
            text: "Theorem 3.4, over a grid, in dt",
            study: "theorem-3.4-grid",
            rate: "theorem-3.4 in dt",
        },
        Statement {
            text: "Proposition 3.1: the energy never rises, its balance closes",
            study: "energy-decay",
            rate: "",
        },
        Statement {
            text: "Section 4: the fixed point contracts as its linearisation does",
            study: "fixed-point",
            rate: "",
        },
        Statement {
            text: "Steady states, in closed form",
            study: "equilibria",
            rate: "",
        },
        Statement {
            text: "Beyond: elements of degree p",
            study: "any-order-space",
            rate: "",
        },
        Statement {
            text: "Beyond: dG(q) in time",
            study: "any-order-time",
            rate: "",
        },
        Statement {
            text: "Beyond: the experiments to ten decimals",
            study: "experiments-exact",
            rate: "",
        },
    ],
};

const TEMPLATES: &[Template] = &[
    Template {
        name: "study",
        about: "A convergence study with a manufactured solution",
        files: &[(".toml", include_str!("begin/study.toml"))],
        ignored: "",
        next: "study",
    },
    Template {
        name: "scene",
        about: "A scene: a beam, how it starts, a mesh, time steps",
        files: &[(".toml", include_str!("begin/scene.toml"))],
        ignored: "",
        next: "run",
    },
    Template {
        name: "any-order-scene",
        about: "The same by elements of high degree and dG(q), for many digits",
        files: &[(".toml", include_str!("begin/any-order-scene.toml"))],
        ignored: "",
        next: "run",
    },
    Template::PROGRAM,
    #[cfg(feature = "manufacture")]
    Template::MANUFACTURE,
];
