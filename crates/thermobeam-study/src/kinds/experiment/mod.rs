//! The paper's Section 5, sentence by sentence: seven experiments run until nothing changes any more, the claims of the
//! text judged, its figures redrawn.
//!
//! # What is measured, and how
//!
//! | quantity | measured as |
//! | --- | --- |
//! | steady | the energy has fallen by less than `rate` per unit of time over the last `window` |
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

mod claims;
mod log;
mod motion;
mod report;
mod resting;
mod spec;

use thermobeam::equilibrium::Contact;

use super::Study;
use super::complete::{all_ran, or_nothing};
use crate::kinds::untyped::{Case, Measured};
use crate::scene::Scene;
use convergence_study::study::CaseFailure;
use convergence_study::study::Header;
use convergence_study::study::outcome::{Check, Outcome};

/// Which of the section's experiments, and so what is claimed of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Group {
    /// θ_A = 0, (5.4): the beam becomes straight.
    First,
    /// θ_A = 20, (5.5): the beam comes to rest in this state of contact.
    Second(Contact),
    /// Beyond buckling: the beam comes to rest bent.
    Third,
}

/// One of the experiments.
#[derive(Debug, Clone, PartialEq)]
pub struct Experiment {
    /// Its part in the section.
    pub group: Group,
    /// The scene, at the study's resolution.
    pub scene: Scene,
}

/// When a run ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Until {
    /// A run that lasts longer fails.
    pub t_max: f64,
    /// Span over which the energy's fall is measured: longer than an oscillation, because at its turning points the beam
    /// stands still.
    pub window: f64,
    /// Fall of the energy per unit of time below which the state is steady.
    pub rate: f64,
}

/// How the runs are done that only have to come to rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ToRest {
    /// Elements of a uniform mesh.
    pub elements: usize,
    /// Time step.
    pub dt: f64,
    /// Largest velocity of a beam at rest.
    pub speed: f64,
    /// A run that lasts longer fails.
    pub t_max: f64,
}

/// The study.
#[derive(Debug, Clone, PartialEq)]
pub struct Experiments {
    header: Header,
    experiments: Vec<Experiment>,
    until: Until,
    betas: Vec<f64>,
    rest: ToRest,
}

impl Experiments {
    /// The experiments, in the order of the cases.
    pub fn experiments(&self) -> &[Experiment] {
        &self.experiments
    }

    /// The axial forces at which steady states are counted, in the order of the cases that follow.
    pub fn betas(&self) -> &[f64] {
        &self.betas
    }
}

impl Study for Experiments {
    fn header(&self) -> &Header {
        &self.header
    }

    fn cases(&self) -> Vec<Case> {
        let runs = self.experiments.iter().map(|experiment| {
            let Scene { name, mesh, dt, .. } = &experiment.scene;
            // Steady states come at t = 50 to 100.
            Case { label: name.clone(), cost: 80.0 / dt * (mesh.nodes().len() - 1) as f64 }
        });
        let rest_cost = 200.0 / self.rest.dt * self.rest.elements as f64;
        let rests = self.betas.iter().map(|beta| Case { label: format!("to rest, beta = {beta}"), cost: rest_cost });
        runs.chain(rests).collect()
    }

    fn run(&self, index: usize) -> Result<Measured, CaseFailure> {
        match index.checked_sub(self.experiments.len()) {
            None => log::run(&self.experiments[index].scene, &self.until),
            Some(rest) => {
                let third = self.experiments.iter().find(|experiment| experiment.group == Group::Third);
                let third = third.ok_or_else(|| CaseFailure { reason: "no third experiment".to_owned() })?;
                resting::run(&third.scene, self.betas[rest], &self.rest)
            }
        }
    }

    fn conclude(&self, results: &[Result<Measured, CaseFailure>]) -> Outcome {
        let labels = self.cases();
        let mut checks = vec![all_ran(&labels, results)];
        let measured = or_nothing(labels.len(), results);
        let (runs, rests) = measured.split_at(self.experiments.len());
        checks.extend(claims::judge(self, runs));
        checks.extend(resting::judge(&self.betas, rests));
        report::outcome(self, runs, rests, checks)
    }
}

/// The runs of a group, each with its scene.
fn of_group<'a>(
    study: &'a Experiments,
    runs: &'a [Measured],
    belongs: impl Fn(Group) -> bool + 'a,
) -> impl Iterator<Item = (&'a Experiment, &'a Measured)> {
    study.experiments.iter().zip(runs).filter(move |(experiment, _)| belongs(experiment.group))
}

/// How many of the checks passed, in a sentence.
fn summary(checks: &[Check]) -> String {
    let passed =
        checks.iter().filter(|check| check.verdict == convergence_study::judge::verdict::Verdict::Pass).count();
    format!("{passed} of {} statements about the experiments hold", checks.len())
}
