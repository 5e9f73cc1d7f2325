//! The runs: an experiment by dG until it is steady, by the paper's algorithm, and a beam to rest.

use std::ops::ControlFlow;

use super::{
    AtRest, Experiments, SolverComparison,
    trace::{self, Observed, Recorder, Trace},
};
use crate::kinds::prelude::*;
use crate::{
    kinds::runs::{side_by_side::SideBySide, steady::compared},
    run::{AnyMotion, Report, run, simulate},
    scene::Scene,
};

/// What a case runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Task {
    /// An experiment by dG until it is steady.
    AnyOrder {
        /// Its place.
        experiment: usize,
        /// The place of the discretisation.
        discretisation: usize,
    },
    /// The experiment at this place by the paper's algorithm, with Newton's method beside it.
    FixedPoint(usize),
    /// A moving beam until it rests, with the β at this place.
    Rest(usize),
}

/// What a case finds.
#[derive(Debug, Clone, PartialEq)]
pub enum ExperimentResult {
    /// Of an experiment by dG.
    Run(Box<MeasuredRun>),
    /// Of an experiment by the paper's algorithm.
    FixedPoint(Box<PaperRun>),
    /// Of a run to rest.
    Rest(AtRest),
}

impl ExperimentResult {
    pub(super) fn run(&self) -> &MeasuredRun {
        match self {
            Self::Run(run) => run,
            other => unreachable!("an experiment by dG shows {other:?}"),
        }
    }

    pub(super) fn paper_run(&self) -> &PaperRun {
        match self {
            Self::FixedPoint(run) => run,
            other => unreachable!("the paper's algorithm shows {other:?}"),
        }
    }

    pub(super) fn rest(&self) -> &AtRest {
        match self {
            Self::Rest(rest) => rest,
            other => unreachable!("a run to rest shows {other:?}"),
        }
    }
}

/// An experiment by dG, until it is steady.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuredRun {
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

impl Experiments {
    /// Runs an experiment by dG until its energy is steady.
    ///
    /// # Errors
    /// A step that fails, steady states that cannot be found, or a beam that still moves at
    /// `t_max`.
    pub(super) fn run_until_steady(
        &self,
        experiment: usize,
        discretisation: usize,
    ) -> Result<MeasuredRun, CaseFailure> {
        let original = &self.experiments[experiment].scene;
        let scene = self.discretisations[discretisation].of(original, self.t_max)?;
        let mut motion = simulate::motion(&scene)?;
        let observed = Observed {
            t_end: original.t_end,
            t_max: self.t_max,
            levels: trace::POINTS,
        };
        let mut recorder = Recorder::new(observed, &mut *motion);
        let mut windows = 0.0;
        while motion.work().t < self.t_max {
            windows += 1.0;
            let end = (windows * self.window).min(self.t_max);
            // Summed from differences: the round-off of the total would hide a slow fall.
            let mut fall = 0.0;
            let mut watch = |motion: &mut AnyMotion, _: &Report| {
                fall -= recorder.add(motion)?;
                Ok(ControlFlow::Continue(()))
            };
            run(&mut *motion, end, &[], &mut [&mut watch])?;
            if fall <= self.rate * self.window {
                return measured(
                    &scene,
                    recorder.finish(&*motion, scene.obstacles),
                    &mut *motion,
                );
            }
        }
        Err(CaseFailure::new(format!(
            "not steady by t = {}",
            self.t_max
        )))
    }

    /// Runs an experiment by the paper's algorithm at its own resolution, with Newton's method
    /// beside it.
    ///
    /// # Errors
    /// A step that fails.
    pub(super) fn run_side_by_side(&self, experiment: usize) -> Result<PaperRun, CaseFailure> {
        let scene = &self.experiments[experiment].scene;
        let tolerance = self.fixed_point;
        let tolerance = tolerance.ok_or_else(|| CaseFailure::new("the study has no tolerance"))?;
        let mut both = SideBySide::new(scene, tolerance)?;
        let observed = Observed {
            t_end: scene.t_end,
            t_max: scene.t_end,
            levels: trace::LEVELS,
        };
        let mut recorder = Recorder::new(observed, &mut both.fixed_point);
        for _ in 0..scene.steps() {
            both.step()?;
            recorder.add(&mut both.fixed_point)?;
        }
        Ok(PaperRun {
            trace: recorder.finish(&both.fixed_point, scene.obstacles),
            solvers: both.comparison,
        })
    }
}

/// The beam at its end.
fn measured(
    scene: &Scene,
    trace: Trace,
    motion: &mut AnyMotion,
) -> Result<MeasuredRun, CaseFailure> {
    let nodes = compared(scene)?;
    let t = motion.work().t;
    let (level, last) = (motion.snapshot().on(&nodes), motion.sample());
    let values = [&level.u, &level.phi, &level.theta].into_iter().flatten();
    Ok(MeasuredRun {
        trace,
        largest_field: values.fold(0.0, |most, value| max_or_nan(most, value.abs())),
        end: AtRest::of(scene, &nodes, t, &level, |_| true)?,
        energy: last.energy,
        contact_force: last.contact_force,
    })
}
