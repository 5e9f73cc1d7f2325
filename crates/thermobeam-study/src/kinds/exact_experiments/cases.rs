//! One run of one scene a case.

use std::ops::ControlFlow;

use convergence_study::study::{Case, CaseFailure};

use super::{ExactExperiments, Method, Run, Shown};
use crate::run::motion::{Motion, Report};
use crate::run::simulate::{Recording, Simulator};
use crate::scene::Scene;

/// Times at which the free end is compared over the whole time.
pub(super) const TIP_TIMES: usize = 1000;

pub(super) fn cases(study: &ExactExperiments) -> Vec<Case<Run>> {
    let mut cases = vec![];
    for (scene, of) in study.scenes.iter().enumerate() {
        for (k, how) in study.discretisations.iter().enumerate() {
            let (label, cost) = (format!("{}, {}", of.name, how.label()), how.cost(of.t_end));
            cases.push(Case { label, cost, data: Run { scene, method: Method::AnyOrder(k) } });
        }
        if study.compare {
            let label = format!("{}, {}", of.name, of.method.name());
            let cost = of.mesh.elements() as f64 * of.steps() as f64;
            cases.push(Case { label, cost, data: Run { scene, method: Method::Own } });
        }
    }
    cases
}

pub(super) fn run(study: &ExactExperiments, run: Run) -> Result<Shown, CaseFailure> {
    let scene = &study.scenes[run.scene];
    let t_end = study.times.last().copied().unwrap_or(scene.t_end);
    match run.method {
        Method::AnyOrder(k) => shown(study, &study.discretisations[k].of(scene, t_end)?),
        Method::Own => shown(study, &Scene { t_end, ..scene.clone() }),
    }
}

fn shown(study: &ExactExperiments, scene: &Scene) -> Result<Shown, CaseFailure> {
    let mut states = vec![];
    let mut observe = |motion: &mut dyn Motion, _: &Report| {
        let t = motion.t();
        // A level of a one-step scheme is there up to rounding.
        if study.times.get(states.len()).is_some_and(|&time| (t - time).abs() <= 1e-9 * time) {
            states.push(motion.at(t));
        }
        Ok(ControlFlow::Continue(()))
    };
    let run = Simulator::new(scene)?.watched(Recording::Curve(TIP_TIMES), &study.times, &mut observe).finished()?;
    let balance = [run.energy.largest_balance_residual / run.energy.initial, run.energy.largest_increase];
    Ok(Shown {
        states,
        tip: run.tip(),
        steps: run.steps,
        balance,
        events: run.contact.map_or(vec![], |contact| contact.events),
    })
}
