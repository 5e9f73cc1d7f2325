//! The paper's Section 5, sentence by sentence: seven experiments are run until they are steady,
//! the claims of the text are judged, its figures redrawn.
//!
//! # Which method shows what
//!
//! * dG by the first of `[[discretisations]]`, until steady: statements about rest, and figures.
//! * dG by the second, until steady: the error of the first. The two share neither mesh nor degrees
//!   nor steps.
//! * With a table `[fixed_point]`: the paper's algorithm (4.1)-(4.5) with η*, at the scene's own h
//!   and dt, and Newton's method side by side, until t_end: statements about the motion, in place
//!   of dG; iterations per step; distance to Newton's solution.
//! * dG for each β of `[steady]`, until rest: the number of steady states.
//!
//! The paper leaves open in which "appropriate norm" the increments fall below η*. Here it is that
//! of (3.14), for the reasons in THEORY.md, "The norm of the stopping test".
//!
//! # What is measured, and how
//!
//! * Steady: the energy has fallen by at most `rate` per unit of time over the last `window`.
//! * Frequency of u(1): upward crossings of zero on [0, t_end], each interpolated: (their number -
//!   1) / (last - first).
//! * Amplitude of φ(1): largest minus smallest value on [0, t_end].
//! * First contact: when the tip first passes the obstacle: a contact event of dG, or interpolated
//!   between time levels.
//! * Rests on: the contact force at the end, and the tip's position.
//! * Error of a figure: largest difference of the two discretisations, over the width of the line.
//!
//! t_end is that of the scene, 10 in the paper: the span of its figures.
//!
//! # Where the paper's text goes too far
//!
//! It takes the experiment at β = -0.8 as evidence of several steady states for β < -1/2. That
//! threshold is not sharp: without heating the straight beam is the only steady state down to
//! -0.7116 (THEORY.md, "Steady states and buckling"). The study shows this twice: by the list of
//! all exact steady states, and by where moving beams come to rest.

mod group;
mod judge;
mod numbers;
mod paper;
mod plotted;
mod report;
mod rests;
mod tasks;
mod trace;

use super::{
    Findings, Results, RunStudy, Runs,
    steady::{ToRest, listed_scene},
};
use crate::kinds::prelude::*;
use crate::{
    figures,
    kinds::{
        settings::{CONTACT, Exercise, Integration},
        tables::{DISCRETISATIONS, Discretisation, discretisations},
    },
    scene::{Scene, limits},
};
use convergence_study::internal::input::POSITIVE;
use group::SectionFive;
use thermobeam_exact::equilibrium::Phase;

pub use super::side_by_side::SolverComparison;
pub use super::steady::{AtRest, Nearest};
pub use tasks::{ExperimentResult, MeasuredRun, PaperRun, Task};
pub use trace::Trace;

/// The row of the table of kinds.
pub const ROW: KindRow = KindRow {
    name: "runs/experiment",
    keys: Experiments::KEYS,
    schema: None,
    read: read_study::<RunStudy<Experiments>>,
    why: "Section 5 of the paper says what its seven experiments show. Each statement is a condition on a run of ours.",
    judged: "One check a statement, with the numbers. Where a statement does not hold as printed, the check says what holds. \
             Figures are drawn from curves whose error, by two discretisations, is below the width of the line.",
    failure: "Our beam does not do what the paper's does, or the resolution is too coarse to tell.",
};

/// One of the experiments.
#[derive(Debug, Clone, PartialEq)]
struct Experiment {
    group: SectionGroup,
    /// The scene, at the paper's resolution.
    scene: Scene,
}

/// The group of an experiment, which determines what is claimed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum SectionGroup {
    /// θ_A = 0, (5.4): the beam becomes straight.
    First,
    /// θ_A = 20, (5.5): the beam comes to rest in this state of contact.
    Second(Phase),
    /// Beyond buckling: the beam comes to rest bent.
    Third,
}

/// The study.
#[derive(Debug, Clone, PartialEq)]
pub struct Experiments {
    experiments: Vec<Experiment>,
    discretisations: [Discretisation; 2],
    /// η* of the paper's algorithm, if that is run.
    fixed_point: Option<f64>,
    /// A longer run fails.
    t_max: f64,
    /// Span over which the energy's fall is measured: longer than an oscillation, because the beam
    /// stands still at turning points.
    window: f64,
    /// Fall of the energy per unit of time below which the state is steady.
    rate: f64,
    rest: ToRest,
}

