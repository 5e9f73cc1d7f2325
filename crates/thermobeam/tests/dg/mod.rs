//! The laws of the scheme of any order.

mod allocation;
mod balance;
mod contact;
mod experiment;
mod failure;
mod first_member;
mod steady;

use crate::prelude::*;

/// Fields of degree 3 on elements of several lengths, with coefficients that all differ.
#[test]
fn slopes_are_those_of_the_values_one_by_one_and_all_together() {
    let mesh = Mesh::from_nodes(vec![0.0, 0.3, 0.4, 1.0]).unwrap();
    let space = Space::new(mesh, 3).unwrap();
    let mut level = DgLevel::new(&space);
    let places = level.places.iter_mut().flatten();
    let numbers = places.chain(level.rates.iter_mut().flatten());
    for (k, number) in numbers.enumerate() {
        *number = (k as f64).sin();
    }
    for x in [0.1, 0.35, 0.7] {
        // Exact for cubics, but for their third derivative times h²/6.
        let h = 1e-5;
        let [before, all, after] = [x - h, x, x + h].map(|x| level.values_and_slopes(&space, x));
        for (k, field) in Field::ALL.into_iter().enumerate() {
            assert_eq!(all[k], level.value_and_slope(&space, field, x));
            let slope = (after[k].0 - before[k].0) / (2.0 * h);
            assert!((slope - all[k].1).abs() < 1e-5, "{field:?} at {x}: {slope}");
        }
    }
}

/// 0.1 + (0.425 - 0.1) is not 0.425.
#[test]
fn a_step_that_a_limit_cuts_ends_there_to_the_last_bit() {
    let long = DgStepping {
        dt: 1.0,
        restart_dt: 1.0,
        ..DgStepping::default()
    };
    let problem = DgProblem {
        obstacles: None,
        ..experiment((0.0, 0.0), 4)
    };
    let mut simulation = of_any_order(problem, long);
    for (steps, limit) in [(1, 0.1), (2, 0.425)] {
        simulation.advance(limit).unwrap();
        assert_eq!((simulation.steps(), simulation.t()), (steps, limit));
    }
}

/// What the balances of a run leave open.
#[derive(Debug, Default)]
struct Open {
    /// The largest residual of a step.
    worst: f64,
    /// The sum of the residuals.
    sum: f64,
    /// The largest rise of the energy.
    rise: f64,
    /// The largest cost of contact.
    contact: f64,
}

/// Runs to a time; each step's balance has the terms that make its residual, and what is lost has a
/// sign.
#[track_caller]
fn opened(simulation: &mut Dg, t: f64) -> Open {
    let mut open = Open {
        rise: f64::NEG_INFINITY,
        ..Open::default()
    };
    while simulation.step(t).unwrap().is_some() {
        let Balance {
            change,
            viscous,
            thermal,
            inertial,
            contact,
            load,
            residual,
        } = simulation.balance();
        let terms = change + viscous + thermal + inertial + load + contact;
        assert_eq!(terms, residual);
        let is_lost = viscous >= 0.0 && thermal >= 0.0 && inertial >= 0.0;
        assert!(is_lost, "{viscous:e} {thermal:e} {inertial:e}");
        open.worst = max_or_nan(open.worst, residual.abs());
        open.sum += residual;
        open.rise = max_or_nan(open.rise, change);
        open.contact = max_or_nan(open.contact, contact.abs());
    }
    open
}
