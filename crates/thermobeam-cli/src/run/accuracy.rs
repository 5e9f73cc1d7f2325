//! `run SCENE --target-error E`: the run is chosen by the error that it is to make.

use clap::ValueEnum;
use serde::Serialize;
use thermobeam::simulation::Stepping;
use thermobeam_study::error::evaluator;
use thermobeam_study::predict::accuracy::{self, Choice, Request, Trust, Unreachable};
use thermobeam_study::run::family::Family;
use thermobeam_study::run::simulate::Run;
use thermobeam_study::scene::{Method, Scene};

/// What the error is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub(crate) enum Quantity {
    /// Maximum over [0, T] of the error of u(1, t)
    #[default]
    Tip,
    /// Maximum over [0, T] of the norm of Theorem 3.4
    #[value(name = "theorem-3.4")]
    Theorem34,
}

/// A target error, as it is given on the command line.
pub(super) fn target(text: &str) -> Result<f64, String> {
    let target = text.parse().ok().filter(|target: &f64| *target > 0.0 && target.is_finite());
    target.ok_or_else(|| "expected a finite number > 0".to_owned())
}

/// What was asked for, and the run that was chosen.
pub(crate) struct Planned {
    quantity: evaluator::ErrorMeasure,
    target: f64,
    choice: Choice,
}

/// The scene with scheme, mesh and steps that make the error asked for; those that it came with do not matter, but for
/// the grading of its mesh.
pub(crate) fn choose(scene: Scene, quantity: Quantity, target: f64) -> Result<(Scene, Planned), Unreachable> {
    let quantity = match quantity {
        Quantity::Tip => evaluator::ErrorMeasure::Tip,
        Quantity::Theorem34 => evaluator::ErrorMeasure::Theorem34,
    };
    let family = Family::of_scene(&scene);
    let choice = accuracy::choose(&family, &Request::new(quantity, target))?;
    let mesh = family.mesh(choice.elements).map_err(|error| Unreachable::Pilot(error.to_string()))?;
    let dt = scene.t_end / choice.steps as f64;
    let stepping = Stepping { scheme: choice.scheme, settings: choice.settings, dt, loaded: false };
    let scene = Scene { mesh, method: Method::OneStep(stepping), ..scene };
    Ok((scene, Planned { quantity, target, choice }))
}

/// What was asked for and what is expected, by whatever scheme.
#[derive(Debug, Serialize)]
pub(super) struct Expected {
    pub(super) quantity: &'static str,
    pub(super) target_error: f64,
    /// The error that the run is estimated to have made.
    pub(super) believed_error: f64,
    pub(super) space_error: f64,
    pub(super) time_error: f64,
}

/// The key `accuracy` of the JSON object.
#[derive(Debug, Serialize)]
pub(super) struct Object {
    #[serde(flatten)]
    expected: Expected,
    confidence: &'static str,
    node_steps: f64,
    pilot_node_steps: f64,
    pilot_seconds: f64,
}

impl Planned {
    pub(super) fn object(&self) -> Object {
        let choice = &self.choice;
        Object {
            expected: Expected {
                quantity: self.quantity.name(),
                target_error: self.target,
                believed_error: choice.expected_error,
                space_error: choice.parts[0],
                time_error: choice.parts[1],
            },
            confidence: match choice.trust {
                Trust::Firm => "firm",
                Trust::Loose => "loose",
                Trust::None => "none",
            },
            node_steps: choice.node_steps(),
            pilot_node_steps: choice.pilots.node_steps,
            pilot_seconds: choice.pilots.seconds,
        }
    }

    /// Lines of the summary: name, value, meaning.
    pub(super) fn lines(&self, run: &Run) -> Vec<(&'static str, String, String)> {
        let choice = &self.choice;
        let what = match self.quantity {
            evaluator::ErrorMeasure::Tip => "maximum over [0, T] of the error of u(1, t)".to_owned(),
            _ => "maximum over [0, T] of the norm of Theorem 3.4".to_owned(),
        };
        let trust = match choice.trust {
            Trust::Firm => "all rates observed are those of theory",
            Trust::Loose => "impacts, or rates below those of theory: judged by pilots as fine as this run",
            Trust::None => "no rates to speak of: judged by coarser runs alone",
        };
        let parts = format!("space {:.1e}, time {:.1e}; {trust}", choice.parts[0], choice.parts[1]);
        let (pilots, node_steps) = (choice.pilots.node_steps, choice.node_steps());
        let seconds =
            format!("{:.3} s for the pilots, {:.3} s for the run", choice.pilots.seconds, run.wall.as_secs_f64());
        vec![
            ("asked for", format!("{:.3e}", self.target), what),
            ("expected", format!("{:.3e}", choice.expected_error), parts),
            ("node-steps", format!("{:.3e}", pilots + node_steps), format!("of which {pilots:.3e} for pilot runs")),
            ("time", format!("{:.3} s", choice.pilots.seconds + run.wall.as_secs_f64()), seconds),
        ]
    }
}
