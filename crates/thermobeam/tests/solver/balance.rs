//! The energy balance closes to round-off, step by step.

use super::scenes::{EXPERIMENTS, paper, schemes_and_meshes, simulate, stepping};
use thermobeam::norms::max_or_nan;
use thermobeam::one_step::{Problem, Stepping};
use thermobeam::scheme::{Case, MIDPOINT};
use thermobeam::solve::{Level, Settings, Start, Stopping};

/// The largest residual relative to the initial energy, over 1000 steps of every experiment, both
/// schemes, both meshes.
fn largest_residual(tolerance: f64, dt: f64) -> f64 {
    let mut worst = 0.0;
    for experiment in EXPERIMENTS {
        for (scheme, mesh) in schemes_and_meshes(100) {
            let settings = Settings {
                stopping: Stopping::below(tolerance),
                ..Settings::default()
            };
            let mut simulation = simulate(
                &paper(mesh, experiment),
                Stepping {
                    scheme,
                    settings,
                    ..stepping(dt)
                },
            );
            let mut old = simulation.level();
            let mut new = Level::new(101);
            let initial = simulation.energy(&old).total();
            let mut of_run = 0.0;
            for step in 1..=1000 {
                simulation.step_once().unwrap();
                simulation.observe(&mut new);
                let balance = simulation.balance(&old, &new);
                of_run = max_or_nan(of_run, balance.residual.abs() / initial.abs());
                let rounding = 1e-12 * initial.abs();
                assert!(
                    balance.change <= rounding,
                    "{experiment:?} {}: {balance:?} at {step}",
                    scheme.name
                );
                assert!(
                    balance.contact >= -rounding,
                    "{experiment:?} {}: {balance:?} at {step}",
                    scheme.name
                );
                // The midpoint rule with its discrete gradient has no numerical dissipation.
                let taken = max_or_nan(balance.contact.abs(), balance.inertial.abs());
                assert!(
                    scheme != MIDPOINT || taken <= rounding,
                    "{experiment:?}: {balance:?} at {step}"
                );
                std::mem::swap(&mut old, &mut new);
            }
            worst = max_or_nan(worst, of_run);
        }
    }
    worst
}

#[test]
fn the_energy_falls_and_its_balance_closes_to_round_off() {
    for dt in [1e-4, 1e-3] {
        let residual = largest_residual(1e-13, dt);
        assert!(residual <= 1e-12, "{residual:e} with dt = {dt}");
    }
}

#[test]
fn the_default_tolerance_is_enough_for_the_balance() {
    assert!(
        Settings::default().stopping == Stopping::below(1e-10)
            && Settings::default().start == Start::Extrapolated
    );
    for dt in [1e-4, 1e-3] {
        let residual = largest_residual(1e-10, dt);
        assert!(residual <= 1e-12, "{residual:e} with dt = {dt}");
    }
}

#[test]
fn the_change_of_energy_is_the_difference_of_the_energies() {
    for experiment in EXPERIMENTS {
        for (scheme, mesh) in schemes_and_meshes(30) {
            let mut simulation = simulate(
                &paper(mesh, experiment),
                Stepping {
                    scheme,
                    ..stepping(1e-3)
                },
            );
            for _ in 0..200 {
                let old = simulation.level();
                simulation.step_once().unwrap();
                let new = simulation.level();
                let (before, after) = (
                    simulation.energy(&old).total(),
                    simulation.energy(&new).total(),
                );
                let change = simulation.balance(&old, &new).change;
                assert_eq!(simulation.energy_change(&old, &new), change);
                let Problem {
                    beam, obstacles, ..
                } = *simulation.problem();
                let case = Case {
                    beam,
                    obstacles,
                    scheme,
                    dt: 1e-3,
                    lengths: simulation.lengths().to_vec(),
                };
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
    let mut level = Level::new(3);
    (level.v[1], level.w[2]) = (-1e-3, 1e-3);
    assert!(level.is_slow(1e-3) && !level.is_slow(0.99e-3));
    level.v[1] = 0.0;
    assert!(!level.is_slow(0.99e-3));
    level.w[2] = f64::NAN;
    assert!(!level.is_slow(1.0));
}
