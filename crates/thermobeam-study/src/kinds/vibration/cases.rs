//! One mesh with one time step a case: the solver beside the motion that it has to give.

use std::ops::ControlFlow;

use convergence_study::study::{Axis, Case, CaseFailure};
use convergence_study::text::number::max_or_nan;
use thermobeam::mesh::Mesh;
use thermobeam::simulation::{Problem, Stepping};
use thermobeam::solve::Level;

use super::clock::{Clock, TimeLevels};
use super::motion::{Modes, Motion};
use super::{Vibrated, Vibration};
use crate::error::design;
use crate::exact::errors::ErrorMeter;
use crate::exact::factors::Factors;
use crate::exact::sources::Nodal;
use crate::kinds::tables::{Norm, Norms, Refine};
use crate::run::driver::{Driver, RunError};

pub(super) fn cases(study: &Vibration) -> Vec<Case<(usize, usize)>> {
    let case = |(elements, steps): (usize, usize)| Case {
        label: Refine::label(elements, steps),
        cost: elements as f64 * steps as f64,
        data: (elements, steps),
    };
    study.refine.cases().into_iter().map(case).collect()
}

pub(super) fn run(study: &Vibration, (elements, steps): (usize, usize)) -> Result<Vibrated, CaseFailure> {
    let Refine { scheme, settings, .. } = study.refine;
    let levels = TimeLevels { dt: study.refine.dt(steps), steps };
    let mesh = study.refine.mesh(elements)?;
    let of_mesh = study.isolates(Axis::Time);
    let modes = if of_mesh { Modes::of_mesh(study, &mesh)? } else { Modes::of_beam(study)? };
    let clock = if study.isolates(Axis::Space) { Clock::Scheme(scheme) } else { Clock::Exact };
    let reference = modes.motion(clock, levels);
    let closed = of_mesh.then(|| modes.motion(Clock::Scheme(scheme), levels));

    let mut factors = Factors::default();
    reference.at(0, &mut factors);
    let nodal = Nodal::of(&modes.exact, &mesh);
    let initial = design::initial(&nodal, &study.beam, &mesh, &factors, study.solver.theta_a);
    let mut meter = ErrorMeter::new(&modes.exact, &mesh, of_mesh);
    meter.lift(&mesh, study.solver.theta_a);
    let tips = nodal.u.iter().map(|values| values[elements]).collect();
    let problem = Problem { beam: study.solver, obstacles: None, mesh: Mesh::clone(&mesh), initial };
    let driver = Driver::new(problem, Stepping { scheme, settings, dt: levels.dt, loaded: false })?;
    Ok(Comparison { meter, tips, factors, levels, reference, closed }.follow(driver)?)
}

/// The motion that the solver is held against.
struct Comparison {
    meter: ErrorMeter,
    /// U(1) of each mode.
    tips: Vec<f64>,
    factors: Factors,
    levels: TimeLevels,
    reference: Motion,
    closed: Option<Motion>,
}

impl Comparison {
    /// Runs the solver and keeps the largest error in each norm.
    fn follow(mut self, mut driver: Driver) -> Result<Vibrated, RunError> {
        let start = driver.level();
        let tip = start.u.len() - 1;
        let zero = Level::new(start.u.len());
        let (mut errors, mut deviation, mut size) = (Norms::ZERO, 0.0, 0.0);
        let (mut exact_tip, mut tips) = (vec![(0.0, self.exact_tip())], vec![(0.0, start.u[tip])]);
        driver.run(self.levels.steps, |step| {
            let n = step.simulation.step();
            if let Some(closed) = &self.closed {
                closed.at(n, &mut self.factors);
                let mut distance = |level: &Level| self.meter.measure(level, &self.factors)[Norm::Theorem34];
                deviation = max_or_nan(deviation, distance(step.new));
                size = max_or_nan(size, distance(&zero));
            }
            self.reference.at(n, &mut self.factors);
            errors = errors.max(&self.meter.measure(step.new, &self.factors));
            let t = n as f64 * self.levels.dt;
            exact_tip.push((t, self.exact_tip()));
            tips.push((t, step.new.u[tip]));
            ControlFlow::<()>::Continue(())
        })?;
        Ok(Vibrated { errors, closed_form: self.closed.map(|_| deviation / size), exact_tip, tip: tips })
    }

    /// u(1) of the motion with the present factors.
    fn exact_tip(&self) -> f64 {
        self.tips.iter().zip(&self.factors.u.value).map(|(tip, factor)| tip * factor).sum()
    }
}
