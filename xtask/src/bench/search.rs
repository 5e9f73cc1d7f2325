//! Which discretisations of a method are run.
//!
//! Elements and steps of a one-step method: as long as runs are cheap, either is doubled, whichever
//! lowers the error more. Then both grow so that the errors of space and time shrink by the same
//! factor, by the orders of the method, until the next run would exceed the time limit. The
//! orders choose what is run; every number of the benchmark is measured.

use std::collections::HashMap;

use convergence_study::CaseFailure;
use thermobeam_study::error::ErrorMeasure;
use thermobeam_study::kinds::work_precision::WorkPrecision;
use thermobeam_study::kinds::work_precision::method::{
    Clock, Degrees, Measurement, NamedMethod, OneStep, Resolution, Trial, UniformGrid,
};

use super::record::Timed;

/// Element-steps up to which both directions are tried.
const CHEAP: usize = 1 << 18;
/// Elements of the coarsest run.
const FIRST: usize = 4;
/// Gradings tried with cheap runs; the better one goes on.
const GRADINGS: [f64; 2] = [1.0, 1.5];
/// A run shorter than this is repeated, without looking at it.
const SHORT: f64 = 0.05;
/// Number of repetitions; the fastest counts, since other load on the machine only slows a run.
const REPEATS: usize = 5;
/// The time of a run is predicted in proportion to the element-steps, with this reserve for caches.
const RESERVE: f64 = 1.15;

/// A run of this part of the limit is long enough.
const ENOUGH: f64 = 0.25;

/// Nodes of the elements of any order: the last one holds the layer of an impact.
const NODES: [&[f64]; 2] = [&[0.0, 1.0], &[0.0, 0.9, 1.0]];

/// Runs of dG, from coarse to fine.
const DEGREES: [(usize, usize, f64); 27] = [
    (3, 0, 0.02),
    (3, 1, 0.1),
    (4, 1, 0.1),
    (4, 1, 0.02),
    (5, 1, 0.05),
    (6, 1, 0.02),
    (6, 2, 0.1),
    (8, 1, 0.02),
    (8, 1, 0.01),
    (8, 2, 0.05),
    (10, 1, 0.02),
    (10, 2, 0.01),
    (10, 3, 0.05),
    (12, 2, 0.02),
    (12, 3, 0.01),
    (12, 4, 0.05),
    (14, 2, 0.02),
    (14, 3, 0.01),
    (14, 4, 0.01),
    (16, 3, 0.02),
    (16, 4, 0.01),
    (16, 5, 0.01),
    (18, 5, 0.006),
    (20, 3, 0.01),
    (22, 5, 0.005),
    (26, 5, 0.004),
    (30, 5, 0.003),
];

/// The runs of one method on one problem.
pub(super) struct MethodSearch<'s> {
    study: &'s WorkPrecision,
    problem: &'s str,
    method: NamedMethod,
    /// CPU seconds that a run may take.
    limit: f64,
    clock: Clock,
    /// Runs that finished, or `None`, by their discretisation in words.
    known: HashMap<String, Option<Timed>>,
    /// In the order in which they were made.
    runs: Vec<Timed>,
}

/// The work of a run on a grid, in element-steps.
fn work(grid: &UniformGrid) -> f64 {
    (grid.elements * grid.steps) as f64
}

impl<'s> MethodSearch<'s> {
    /// * `problem`: the study's name.
    /// * `limit`: CPU seconds that a run may take.
    pub(super) fn new(
        (problem, study): (&'s str, &'s WorkPrecision),
        method: NamedMethod,
        limit: f64,
        clock: Clock,
    ) -> Self {
        Self {
            study,
            problem,
            method,
            limit,
            clock,
            known: HashMap::new(),
            runs: vec![],
        }
    }

    /// Makes all runs of the method.
    ///
    /// # Errors
    /// [`CaseFailure`] of the reference; a run that fails is left out.
    pub(super) fn all(mut self) -> Result<Vec<Timed>, CaseFailure> {
        self.study.reference()?;
        match self.method.one_step {
            None => self.any_order(),
            Some(scheme) => {
                for measure in ErrorMeasure::ALL {
                    self.one_step(scheme, measure);
                }
            }
        }
        Ok(self.runs)
    }

    fn any_order(&mut self) {
        for nodes in NODES {
            for (p, q, dt) in DEGREES {
                self.measure(Resolution::Dg {
                    nodes: nodes.to_vec(),
                    degrees: Degrees { p, q, dt },
                });
            }
        }
    }

