//! Both methods against the semi-discrete system, which is exact in time: the linear beam by the
//! exponential of its matrix, the nonlinear one, contact included, by an explicit Runge-Kutta
//! method of order 8.

use super::p1::blocks;
use super::system::{Dense, affine, level_of};
use crate::prelude::*;
use nalgebra::DMatrix;
use ode_solvers::dop_shared::OutputType;
use ode_solvers::{DVector, Dop853, System};

/// y(t) of `y' = A y + b`, by the exponential of `[A b; 0 0]`.
fn by_exponential(problem: &Problem, t: f64) -> TimeLevel {
    let dense = Dense::new(problem);
    let start = dense.initial(problem);
    let size = start.len();
    let (matrix, constant) = affine(size, dense.rate());
    let constant = DMatrix::from_columns(&[constant]);
    let none = DMatrix::zeros(1, size);
    let augmented = blocks([[&matrix, &constant], [&none, &DMatrix::zeros(1, 1)]]);
    let end = (augmented * t).exp() * start.push(1.0);
    level_of(&end.remove_row(size))
}

#[test]
fn steps_of_every_degree_lead_to_the_matrix_exponential() {
    let problem = || DgProblem {
        beam: Beam {
            zeta: 0.1,
            a: 0.5,
            rho: 0.0,
            beta: -0.3,
            theta_a: 3.0,
        },
        obstacles: None,
        mesh: uniform(5),
        degree: 1,
        initial: InitialFunctions {
            u: Box::new(|x| 0.1 * x * x),
            u_t: Box::new(|x| 3.0 * x * (1.0 - x)),
            phi: Box::new(|x| 0.2 * x),
            phi_t: Box::new(|x| (3.0 * x).sin()),
            theta: Box::new(|x| 3.0 * (1.0 - x) + 4.0 * x * (1.0 - x)),
        },
    };
    let t = 0.5;
    let expected = by_exponential(&on_mesh(&problem(), uniform(5)), t);
    for (q, steps, tolerance) in [
        (1, 400.0, 1e-7),
        (2, 100.0, 2e-9),
        (3, 100.0, 1e-11),
        (4, 50.0, 1e-11),
        (5, 40.0, 1e-11),
    ] {
        let simulation = advanced(problem(), equal_steps(q, t / steps), t);
        let fields = [Field::U, Field::Phi, Field::V, Field::W, Field::Theta];
        close(difference(&simulation, &expected, &fields), 0.0, tolerance);
    }
}

struct SemiDiscrete<F>(F);

impl<F: Fn(&DVector<f64>) -> DVector<f64>> System<f64, DVector<f64>> for SemiDiscrete<F> {
    fn system(&self, _: f64, y: &DVector<f64>, dy: &mut DVector<f64>) {
        dy.copy_from(&self.0(y));
    }
}

/// The semi-discrete solution at time t to about eleven digits.
fn exact(problem: &Problem, t: f64) -> TimeLevel {
    let dense = Dense::new(problem);
    let system = SemiDiscrete(dense.rate());
    let start = dense.initial(problem);
    let mut integrator = Dop853::new(system, 0.0, t, t, start, 1e-12, 1e-12);
    integrator.set_output(OutputType::Sparse);
    integrator.integrate().unwrap();
    assert_eq!(integrator.x_out().last(), Some(&t));
    level_of(integrator.y_out().last().unwrap())
}

/// The errors at time t with these numbers of steps, and whether the tip was in contact before.
fn errors(problem: &Problem, scheme: Scheme, t: f64, steps: [usize; 2]) -> ([f64; 2], bool) {
    let expected = exact(problem, t);
    let mut contact = 0.0;
    let errors = steps.map(|steps| {
        let mut simulation = simulate(problem, with(scheme, below(1e-12), t / steps as f64));
        let mut level = simulation.level();
        for _ in 0..steps {
            advance(&mut simulation, 1);
            simulation.observe(&mut level);
            contact = max_or_nan(contact, level.contact_force.abs());
        }
        distance(&problem.mesh, &level, &expected)
    });
    (errors, contact > 0.0)
}

/// Both schemes have their order on both meshes.
#[track_caller]
fn have_their_order(
    experiments: [(f64, f64); 3],
    has_contact: bool,
    t: f64,
    steps: [usize; 2],
    within: f64,
) {
    for experiment in experiments {
        for (scheme, mesh) in schemes_and_meshes(5) {
            let mut problem = paper(mesh, experiment);
            problem.obstacles = problem.obstacles.filter(|_| has_contact);
            let (errors, contact) = errors(&problem, scheme, t, steps);
            assert_eq!(contact, has_contact, "{experiment:?}");
            let case = format!("{experiment:?} {}", scheme.name);
            near(case, rate(errors), scheme.order, within);
        }
    }
}

#[test]
fn without_contact_both_schemes_converge_at_their_order() {
    let experiments = [(0.0, 0.0), (5.0, 20.0), (-0.8, 0.0)];
    have_their_order(experiments, false, 0.5, [2048, 4096], 0.02);
}

#[test]
fn in_contact_both_schemes_converge_at_their_order_once_the_contact_is_resolved() {
    // The force has a kink, not a jump, when the tip crosses an obstacle: each crossing causes an
    // error of order dt². The order is unchanged, but only visible for small steps.
    let experiments = [(0.0, 0.0), (-0.5, 20.0), (-0.8, 0.0)];
    have_their_order(experiments, true, 0.25, [32768, 65536], 0.05);
}
