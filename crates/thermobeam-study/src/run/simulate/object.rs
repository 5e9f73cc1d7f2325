//! A run as a JSON object. The order of the keys is the order of the fields; names are a contract, more may be added.

use serde::Serialize;
use thermobeam::error::StepFailure;

use super::{EnergySummary, Extremes, Iterations, Run, Sample};
use crate::predict::estimate::Budget;
use crate::run::driver::RunError;
use crate::scene::Scene;

/// The object that `run --format json` prints.
#[derive(Debug, Serialize)]
pub struct Object<'a> {
    scene: &'a str,
    elements: usize,
    /// Steps done: fewer than asked for where the run failed.
    steps: usize,
    dt: f64,
    t_end: f64,
    iterations: Iterations,
    #[serde(skip_serializing_if = "Option::is_none")]
    wall_seconds: Option<f64>,
    #[serde(rename = "final")]
    last: Sample,
    extremes: Extremes,
    energy: EnergySummary,
    scheme: &'static str,
    solver: &'static str,
    /// Whether the temperature was computed.
    heated: bool,
    contact_steps: usize,
    work: Counts,
    #[serde(skip_serializing_if = "Option::is_none")]
    error_budget: Option<&'a Budget>,
    #[serde(skip_serializing_if = "Option::is_none")]
    failure: Option<Failure>,
}

/// Counts of the solvers, which know no JSON.
#[derive(Debug, Serialize)]
pub(in crate::run) struct Counts {
    pub(in crate::run) passes: usize,
    pub(in crate::run) factorizations: usize,
}

#[derive(Debug, Serialize)]
struct Failure {
    kind: &'static str,
    step: usize,
    t: f64,
    message: String,
    #[serde(flatten)]
    numbers: Numbers,
}

/// The numbers of a failure, by its kind.
#[derive(Debug, Serialize)]
#[serde(untagged)]
enum Numbers {
    Iteration { iterations: usize, increment: f64, contraction: f64 },
    NonFinite { iterations: usize, increment: f64 },
    Indefinite { node: usize, pivot: f64, n_value: f64 },
    Limit { limit_seconds: f64 },
    None {},
}

impl<'a> Object<'a> {
    /// Everything there is to say about a run.
    pub fn new(scene: &'a Scene, run: &Run) -> Self {
        Self { wall_seconds: Some(run.wall.as_secs_f64()), ..Self::reproducible(scene, run) }
    }

    /// The same with an error budget.
    pub fn with_budget(self, error_budget: Option<&'a Budget>) -> Self {
        Self { error_budget, ..self }
    }

    /// The same without the time on the clock: the same run gives the same bytes.
    pub fn reproducible(scene: &'a Scene, run: &Run) -> Self {
        Self {
            scene: &scene.name,
            elements: scene.mesh.elements(),
            steps: run.steps,
            dt: scene.dt(),
            t_end: scene.t_end,
            iterations: run.iterations,
            wall_seconds: None,
            last: run.last,
            extremes: run.extremes,
            energy: run.energy,
            scheme: scene.method.name(),
            solver: scene.method.solver(),
            heated: run.is_heated,
            contact_steps: run.contact_steps,
            work: Counts { passes: run.work.passes, factorizations: run.work.factorizations },
            error_budget: None,
            failure: run.failure.as_ref().map(failure),
        }
    }
}

fn failure(ended: &RunError) -> Failure {
    let error = match ended {
        RunError::Step(error) => error,
        RunError::Setup(error) => {
            return Failure { kind: "setup", step: 0, t: 0.0, message: error.to_string(), numbers: Numbers::None {} };
        }
        RunError::TimeUp(up) => {
            let numbers = Numbers::Limit { limit_seconds: up.limit.as_secs_f64() };
            return Failure { kind: "time-limit", step: up.step, t: up.t, message: up.to_string(), numbers };
        }
        &RunError::Unsound { step, t, .. } => {
            return Failure { kind: "unsound", step, t, message: ended.to_string(), numbers: Numbers::None {} };
        }
    };
    let (kind, numbers) = match error.failure {
        StepFailure::Diverged { iterations, increment, contraction } => {
            ("diverged", Numbers::Iteration { iterations, increment, contraction })
        }
        StepFailure::IterationLimit { iterations, increment, contraction } => {
            ("iteration-limit", Numbers::Iteration { iterations, increment, contraction })
        }
        StepFailure::NonFinite { iterations, increment } => {
            ("non-finite", Numbers::NonFinite { iterations, increment })
        }
        StepFailure::Indefinite { node, pivot, n_value } => {
            ("indefinite", Numbers::Indefinite { node, pivot, n_value })
        }
    };
    Failure { kind, step: error.step, t: error.t, message: error.failure.to_string(), numbers }
}
