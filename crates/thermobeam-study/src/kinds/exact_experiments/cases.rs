//! One run of one scene a case.

use std::ops::ControlFlow;

use convergence_study::study::{Case, CaseFailure};

use super::{ExactExperiments, Method, Run, Shown};
use crate::kinds::tables::Discretisation;
use crate::run::any_order;
use crate::run::simulate::{self, Sampler};
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
    match run.method {
        Method::AnyOrder(k) => any_order_run(study, scene, study.discretisations[k]),
        Method::Own => own_run(study, scene),
    }
}

fn any_order_run(study: &ExactExperiments, scene: &Scene, how: Discretisation) -> Result<Shown, CaseFailure> {
    let t_end = study.times.last().copied().unwrap_or(scene.t_end);
    let scene = how.of(scene, t_end)?;
    let mut states = vec![];
    let run = any_order::run_at(&scene, &study.times, &mut |_, state| states.push(state), TIP_TIMES, &mut |_| ())?;
    if let Some(failure) = run.failure {
        return Err(failure.into());
    }
    // The first state of the history is the start.
    let tip = run.history.iter().map(|state| (state.t, state.u_tip)).collect();
    let balance = [run.energy.largest_balance_residual / run.energy.initial, run.energy.largest_increase];
    Ok(Shown { states, events: run.events, tip, steps: run.steps, balance })
}

/// The scene by its own scheme, its levels nearest to the times.
fn own_run(study: &ExactExperiments, scene: &Scene) -> Result<Shown, CaseFailure> {
    let t_end = study.times.last().copied().unwrap_or(scene.t_end);
    let step_of = |t: f64| (t / scene.dt()).round() as usize;
    let steps = step_of(t_end);
    let mut driver = simulate::driver(scene)?;
    let tip_step: Vec<usize> = (1..=TIP_TIMES).map(|k| step_of(t_end * k as f64 / TIP_TIMES as f64)).collect();
    let mut shown = Shown { steps, balance: [f64::NAN; 2], ..Shown::default() };
    let (sampler, mut next) = (Sampler::new(&scene.mesh), 0);
    let wanted: Vec<usize> = study.times.iter().map(|&t| step_of(t)).collect();
    driver.run(steps, |step| -> ControlFlow<()> {
        let (level, n) = (step.new, step.simulation.step());
        let last = level.u.len() - 1;
        if tip_step.get(next) == Some(&n) {
            shown.tip.push((step.simulation.t(), level.u[last]));
            next += 1;
        }
        if wanted.contains(&n) {
            shown.states.push(sampler.sample(step.simulation, level));
        }
        ControlFlow::Continue(())
    })?;
    Ok(shown)
}
