//! The paper's fixed point and Newton's method on one scene, step by step side by side.
//!
//! The fixed point stops when the increment of its last iteration, in the norm of (3.14), is at
//! most η*. Newton's method solves the same equations (3.7)-(3.8) to round-off, so the distance of
//! both is the error that η* leaves.

use crate::kinds::prelude::*;
use crate::{
    error::reference::norm,
    run::{ObservableMotion, driver::Driver, run_to, simulate},
    scene::Scene,
};
use thermobeam::{
    motion::StepReport,
    one_step::Stepping,
    solve::{Settings, Solver, Stopping, TimeLevel},
};

/// Tolerance of Newton's method.
const SOLVED: f64 = 1e-14;

/// Two runs of one scene.
pub(crate) struct SideBySide {
    /// The paper's algorithm.
    pub(crate) fixed_point: Driver<'static>,
    newton: Driver<'static>,
    lengths: Vec<f64>,
    /// The difference of both levels.
    difference: TimeLevel,
    steps: usize,
    iterations: usize,
    /// What both runs show so far.
    pub(crate) comparison: SolverComparison,
}

/// How the fixed point compares with Newton's method.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SolverComparison {
    /// Largest distance of their levels in the norm of Theorem 3.4, over all steps.
    pub distance: f64,
    /// Iterations of the fixed point per step.
    pub mean_iterations: f64,
    /// Its largest number of iterations in a step.
    pub most_iterations: usize,
}

/// A step by both.
pub(crate) struct StepOfBoth {
    pub(crate) fixed_point: StepReport,
    pub(crate) newton: StepReport,
}

/// A scene by one of the solvers.
fn driver_by(
    scene: &Scene,
    solver: Solver,
    tolerance: f64,
) -> Result<Driver<'static>, CaseFailure> {
    let settings = Settings {
        solver,
        stopping: Stopping::below(tolerance),
        ..Settings::default()
    };
    let stepping = Stepping {
        settings,
        ..scene.one_step()?
    };
    Ok(Driver::new(simulate::problem(scene), stepping)?)
}

impl SideBySide {
    /// Both at t = 0.
    ///
    /// * `tolerance`: η*.
    ///
    /// # Errors
    /// The solver refuses the scene.
    pub(crate) fn new(scene: &Scene, tolerance: f64) -> Result<Self, CaseFailure> {
        Ok(Self {
            fixed_point: driver_by(scene, Solver::FixedPoint, tolerance)?,
            newton: driver_by(scene, Solver::Newton, SOLVED)?,
            lengths: scene.mesh.lengths().collect(),
            difference: TimeLevel::new(scene.mesh.nodes().len()),
            steps: 0,
            iterations: 0,
            comparison: SolverComparison::default(),
        })
    }

    /// Does one step by each.
    ///
    /// # Errors
    /// A step that fails.
    pub(crate) fn step(&mut self) -> Result<StepOfBoth, CaseFailure> {
        let stepped = StepOfBoth {
            fixed_point: one_step(&mut self.fixed_point)?,
            newton: one_step(&mut self.newton)?,
        };
        let iterations = stepped.fixed_point.iterations;
        self.steps += 1;
        self.iterations += iterations;
        // Without allocating: a run has many thousand steps.
        let [one, other] = [self.fixed_point.level(), self.newton.level()];
        self.difference.set_difference(one, other);
        let now = norm(&self.lengths, &self.difference);
        let SolverComparison {
            distance,
            mean_iterations,
            most_iterations,
        } = &mut self.comparison;
        *distance = max_or_nan(*distance, now);
        *mean_iterations = self.iterations as f64 / self.steps as f64;
        *most_iterations = iterations.max(*most_iterations);
        Ok(stepped)
    }
}

fn one_step(driver: &mut Driver<'_>) -> Result<StepReport, CaseFailure> {
    let until = driver.motion().t() + driver.simulation().dt();
    let mut done = None;
    run_to(driver, until, |_, report| done = Some(*report))?;
    done.ok_or_else(|| CaseFailure::new("no step was done"))
}
