//! The nonlinear semi-discrete system, contact included, against an explicit Runge-Kutta method of
//! order 8.

use super::dense::{Dense, State};
use super::scenes::{advance, distance, last_rate, paper, schemes_and_meshes, simulate, stepping};
use ode_solvers::dop_shared::OutputType;
use ode_solvers::{DVector, Dop853, System};
use thermobeam::norms::max_or_nan;
use thermobeam::one_step::{Problem, Stepping};
use thermobeam::scheme::Scheme;
use thermobeam::solve::{Level, Settings, Stopping};

struct SemiDiscrete<F> {
    n: usize,
    rate: F,
}

impl<F: Fn(&State) -> State> System<f64, DVector<f64>> for SemiDiscrete<F> {
    fn system(&self, _: f64, y: &DVector<f64>, dy: &mut DVector<f64>) {
        dy.copy_from(&(self.rate)(&State::unstack(y, self.n)).stack());
    }
}

/// The semi-discrete solution at time t to about eleven digits.
fn exact(problem: &Problem, t: f64) -> Level {
    let dense = Dense::new(problem);
    let n = problem.mesh.elements();
    let system = SemiDiscrete {
        n,
        rate: dense.rate(),
    };
    let mut integrator = Dop853::new(
        system,
        0.0,
        t,
        t,
        dense.initial(problem).stack(),
        1e-12,
        1e-12,
    );
    integrator.set_output(OutputType::Sparse);
    integrator.integrate().unwrap();
    assert_eq!(integrator.x_out().last(), Some(&t));
    State::unstack(integrator.y_out().last().unwrap(), n).to_level()
}

/// (dt, error) at time t for each number of steps, and whether the tip was in contact before.
fn errors(problem: &Problem, scheme: Scheme, t: f64, steps: &[usize]) -> (Vec<(f64, f64)>, bool) {
    let expected = exact(problem, t);
    let mut contact = 0.0;
    let errors = steps
        .iter()
        .map(|&steps| {
            let dt = t / steps as f64;
            let settings = Settings {
                stopping: Stopping::below(1e-12),
                ..Settings::default()
            };
            let mut simulation = simulate(
                problem,
                Stepping {
                    scheme,
                    settings,
                    ..stepping(dt)
                },
            );
            let mut level = simulation.level();
            for _ in 0..steps {
                advance(&mut simulation, 1);
                simulation.observe(&mut level);
                contact = max_or_nan(contact, level.contact_force.abs());
            }
            (dt, distance(&problem.mesh, &level, &expected))
        })
        .collect();
    (errors, contact > 0.0)
}

#[test]
fn without_contact_both_schemes_converge_at_their_order() {
    for experiment in [(0.0, 0.0), (5.0, 20.0), (-0.8, 0.0)] {
        for (scheme, mesh) in schemes_and_meshes(5) {
            let problem = Problem {
                obstacles: None,
                ..paper(mesh, experiment)
            };
            let (errors, _) = errors(&problem, scheme, 0.5, &[2048, 4096]);
            let rate = last_rate(&errors);
            assert!(
                (rate - scheme.order).abs() <= 0.02,
                "{experiment:?} {}: rate {rate}, {errors:?}",
                scheme.name
            );
        }
    }
}

#[test]
fn in_contact_both_schemes_converge_at_their_order_once_the_contact_is_resolved() {
    // The force has a kink, not a jump, when the tip crosses an obstacle: each crossing causes an
    // error of order dt². The order is unchanged, but only visible for small steps.
    for experiment in [(0.0, 0.0), (-0.5, 20.0), (-0.8, 0.0)] {
        for (scheme, mesh) in schemes_and_meshes(5) {
            let problem = paper(mesh, experiment);
            let (errors, contact) = errors(&problem, scheme, 0.25, &[32768, 65536]);
            let rate = last_rate(&errors);
            assert!(contact, "{experiment:?}");
            assert!(
                (rate - scheme.order).abs() <= 0.05,
                "{experiment:?} {}: rate {rate}, {errors:?}",
                scheme.name
            );
        }
    }
}
