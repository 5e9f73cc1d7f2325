//! Steps allocate no memory: all memory is allocated when a simulation is set up.

use crate::prelude::*;

/// The paper's beam, moving towards its upper obstacle, with or without heat.
fn moving_beam(heated: bool, elements: usize) -> Problem {
    let mut problem = paper(uniform(elements), (0.0, 0.0));
    if !heated {
        problem.beam.a = 0.0;
        problem.initial.theta.fill(0.0);
    }
    problem
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
                let stepping = with(scheme, by(solver), 1e-3);
                let simulation = simulate(&moving_beam(heated, 20), stepping);
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
    let problems = [true, false, true, true, false].map(|heated| moving_beam(heated, 20));
    let mut ensemble = Ensemble::new(
        problems.to_vec(),
        &[1e-3; 5],
        SCHEMES[0],
        Settings::default(),
    )
    .unwrap();
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
        let stepping = Stepping {
            loaded: true,
            ..with(SCHEMES[0], by(solver), 1e-3)
        };
        let mut simulation = simulate(&moving_beam(true, 20), stepping);
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
    let problem = moving_beam(heated, elements);
    let mut kept = None;
    let info = allocation_counter::measure(|| {
        kept = Some(simulate(&problem, with(SCHEMES[0], by(solver), 1e-3)));
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
        let case = format!("{solver:?}, heated: {heated}");
        near(case, per_element, documented as f64, 1.0);
    }
}
