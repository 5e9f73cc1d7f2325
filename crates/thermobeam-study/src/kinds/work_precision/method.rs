//! The compared methods, and a single run of each.
//!
//! The unit of counted work is the node-solve of `midpoint`, with two 3 x 3 blocks per row. A
//! factorisation of a one-step method counts as one solve; an iteration of the fixed point, with
//! both, takes about 2.7 times as long as one of Newton's method. A solve of dG(q) has 3 (q + 1)
//! unknowns per block, each of which costs (q + 1)² as much; its factorisation counts as 3 (q + 1)
//! solves.

use thermobeam::{
    dg::{self, Dg, DgLevel, DgStepping},
    mesh::{Mesh, MeshError},
    motion::Motion,
    scheme::{EULER_CRANK_NICOLSON, MIDPOINT, Scheme},
    solve::{Settings, Solver, Stopping},
};

use crate::kinds::prelude::*;
use crate::{
    error::{Errors, Evaluator, polynomials::Polynomials},
    run::{
        ObservableMotion,
        family::{Family, OnMesh, Spent},
        levels::{equidistant_time, linear, map_fields},
        run_to,
    },
    scene::parts::is_uniform,
};

/// A method of solution.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NamedMethod {
    /// Name in study files, tables and figures.
    pub name: &'static str,
    /// The name in words.
    pub in_words: &'static str,
    /// The one-step method; `None`: dG(q) on elements of degree p.
    pub one_step: Option<OneStep>,
}

/// A one-step scheme.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OneStep {
    /// The time scheme.
    pub scheme: Scheme,
    /// Solver of a step.
    pub solver: Solver,
    /// When its iteration ends.
    pub stopping: Stopping,
    /// Two runs, with dt and dt/2, combined to `2 u_{dt/2} - u_dt`.
    pub extrapolated: bool,
}

/// The solver's tolerance is far below the measured errors.
const SOLVED: Stopping = Stopping::Converged {
    tolerance: 1e-11,
    max_iterations: 1000,
};
/// The paper's η*, Section 5.
const PAPER: Stopping = Stopping::Converged {
    tolerance: 1e-7,
    max_iterations: 1000,
};

const fn row(
    name: &'static str,
    in_words: &'static str,
    (scheme, extrapolated): (Scheme, bool),
    (solver, stopping): (Solver, Stopping),
) -> NamedMethod {
    NamedMethod {
        name,
        in_words,
        one_step: Some(OneStep {
            scheme,
            solver,
            stopping,
            extrapolated,
        }),
    }
}

/// All methods; a new one-step method is a row.
pub const METHODS: [NamedMethod; 6] = [
    row(
        "fixed-point",
        "the paper's fixed point, η* = 1e-7",
        (EULER_CRANK_NICOLSON, false),
        (Solver::FixedPoint, PAPER),
    ),
    row(
        "fixed-point-once",
        "the paper's fixed point, L = 1",
        (EULER_CRANK_NICOLSON, false),
        (Solver::FixedPoint, Stopping::Iterations(1)),
    ),
    row(
        "euler-crank-nicolson",
        "the paper's scheme by Newton",
        (EULER_CRANK_NICOLSON, false),
        (Solver::Newton, SOLVED),
    ),
    row(
        "richardson",
        "Richardson",
        (EULER_CRANK_NICOLSON, true),
        (Solver::Newton, SOLVED),
    ),
    row(
        "midpoint",
        "midpoint",
        (MIDPOINT, false),
        (Solver::Newton, SOLVED),
    ),
    NamedMethod {
        name: "dg",
        in_words: "dG(q), degree p",
        one_step: None,
    },
];

/// Mesh and steps of a run.
#[derive(Debug, Clone, PartialEq)]
pub enum Resolution {
    /// A scheme on linear elements, with equal steps.
    OneStep(OneStep, UniformGrid),
    /// Elements of degree p, dG(q) in time.
    Dg {
        /// The elements.
        mesh: Mesh,
        /// Degrees and steps.
        degrees: Degrees,
    },
}

