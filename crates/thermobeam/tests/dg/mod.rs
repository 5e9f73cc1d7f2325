//! The laws of the scheme of any order.

mod allocation;
mod balance;
mod contact;
mod experiment;
mod failure;
mod first_member;
mod steady;

use crate::prelude::*;

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
