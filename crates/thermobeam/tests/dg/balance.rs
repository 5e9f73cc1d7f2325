//! The energy balance closes to round-off in every step, including contact events and loads.

use super::opened;
use crate::prelude::*;

#[test]
fn the_balance_of_all_experiments_closes_to_round_off_for_every_degree_in_time() {
    for one in EXPERIMENTS {
        for q in 0..=5 {
            let mut simulation = of_any_order(experiment(one, 10), of_degree(q));
            let scale = simulation.energy(simulation.level()).total();
            // The full time of the paper for one degree.
            let open = opened(&mut simulation, if q == 2 { 10.0 } else { 2.0 });
            let events = simulation.events().len();
            let case = format!("{one:?}, q = {q}, {events} events: {open:?} of {scale}");
            let is_closed = open.sum.abs() <= 2e-14 * scale && open.worst <= 1e-14 * scale;
            assert!(
                events >= 3 && is_closed && open.rise <= 1e-13 * scale,
                "{case}"
            );
        }
    }
}

#[test]
fn the_change_in_the_balance_is_the_difference_of_the_energies() {
    let mut simulation = of_any_order(experiment((-0.5, 20.0), 9), DgStepping::default());
    while simulation.step(0.5).unwrap().is_some() {
        let [old, new] = [simulation.old_level(), simulation.level()]
            .map(|level| simulation.energy(level).total());
        let change = simulation.balance().change;
        assert!((new - old - change).abs() <= 1e-12 * old, "{change:e}");
    }
}

#[test]
fn every_beam_and_obstacle_has_an_answer_whose_balance_closes() {
    for zeta in [0.0, 1e-3, 0.1] {
        for (beta, rho) in [(-0.8, 0.0), (0.0, 1e4), (200.0, 1.0), (5.0, 100.0)] {
            for epsilon in [1e-6, 1e-3, 1.0] {
                for (elements, degree, q) in [(20, 1, 0), (3, 4, 1), (1, 10, 2), (4, 4, 4)] {
                    let beam = Beam {
                        zeta,
                        beta,
                        rho,
                        a: 0.3,
                        ..Beam::default()
                    };
                    let problem = DgProblem {
                        beam,
                        obstacles: Some(soft(epsilon)),
                        mesh: Mesh::mapped(elements, |s| 1.3 * s - 0.3 * s * s).unwrap(),
                        ..experiment((0.0, 0.0), degree)
                    };
                    let mut simulation = of_any_order(problem, of_degree(q));
                    let scale = simulation.energy(simulation.level()).total();
                    let open = opened(&mut simulation, 0.5);
                    assert!(
                        open.worst <= 1e-12 * scale && open.rise <= 1e-12 * scale,
                        "{beam:?}, epsilon {epsilon}, p {degree}, q {q}: {open:?} of {scale}"
                    );
                }
            }
        }
    }
}

#[test]
fn the_work_of_the_loads_belongs_to_the_balance() {
    let loads = |space: &Space| -> Box<thermobeam::dg::Load> {
        let (space, points) = (space.clone(), Space::gauss(space.degree() + 8));
        Box::new(move |t, load| {
            for (k, field) in [Field::U, Field::Phi, Field::Theta].into_iter().enumerate() {
                let phase = k as f64 + 3.0 * t;
                space.add_load(field, &points, |x| (phase + 4.0 * x).cos(), load);
            }
            load[space.mesh().elements()][0] += (5.0 * t).cos();
        })
    };
    let problem = experiment((0.5, 20.0), 6);
    let mut simulation = Dg::with_load(problem, of_degree(4), loads).unwrap();
    let scale = simulation.energy(simulation.level()).total();
    while simulation.step(0.5).unwrap().is_some() {
        let balance = simulation.balance();
        assert!(
            balance.load != 0.0 && balance.residual.abs() < 1e-13 * scale,
            "{balance:?}"
        );
    }
}