    fn one_step(&mut self, scheme: OneStep, measure: ErrorMeasure) {
        let cheap = GRADINGS.map(|grading| self.cheap(scheme, grading, measure));
        let [(uniform, error), (graded, graded_error)] = cheap;
        let mut grid = if graded_error < error {
            graded
        } else {
            uniform
        };
        loop {
            let seconds = self.seconds(grid);
            let Some(next) = [1.0, 0.5]
                .map(|part| self.finer(grid, scheme, measure, part))
                .into_iter()
                .find(|next| {
                    let predicted = RESERVE * seconds * work(next) / work(&grid);
                    work(next) > work(&grid) && predicted <= self.limit
                })
                .filter(|_| seconds < ENOUGH * self.limit)
            else {
                return;
            };
            if self.measure(Resolution::OneStep(next)).is_none() {
                return;
            }
            grid = next;
        }
    }

    /// Doubles elements or steps while runs are cheap; the last grid with its error.
    fn cheap(
        &mut self,
        scheme: OneStep,
        grading: f64,
        measure: ErrorMeasure,
    ) -> (UniformGrid, f64) {
        let mut grid = UniformGrid {
            grading,
            elements: FIRST,
            steps: self.study.observations(),
        };
        let mut error = self.error(grid, measure);
        while ((2 * grid.elements * grid.steps) as f64) * scheme.runs() <= CHEAP as f64 {
            let more_elements = UniformGrid {
                elements: 2 * grid.elements,
                ..grid
            };
            let more_steps = UniformGrid {
                steps: 2 * grid.steps,
                ..grid
            };
            let errors = [more_elements, more_steps].map(|grid| self.error(grid, measure));
            let best = usize::from(!(errors[0] < errors[1]));
            grid = [more_elements, more_steps][best];
            error = errors[best];
        }
        (grid, error)
    }

    /// A grid whose errors of space and time are both smaller by the same factor: by four or two,
    /// or by its root for half a part.
    fn finer(
        &self,
        grid: UniformGrid,
        scheme: OneStep,
        measure: ErrorMeasure,
        part: f64,
    ) -> UniformGrid {
        let space = match measure {
            ErrorMeasure::Theorem34 => 1.0,
            ErrorMeasure::Tip => 2.0,
        };
        let time = if scheme.extrapolated {
            2.0
        } else {
            scheme.scheme.order
        };
        let factor = 2.0_f64.powf(part * f64::max(space, time));
        let observations = self.study.observations();
        let intervals = (grid.steps / observations) as f64;
        UniformGrid {
            elements: (grid.elements as f64 * factor.powf(1.0 / space)).round() as usize,
            steps: observations * (intervals * factor.powf(1.0 / time)).round() as usize,
            ..grid
        }
    }

    /// The error of a run; infinite if it fails.
    fn error(&mut self, grid: UniformGrid, measure: ErrorMeasure) -> f64 {
        self.measure(Resolution::OneStep(grid))
            .map_or(f64::INFINITY, |run| run.error(measure))
    }

    fn seconds(&mut self, grid: UniformGrid) -> f64 {
        self.measure(Resolution::OneStep(grid))
            .map_or(f64::INFINITY, |run| run.seconds)
    }

    /// Makes a run unless it was made; `None` if it fails.
    fn measure(&mut self, resolution: Resolution) -> Option<Timed> {
        let name = resolution.to_string();
        if let Some(known) = self.known.get(&name) {
            return known.clone();
        }
        let trial = Trial {
            method: self.method,
            resolution,
        };
        let run = self.study.measure(&trial, self.clock).ok();
        let timed = run.map(|run| self.timed(&trial, run));
        self.runs.extend(timed.clone());
        self.known.insert(name, timed.clone());
        timed
    }

    /// A run with its time, which is that of the fastest repetition if it is short.
    fn timed(&self, trial: &Trial, run: Measurement) -> Timed {
        let mut seconds = run.seconds;
        if seconds < SHORT {
            for _ in 0..REPEATS {
                let again = self.study.seconds(trial, self.clock);
                seconds = again.map_or(seconds, |again| again.min(seconds));
            }
        }
        let timed = Timed {
            problem: self.problem.to_owned(),
            method: self.method.name.to_owned(),
            resolution: trial.resolution.to_string(),
            norm: run.errors.norm,
            tip: run.errors.tip,
            work: Some(run.spent.node_solves),
            seconds,
        };
        eprintln!(
            "{} {} {}: {:.2e}, {:.2e}, {:.3} s",
            timed.problem, timed.method, timed.resolution, timed.norm, timed.tip, seconds
        );
        timed
    }
}
