//! The computations: the seven experiments, then a moving beam until it rests for each β.

use convergence_study::study::{Case, CaseFailure};

use super::{Experiment, Experiments, Group, Rest, Run, rest, run};
use crate::scene::Scene;

/// What a case computes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Task {
    /// An experiment, by its place in the list.
    Run(usize),
    /// A moving beam until it rests, at the β of this place in the list.
    Rest(usize),
}

/// What a case finds.
#[derive(Debug, Clone, PartialEq)]
pub enum Found {
    /// Of an experiment.
    Run(Box<Run>),
    /// Of a run to rest.
    Rest(Rest),
}

pub(super) fn cases(study: &Experiments) -> Vec<Case<Task>> {
    let run = |(k, Experiment { scene, .. }): (usize, &Experiment)| {
        let (Scene { name, mesh, .. }, dt) = (scene, scene.dt());
        // Steady states come at t = 50 to 100.
        Case { label: name.clone(), cost: 80.0 / dt * (mesh.nodes().len() - 1) as f64, data: Task::Run(k) }
    };
    let rest = |(k, beta): (usize, &f64)| Case {
        label: format!("to rest, beta = {beta}"),
        cost: 200.0 / study.rest.dt * study.rest.elements as f64,
        data: Task::Rest(k),
    };
    let runs = study.experiments.iter().enumerate().map(run);
    runs.chain(study.betas.iter().enumerate().map(rest)).collect()
}

pub(super) fn run(study: &Experiments, task: Task) -> Result<Found, CaseFailure> {
    Ok(match task {
        Task::Run(k) => Found::Run(Box::new(run::run(&study.experiments[k].scene, &study.until)?)),
        Task::Rest(k) => {
            let third = study.experiments.iter().find(|experiment| experiment.group == Group::Third);
            let third = third.ok_or_else(|| CaseFailure { reason: "no third experiment".to_owned() })?;
            Found::Rest(rest::run(&third.scene, study.betas[k], &study.rest)?)
        }
    })
}
