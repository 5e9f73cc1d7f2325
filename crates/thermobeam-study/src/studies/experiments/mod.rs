//! The paper's seven experiments by dG, each by two discretisations that share neither mesh nor
//! degrees nor steps: their difference is the error.
//!
//! # Section 5, sentence by sentence
//!
//! * dG by the first discretisation, until steady: statements about rest, and figures.
//! * dG by the second, until steady: the error of the first.
//! * In the full tier also the paper's algorithm (4.1)-(4.5) with η*, at the paper's h and dt, and
//!   Newton's method side by side, until t_end: statements about the motion, in place of dG;
//!   iterations per step; distance to Newton's solution.
//! * dG for each of several β, until rest: the number of steady states.
//!
//! The paper leaves open in which "appropriate norm" the increments fall below η*. Here it is that
//! of (3.14), for the reasons in THEORY.md, "The norm of the stopping test".
//!
//! # What is measured, and how
//!
//! * Steady: the energy has fallen by at most `rate` per unit of time over the last window.
//! * Frequency of u(1): upward crossings of zero on [0, t_end], each interpolated: (their number -
//!   1) / (last - first).
//! * Amplitude of φ(1): largest minus smallest value on [0, t_end].
//! * First contact: when the tip first passes the obstacle: a contact event of dG, or interpolated
//!   between time levels.
//! * Rests on: the contact force at the end, and the tip's position.
//! * Error of a figure: largest difference of the two discretisations, over the width of the line.
//!
//! t_end = 10 is the span of the paper's figures.
//!
//! # Where the paper's text goes too far
//!
//! It takes the experiment at β = -0.8 as evidence of several steady states for β < -1/2. That
//! threshold is not sharp: without heating the straight beam is the only steady state down to
//! -0.7116 (THEORY.md, "Steady states and buckling"). The study shows this twice: by the list of
//! all exact steady states, and by where moving beams come to rest.

pub mod digits;
mod figures;
mod plotted;
mod rests;
mod statements;
mod trace;

use super::paper::{ELEMENTS, Experiment, RESOLUTION, STEPS, T_END, THIRD, experiments};
use super::prelude::*;
use super::steady::{MethodToRest, ToRest, compared};
use crate::kinds::{runs::side_by_side::SideBySide, tables::Discretisation};
use crate::run::{AnyMotion, run, simulate};
use crate::scene::Scene;

use trace::Recorder;

pub use super::steady::{AtRest, Nearest};
pub use crate::kinds::runs::side_by_side::SolverComparison;
pub use trace::Trace;

/// What the study says about itself.
pub const ABOUT: About = About {
    id: "section-5",
    claim: "Section 5: what the paper says of its seven experiments, judged by dG with a known error",
    tier: Tier::Quick,
    group: "contact",
    home: file!(),
};

/// The same by the paper's own algorithm.
pub const FULL: About = About {
    id: "section-5-full",
    claim: "Section 5: what the paper says of its seven experiments, judged by the paper's own algorithm at its resolution",
    tier: Tier::Full,
    ..ABOUT
};

/// Time after which no state counts as steady.
const T_MAX: f64 = 300.0;
/// Span over which the energy's fall is measured: longer than the slowest oscillation, because the
/// beam stands still at turning points.
const WINDOW: f64 = 10.0;
/// When a beam at another β rests: its largest velocity, and the time by which it must.
const SPEED: f64 = 1e-10;
const RESTS_BY: f64 = 2000.0;
/// The β of beams that move until they rest.
const BETAS: [f64; 11] = [
    -1.0, -0.9, -0.8, -0.75, -0.72, -0.7, -0.65, -0.6, -0.55, -0.45, 0.0,
];

/// The seven experiments until they are steady.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SectionFive {
    /// The first is drawn and run to rest, the second shows the error of the first.
    discretisations: [Discretisation; 2],
    /// Fall of the energy per unit of time below which the state is steady.
    rate: f64,
    /// The paper's algorithm, if that is run.
    pub fixed_point: Option<FixedPoint>,
}

/// The paper's algorithm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FixedPoint {
    /// η*; increments in the norm of (3.14).
    pub tolerance: f64,
    /// Mesh and steps: these tables of a scene.
    pub resolution: &'static str,
}

/// The study.
pub fn study() -> Described<SectionFive> {
    ABOUT.study(SectionFive {
        discretisations: [
            Discretisation::new([1, 12, 3], [0.2, 1e-3, 1.5]),
            Discretisation::new([2, 7, 2], [0.12, 5e-4, 1.4]),
        ],
        rate: 1e-8,
        fixed_point: None,
    })
}

