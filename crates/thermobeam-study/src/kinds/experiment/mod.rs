//! The paper's Section 5, sentence by sentence: seven experiments run until they are steady, the claims of the text judged,
//! its figures redrawn.
//!
//! # What is measured, and how
//!
//! | quantity | measured as |
//! | --- | --- |
//! | steady | the energy has fallen by at most `rate` per unit of time over the last `window` |
//! | frequency of u(1) | upward crossings of zero on [0, t_end]: (their number - 1) / (last - first), each interpolated |
//! | amplitude of φ(1) | largest minus smallest value on [0, t_end] |
//! | first contact | when the tip first passes the obstacle, interpolated |
//! | rests on | the contact force of the last step, and the tip's position |
//!
//! t_end is the scene's, the paper's 10: the span of its figures.
//!
//! # Where the paper's text goes too far
//!
//! It takes the experiment at β = -0.8 as evidence that for β < -1/2 there are several steady states. Between
//! -0.7116 and -1/2 there are not. With B = π²/4 / (1 + π²/4) = 0.711600 and without heating, steady states are the critical points of
//!
//! ```text
//! ½ (‖u_x - φ‖² + ‖φ_x‖² + β ‖u_x‖²) + ρ/4 ‖u_x‖⁴ + G(u(1)),
//! ```
//!
//! and `‖u_x - φ‖² + ‖φ_x‖² >= B ‖u_x‖²`: for β > -B this is strictly convex, so that the straight beam is the only one.
//! The study shows it twice: in the list of all exact steady states, and by where moving beams come to rest.

mod judge;
mod report;
mod run;

use super::prelude::*;
use super::steady::{ToRest, listed_scene};
use convergence_study::input::POSITIVE;

pub use super::steady::{AtRest, Nearest};
pub use run::{CurvePoint, Measured};

/// The row of the table of kinds.
pub const ROW: KindRow = KindRow {
    name: "experiment",
    read: reader::<Experiments>,
    why: "Section 5 of the paper says what its seven experiments show. Each statement is a condition on a run of ours.",
    judged: "One check a statement, with the numbers. Where a statement does not hold as printed, the check says what holds.",
    failure: "Our beam does not do what the paper's does, or the resolution is too coarse to tell.",
};

/// Which of the section's experiments, and so what is claimed of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum SectionGroup {
    /// θ_A = 0, (5.4): the beam becomes straight.
    First,
    /// θ_A = 20, (5.5): the beam comes to rest in this state of contact.
    Second(Contact),
    /// Beyond buckling: the beam comes to rest bent.
    Third,
}

/// One of the experiments.
#[derive(Debug, Clone, PartialEq)]
struct Experiment {
    group: SectionGroup,
    /// The scene, at the study's resolution.
    scene: Scene,
}

/// When a run ends.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Until {
    /// A run that lasts longer fails.
    t_max: f64,
    /// Span over which the energy's fall is measured: longer than an oscillation, because at its turning points the beam
    /// stands still.
    window: f64,
    /// Fall of the energy per unit of time below which the state is steady.
    rate: f64,
}

/// The study.
#[derive(Debug, Clone, PartialEq)]
pub struct Experiments {
    header: Header,
    experiments: Vec<Experiment>,
    until: Until,
    rest: ToRest,
}

/// What a case computes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ExperimentTask {
    /// An experiment, by its place in the list.
    Run(usize),
    /// A moving beam until it rests, at the β of this place in the list.
    Rest(usize),
}

/// What a case finds.
#[derive(Debug, Clone, PartialEq)]
pub enum Found {
    /// Of an experiment.
    Run(Box<Measured>),
    /// Of a run to rest.
    Rest(AtRest),
}

impl FromFile for Experiments {
    fn from_document(header: Header, root: &Section<'_>, folder: &Path) -> Result<Self, InputError> {
        root.allow(&["study", "experiments", "run", "steady"])?;
        let run = root.table("run", &["elements", "dt", "t_max", "window", "rate"])?;
        let until =
            Until { t_max: run.positive("t_max")?, window: run.positive("window")?, rate: run.positive("rate")? };
        let t_max = run.require("t_max", POSITIVE)?;
        let mut experiments = experiments(root, folder)?;
        for Experiment { scene, .. } in &mut experiments {
            refine(&run, scene)?;
            limits::steps_until(&t_max, until.t_max, scene.dt(), limits::STEPS)?;
        }
        Ok(Self { header, experiments, until, rest: ToRest::read(&root.table("steady", &ToRest::KEYS)?)? })
    }
}