impl Resolution {
    /// Whether all elements are equally long.
    pub(super) fn is_uniform(&self) -> bool {
        match self {
            Self::OneStep(_, grid) => grid.grading == 1.0,
            Self::Dg { mesh, .. } => is_uniform(mesh.nodes()),
        }
    }
}

/// Linear elements and equal steps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UniformGrid {
    /// The nodes are `1 - (1 - i/n)^grading`: 1 for equal elements, more for small ones at the free
    /// end.
    pub grading: f64,
    /// Number of elements n.
    pub elements: usize,
    /// Number of steps; of the coarser run of two.
    pub steps: usize,
}

impl UniformGrid {
    /// The mesh.
    ///
    /// # Errors
    /// [`MeshError`] if elements are too small.
    pub fn mesh(&self) -> Result<Mesh, MeshError> {
        if self.grading == 1.0 {
            return Mesh::uniform(self.elements);
        }
        Mesh::mapped(self.elements, |s| 1.0 - (1.0 - s).powf(self.grading))
    }
}

impl std::fmt::Display for Resolution {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::OneStep(
                _,
                UniformGrid {
                    grading,
                    elements,
                    steps,
                },
            ) => {
                write!(f, "{elements} x {steps}")?;
                if *grading == 1.0 {
                    return Ok(());
                }
                write!(f, ", grading {grading}")
            }
            Self::Dg { mesh, degrees } => {
                write!(f, "{degrees}")?;
                match mesh.elements() {
                    1 => Ok(()),
                    more => write!(f, ", {more} elements"),
                }
            }
        }
    }
}

/// A run to be made.
#[derive(Debug, Clone, PartialEq)]
pub struct Trial {
    /// The method.
    pub method: NamedMethod,
    /// Its mesh and steps.
    pub resolution: Resolution,
}

/// A run: largest errors over the times of observation, and its cost.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measurement {
    /// The errors.
    pub errors: Errors,
    /// The counted work, excluding the measurement.
    pub spent: Spent,
    /// Seconds of the clock, excluding the measurement.
    pub seconds: f64,
}

impl Measurement {
    /// A run that the solver gives up, so that it reaches no error: a neighbour may be too coarse.
    pub(super) const UNFINISHED: Self = Self {
        errors: Errors {
            norm: f64::INFINITY,
            tip: f64::INFINITY,
        },
        spent: Spent {
            node_steps: f64::INFINITY,
            node_solves: f64::INFINITY,
        },
        seconds: 0.0,
    };
}

/// A reading of a clock, in seconds. Studies have [`no_clock`].
pub type Clock = fn() -> f64;

/// A clock that stands still.
pub fn no_clock() -> f64 {
    0.0
}

impl OneStep {
    /// Runs of unit size per step of the coarse run: 3 if a second run halves the step.
    pub fn runs(&self) -> f64 {
        if self.extrapolated { 3.0 } else { 1.0 }
    }

    /// Runs `steps` steps, a multiple of `observations`, and measures at that many equidistant
    /// times; without an evaluator it only takes the time.
    ///
    /// # Errors
    /// [`CaseFailure`] with the solver's message.
    pub(super) fn run(
        &self,
        on: &OnMesh<'_>,
        mut evaluator: Option<Evaluator<'_>>,
        [steps, observations]: [usize; 2],
        clock: Clock,
    ) -> Result<Measurement, CaseFailure> {
        let settings = Settings {
            solver: self.solver,
            stopping: self.stopping,
            ..Settings::default()
        };
        let mut run = on.start(self.scheme, settings, steps)?;
        let mut half = if self.extrapolated {
            Some(on.start(self.scheme, settings, 2 * steps)?)
        } else {
            None
        };
        let mut errors = Errors::default();
        let mut seconds = 0.0;
        for index in 0..observations {
            let begun = clock();
            let until = on.t_end() * (index + 1) as f64 / observations as f64;
            run_to(&mut run, until, |_, _| ())?;
            if let Some(half) = &mut half {
                run_to(half, until, |_, _| ())?;
            }
            seconds += clock() - begun;
            if let Some(evaluator) = &mut evaluator {
                let mut level = run.on(on.mesh());
                if let Some(half) = &half {
                    let half = half.on(on.mesh());
                    let twice = map_fields(&half, |y| y.iter().map(|y| 2.0 * y).collect());
                    let whole = level.clone();
                    level.set_difference(&twice, &whole);
                }
                let level = linear(&level, run.motion().t());
                errors = errors.worst(evaluator.measure(&level, index));
            }
        }
        let mut spent = Spent::of(&run, on.mesh().elements());
        if let Some(half) = &half {
            let more = Spent::of(half, on.mesh().elements());
            spent.node_steps += more.node_steps;
            spent.node_solves += more.node_solves;
        }
        Ok(Measurement {
            errors,
            spent,
            seconds,
        })
    }
}

