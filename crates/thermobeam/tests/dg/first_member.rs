//! For q = 0 and p = 1 the family begins with (3.7)-(3.8), with three differences.

use super::scenes::{equal_steps, experiment, simulate};
use thermobeam::dg::{Dg, DgProblem, Field};
use thermobeam::mesh::Mesh;
use thermobeam::motion::Motion;
use thermobeam::one_step::{InitialValues, OneStep, Problem, Stepping};
use thermobeam::parameters::Beam;
use thermobeam::scheme::EULER_CRANK_NICOLSON;
use thermobeam::solve::{Level, Settings, Stopping};

fn graded() -> Mesh {
    Mesh::mapped(9, |s| 0.4 * s + 0.6 * s * s).unwrap()
}

/// The first member and the paper's scheme after `steps` steps to t = 0.2.
fn both(beam: Beam, steps: usize) -> (Dg, Level) {
    let dt = 0.2 / steps as f64;
    let problem = DgProblem {
        beam,
        obstacles: None,
        mesh: graded(),
        ..experiment(0.0, 0.0, 1)
    };
    let mut simulation = simulate(problem, equal_steps(0, dt));
    let mesh = graded();
    let mut initial = InitialValues::at_rest(&mesh, 0.0);
    let last = mesh.elements();
    for (i, &x) in mesh.nodes().iter().enumerate() {
        initial.u[i] = 0.01 * x * (x - 2.0);
        initial.u_t[i] = 20.0 * x * (x - 1.0) * (x - 1.0);
        initial.theta[i] = if i == last {
            0.0
        } else {
            (std::f64::consts::PI * x).sin()
        };
    }
    let settings = Settings {
        stopping: Stopping::below(1e-14),
        ..Settings::default()
    };
    let stepping = Stepping {
        scheme: EULER_CRANK_NICOLSON,
        settings,
        dt,
        loaded: false,
    };
    let problem = Problem {
        beam,
        obstacles: None,
        mesh,
        initial,
    };
    let mut paper = OneStep::new(problem, stepping).unwrap();
    for _ in 0..steps {
        simulation.step(f64::INFINITY).unwrap();
        paper.step_once().unwrap();
    }
    let level = paper.level();
    (simulation, level)
}

/// Largest difference of a nodal value of u, φ and their velocities.
fn difference((simulation, level): &(Dg, Level)) -> f64 {
    let fields = [
        (Field::U, &level.u),
        (Field::Phi, &level.phi),
        (Field::V, &level.v),
        (Field::W, &level.w),
    ];
    let mut largest = 0.0_f64;
    for (field, values) in fields {
        for (x, value) in graded().nodes().iter().zip(values) {
            let found = simulation
                .value(field, *x, simulation.t())
                .expect("the present time");
            assert!(found.is_finite());
            largest = largest.max((found - value).abs());
        }
    }
    largest
}

#[test]
fn without_its_three_other_rules_the_first_member_is_the_papers_scheme() {
    // No contact, N constant, no coupling with the temperature.
    for beta in [-0.5, 0.0, 5.0] {
        let found = difference(&both(
            Beam {
                beta,
                rho: 0.0,
                a: 0.0,
                ..Beam::default()
            },
            100,
        ));
        assert!(found < 1e-11, "beta = {beta}: {found:e}");
    }
}

#[test]
fn the_three_other_rules_are_a_difference_of_first_order() {
    let beam = Beam {
        a: 0.5,
        rho: 2.0,
        beta: 0.3,
        ..Beam::default()
    };
    let [coarse, fine] = [400, 800].map(|steps| difference(&both(beam, steps)));
    let rate = (coarse / fine).log2();
    assert!((rate - 1.0).abs() < 0.1, "{coarse:e} {fine:e}: rate {rate}");
}
