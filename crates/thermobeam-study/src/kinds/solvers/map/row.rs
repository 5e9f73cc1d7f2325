//! One row of a map: all its time steps, Newton's method in lanes.

use std::ops::ControlFlow;

use convergence_study::study::CaseFailure;
use thermobeam::ensemble::Ensemble;
use thermobeam::scheme::EULER_CRANK_NICOLSON;
use thermobeam::simulation::Problem;
use thermobeam::solve::{Level, Settings};

use super::super::step::{FixedPointStep, factors};
use super::{Map, axial_force};
use crate::kinds::watch::{SOLVED, Watch, Worst};
use crate::run::ensemble::EnsembleDriver;

/// Iterations after which the fixed point is given up on the map.
pub(super) const ITERATIONS: usize = 150;
/// Increment at which it has converged: large against round-off, so that the last ratio is a contraction.
pub(super) const TOLERANCE: f64 = 1e-10;

/// What was found at one value of the second parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// One for each time step, ascending.
    pub points: Vec<Point>,
}

/// Both solvers with one time step.
#[derive(Debug, Clone, PartialEq)]
pub struct Point {
    /// The time step.
    pub dt: f64,
    /// Predicted factor of the contact; infinite where its operator is not definite.
    pub alpha: f64,
    /// Predicted factor of the coupling; infinite where its operator is not definite.
    pub gamma: f64,
    /// The first step by the fixed point.
    pub fixed_point: FixedPointStep,
    /// Whether Newton's method did all steps.
    pub newton_completes: bool,
    /// The steps that it did; `None` where the first one failed.
    pub newton: Option<NewtonSteps>,
}

/// Steps by Newton's method.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NewtonSteps {
    /// Iterations of the step that took most.
    pub iterations: usize,
    /// The contact force after the first step.
    pub contact_force: f64,
    /// Rise of the energy and residual of its balance.
    pub worst: Worst,
}

impl Row {
    pub(in super::super) fn not_finite(&self) -> Vec<&'static str> {
        self.points.iter().flat_map(Point::not_finite).collect()
    }

    /// The points at which Newton's method did at least one step.
    pub(super) fn newton(&self) -> impl Iterator<Item = &NewtonSteps> {
        self.points.iter().filter_map(|point| point.newton.as_ref())
    }
}

impl Point {
    fn not_finite(&self) -> Vec<&'static str> {
        let mut names = vec![];
        let mut require = |holds: bool, name| {
            if !holds {
                names.push(name);
            }
        };
        require(!self.alpha.is_nan(), "alpha");
        require(!self.gamma.is_nan(), "gamma");
        let contraction = self.fixed_point.contraction.filter(|_| self.fixed_point.converged);
        require(contraction.is_none_or(f64::is_finite), "the contraction");
        if let Some(NewtonSteps { contact_force, worst, .. }) = self.newton {
            let finite = worst.named().iter().all(|(_, value)| value.is_finite()) && contact_force.is_finite();
            require(finite, "force or energy");
        }
        names
    }
}

impl Map {
    pub(in super::super) fn row(&self, value: f64) -> Result<Row, CaseFailure> {
        let (problem, dts) = (self.problem(value)?, self.time_steps());
        let n_value = axial_force(&problem);
        let newton = newton(&problem, &dts, self.steps)?;
        let point = |(dt, (newton_completes, newton)): (f64, (bool, Option<NewtonSteps>))| {
            let fixed_point = FixedPointStep::run(&problem, dt, TOLERANCE, ITERATIONS)?;
            let [alpha, gamma] = factors(&problem, dt, n_value);
            Ok(Point { dt, alpha, gamma, fixed_point, newton_completes, newton })
        };
        Ok(Row { points: dts.iter().copied().zip(newton).map(point).collect::<Result<_, CaseFailure>>()? })
    }
}

/// A time step while Newton's method is under way.
struct Lane {
    old: Level,
    new: Level,
    watch: Watch,
    iterations: usize,
    /// After the first step, if it was done.
    contact_force: Option<f64>,
}

impl Lane {
    fn new(ensemble: &Ensemble, k: usize, nodes: usize) -> Self {
        let mut old = Level::new(nodes);
        ensemble.observe(k, &mut old);
        let watch = Watch::new(ensemble.energy_scale(k, &old));
        Self { new: old.clone(), old, watch, iterations: 0, contact_force: None }
    }

    fn steps(&self) -> Option<NewtonSteps> {
        let (iterations, worst) = (self.iterations, self.watch.worst);
        self.contact_force.map(|contact_force| NewtonSteps { iterations, contact_force, worst })
    }
}

/// Newton's method, several time steps side by side: whether all steps were done, and what was seen in them.
fn newton(problem: &Problem, dts: &[f64], steps: usize) -> Result<Vec<(bool, Option<NewtonSteps>)>, CaseFailure> {
    let settings = Settings { tolerance: SOLVED, ..Settings::default() };
    let problems = vec![problem.clone(); dts.len()];
    let mut driver = EnsembleDriver::new(problems, dts, EULER_CRANK_NICOLSON, settings)?;
    let nodes = problem.mesh.nodes().len();
    let mut lanes: Vec<Lane> = (0..dts.len()).map(|k| Lane::new(driver.ensemble(), k, nodes)).collect();
    driver.run(steps, |ensemble, balances| {
        for (k, (lane, balance)) in lanes.iter_mut().zip(balances).enumerate() {
            let Ok(report) = ensemble.report(k) else { continue };
            lane.iterations = lane.iterations.max(report.iterations);
            ensemble.observe(k, &mut lane.new);
            lane.contact_force.get_or_insert(lane.new.contact_force);
            let scale = ensemble.energy_scale(k, &lane.new);
            lane.watch.step(balance, scale, || ensemble.rounding(k, &lane.old, &lane.new));
            std::mem::swap(&mut lane.old, &mut lane.new);
        }
        ControlFlow::Continue(())
    })?;
    let ensemble = driver.ensemble();
    Ok(lanes.iter().enumerate().map(|(k, lane)| (ensemble.report(k).is_ok(), lane.steps())).collect())
}