/// Ratio of the first step to the largest.
const RESTART: f64 = 0.05;
/// Growth of steps is 1.5 for this largest step, and smaller for finer steps.
const COARSE: f64 = 0.02;

/// Degrees in space and time, and the largest step, which determines the other steps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Degrees {
    /// Degree of the elements.
    pub p: usize,
    /// Degree in time.
    pub q: usize,
    /// The largest step.
    pub dt: f64,
}

impl std::fmt::Display for Degrees {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { p, q, dt } = self;
        write!(f, "p = {p}, q = {q}, dt = {dt}")
    }
}

/// Who sees a run by dG.
pub(super) enum Audience<'r> {
    /// An evaluator, against this reference or the exact solution.
    Errors(Option<&'r Polynomials>),
    /// The levels are kept.
    Levels(&'r mut Vec<DgLevel>),
    /// Nobody: the run only takes its time.
    Nobody,
}

impl Degrees {
    /// Runs a problem on the elements of a mesh, observed at `times` equidistant times,
    /// most of them inside steps.
    ///
    /// # Errors
    /// [`CaseFailure`] with the solver's message.
    pub(super) fn run(
        self,
        family: &Family,
        mesh: &Mesh,
        times: usize,
        mut audience: Audience<'_>,
        clock: Clock,
    ) -> Result<(dg::Space, Measurement), CaseFailure> {
        let mut motion = family.dg(mesh.clone(), self.p, self.stepping())?;
        let space = motion.simulation().space().clone();
        let mut evaluator = match &audience {
            Audience::Errors(reference) => Some(Evaluator::new(family, &space, *reference)?),
            Audience::Levels(_) | Audience::Nobody => None,
        };
        let mut level = motion.simulation().level().clone();
        let mut errors = Errors::default();
        let mut index = 0;
        let mut seconds = 0.0;
        let mut begun = clock();
        run_to(&mut motion, family.t_end, |motion, _| {
            if motion.motion().t() < equidistant_time(family.t_end, index + 1, times) {
                return;
            }
            seconds += clock() - begun;
            while index < times {
                let t = equidistant_time(family.t_end, index + 1, times);
                if !motion.simulation().level_into(t, &mut level) {
                    break;
                }
                if let Some(evaluator) = &mut evaluator {
                    errors = errors.worst(evaluator.measure(&level, index));
                }
                if let Audience::Levels(levels) = &mut audience {
                    levels.push(level.clone());
                }
                index += 1;
            }
            begun = clock();
        })?;
        drop(evaluator);
        let spent = self.spent(motion.simulation());
        let measurement = Measurement {
            errors,
            spent,
            seconds,
        };
        Ok((space, measurement))
    }

    fn stepping(self) -> DgStepping {
        let Self { q, dt, .. } = self;
        DgStepping {
            degree: q,
            dt,
            restart_dt: RESTART * dt,
            growth: 1.0 + 0.5 * dt / COARSE,
            ..DgStepping::default()
        }
    }

    /// The counted work, in the unit of the head of this file.
    fn spent(self, simulation: &Dg) -> Spent {
        let stages = (self.q + 1) as f64;
        let work = simulation.work();
        let solves = work.passes as f64 + 3.0 * stages * work.factorizations as f64;
        let weight = simulation.space().blocks() as f64 * stages * stages;
        Spent {
            node_steps: weight * simulation.steps() as f64,
            node_solves: weight * solves,
        }
    }
}