const KEYS: [Key; 5] = [
    Key::new(
        "experiments",
        Form::Table(&[&[&SCENES]]),
        "the scenes of the three groups",
    ),
    Key::new(
        "run",
        Form::Table(&[&[&RUN]]),
        "when a run counts as steady",
    ),
    DISCRETISATIONS,
    Key::new(
        "fixed_point",
        Form::Table(&[&[&[Key::new(
            "tolerance",
            Form::Positive,
            "at which the fixed point ends",
        )]]]),
        "the paper's algorithm beside Newton's",
    )
    .or("not run"),
    Key::new(
        "steady",
        Form::Table(&[&[&ToRest::ANY_ORDER_KEYS]]),
        "moving beams until they rest",
    ),
];
const SCENES: [Key; 4] = [
    Key::new(
        "first",
        Form::List(&Form::Text),
        "scene files, beta ascending",
    ),
    Key::new(
        "second",
        Form::List(&Form::Text),
        "scene files, beta ascending",
    ),
    Key::new(
        "rests",
        Form::List(&Form::Choice(|| vec!["upper", "lower", "free"])),
        "the contact of each scene of second at rest",
    ),
    Key::new("third", Form::Text, "a scene file"),
];
const RUN: [Key; 3] = [
    Key::new(
        "t_max",
        Form::Positive,
        "time after which no state counts as steady",
    ),
    Key::new(
        "window",
        Form::Positive,
        "time during which the energy must change little",
    ),
    Key::new(
        "rate",
        Form::Positive,
        "relative change of the energy per time that counts as steady",
    ),
];

impl Runs for Experiments {
    const KEYS: &'static [Keys] = &[&[&KEYS]];

    type Run = Task;
    type Shown = ExperimentResult;

    fn from_document(root: &Section<'_>, folder: &Path) -> Result<Self, InputError> {
        let run = root.table("run", &[&RUN])?;
        let t_max = run.positive("t_max")?;
        let experiments = experiments(root, folder)?;
        let ends = experiments.iter().map(|experiment| experiment.scene.t_end);
        let t_end = ends.fold(0.0, f64::max);
        let discretisations = discretisations(root, "discretisations", None, t_end)?;
        let field = run.require("t_max", POSITIVE)?;
        for Discretisation { stepping, .. } in &discretisations {
            limits::steps_until(&field, t_max, stepping.dt, limits::STEPS)?;
        }
        let fixed_point = root
            .section("fixed_point")?
            .map(|section| {
                comparable(root, &experiments)?;
                section.positive("tolerance")
            })
            .transpose()?;
        let steady = root.table("steady", &[&ToRest::ANY_ORDER_KEYS])?;
        Ok(Self {
            rest: ToRest::read_any_order(&steady, discretisations[0])?,
            experiments,
            discretisations,
            fixed_point,
            t_max,
            window: run.positive("window")?,
            rate: run.positive("rate")?,
        })
    }

    fn exercise(&self, case: Option<&str>) -> Exercise {
        let scenes = self.experiments.iter().map(|experiment| &experiment.scene);
        Exercise::of_scenes(CONTACT, Integration::PAPER, scenes, case)
    }

    /// The experiments by both discretisations and, where asked for, by the paper's algorithm; then
    /// for each β a moving beam until it rests.
    fn runs(&self) -> Vec<Case<Task>> {
        let places = 0..self.experiments.len();
        let mut runs = vec![];
        for discretisation in [0, 1] {
            runs.extend(
                places
                    .clone()
                    .map(|k| self.any_order_case(k, discretisation)),
            );
        }
        if self.fixed_point.is_some() {
            runs.extend(places.map(|k| self.fixed_point_case(k)));
        }
        for (place, beta) in self.rest.betas.iter().enumerate() {
            let label = format!("to rest, beta = {beta}");
            runs.push(Case::new(label, self.rest.cost(), Task::Rest(place)));
        }
        runs
    }

    fn run(&self, &task: &Task) -> Result<ExperimentResult, CaseFailure> {
        Ok(match task {
            Task::AnyOrder {
                experiment,
                discretisation,
            } => {
                ExperimentResult::Run(Box::new(self.run_until_steady(experiment, discretisation)?))
            }
            Task::FixedPoint(experiment) => {
                ExperimentResult::FixedPoint(Box::new(self.run_side_by_side(experiment)?))
            }
            Task::Rest(place) => {
                let last = self.experiments.last();
                let third = last.ok_or_else(|| CaseFailure::new("no experiment"))?;
                ExperimentResult::Rest(self.rest.run(&third.scene, place)?)
            }
        })
    }

