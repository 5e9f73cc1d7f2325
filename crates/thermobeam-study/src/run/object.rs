//! A run as a JSON object. Names and order of the keys are a contract; keys may be added.

use serde::ser::{Serialize, SerializeMap, Serializer};
use thermobeam::dg::{ContactEvent, Phase};
use thermobeam::error::{StepError, StepFailure};
use thermobeam::motion::Work;

use super::RunError;
use super::ringing::note;
use super::simulate::Run;
use crate::scene::Scene;

/// The object that `run --format json` prints: all information about a run.
#[derive(Debug)]
pub struct Object<'a> {
    scene: &'a Scene,
    run: &'a Run,
    is_timed: bool,
}

#[derive(Debug, serde::Serialize)]
struct Event {
    t: f64,
    from: &'static str,
    to: &'static str,
}

impl Event {
    fn new(event: &ContactEvent) -> Self {
        Self {
            t: event.t,
            from: phase_name(event.from),
            to: phase_name(event.to),
        }
    }
}

#[derive(Debug, serde::Serialize)]
struct Solves {
    passes: usize,
    factorizations: usize,
}

impl Solves {
    fn of(run: &Run) -> Self {
        let Work {
            passes,
            factorizations,
        } = run.work;
        Self {
            passes,
            factorizations,
        }
    }
}

#[derive(Debug, serde::Serialize)]
struct Failure {
    kind: &'static str,
    step: usize,
    t: f64,
    message: String,
    #[serde(flatten)]
    numbers: FailureNumbers,
}

/// The numbers of a failure, by its kind.
#[derive(Debug, serde::Serialize)]
#[serde(untagged)]
enum FailureNumbers {
    Iteration {
        iterations: usize,
        increment: f64,
        contraction: f64,
    },
    NonFinite {
        iterations: usize,
        increment: f64,
    },
    Indefinite {
        node: usize,
        pivot: f64,
        n_value: f64,
    },
    Limit {
        limit_seconds: f64,
    },
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
    /// Includes the time on the clock.
    pub fn new(scene: &'a Scene, run: &'a Run) -> Self {
        Self {
            scene,
            run,
            is_timed: true,
        }
    }

    /// Excludes the time on the clock: the same run gives the same bytes.
    pub fn reproducible(scene: &'a Scene, run: &'a Run) -> Self {
        Self {
            scene,
            run,
            is_timed: false,
        }
    }
}

impl Serialize for Object<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Self {
            scene,
            run,
            is_timed,
        } = *self;
        let mut map = serializer.serialize_map(None)?;
        map.serialize_entry("scene", &scene.name)?;
        map.serialize_entry("elements", &scene.mesh.elements())?;
        // Completed steps: fewer than requested if the run failed.
        map.serialize_entry("steps", &run.steps)?;
        map.serialize_entry("dt", &scene.dt())?;
        map.serialize_entry("t_end", &scene.t_end)?;
        map.serialize_entry("iterations", &run.iterations)?;
        if is_timed {
            map.serialize_entry("wall_seconds", &run.wall.as_secs_f64())?;
        }
        map.serialize_entry("final", &run.last)?;
        map.serialize_entry("extremes", &run.extremes)?;
        map.serialize_entry("energy", &run.energy)?;
        map.serialize_entry("scheme", scene.method.name())?;
        map.serialize_entry("solver", scene.method.solver())?;
        map.serialize_entry("heated", &run.is_heated)?;
        map.serialize_entry("contact_steps", &run.contact_steps)?;
        map.serialize_entry("degree", &scene.degree)?;
        if let Some(stepping) = scene.method.dg() {
            map.serialize_entry("time_degree", &stepping.degree)?;
            map.serialize_entry("restart_dt", &stepping.restart_dt)?;
            map.serialize_entry("growth", &stepping.growth)?;
        }
        map.serialize_entry("work", &Solves::of(run))?;
        if let Some(contact) = &run.contact {
            let events: Vec<Event> = contact.events.iter().map(Event::new).collect();
            map.serialize_entry("events", &events)?;
        }
        if let Some(note) = note(scene, run) {
            map.serialize_entry("note", &note)?;
        }
        if let Some(error) = &run.failure {
            map.serialize_entry("failure", &failure(error))?;
        }
        map.end()
    }
}

fn failure(error: &RunError) -> Failure {
    match error {
        RunError::Loaded(_) => Failure::at_start("loaded", error),
        RunError::Setup(_) => Failure::at_start("setup", error),
        RunError::Step(StepError {
            step, t, failure, ..
        }) => {
            let (kind, numbers) = kind(failure);
            Failure {
                kind,
                step: *step,
                t: *t,
                message: failure.to_string(),
                numbers,
            }
        }
        RunError::TimeUp(up) => Failure {
            kind: "time-limit",
            step: up.step,
            t: up.t,
            message: up.to_string(),
            numbers: FailureNumbers::Limit {
                limit_seconds: up.limit.as_secs_f64(),
            },
        },
        RunError::Unsound {
            step, t, unsound, ..
        } => Failure {
            kind: "unsound",
            step: *step,
            t: *t,
            message: unsound.to_string(),
            numbers: FailureNumbers::None {},
        },
    }
}

impl Failure {
    /// Of a run without a step.
    fn at_start(kind: &'static str, error: &RunError) -> Self {
        Self {
            kind,
            step: 0,
            t: 0.0,
            message: error.to_string(),
            numbers: FailureNumbers::None {},
        }
    }
}

fn kind(failure: &StepFailure) -> (&'static str, FailureNumbers) {
    match *failure {
        StepFailure::Diverged {
            iterations,
            increment,
            contraction,
            ..
        } => (
            "diverged",
            FailureNumbers::Iteration {
                iterations,
                increment,
                contraction,
            },
        ),
        StepFailure::IterationLimit {
            iterations,
            increment,
            contraction,
        } => (
            "iteration-limit",
            FailureNumbers::Iteration {
                iterations,
                increment,
                contraction,
            },
        ),
        StepFailure::NonFinite {
            iterations,
            increment,
        } => (
            "non-finite",
            FailureNumbers::NonFinite {
                iterations,
                increment,
            },
        ),
        StepFailure::Indefinite {
            node,
            pivot,
            n_value,
            ..
        } => (
            "indefinite",
            FailureNumbers::Indefinite {
                node,
                pivot,
                n_value,
            },
        ),
        StepFailure::EventsTooClose { .. } => ("events-too-close", FailureNumbers::None {}),
        StepFailure::WrongContact { .. } => ("wrong-contact", FailureNumbers::None {}),
        StepFailure::EventNotFound { .. } => ("event-not-found", FailureNumbers::None {}),
    }
}