/// The study by the paper's algorithm, with its η* and its resolution.
pub fn full() -> Described<SectionFive> {
    FULL.study(SectionFive {
        discretisations: [
            Discretisation::new([1, 16, 3], [0.1, 1e-3, 1.5]),
            Discretisation::new([2, 10, 2], [0.12, 5e-4, 1.4]),
        ],
        rate: 1e-10,
        fixed_point: Some(FixedPoint {
            tolerance: 1e-7,
            resolution: RESOLUTION,
        }),
    })
}

/// What a case runs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Task {
    /// An experiment by a discretisation of dG, until it is steady.
    AnyOrder(Experiment, usize),
    /// An experiment by the paper's algorithm, with Newton's method beside it.
    FixedPoint(Experiment),
    /// A moving beam with this β until it rests.
    Rest(f64),
}

/// What a case finds.
#[derive(Debug, Clone, PartialEq)]
pub enum Found {
    /// Of an experiment by dG.
    Run(Box<SteadyRun>),
    /// Of an experiment by the paper's algorithm.
    FixedPoint(Box<PaperRun>),
    /// Of a run to rest.
    Rest(AtRest),
}

impl Found {
    fn run(&self) -> &SteadyRun {
        match self {
            Self::Run(run) => run,
            other => unreachable!("an experiment by dG shows {other:?}"),
        }
    }

    fn paper_run(&self) -> &PaperRun {
        match self {
            Self::FixedPoint(run) => run,
            other => unreachable!("the paper's algorithm shows {other:?}"),
        }
    }

    fn rest(&self) -> &AtRest {
        match self {
            Self::Rest(rest) => rest,
            other => unreachable!("a run to rest shows {other:?}"),
        }
    }
}

/// An experiment by dG, until it is steady.
#[derive(Debug, Clone, PartialEq)]
pub struct SteadyRun {
    /// The motion.
    pub trace: Trace,
    /// The beam as soon as it is steady.
    pub end: AtRest,
    /// The energy then.
    pub energy: f64,
    /// The contact force then: positive at the upper obstacle.
    pub contact_force: f64,
    /// Largest absolute value of u, φ and the lifted temperature then.
    pub largest_field: f64,
}

/// An experiment by the paper's algorithm.
#[derive(Debug, Clone, PartialEq)]
pub struct PaperRun {
    /// The motion.
    pub trace: Trace,
    /// Distance to Newton's solution, and iterations.
    pub solvers: SolverComparison,
}

impl Kind for SectionFive {
    type Data = Task;
    type Found = Found;

    /// The experiments by both discretisations and by the paper's algorithm; then for each β a
    /// moving beam until it rests.
    fn cases(&self) -> Vec<Case<Task>> {
        let mut runs = vec![];
        for discretisation in [0, 1] {
            runs.extend(experiments().map(|one| self.any_order(one, discretisation)));
        }
        if self.fixed_point.is_some() {
            // Two to three iterations and a step of Newton's method cost as much as four of its
            // steps.
            let cost = 4.0 * (STEPS * ELEMENTS) as f64;
            runs.extend(experiments().map(|one| {
                let label = format!("{}, fixed point and Newton", one.name);
                let parts = one.parts().on(true);
                let parts = parts.by_the_paper(Solver::FixedPoint);
                Case::new(label, cost, Task::FixedPoint(one)).described(&parts)
            }));
        }
        runs.extend(BETAS.map(|beta| {
            let label = format!("to rest, beta = {beta}");
            let scene = Experiment { beta, ..THIRD };
            let parts = scene.parts().on(true).by_dg().against(Known::SteadyStates);
            Case::new(label, self.to_rest().cost(), Task::Rest(beta)).described(&parts)
        }));
        runs
    }

    fn run(&self, task: &Task) -> Result<Found, CaseFailure> {
        Ok(match *task {
            Task::AnyOrder(experiment, discretisation) => {
                let scene = experiment.scene()?;
                let scene = self.discretisations[discretisation].of(&scene, T_MAX)?;
                Found::Run(Box::new(self.until_steady(&scene)?))
            }
            Task::FixedPoint(experiment) => {
                let by = self.fixed_point;
                let by = by.ok_or_else(|| CaseFailure::new("no run by the paper's algorithm"))?;
                Found::FixedPoint(Box::new(by.run(&experiment.by(by.resolution)?)?))
            }
            Task::Rest(beta) => Found::Rest(self.to_rest().run(&THIRD.scene()?, beta)?),
        })
    }