    fn numbers(&self, _: &Task, found: &ExperimentResult) -> Vec<Reading> {
        match found {
            ExperimentResult::Run(run) => [run.trace.readings(""), run.readings("", true)].concat(),
            ExperimentResult::FixedPoint(run) => {
                [run.trace.readings(""), run.readings("")].concat()
            }
            ExperimentResult::Rest(rest) => rest.readings(),
        }
    }

    fn judge(&self, results: &Results<'_, Self>) -> Findings {
        report::findings(self, &SectionFive::of(self, results))
    }
}

/// Refuses scenes whose time levels are not those of a figure: dG is compared with them there.
fn comparable(root: &Section<'_>, experiments: &[Experiment]) -> Result<(), InputError> {
    for Experiment { scene, .. } in experiments {
        if !scene.steps().is_multiple_of(trace::LEVELS) {
            let found = format!("{}, which has {} steps", scene.name, scene.steps());
            let expected = format!("scenes with a multiple of {} steps", trace::LEVELS);
            return Err(root.refuse("fixed_point", found, expected));
        }
    }
    Ok(())
}

/// The table `[experiments]`: the scenes of the three groups.
fn experiments(root: &Section<'_>, folder: &Path) -> Result<Vec<Experiment>, InputError> {
    let section = root.table("experiments", &[&SCENES])?;
    // At least two scenes in ascending order of β, since the claims compare neighbours.
    let ascending = |key: &str| {
        let fits = |scenes: &[Scene]| {
            scenes.len() >= 2 && scenes.is_sorted_by(|a, b| a.beam.beta < b.beam.beta)
        };
        let allowed = "a list of at least two scene files, beta ascending";
        section.list(key, allowed, |item| listed_scene(item, folder), fits)
    };
    let (first, second) = (ascending("first")?, ascending("second")?);
    // The contact state that is claimed for each beam of the second group.
    let choices = [
        ("upper", Phase::Upper),
        ("lower", Phase::Lower),
        ("free", Phase::Free),
    ];
    let allowed = "a list of \"upper\", \"lower\" or \"free\", one for each scene of second";
    let rests = section.list(
        "rests",
        allowed,
        |item| item.choice(&choices),
        |list| list.len() == second.len(),
    )?;
    let third = listed_scene(&section.require("third", "a scene file")?, folder)?;
    let mut experiments = vec![];
    for scene in first {
        let group = SectionGroup::First;
        experiments.push(Experiment { group, scene });
    }
    for (rest, scene) in rests.into_iter().zip(second) {
        let group = SectionGroup::Second(rest);
        experiments.push(Experiment { group, scene });
    }
    experiments.push(Experiment {
        group: SectionGroup::Third,
        scene: third,
    });
    Ok(experiments)
}

impl Experiments {
    /// Whether the scenes are the paper's experiments, which needs no run.
    pub fn data(&self) -> Check {
        paper::data(self)
    }

    fn any_order_case(&self, experiment: usize, discretisation: usize) -> Case<Task> {
        // Steady states are reached at t = 50 to 100.
        const STEADY: f64 = 80.0;
        let how = &self.discretisations[discretisation];
        let name = &self.experiments[experiment].scene.name;
        let label = match discretisation {
            0 => name.clone(),
            _ => format!("{name}, {}", how.label()),
        };
        let task = Task::AnyOrder {
            experiment,
            discretisation,
        };
        Case::new(label, how.cost(STEADY), task)
    }

    fn fixed_point_case(&self, experiment: usize) -> Case<Task> {
        // Two to three iterations and a step of Newton's method cost as much as four of its steps.
        let scene = &self.experiments[experiment].scene;
        let cost = 4.0 * scene.steps() as f64 * scene.mesh.elements() as f64;
        let label = format!("{}, fixed point and Newton", scene.name);
        Case::new(label, cost, Task::FixedPoint(experiment))
    }
}

/// The energy of the straight beam at rest; NaN for the linear beam, whose energy differs by a
/// constant.
fn straight_energy(scene: &Scene) -> f64 {
    figures::energy_at_rest(&scene.beam).unwrap_or(f64::NAN)
}
