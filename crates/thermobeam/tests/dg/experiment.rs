//! The paper's first experiment, to the digits in which independent discretisations agree.

use super::scenes::{advanced, close, experiment, tip};
use thermobeam::dg::{ContactEvent, Dg, DgStepping, Field, Phase};
use thermobeam::mesh::Mesh;
use thermobeam::motion::Motion;
use thermobeam::one_step::{InitialValues, OneStep, Problem, Stepping};
use thermobeam::parameters::{Beam, Obstacles};
use thermobeam::scheme::MIDPOINT;
use thermobeam::solve::Settings;

/// u(1, 1), by an independent prototype.
const REFERENCE: f64 = -0.011764243810;

fn first(p: usize, q: usize, dt: f64, t: f64) -> Dg {
    advanced(
        experiment(0.0, 0.0, p),
        DgStepping {
            degree: q,
            dt,
            ..DgStepping::default()
        },
        t,
    )
}

#[test]
fn errors_of_the_first_experiment_are_those_of_the_prototype() {
    // Degree, degree in time, largest step, error of u(1, 1).
    for (p, q, dt, error) in [
        (16, 0, 0.02, 2.5e-4),
        (16, 1, 0.02, 6e-7),
        (16, 1, 0.01, 2.5e-8),
        (16, 2, 0.02, 5e-9),
        (16, 2, 0.01, 1.5e-10),
        (16, 3, 0.02, 9e-11),
    ] {
        let found = tip(&first(p, q, dt, 1.0), Field::U);
        close(found, REFERENCE, error);
        assert!(
            (found - REFERENCE).abs() > 0.1 * error,
            "p = {p}, q = {q}: {found} is better than it can be"
        );
    }
}

#[test]
fn ten_units_of_time_keep_ten_digits() {
    let simulation = first(20, 3, 0.01, 10.0);
    close(tip(&simulation, Field::U), 0.008482598710, 2e-12);
    close(tip(&simulation, Field::Phi), 0.005168435936, 2e-12);
    close(tip(&simulation, Field::W), -0.0585739110, 1e-10);
    let expected = [
        (0.2034132761, Phase::Upper),
        (0.6481694610, Phase::Free),
        (0.8582338080, Phase::Lower),
    ];
    for (event, (t, to)) in simulation.events().iter().zip(expected) {
        close(event.t, t, 2e-10);
        assert_eq!(event.to, to);
    }
    assert_eq!(simulation.events().len(), 14);
    assert!(
        simulation
            .events()
            .windows(2)
            .all(|pair| pair[0].t < pair[1].t && pair[0].to == pair[1].from)
    );
}

#[test]
fn events_do_not_depend_on_the_steps() {
    let [coarse, fine] = [(3, 0.02), (4, 0.013)].map(|(q, dt)| first(16, q, dt, 3.0));
    let pairs: Vec<(&ContactEvent, &ContactEvent)> =
        coarse.events().iter().zip(fine.events()).collect();
    assert_eq!((coarse.events().len(), fine.events().len()), (7, 7));
    for (one, other) in pairs {
        assert_eq!((one.from, one.to), (other.from, other.to));
        close(one.t, other.t, 2e-9);
    }
}

#[test]
fn the_error_falls_exponentially_with_the_degree() {
    let errors = [4, 8, 12, 16].map(|p| {
        (tip(&first(p, 4, 0.01, 0.5), Field::U) - tip(&first(22, 4, 0.01, 0.5), Field::U)).abs()
    });
    for (error, bound) in errors.iter().zip([1e-3, 5e-6, 5e-8, 1e-10]) {
        assert!(*error < bound, "{errors:?}");
    }
    assert!(
        errors.windows(2).all(|pair| pair[1] < 0.05 * pair[0]),
        "{errors:?}"
    );
}

#[test]
fn one_element_and_several_agree() {
    let mesh = Mesh::from_nodes(vec![0.0, 0.5, 0.85, 1.0]).unwrap();
    let several = thermobeam::dg::DgProblem {
        mesh,
        ..experiment(0.0, 0.0, 12)
    };
    let several = advanced(
        several,
        DgStepping {
            degree: 3,
            dt: 0.01,
            ..DgStepping::default()
        },
        1.0,
    );
    close(tip(&several, Field::U), REFERENCE, 2e-11);
}

#[test]
fn linear_elements_and_small_steps_lead_to_the_same_answer() {
    let expected = tip(&first(16, 3, 0.01, 0.5), Field::U);
    let errors = [40, 80].map(|elements| {
        let mesh = Mesh::uniform(elements).unwrap();
        let mut initial = InitialValues::at_rest(&mesh, 0.0);
        for (i, &x) in mesh.nodes().iter().enumerate() {
            initial.u[i] = 0.01 * x * (x - 2.0);
            initial.u_t[i] = 20.0 * x * (x - 1.0) * (x - 1.0);
            initial.theta[i] = if i == elements {
                0.0
            } else {
                (std::f64::consts::PI * x).sin()
            };
        }
        let problem = Problem {
            beam: Beam::default(),
            obstacles: Some(Obstacles::default()),
            mesh,
            initial,
        };
        let dt = 0.04 / elements as f64;
        let stepping = Stepping {
            scheme: MIDPOINT,
            settings: Settings::default(),
            dt,
            loaded: false,
        };
        let mut simulation = OneStep::new(problem, stepping).unwrap();
        while simulation.t() < 0.5 - 0.5 * dt {
            simulation.step_once().unwrap();
        }
        simulation.level().u[elements] - expected
    });
    // `midpoint` on P1 is of second order in h and dt.
    let rate = (errors[0] / errors[1]).log2();
    assert!(
        (rate - 2.0).abs() < 0.1 && errors[1].abs() < 1e-4,
        "{errors:?}: rate {rate}"
    );
}

#[test]
fn the_same_problem_gives_the_same_bits() {
    let [one, other] = [(), ()].map(|()| first(11, 2, 0.02, 2.0));
    assert_eq!(one.level(), other.level());
    assert_eq!(one.events(), other.events());
}

#[test]
fn a_simulation_may_go_on_in_another_thread() {
    let mut simulation = first(8, 1, 0.02, 0.5);
    let expected = tip(&first(8, 1, 0.02, 1.0), Field::U);
    let moved = std::thread::spawn(move || {
        simulation.advance(1.0).unwrap();
        tip(&simulation, Field::U)
    });
    // The only difference is the step that ends at 0.5.
    close(moved.join().unwrap(), expected, 1e-6);
}
