//! Cases in lanes get the bits that they get alone, and a case that fails does not touch the others.

use thermobeam::ensemble::Ensemble;
use thermobeam::error::StepFailure;
use thermobeam::mesh::Mesh;
use thermobeam::parameters::{Beam, Obstacles};
use thermobeam::scheme::{EULER_CRANK_NICOLSON, SCHEMES};
use thermobeam::simulation::{Initial, Problem, Simulation, Stepping};
use thermobeam::solve::Settings;

/// Four beams that differ in everything, so that some need a second pass or the safeguarded iteration where others do not.
fn problem(k: usize) -> Problem {
    let grading = 0.1 * k as f64;
    let mesh = Mesh::mapped(20, |s| (1.0 - grading) * s + grading * s * s).unwrap();
    let nodes = mesh.nodes().to_vec();
    let on = |f: &dyn Fn(f64) -> f64| nodes.iter().map(|&x| f(x)).collect::<Vec<_>>();
    let theta_a = [0.0, 20.0, -3.0, 0.0][k];
    let initial = Initial {
        u: on(&|x| 0.01 * x * (x - 2.0)),
        u_t: on(&|x| 20.0 * x * (x - 1.0) * (x - 1.0)),
        theta: on(&|x| theta_a * (1.0 - x) + (3.0 * x * (1.0 - x))),
        ..Initial::at_rest(&mesh, 0.0)
    };
    let beam = Beam { beta: [-0.5, 0.0, 5.0, 1.0][k], rho: [1.0, 0.0, 1e4, 10.0][k], theta_a, ..Beam::default() };
    let obstacles = (k != 3).then(Obstacles::default);
    Problem { beam, obstacles, mesh, initial }
}

const DT: [f64; 4] = [1e-4, 1e-3, 1e-2, 0.1];

#[test]
fn a_case_in_a_lane_gets_the_bits_that_it_gets_alone() {
    for scheme in SCHEMES {
        let settings = Settings::default();
        let mut ensemble = Ensemble::new((0..4).map(problem).collect(), DT, scheme, settings).unwrap();
        let mut alone: Vec<Simulation> = (0..4)
            .map(|k| Simulation::new(problem(k), Stepping { scheme, settings, dt: DT[k], loaded: false }).unwrap())
            .collect();
        for _ in 0..200 {
            ensemble.advance();
            for (k, simulation) in alone.iter_mut().enumerate() {
                let report = simulation.advance().unwrap();
                assert_eq!(ensemble.report(k).unwrap(), report, "{}: case {k}", scheme.name);
                let level = simulation.level();
                let mut lane = level.clone();
                lane.u[3] = f64::NAN;
                ensemble.observe(k, &mut lane);
                assert_eq!(lane, level, "{}: case {k}", scheme.name);
            }
        }
    }
}

#[test]
fn a_case_that_fails_keeps_its_last_level_and_leaves_the_others_alone() {
    // At dt = 10 the operator of a beam loaded beyond buckling is not definite.
    let buckled = |k: usize| {
        let mut problem = problem(k);
        if k == 2 {
            problem.beam = Beam { beta: -0.8, theta_a: problem.beam.theta_a, ..Beam::default() };
        }
        problem
    };
    let dt = [1e-4, 1e-3, 10.0, 0.1];
    let settings = Settings::default();
    let mut ensemble = Ensemble::new((0..4).map(buckled).collect(), dt, EULER_CRANK_NICOLSON, settings).unwrap();
    let mut before =
        Simulation::new(buckled(2), Stepping { scheme: EULER_CRANK_NICOLSON, settings, dt: 10.0, loaded: false })
            .unwrap();
    for _ in 0..50 {
        ensemble.advance();
    }
    let error = ensemble.report(2).unwrap_err();
    assert_eq!((error.step, error.t), (1, 10.0));
    assert!(matches!(error.failure, StepFailure::Indefinite { .. }), "{error}");
    let mut lane = before.level();
    ensemble.observe(2, &mut lane);
    assert_eq!(lane, before.level());
    for k in [0, 1, 3] {
        let stepping = Stepping { scheme: EULER_CRANK_NICOLSON, settings, dt: dt[k], loaded: false };
        let mut alone = Simulation::new(problem(k), stepping).unwrap();
        for _ in 0..50 {
            alone.advance().unwrap();
        }
        ensemble.observe(k, &mut lane);
        assert_eq!(lane, alone.level(), "case {k}");
    }
}
