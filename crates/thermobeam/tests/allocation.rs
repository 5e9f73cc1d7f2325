//! Steps allocate no memory: all memory is allocated when a simulation is set up.

use std::f64::consts::PI;
use thermobeam::ensemble::Ensemble;
use thermobeam::mesh::Mesh;
use thermobeam::one_step::{BYTES_PER_ELEMENT, InitialValues, OneStep, Problem, Stepping};
use thermobeam::parameters::{Beam, Obstacles};
use thermobeam::scheme::SCHEMES;
use thermobeam::solve::{Settings, Solver};

/// The paper's beam, moving towards its upper obstacle, with or without heat.
fn moving_beam(heated: bool) -> Problem {
    let mesh = Mesh::uniform(20).unwrap();
    let mut initial = InitialValues::at_rest(&mesh, 0.0);
    let mut beam = Beam::default();
    for (i, &x) in mesh.nodes().iter().enumerate() {
        initial.u_t[i] = 20.0 * x * (x - 1.0) * (x - 1.0);
        if heated {
            initial.theta[i] = (PI * x).sin();
        }
    }
    if !heated {
        beam.a = 0.0;
    }
    Problem {
        beam,
        obstacles: Some(Obstacles::default()),
        mesh,
        initial,
    }
}

/// Number of allocations in 500 steps with their energies and balances, and number of steps that
/// end in contact.
fn allocations(mut simulation: OneStep) -> (u64, usize) {
    let mut levels = [simulation.level(), simulation.level()];
    let mut touching = 0;
    let info = allocation_counter::measure(|| {
        for _ in 0..500 {
            if let Some(load) = simulation.load_mut() {
                load[1][2] = 1.0;
            }
            simulation.step_once().unwrap();
            let [old, new] = &mut levels;
            simulation.observe(new);
            let energy = simulation.energy(new).total() + simulation.balance(old, new).residual;
            assert!(energy.is_finite());
            touching += usize::from(new.contact_force != 0.0);
            levels.swap(0, 1);
        }
    });
    (info.count_total, touching)
}

#[test]
fn the_time_loop_allocates_nothing() {
    for scheme in SCHEMES {
        for solver in Solver::ALL {
            for heated in [false, true] {
                let settings = Settings {
                    solver,
                    ..Settings::default()
                };
                let stepping = Stepping {
                    scheme,
                    settings,
                    dt: 1e-3,
                    loaded: false,
                };
                let simulation = OneStep::new(moving_beam(heated), stepping).unwrap();
                let (count, touching) = allocations(simulation);
                assert_eq!(count, 0, "{} {solver:?} heated: {heated}", scheme.name);
                assert!(
                    touching > 10,
                    "expected contact in more than 10 steps, found {touching}"
                );
            }
        }
    }
}

#[test]
fn lanes_with_their_balances_allocate_nothing() {
    let (problems, dt) = (
        [true, false, true, true, false].map(moving_beam).to_vec(),
        [1e-3; 5],
    );
    let mut ensemble = Ensemble::new(problems, &dt, SCHEMES[0], Settings::default()).unwrap();
    let mut balances = Vec::with_capacity(5);
    let info = allocation_counter::measure(|| {
        for _ in 0..500 {
            ensemble.step_once();
            ensemble.balances(&mut balances);
            assert!(balances.iter().all(|balance| balance.residual.abs() < 1e-9));
        }
    });
    assert_eq!(info.count_total, 0);
}

#[test]
fn loads_are_allocated_once() {
    for solver in Solver::ALL {
        let settings = Settings {
            solver,
            ..Settings::default()
        };
        let stepping = Stepping {
            scheme: SCHEMES[0],
            settings,
            dt: 1e-3,
            loaded: true,
        };
        let mut simulation = OneStep::new(moving_beam(true), stepping).unwrap();
        simulation.load_mut();
        assert_eq!(allocations(simulation).0, 0, "{solver:?}");
    }
}

#[test]
fn the_allocation_counter_counts() {
    let info = allocation_counter::measure(|| drop(std::hint::black_box(vec![0u8; 100])));
    assert_eq!(info.count_total, 1);
}

/// Bytes of a simulation with the given number of elements, its data included.
fn bytes(elements: usize, solver: Solver, heated: bool) -> i64 {
    let problem = Problem {
        mesh: Mesh::uniform(elements).unwrap(),
        initial: InitialValues::at_rest(&Mesh::uniform(elements).unwrap(), 0.0),
        ..moving_beam(heated)
    };
    let settings = Settings {
        solver,
        ..Settings::default()
    };
    let stepping = Stepping {
        scheme: SCHEMES[0],
        settings,
        dt: 1e-3,
        loaded: false,
    };
    let mut kept = None;
    let info = allocation_counter::measure(|| {
        kept = Some(OneStep::new(problem.clone(), stepping).unwrap());
    });
    assert!(kept.is_some());
    info.bytes_current
}

#[test]
fn memory_grows_with_the_elements_as_documented() {
    for (solver, heated, documented) in [
        (Solver::Newton, true, BYTES_PER_ELEMENT),
        (Solver::Newton, false, 256),
        (Solver::FixedPoint, true, 248),
    ] {
        let per_element =
            (bytes(3000, solver, heated) - bytes(1000, solver, heated)) as f64 / 2000.0;
        assert!(
            (per_element - documented as f64).abs() < 1.0,
            "{solver:?}, heated: {heated}: {per_element}"
        );
    }
}
