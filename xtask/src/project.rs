//! The beam as a project of the harness.

use convergence_study::project::Project;
use thermobeam_study::kinds::{KINDS, TERMS};

/// The beam's kinds of study and words, under this command.
pub(crate) const PROJECT: Project = Project {
    name: "thermobeam",
    command: "cargo xtask",
    about: "Simulate the beam between its obstacles, and verify the scheme that does",
    kinds: &KINDS,
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
    // Others show this picture, and need a name that studies do not change.
    front_pictures: &[("section-5-beam.svg", "beam.svg")],
};