    fn judge(&self, ran: &[Ran<Task, Found>]) -> Outcome {
        Outcome::of_complete(self, ran, |shown| {
            let runs: Vec<OfExperiment<'_>> = experiments()
                .map(|experiment| OfExperiment::of(self, shown, experiment))
                .collect();
            let rests = BETAS.map(|beta| (beta, of(shown, &Task::Rest(beta)).rest()));
            statements::judge(self, &runs, &rests)
        })
    }
}

impl SectionFive {
    fn to_rest(self) -> ToRest {
        ToRest {
            method: MethodToRest::AnyOrder(self.discretisations[0]),
            speed: SPEED,
            t_max: RESTS_BY,
        }
    }

    fn any_order(&self, experiment: Experiment, discretisation: usize) -> Case<Task> {
        // Steady states are reached at t = 50 to 100.
        const STEADY: f64 = 80.0;
        let how = &self.discretisations[discretisation];
        let label = match discretisation {
            0 => experiment.name.to_owned(),
            _ => format!("{}, {}", experiment.name, how.label()),
        };
        let task = Task::AnyOrder(experiment, discretisation);
        let parts = experiment
            .parts()
            .on(true)
            .by_dg()
            .against(Known::SteadyStates);
        Case::new(label, how.cost(STEADY), task).described(&parts)
    }

    /// Runs a scene until its energy is steady.
    ///
    /// # Errors
    /// A step that fails, steady states that cannot be found, or a beam that still moves at the
    /// end.
    fn until_steady(&self, scene: &Scene) -> Result<SteadyRun, CaseFailure> {
        let mut motion = simulate::motion(scene)?;
        let mut recorder = Recorder::new(&mut *motion, scene, T_END);
        let mut end = 0.0;
        while motion.motion().t() < T_MAX {
            end += WINDOW;
            run(&mut *motion, end, &[], &mut [&mut recorder])?;
            if -recorder.change() <= self.rate * WINDOW {
                return SteadyRun::of(scene, recorder, &mut *motion);
            }
        }
        Err(CaseFailure::new(format!("not steady by t = {T_MAX}")))
    }
}

impl FixedPoint {
    /// Runs a scene, with Newton's method beside it.
    ///
    /// # Errors
    /// A step that fails.
    fn run(&self, scene: &Scene) -> Result<PaperRun, CaseFailure> {
        let mut both = SideBySide::new(scene, self.tolerance)?;
        let mut recorder = Recorder::new(&mut both.fixed_point, scene, T_END);
        for _ in 0..scene.steps() {
            both.step()?;
            recorder.add(&mut both.fixed_point)?;
        }
        Ok(PaperRun {
            trace: recorder.finish(&both.fixed_point),
            solvers: both.comparison,
        })
    }
}

impl SteadyRun {
    /// The beam at its end.
    fn of(scene: &Scene, recorder: Recorder, motion: &mut AnyMotion) -> Result<Self, CaseFailure> {
        let nodes = compared(scene)?;
        let t = motion.motion().t();
        let (level, last) = (motion.on(&nodes), motion.sample());
        let values = [&level.u, &level.phi, &level.theta].into_iter().flatten();
        Ok(Self {
            trace: recorder.finish(motion),
            largest_field: values.fold(0.0, |most, value| max_or_nan(most, value.abs())),
            end: AtRest::of(scene, &nodes, t, &level, |_| true)?,
            energy: last.energy,
            contact_force: last.contact_force,
        })
    }
}

/// An experiment and its runs.
#[derive(Debug, Clone, Copy)]
struct OfExperiment<'r> {
    experiment: Experiment,
    /// By the first discretisation.
    first: &'r SteadyRun,
    /// By the second, which shows the error of the first.
    second: &'r SteadyRun,
    /// By the paper's algorithm, if the study runs that.
    paper: Option<&'r PaperRun>,
}

impl<'r> OfExperiment<'r> {
    fn of(study: &SectionFive, shown: &[(&Task, &'r Found)], experiment: Experiment) -> Self {
        let by_dg = |k: usize| of(shown, &Task::AnyOrder(experiment, k)).run();
        let by_the_paper = || of(shown, &Task::FixedPoint(experiment)).paper_run();
        Self {
            experiment,
            first: by_dg(0),
            second: by_dg(1),
            paper: study.fixed_point.map(|_| by_the_paper()),
        }
    }

    /// The motion by which statements are judged: that of the paper's algorithm, if the study runs
    /// that.
    fn trace(&self) -> &'r Trace {
        self.paper.map_or(&self.first.trace, |paper| &paper.trace)
    }
}
