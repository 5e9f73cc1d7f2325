//! The paper's first experiment, to the digits in which independent discretisations agree.

use crate::prelude::*;

/// u(1, 1), by an independent prototype.
const REFERENCE: f64 = -0.011764243810;

fn first(p: usize, q: usize, dt: f64, t: f64) -> Dg {
    let stepping = DgStepping { dt, ..of_degree(q) };
    advanced(experiment((0.0, 0.0), p), stepping, t)
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
fn one_element_and_several_agree() {
    let several = DgProblem {
        mesh: Mesh::from_nodes(vec![0.0, 0.5, 0.85, 1.0]).unwrap(),
        ..experiment((0.0, 0.0), 12)
    };
    let stepping = DgStepping {
        dt: 0.01,
        ..of_degree(3)
    };
    close(
        tip(&advanced(several, stepping, 1.0), Field::U),
        REFERENCE,
        2e-11,
    );
}

#[test]
fn events_do_not_depend_on_the_steps() {
    let [fine, coarse] = [(20, 3, 0.01), (16, 4, 0.013)].map(|(p, q, dt)| first(p, q, dt, 10.0));
    let expected = [
        (0.2034132761, Phase::Upper),
        (0.6481694610, Phase::Free),
        (0.8582338080, Phase::Lower),
    ];
    for (event, (t, to)) in fine.events().iter().zip(expected) {
        close(event.t, t, 2e-10);
        assert_eq!(event.to, to);
    }
    assert_eq!((coarse.events().len(), fine.events().len()), (14, 14));
    for (one, other) in coarse.events().iter().zip(fine.events()) {
        assert_eq!((one.from, one.to), (other.from, other.to));
        close(one.t, other.t, 2e-9);
    }
    let is_next =
        |pair: &[thermobeam::dg::ContactEvent]| pair[0].t < pair[1].t && pair[0].to == pair[1].from;
    assert!(fine.events().windows(2).all(is_next));
}

#[test]
fn the_same_problem_gives_the_same_bits_in_any_thread() {
    let [mut one, mut other] = [(), ()].map(|()| first(11, 2, 0.02, 1.0));
    one.advance(2.0).unwrap();
    let moved = std::thread::spawn(move || {
        other.advance(2.0).unwrap();
        other
    });
    let other = moved.join().unwrap();
    assert_eq!((one.level(), one.events()), (other.level(), other.events()));
}
