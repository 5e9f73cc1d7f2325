//! A run as a JSON object. The order of the keys is the order of the fields; names are a contract, more may be added.

use serde::Serialize;
use thermobeam::dg::{self, ContactEvent, Phase};
use thermobeam::error::{StepError, StepFailure};

use super::motion::{RunError, Sample, Solves};
use super::simulate::Run;
use super::tally::{EnergySummary, Extremes, Iterations};
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
    degree: usize,
    #[serde(flatten)]
    lengths: Option<StepsOfDg>,
    work: Solves,
    #[serde(skip_serializing_if = "Option::is_none")]
    events: Option<Vec<Event>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    failure: Option<Failure>,
}

/// Steps of dG.
#[derive(Debug, Serialize)]
struct StepsOfDg {
    time_degree: usize,
    restart_dt: f64,
    growth: f64,
}

#[derive(Debug, Serialize)]
struct Event {
    t: f64,
    from: &'static str,
    to: &'static str,
}

#[derive(Debug, Serialize)]
struct Failure {
    kind: &'static str,
    step: usize,
    t: f64,
    message: String,
    #[serde(flatten)]
    numbers: FailureNumbers,
}

/// The numbers of a failure, by its kind.
#[derive(Debug, Serialize)]
#[serde(untagged)]
enum FailureNumbers {
    Iteration { iterations: usize, increment: f64, contraction: f64 },
    NonFinite { iterations: usize, increment: f64 },
    Indefinite { node: usize, pivot: f64, n_value: f64 },
    Limit { limit_seconds: f64 },
    None {},
}

/// A contact state in a word.
pub fn phase_name(phase: Phase) -> &'static str {
    match phase {
        Phase::Free => "free",
        Phase::Lower => "lower",
        Phase::Upper => "upper",
    }
}

impl<'a> Object<'a> {
    /// Everything there is to say about a run.
    pub fn new(scene: &'a Scene, run: &Run) -> Self {
        Self { wall_seconds: Some(run.wall.as_secs_f64()), ..Self::reproducible(scene, run) }
    }

    /// The same without the time on the clock: the same run gives the same bytes.
    pub fn reproducible(scene: &'a Scene, run: &Run) -> Self {
        let event = |event: &ContactEvent| Event { t: event.t, from: phase_name(event.from), to: phase_name(event.to) };
        let lengths =
            |by: dg::Stepping| StepsOfDg { time_degree: by.degree, restart_dt: by.restart_dt, growth: by.growth };
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
            degree: scene.degree,
            lengths: scene.method.dg().map(lengths),
            work: run.work,
            events: run.contact.as_ref().map(|contact| contact.events.iter().map(event).collect()),
            failure: run.failure.as_ref().map(failure),
        }
    }
}

fn failure(ended: &RunError) -> Failure {
    let of = |kind, step, t, message: String, numbers| Failure { kind, step, t, message, numbers };
    match ended {
        RunError::Setup(_) => of("setup", 0, 0.0, ended.to_string(), FailureNumbers::None {}),
        RunError::Step(StepError { step, t, failure, .. }) => {
            let (kind, numbers) = kind(failure);
            of(kind, *step, *t, failure.to_string(), numbers)
        }
        RunError::TimeUp(up) => {
            let numbers = FailureNumbers::Limit { limit_seconds: up.limit.as_secs_f64() };
            of("time-limit", up.step, up.t, up.to_string(), numbers)
        }
        RunError::Unsound { step, t, unsound, .. } => {
            of("unsound", *step, *t, unsound.to_string(), FailureNumbers::None {})
        }
    }
}

fn kind(failure: &StepFailure) -> (&'static str, FailureNumbers) {
    match *failure {
        StepFailure::Diverged { iterations, increment, contraction, .. } => {
            ("diverged", FailureNumbers::Iteration { iterations, increment, contraction })
        }
        StepFailure::IterationLimit { iterations, increment, contraction } => {
            ("iteration-limit", FailureNumbers::Iteration { iterations, increment, contraction })
        }
        StepFailure::NonFinite { iterations, increment } => {
            ("non-finite", FailureNumbers::NonFinite { iterations, increment })
        }
        StepFailure::Indefinite { node, pivot, n_value } => {
            ("indefinite", FailureNumbers::Indefinite { node, pivot, n_value })
        }
        StepFailure::EventsTooClose { .. } => ("events-too-close", FailureNumbers::None {}),
        StepFailure::WrongContact { .. } => ("wrong-contact", FailureNumbers::None {}),
        StepFailure::EventNotFound { .. } => ("event-not-found", FailureNumbers::None {}),
    }
}
