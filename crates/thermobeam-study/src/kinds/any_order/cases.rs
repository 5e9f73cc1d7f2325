//! One run a case, its errors measured at the end and inside every step.

use convergence_study::run::time_limit::Patience;
use convergence_study::study::{Case, CaseFailure};
use convergence_study::text::number::max_or_nan;
use thermobeam::dg::{Initial, Load, Problem, Simulation, Space, Stepping};

use super::{AnyOrder, Errors, Over, Resolution};
use crate::exact::any_order::{self, ErrorMeter, LevelErrors, ManufacturedLoad};

/// Where inside a step the errors are measured: no Gauss or Radau point, where they are smaller.
const INSIDE: [f64; 2] = [0.13, 0.61];

pub(super) fn cases(study: &AnyOrder) -> Vec<Case<Resolution>> {
    let case = |data: Resolution| {
        let Resolution { degree, elements, time_degree, steps } = data;
        let label = match study.over {
            Over::Space => format!("p = {degree}, n = {elements}"),
            Over::Time => format!("q = {time_degree}, {steps} steps"),
            Over::Degree => format!("p = {degree}"),
        };
        let cost = (elements * degree * (time_degree + 1) * (steps + 10)) as f64 * 10.0;
        Case { label, cost, data }
    };
    study.resolutions().map(case).collect()
}

pub(super) fn run(study: &AnyOrder, resolution: Resolution) -> Result<Errors, CaseFailure> {
    let mut simulation = simulation(study, resolution)?;
    // The temperature that the solver means: what it computes is lifted by its own.
    let theta_a = study.solver_coefficients().0.theta_a;
    let mut level = simulation.level().clone();
    let (mut inside_u, mut inside_u_t) = (0.0, 0.0);
    let mut patience = Patience::new(simulation.space().blocks() * (resolution.time_degree + 1));
    let mut meter = ErrorMeter::new(&study.exact, theta_a, simulation.space());
    loop {
        patience.check(simulation.work().steps, || simulation.t())?;
        if simulation.step(study.t_end)?.is_none() {
            break;
        }
        // Only a study over time judges these.
        if study.over == Over::Time {
            let (from, to) = (simulation.old_level().t, simulation.t());
            for s in INSIDE {
                if simulation.level_into(from + s * (to - from), &mut level) {
                    let LevelErrors { values: [u, _, u_t, ..], .. } = meter.errors(&level);
                    inside_u = max_or_nan(inside_u, u);
                    inside_u_t = max_or_nan(inside_u_t, u_t);
                }
            }
        }
    }
    let LevelErrors { values, slopes } = meter.errors(simulation.level());
    let together = |errors: [f64; 5]| errors.iter().map(|error| error * error).sum::<f64>().sqrt();
    Ok(Errors { fields: together(values), slopes: together(slopes), inside_u, inside_u_t })
}

fn simulation(study: &AnyOrder, resolution: Resolution) -> Result<Simulation, CaseFailure> {
    let Resolution { degree, elements, time_degree, steps } = resolution;
    let dt = study.t_end / steps as f64;
    let stepping = Stepping { degree: time_degree, dt, restart_dt: dt, growth: 1.0, ..Stepping::default() };
    let (beam, obstacles) = study.solver_coefficients();
    // A wrong temperature of the clamped end is one from the start: the initial data meet it, or no step would be done.
    let shift = beam.theta_a - study.beam.theta_a;
    let exact = any_order::initial(&study.exact);
    let theta = exact.theta;
    let initial = Initial { theta: Box::new(move |x| theta(x) + shift * (1.0 - x)), ..exact };
    let problem = Problem { beam, obstacles, mesh: study.mesh(elements)?, degree, initial };
    let load = |space: &Space| -> Box<dyn Load> {
        Box::new(ManufacturedLoad::new(&study.exact, &study.beam, study.obstacles, space))
    };
    if !study.loaded {
        return Ok(Simulation::new(problem, stepping)?);
    }
    Ok(Simulation::with_load(problem, stepping, load)?)
}
