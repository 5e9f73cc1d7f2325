//! Several simulations side by side, in lanes: for sweeps, maps and random scenes.
//!
//! The stepping code is that of [`Simulation`](crate::simulation::Simulation), with W numbers in place of one. A case in a
//! lane gets the same bits as alone; a case that fails keeps its last level and does not touch the others.

use crate::energy::{self, Balance, Energy, Rounding};
use crate::error::{SetupError, StepError, StepFailure};
use crate::lanes::Lanes;
use crate::scheme::Scheme;
use crate::simulation::{Problem, Stepping, prepare};
use crate::solve::newton::{Case, Newton};
use crate::solve::{Level, Settings, StepReport, Work};

/// W simulations by Newton's method, with as many elements each, the same scheme and the same settings; coefficients,
/// obstacles, meshes, data and time steps may differ.
pub struct Ensemble<const W: usize> {
    problems: Vec<Problem>,
    lengths: Vec<Vec<f64>>,
    dt: [f64; W],
    scheme: Scheme,
    stepper: Stepper<W>,
    step: usize,
    outcomes: Vec<Result<StepReport, StepFailure>>,
    /// The step in which a case failed.
    failed: [Option<usize>; W],
}

enum Stepper<const W: usize> {
    Cold(Box<Newton<Lanes<W>, 2>>),
    Heated(Box<Newton<Lanes<W>, 3>>),
}

impl<const W: usize> Ensemble<W> {
    /// Checks every case and stands at t = 0.
    ///
    /// * `problems`: W of them, with as many elements each.
    /// * `dt`: the time step of each.
    ///
    /// # Errors
    /// [`SetupError`] as for a single simulation, of the first case that has one; [`SetupError::Length`] where the
    /// numbers of elements, or of problems, differ.
    pub fn new(problems: Vec<Problem>, dt: [f64; W], scheme: Scheme, settings: Settings) -> Result<Self, SetupError> {
        if problems.len() != W {
            return Err(SetupError::Length { field: "problems", found: problems.len(), expected: W });
        }
        let mut problems = problems;
        let (mut cases, mut initial, mut velocity) = (vec![], vec![], vec![]);
        let nodes = problems[0].mesh.nodes().len();
        for (problem, &dt) in problems.iter_mut().zip(&dt) {
            let level = prepare(problem, &Stepping { scheme, settings, dt, loaded: false })?;
            if level.u.len() != nodes {
                return Err(SetupError::Length { field: "nodes", found: level.u.len(), expected: nodes });
            }
            initial.push((0..nodes).map(|i| [level.u[i], level.phi[i], level.theta[i]]).collect::<Vec<_>>());
            velocity.push((0..nodes).map(|i| [level.v[i], level.w[i]]).collect::<Vec<_>>());
            let lengths = problem.mesh.lengths().collect();
            cases.push(Case { beam: problem.beam, obstacles: problem.obstacles, dt, lengths });
        }
        let lengths = cases.iter().map(|case| case.lengths.clone()).collect();
        let heated = cases.iter().any(|case| case.beam.a != 0.0)
            || initial.iter().flatten().any(|&[_, _, theta]: &[f64; 3]| theta != 0.0);
        let stepper = if heated {
            Stepper::Heated(Box::new(Newton::new(cases, scheme, settings, &initial, &velocity)))
        } else {
            Stepper::Cold(Box::new(Newton::new(cases, scheme, settings, &initial, &velocity)))
        };
        let outcomes = (0..W).map(|_| Err(StepFailure::NonFinite { iterations: 0, increment: f64::NAN })).collect();
        Ok(Self { problems, lengths, dt, scheme, stepper, step: 0, outcomes, failed: [None; W] })
    }

    /// Number of steps done.
    pub fn step(&self) -> usize {
        self.step
    }

    /// Does one step of every case that has not failed; allocates nothing as long as none does.
    pub fn advance(&mut self) {
        match &mut self.stepper {
            Stepper::Cold(newton) => newton.advance(&mut self.outcomes),
            Stepper::Heated(newton) => newton.advance(&mut self.outcomes),
        }
        self.step += 1;
        for (failed, outcome) in self.failed.iter_mut().zip(&self.outcomes) {
            if outcome.is_err() && failed.is_none() {
                *failed = Some(self.step);
            }
        }
    }

    /// What the last step of case k took, or why and when the case failed.
    ///
    /// # Errors
    /// [`StepError`] of the step in which the case failed.
    pub fn report(&self, k: usize) -> Result<StepReport, StepError> {
        self.outcomes[k].clone().map_err(|failure| {
            let step = self.failed[k].unwrap_or(self.step);
            StepError { step, t: step as f64 * self.dt[k], failure }
        })
    }

    /// Copies the present level of case k into `level`; its last good one if the case has failed.
    pub fn observe(&self, k: usize, level: &mut Level) {
        match &self.stepper {
            Stepper::Cold(newton) => newton.read(k, level),
            Stepper::Heated(newton) => newton.read(k, level),
        }
    }

    /// Energy of a level of case k.
    pub fn energy(&self, k: usize, level: &Level) -> Energy {
        let problem = &self.problems[k];
        Energy::of(&problem.beam, problem.obstacles.as_ref(), &self.lengths[k], level)
    }

    /// Balance of a step of case k between two consecutive levels.
    pub fn balance(&self, k: usize, old: &Level, new: &Level) -> Balance {
        let problem = &self.problems[k];
        Balance::of(&problem.beam, problem.obstacles.as_ref(), &self.scheme, self.dt[k], &self.lengths[k], old, new)
    }

    /// The size of the energy of a level of case k, without signs.
    pub fn energy_scale(&self, k: usize, level: &Level) -> f64 {
        let problem = &self.problems[k];
        energy::scale(&problem.beam, problem.obstacles.as_ref(), &self.lengths[k], level)
    }

    /// What rounding errors explain in the balance of a step of case k.
    pub fn rounding(&self, k: usize, old: &Level, new: &Level) -> Rounding {
        let problem = &self.problems[k];
        Rounding::of(&problem.beam, problem.obstacles.as_ref(), self.dt[k], &self.lengths[k], old, new)
    }

    /// Counts of the work done so far, all cases together: a pass of all lanes is one.
    pub fn work(&self) -> Work {
        match &self.stepper {
            Stepper::Cold(newton) => newton.work(),
            Stepper::Heated(newton) => newton.work(),
        }
    }
}
