//! The compared methods, and a single run of each.
//!
//! The errors of dG fall faster than any power of h and dt, so no law is fitted: the cost of an error is that of the cheapest
//! run that reaches it. The unit is the node-solve of `midpoint`, with two 3 x 3 blocks per row. A solve of dG(q) has 3 (q + 1)
//! unknowns per block, each of which costs (q + 1)² as much; a factorisation counts as 3 (q + 1) solves.

use thermobeam::dg;

use crate::error::Evaluator;
use crate::error::reference::combine;
use crate::kinds::prelude::*;
use crate::run::family::{Family, OnMesh, Spent};

/// A method of solution.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NamedMethod {
    /// Name in study files, tables and figures.
    pub name: &'static str,
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
    /// Two runs, with dt and dt/2, combined to `2 u_{dt/2} - u_dt`.
    pub extrapolated: bool,
}

const fn row(
    name: &'static str,
    scheme: Scheme,
    solver: Solver,
    extrapolated: bool,
) -> NamedMethod {
    NamedMethod {
        name,
        one_step: Some(OneStep {
            scheme,
            solver,
            extrapolated,
        }),
    }
}

/// All methods; a new one-step method is a row.
pub const METHODS: [NamedMethod; 5] = [
    row(
        "fixed-point",
        EULER_CRANK_NICOLSON,
        Solver::FixedPoint,
        false,
    ),
    row(
        "euler-crank-nicolson",
        EULER_CRANK_NICOLSON,
        Solver::Newton,
        false,
    ),
    row("richardson", EULER_CRANK_NICOLSON, Solver::Newton, true),
    row("midpoint", MIDPOINT, Solver::Newton, false),
    NamedMethod {
        name: "dg",
        one_step: None,
    },
];

/// A run: largest errors over the times of observation, and its cost.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measurement {
    /// Errors in the order of [`crate::error::ErrorMeasure::ALL`].
    pub errors: [f64; 3],
    /// The cost, excluding the measurement.
    pub spent: Spent,
}

/// The larger of each two errors; NaN if either is NaN.
pub(super) fn worst(errors: [f64; 3], found: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|k| max_or_nan(errors[k], found[k]))
}

/// Does this number of steps.
fn advance(motion: &mut impl Motion, steps: usize) -> Result<(), CaseFailure> {
    (0..steps).try_for_each(|_| motion.step(f64::INFINITY).map(drop))?;
    Ok(())
}

impl OneStep {
    /// Steps of unit size per step of the coarse run: 3 if a second run halves the step.
    pub(super) fn runs(&self) -> f64 {
        if self.extrapolated { 3.0 } else { 1.0 }
    }

    /// Runs `steps` steps and measures at `observations` equidistant times; `steps` must be a multiple of their number.
    ///
    /// # Errors
    /// [`CaseFailure`] with the solver's message.
    pub(super) fn run(
        &self,
        on: &OnMesh<'_>,
        evaluator: &mut Evaluator<'_>,
        [steps, observations]: [usize; 2],
        tolerance: f64,
    ) -> Result<Measurement, CaseFailure> {
        let settings = Settings {
            solver: self.solver,
            stopping: Stopping::Converged {
                tolerance,
                max_iterations: 1000,
            },
            ..Settings::default()
        };
        let mut run = on.start(self.scheme, settings, steps)?;
        let mut half = if self.extrapolated {
            Some(on.start(self.scheme, settings, 2 * steps)?)
        } else {
            None
        };
        let mut errors = [0.0_f64; 3];
        for index in 0..observations {
            advance(&mut run, steps / observations)?;
            let (mut level, t) = (run.on(on.mesh()), run.t());
            if let Some(half) = &mut half {
                advance(half, 2 * steps / observations)?;
                level = combine(&half.on(on.mesh()), &level, 2.0);
            }
            errors = worst(errors, evaluator.measure(&level, index, t));
        }
        let mut spent = Spent::of(&run, on.mesh().elements());
        if let Some(half) = &half {
            spent += Spent::of(half, on.mesh().elements());
        }
        Ok(Measurement { errors, spent })
    }
}

/// Elements that grow towards x = 0: the last one holds the layer of an impact.
pub(super) const GRADED: [f64; 3] = [0.0, 0.9, 1.0];

/// The default reference.
pub(super) const REFERENCE: Degrees = Degrees {
    p: 26,
    q: 5,
    dt: 0.0021,
};

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

impl Degrees {
    /// Runs a problem on the elements between these nodes. `observe` receives the level at each of the `times` equidistant times,
    /// numbered from 0; most of them lie inside steps.
    ///
    /// # Errors
    /// [`CaseFailure`] with the solver's message.
    pub(crate) fn run(
        self,
        family: &Family,
        nodes: &[f64],
        times: usize,
        observe: &mut dyn FnMut(&dg::Space, &dg::Level, usize),
    ) -> Result<Spent, CaseFailure> {
        let Self { p, q, dt } = self;
        let stepping = dg::Stepping {
            degree: q,
            dt,
            restart_dt: RESTART * dt,
            growth: 1.0 + 0.5 * dt / COARSE,
            ..dg::Stepping::default()
        };
        let mut motion = family.dg(Mesh::from_nodes(nodes.to_vec())?, p, stepping)?;
        let time = |k: usize| {
            if k == times {
                family.t_end
            } else {
                family.t_end * k as f64 / times as f64
            }
        };
        let (mut level, mut shown) = (motion.simulation().level().clone(), 0);
        while motion.step(family.t_end)?.is_some() {
            let simulation = motion.simulation();
            while shown < times && simulation.level_into(time(shown + 1), &mut level) {
                observe(simulation.space(), &level, shown);
                shown += 1;
            }
        }
        let (simulation, seconds) = (motion.simulation(), motion.wall().as_secs_f64());
        let (stages, work) = ((q + 1) as f64, simulation.work());
        let solves = work.solves as f64 + 3.0 * stages * work.factorizations as f64;
        let weight = simulation.space().blocks() as f64 * stages * stages;
        Ok(Spent {
            node_steps: weight * work.steps as f64,
            node_solves: weight * solves,
            seconds,
        })
    }
}
