//! `run SCENE --target-error E` for scenes with `scheme = "dg"`.

use serde::Serialize;
use thermobeam_study::predict::any_order::{Choice, Unreachable, choose};
use thermobeam_study::run::any_order::AnyOrderRun;
use thermobeam_study::scene::Scene;

use super::accuracy::{Expected, Quantity};

/// Why no run was chosen.
pub(super) enum NotChosen {
    /// What was asked for makes no sense.
    Refused(String),
    /// The accuracy is out of reach, or a run to compare with failed.
    NotReached(Unreachable),
}

/// What was asked for, and the run that was chosen.
pub(super) struct PlannedAnyOrder {
    target: f64,
    choice: Choice,
}

/// The scene with the degrees, elements and steps that make the error asked for.
pub(super) fn choose_any_order(scene: &Scene, quantity: Quantity, target: f64) -> Result<PlannedAnyOrder, NotChosen> {
    if quantity != Quantity::Tip {
        let reason = "--quantity: found theorem-3.4; expected tip where time.scheme is \"dg\"";
        return Err(NotChosen::Refused(reason.to_owned()));
    }
    match choose(scene, target) {
        Ok(choice) => Ok(PlannedAnyOrder { target, choice }),
        Err(error @ Unreachable::Target { .. }) => Err(NotChosen::Refused(error.to_string())),
        Err(error) => Err(NotChosen::NotReached(error)),
    }
}

/// The key `accuracy` of the JSON object.
#[derive(Debug, Serialize)]
pub(super) struct Object {
    /// The error expected is the sum of its parts.
    #[serde(flatten)]
    expected: Expected,
    nodes: Vec<f64>,
    unknown_solves: f64,
    pilot_unknown_solves: f64,
    pilot_runs: usize,
    pilot_seconds: f64,
}

impl PlannedAnyOrder {
    pub(super) fn scene(&self) -> &Scene {
        &self.choice.scene
    }

    pub(super) fn object(&self) -> Object {
        let choice = &self.choice;
        Object {
            expected: Expected {
                quantity: "tip",
                target_error: self.target,
                believed_error: choice.expected_error(),
                space_error: choice.space,
                time_error: choice.time,
            },
            nodes: choice.scene.mesh.nodes().to_vec(),
            unknown_solves: choice.run.unknown_solves,
            pilot_unknown_solves: choice.checks.unknown_solves,
            pilot_runs: choice.checks.runs,
            pilot_seconds: choice.checks.seconds,
        }
    }

    /// Lines of the summary: name, value, meaning.
    pub(super) fn lines(&self, run: &AnyOrderRun) -> Vec<(&'static str, String, String)> {
        let Choice { scene, space, time, checks, run: cost, finer_space } = &self.choice;
        let nodes: Vec<String> = scene.mesh.nodes().iter().map(|x| format!("{x:.4}")).collect();
        let ratio = checks.unknown_solves / cost.unknown_solves;
        vec![
            (
                "asked for",
                format!("{:.3e}", self.target),
                "maximum over [0, T] of the error of u(1, t), inside steps included".to_owned(),
            ),
            (
                "expected",
                format!("{:.3e}", self.choice.expected_error()),
                "the sum of the two differences below".to_owned(),
            ),
            ("space", format!("{space:.3e}"), format!("largest difference to {finer_space}")),
            ("time", format!("{time:.3e}"), "largest difference to steps half as long, growth included".to_owned()),
            ("growth", format!("{:.4}", scene.dg_stepping().growth), "of the steps after a contact event".to_owned()),
            ("elements", scene.mesh.elements().to_string(), format!("between x = {}", nodes.join(", "))),
            (
                "time spent",
                format!("{:.3} s", checks.seconds + run.wall.as_secs_f64()),
                format!("{} runs to compare with, {ratio:.1} times the work of this one", checks.runs),
            ),
        ]
    }
}
