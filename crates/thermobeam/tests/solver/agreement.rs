//! Different ways to the solution of a step lead to the same one.

use crate::scenes::{EXPERIMENTS, paper, relative_difference, schemes_and_meshes, simulate, stepping};
use thermobeam::simulation::{Initial, Problem, Stepping};
use thermobeam::solve::{Level, Settings, Solver, Start};

/// Runs all experiments twice, side by side, and compares every nodal value at every step.
#[track_caller]
fn agree(one: Settings, other: Settings, dt: f64, steps: usize, allowed: f64) {
    let mut worst = 0.0_f64;
    for experiment in EXPERIMENTS {
        for (scheme, mesh) in schemes_and_meshes(20) {
            let problem = paper(mesh, experiment);
            let mut pair =
                [one, other].map(|settings| simulate(&problem, Stepping { scheme, settings, ..stepping(dt) }));
            for step in 1..=steps {
                for simulation in &mut pair {
                    simulation.advance().unwrap_or_else(|error| panic!("{experiment:?} {}: {error}", scheme.name));
                }
                let [one, other] = pair.each_mut().map(|simulation| simulation.level());
                let difference = relative_difference(&one, &other);
                worst = worst.max(difference);
                assert!(difference <= allowed, "{experiment:?} {} step {step}: {difference:e}", scheme.name);
            }
        }
    }
}

fn tight() -> Settings {
    Settings { tolerance: 1e-13, ..Settings::default() }
}

#[test]
fn newton_and_the_fixed_point_agree() {
    agree(tight(), Settings { solver: Solver::FixedPoint, ..tight() }, 1e-3, 1000, 1e-10);
}

/// (4.1): a step starts from the level before alone, so that a run goes on from a level as if it had begun there.
#[test]
fn the_fixed_point_knows_nothing_but_the_level_before() {
    let settings = Settings { solver: Solver::FixedPoint, ..Settings::default() };
    for (scheme, mesh) in schemes_and_meshes(20) {
        let problem = paper(mesh, EXPERIMENTS[0]);
        let stepping = Stepping { scheme, settings, ..stepping(1e-3) };
        let mut simulation = simulate(&problem, stepping);
        for _ in 0..5 {
            simulation.advance().unwrap();
        }
        let Level { u, v, phi, w, theta, .. } = simulation.level();
        let afresh = Problem { initial: Initial { u, u_t: v, phi, phi_t: w, theta }, ..problem };
        let mut afresh = simulate(&afresh, stepping);
        for _ in 0..5 {
            assert_eq!(simulation.advance(), afresh.advance());
            assert_eq!(simulation.level(), afresh.level(), "{}", scheme.name);
        }
    }
}

#[test]
fn the_start_of_the_iteration_does_not_change_the_answer() {
    agree(tight(), Settings { start: Start::Previous, ..tight() }, 1e-3, 1000, 1e-10);
    agree(tight(), Settings { start: Start::Previous, ..tight() }, 2e-2, 200, 1e-10);
}
