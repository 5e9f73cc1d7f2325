//! The energy balance closes to round-off, step by step.

use crate::prelude::*;

#[test]
fn the_energy_falls_and_its_balance_closes_to_round_off() {
    assert!(
        Settings::default().stopping == Stopping::below(1e-10)
            && Settings::default().start == Start::Extrapolated
    );
    for (tolerance, dt) in [(1e-13, 1e-4), (1e-13, 1e-3), (1e-10, 1e-4), (1e-10, 1e-3)] {
        for experiment in EXPERIMENTS {
            for (scheme, mesh) in schemes_and_meshes(100) {
                let stepping = with(scheme, below(tolerance), dt);
                let mut simulation = simulate(&paper(mesh, experiment), stepping);
                let (mut old, mut new) = (simulation.level(), TimeLevel::new(101));
                let rounding = 1e-12 * simulation.energy(&old).total().abs();
                for step in 1..=1000 {
                    simulation.step_once().unwrap();
                    simulation.observe(&mut new);
                    let balance = simulation.balance(&old, &new);
                    let (change, contact) = (balance.change, balance.contact);
                    // The midpoint rule with its discrete gradient has no numerical dissipation.
                    let taken = max_or_nan(contact.abs(), balance.inertial.abs());
                    assert!(
                        balance.residual.abs() <= rounding
                            && change <= rounding
                            && contact >= -rounding
                            && (scheme != MIDPOINT || taken <= rounding),
                        "{experiment:?} {}, {tolerance:e}: {balance:?} at step {step} of {dt}",
                        scheme.name
                    );
                    std::mem::swap(&mut old, &mut new);
                }
            }
        }
    }
}

#[test]
fn the_change_of_energy_is_the_difference_of_the_energies() {
    for experiment in EXPERIMENTS {
        for (scheme, mesh) in schemes_and_meshes(30) {
            let stepping = with(scheme, Settings::default(), 1e-3);
            let mut simulation = simulate(&paper(mesh, experiment), stepping);
            for _ in 0..200 {
                let old = simulation.level();
                simulation.step_once().unwrap();
                let new = simulation.level();
                let [before, after] = [&old, &new].map(|level| simulation.energy(level).total());
                let change = simulation.balance(&old, &new).change;
                assert_eq!(simulation.energy_change(&old, &new), change);
                let case = simulation.problem().case(scheme, 1e-3);
                assert_eq!(simulation.energy_scale(&new), case.energy_scale(&new));
                let difference = change - (after - before);
                assert!(
                    difference.abs() <= 1e-12 * before.abs().max(1.0),
                    "{difference:e}"
                );
            }
        }
    }
}

#[test]
fn a_level_is_slow_when_no_nodal_velocity_is_larger_or_nan() {
    let mut level = TimeLevel::new(3);
    (level.v[1], level.w[2]) = (-1e-3, 1e-3);
    assert!(level.is_slow(1e-3) && !level.is_slow(0.99e-3));
    level.v[1] = 0.0;
    assert!(!level.is_slow(0.99e-3));
    level.w[2] = f64::NAN;
    assert!(!level.is_slow(1.0));
}