/// The table `[experiments]`: the scenes of the three groups.
fn experiments(root: &Section<'_>, folder: &Path) -> Result<Vec<Experiment>, InputError> {
    let section = root.table("experiments", &["first", "second", "rests", "third"])?;
    // At least two scenes in ascending order of β, because what is claimed of them is an order.
    let ascending = |key: &str| {
        let fits =
            |scenes: &[Scene]| scenes.len() >= 2 && scenes.windows(2).all(|pair| pair[0].beam.beta < pair[1].beam.beta);
        let allowed = "a list of at least two scene files, beta ascending";
        section.list(key, allowed, |item| listed_scene(item, folder), fits)
    };
    let (first, second) = (ascending("first")?, ascending("second")?);
    // What each beam of the second group is said to rest on.
    let choices = [("upper", Contact::Upper), ("lower", Contact::Lower), ("free", Contact::Free)];
    let allowed = "a list of \"upper\", \"lower\" or \"free\", one for each scene of second";
    let rests = section.list("rests", allowed, |item| item.choice(&choices), |list| list.len() == second.len())?;
    let third = listed_scene(&section.require("third", "a scene file")?, folder)?;
    let one = |(group, scene): (SectionGroup, Scene)| Experiment { group, scene };
    let first = first.into_iter().map(|scene| (SectionGroup::First, scene));
    let second = rests.into_iter().map(SectionGroup::Second).zip(second);
    Ok(first.chain(second).chain([(SectionGroup::Third, third)]).map(one).collect())
}

/// Another mesh and time step, where `[run]` has them.
fn refine(run: &Section<'_>, scene: &mut Scene) -> Result<(), InputError> {
    let (elements, dt) = (run.get("elements"), run.get("dt"));
    if elements.is_none() && dt.is_none() {
        return Ok(());
    }
    let elements = elements.as_ref().map_or(Ok(scene.mesh.elements()), tables::elements)?;
    let dt = dt.map_or(Ok(scene.dt()), |field| field.positive())?;
    let mesh = Mesh::uniform(elements).map_err(|error| run.refuse("elements", error.to_string(), "a mesh"))?;
    *scene = scene.at(mesh, dt);
    Ok(())
}

impl Kind for Experiments {
    type Data = ExperimentTask;
    type Found = Found;

    fn header(&self) -> &Header {
        &self.header
    }

    /// The seven experiments, then a moving beam until it rests for each β.
    fn cases(&self) -> Vec<Case<ExperimentTask>> {
        let run = |(k, Experiment { scene, .. }): (usize, &Experiment)| Case {
            label: scene.name.clone(),
            // Steady states come at t = 50 to 100.
            cost: 80.0 / scene.dt() * scene.mesh.elements() as f64,
            data: ExperimentTask::Run(k),
        };
        let rest = |(k, beta): (usize, &f64)| Case {
            label: format!("to rest, beta = {beta}"),
            cost: self.rest.cost(),
            data: ExperimentTask::Rest(k),
        };
        let runs = self.experiments.iter().enumerate().map(run);
        runs.chain(self.rest.betas.iter().enumerate().map(rest)).collect()
    }

    fn run(&self, task: &ExperimentTask) -> Result<Found, CaseFailure> {
        match *task {
            ExperimentTask::Run(k) => Ok(Found::Run(Box::new(run::run(&self.experiments[k].scene, &self.until)?))),
            ExperimentTask::Rest(k) => {
                // The third experiment is the last.
                let third = self.experiments.last().ok_or(CaseFailure { reason: "no experiment".to_owned() })?;
                Ok(Found::Rest(self.rest.run(&third.scene, k)?))
            }
        }
    }

    fn judge(&self, ran: &[Ran<ExperimentTask, Found>]) -> Outcome {
        report::outcome(self, ran)
    }
}
