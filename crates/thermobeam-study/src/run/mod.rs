//! A beam in motion, by any method: what a step does, what can be read from it, and why it ends
//! early.

pub(crate) mod dg;
pub mod driver;
pub mod energy;
pub mod family;
pub mod history;
pub(crate) mod levels;
pub mod object;
pub mod ringing;
pub mod simulate;
pub mod tally;
pub mod together;

use std::ops::ControlFlow;
use std::time::Duration;

use convergence_judge::time_limit::TimeUp;
use serde::Serialize;
use thermobeam::dg::Dg;
use thermobeam::energy::Balance;
use thermobeam::error::{SetupError, StepError};
use thermobeam::mesh::{Mesh, MeshError};
use thermobeam::motion::{Motion, StepReport};
use thermobeam::solve::TimeLevel;
use thiserror::Error;

/// Observed quantities at one time; the JSON object of a run has them, except the contact force.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Sample {
    /// Time.
    pub t: f64,
    /// u(1).
    pub u_tip: f64,
    /// φ(1).
    pub phi_tip: f64,
    /// u_t(1); for a one-step scheme û(1).
    pub u_t_tip: f64,
    /// φ_t(1); for a one-step scheme φ̂(1).
    pub phi_t_tip: f64,
    /// The physical temperature at x = 1/2.
    pub theta_mid: f64,
    /// The contact force, positive on the upper obstacle: g(u(1)); for a one-step scheme that of
    /// the last step.
    #[serde(skip)]
    pub contact_force: f64,
    /// The energy (3.9), with the term of θ_A.
    pub energy: f64,
}

/// What may explain an error of the energy at one level.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EnergySize {
    /// Sum of the absolute values of the energy's terms, without the constant β²/(4ρ).
    pub terms: f64,
    /// Bound on the rounding errors of a balance at this level.
    pub rounding: f64,
    /// Whether steps are solved to a tolerance: only then each obeys its balance.
    pub is_solved: bool,
}

impl Sample {
    /// The state of the free end, the temperature in the middle, and the energy, in the order of
    /// the fields.
    pub(crate) fn numbers(&self) -> [f64; 6] {
        let Self {
            u_tip,
            phi_tip,
            u_t_tip,
            phi_t_tip,
            theta_mid,
            energy,
            ..
        } = *self;
        [u_tip, phi_tip, u_t_tip, phi_t_tip, theta_mid, energy]
    }
}

/// Why a problem did not reach its end.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum RunError {
    /// The solver refuses the problem.
    #[error(transparent)]
    Setup(#[from] SetupError),
    /// A step failed.
    #[error(transparent)]
    Step(#[from] StepError),
    /// A step raised the energy, broke its balance, or led to a state that is not finite.
    #[error("step {step} (from t = {t}, length {dt:e}): {unsound}")]
    Unsound {
        /// Number of the step, counted from 1.
        step: usize,
        /// The time at which it started.
        t: f64,
        /// Its length.
        dt: f64,
        /// What is wrong with it.
        unsound: Unsound,
    },
    /// The time limit of the case was reached.
    #[error(transparent)]
    TimeUp(#[from] TimeUp),
    /// Something was asked for that a beam with loads does not have.
    #[error(transparent)]
    Loaded(#[from] Loaded),
}

/// A beam with loads does not have what was asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error(
    "{what}: found a beam with loads, whose work may raise its energy and keep it moving: expected a beam without loads"
)]
pub struct Loaded {
    /// What was asked for, in words.
    pub what: &'static str,
}

impl RunError {
    /// For the last step of a motion.
    fn unsound(motion: &dyn Motion, dt: f64, unsound: Unsound) -> Self {
        Self::Unsound {
            step: motion.steps(),
            t: motion.t() - dt,
            dt,
            unsound,
        }
    }
}

impl From<MeshError> for RunError {
    fn from(error: MeshError) -> Self {
        Self::Setup(error.into())
    }
}

/// Why the results of a run are invalid, although every step of it was done.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum Unsound {
    /// The energy is infinite or NaN.
    #[error("the energy is {0}: {EXPECTED}")]
    NotFinite(f64),
    /// The energy rose by this amount.
    #[error(
        "the energy rose by {0:.3e} in a step or since t = 0, where no exactly solved step raises it: {EXPECTED}"
    )]
    Rise(f64),
    /// The balance of the energy is violated by this amount.
    #[error(
        "the balance of the energy is violated by {0:.3e} in a step, where every exactly solved step keeps it: {EXPECTED}"
    )]
    Imbalance(f64),
    /// Rounding errors hide whether a step obeys the law of the energy.
    #[error(
        "the contact cannot be resolved: rounding of the contact energy, up to {rounding:.3e} in a step, exceeds {most:.3e}, \
         the most that a step may raise the energy: expected a larger epsilon, or longer elements; nothing can be judged"
    )]
    Unresolved {
        /// Bound on the rounding errors of a balance at this level.
        rounding: f64,
        /// Share of the energy's size.
        most: f64,
    },
}

const EXPECTED: &str = "expected coefficients of less extreme size, a smaller tolerance, or smaller steps; the numbers of this run mean nothing";

/// What a beam with loads does not have, in the words of [`Loaded`].
const BALANCE: &str = "a balance of the energy";

/// A [`Motion`] that is stepped within the limits of its case, and whose values are observed.
/// Observed values are computed only on request.
pub trait ObservableMotion {
    /// The motion: its time, counts of its steps and solves, the range of its free end.
    fn motion(&self) -> &dyn Motion;

    /// Does one step, at most to `until`; `None` if it stands there. For a one-step scheme `until`
    /// is the end of a step. Only [`run`] calls it.
    ///
    /// # Errors
    /// [`RunError`]; the state is then unchanged.
    fn step(&mut self, until: f64) -> Result<Option<StepReport>, RunError>;

    /// What is wrong with the state after the last step, if the method checks it: [`run`] ends at
    /// it.
    fn unsound(&self) -> Option<Unsound> {
        None
    }

    /// The current state.
    fn sample(&mut self) -> Sample;

    /// The state at a time in the last step; for a one-step scheme at its end.
    fn inside(&mut self, t: f64) -> Sample;

    /// The energy's balance over the last step, of a beam without loads.
    ///
    /// # Errors
    /// [`Loaded`].
    fn balance(&self) -> Result<Balance, Loaded>;

    /// Refuses a beam with loads: its energy may rise, its balance has the work of the loads, and
    /// it need not come to rest at one of its steady states.
    ///
    /// * `what`: what such a beam does not have, in words.
    ///
    /// # Errors
    /// [`Loaded`].
    fn refuse_loads(&self, what: &'static str) -> Result<(), Loaded> {
        if self.motion().is_loaded() {
            Err(Loaded { what })
        } else {
            Ok(())
        }
    }

    /// Time spent in steps so far.
    fn wall(&self) -> Duration;

    /// The motion by dG, if it is one.
    fn dg(&self) -> Option<&Dg> {
        None
    }

    /// The size of the current level's energy, with which errors of the balance are compared.
    fn energy_size(&self) -> EnergySize;

    /// Those ends of `count` equal parts of the time to `t_end` that lie in the last step; the
    /// first is `t_end / count`. A one-step scheme shows levels at equal numbers of steps, at most
    /// `count` of them.
    fn parts(&self, t_end: f64, count: usize) -> Vec<f64>;

    /// Times of a history.
    fn rows(&self) -> usize;

    /// Points x of a picture.
    fn points(&self) -> Vec<f64>;

    /// Displacement at those points, at a time in the last step; for a one-step scheme at its end.
    fn shape(&self, t: f64) -> Vec<f64>;

    /// The values of the current level at the nodes of a mesh, without the contact force.
    fn on(&self, mesh: &Mesh) -> TimeLevel;
}

/// A motion by whatever method.
pub type AnyMotion = dyn ObservableMotion;

/// Observes a motion after each of its steps: any motion, or those of one method.
pub trait Watch<M: ?Sized = AnyMotion> {
    /// Observes the last step, and reads what it needs.
    ///
    /// # Errors
    /// [`RunError`] ends the run at this step.
    fn see(&mut self, motion: &mut M, report: &StepReport) -> Result<ControlFlow<()>, RunError>;
}

impl<M: ?Sized, F> Watch<M> for F
where
    F: FnMut(&mut M, &StepReport) -> Result<ControlFlow<()>, RunError>,
{
    fn see(&mut self, motion: &mut M, report: &StepReport) -> Result<ControlFlow<()>, RunError> {
        self(motion, report)
    }
}

/// Steps a motion to `until` and shows every step to one observer, which cannot end it: see
/// [`run`].
///
/// # Errors
/// [`RunError`] of the failed step; the motion then stands at the last level.
pub(crate) fn run_to<M: ObservableMotion + ?Sized>(
    motion: &mut M,
    until: f64,
    mut see: impl FnMut(&mut M, &StepReport),
) -> Result<(), RunError> {
    let mut watch = |motion: &mut M, report: &StepReport| {
        see(motion, report);
        Ok(ControlFlow::Continue(()))
    };
    run(motion, until, &[], &mut [&mut watch])
}

/// Steps a motion to `until`, or until a watch ends it.
///
/// * `ends`: increasing times at which a step must end; for a one-step scheme they are ends of
///   steps.
///
/// Every watch sees the step that ends the run, also one whose state is
/// [unsound](ObservableMotion::unsound).
///
/// # Errors
/// [`RunError`] of the failed step, of a watch, or of an unsound state; the motion then stands at
/// the last level.
#[expect(clippy::disallowed_methods, reason = "it is the loop")]
pub fn run<M: ObservableMotion + ?Sized>(
    motion: &mut M,
    until: f64,
    ends: &[f64],
    watches: &mut [&mut dyn Watch<M>],
) -> Result<(), RunError> {
    let mut passed = 0;
    loop {
        while ends
            .get(passed)
            .is_some_and(|&end| end <= motion.motion().t())
        {
            passed += 1;
        }
        let Some(report) = motion.step(ends.get(passed).copied().unwrap_or(until).min(until))?
        else {
            if passed >= ends.len() {
                return Ok(());
            }
            // A one-step scheme reaches this time up to rounding.
            passed += 1;
            continue;
        };
        let mut is_ended = false;
        for watch in &mut *watches {
            is_ended |= watch.see(motion, &report)?.is_break();
        }
        if let Some(unsound) = motion.unsound() {
            return Err(RunError::unsound(motion.motion(), report.dt, unsound));
        }
        if is_ended {
            return Ok(());
        }
    }
}
