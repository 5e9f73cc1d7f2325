//! The paper's first experiment with elements of degree p and steps of degree q: ten digits of
//! u(1, 1) in milliseconds.
//!
//! `cargo run --release -p thermobeam --example any_order`

#![allow(clippy::disallowed_methods, reason = "an example of the solver alone")]

use std::error::Error;
use std::f64::consts::PI;
use std::time::Instant;

use thermobeam::dg::{Dg, DgProblem, DgStepping, Field, InitialFunctions};
use thermobeam::mesh::Mesh;
use thermobeam::motion::Motion;
use thermobeam::parameters::{Beam, Obstacles};

/// u(1, 1), by three discretisations that agree in all digits.
const REFERENCE: f64 = -0.011764243810;

fn experiment(degree: usize) -> Result<DgProblem, Box<dyn Error>> {
    let initial = InitialFunctions {
        u: Box::new(|x| 0.01 * x * (x - 2.0)),
        u_t: Box::new(|x| 20.0 * x * (x - 1.0) * (x - 1.0)),
        theta: Box::new(|x| (PI * x).sin()),
        ..InitialFunctions::at_rest(0.0)
    };
    let mesh = Mesh::uniform(1)?;
    Ok(DgProblem {
        beam: Beam::default(),
        obstacles: Some(Obstacles::default()),
        mesh,
        degree,
        initial,
    })
}

fn main() -> Result<(), Box<dyn Error>> {
    println!("   p  q     dt           u(1, 1)    error  steps  solves  factors   ms");
    for (p, q, dt) in [
        (10, 1, 0.02),
        (12, 2, 0.02),
        (14, 2, 0.02),
        (16, 2, 0.02),
        (16, 2, 0.01),
        (16, 3, 0.02),
    ] {
        let mut simulation = Dg::new(
            experiment(p)?,
            DgStepping {
                degree: q,
                dt,
                ..DgStepping::default()
            },
        )?;
        let start = Instant::now();
        simulation.advance(1.0)?;
        let time = start.elapsed().as_secs_f64();
        let u = simulation
            .value(Field::U, 1.0, 1.0)
            .ok_or("the last step ends at 1")?;
        let work = simulation.work();
        println!(
            "{p:4} {q:2} {dt:6} {u:17.12} {:8.1e} {:6} {:7} {:8} {:6.2}",
            (u - REFERENCE).abs(),
            simulation.steps(),
            work.passes,
            work.factorizations,
            1e3 * time
        );
    }
    let mut simulation = Dg::new(
        experiment(16)?,
        DgStepping {
            degree: 3,
            ..DgStepping::default()
        },
    )?;
    simulation.advance(10.0)?;
    for event in simulation.events() {
        println!("t = {:.10}   {:?} -> {:?}", event.t, event.from, event.to);
    }
    let tip = |field| simulation.value(field, 1.0, 10.0).unwrap_or(f64::NAN);
    let [u, phi, w] = [Field::U, Field::Phi, Field::W].map(tip);
    println!("u(1, 10) = {u:.12}   phi(1, 10) = {phi:.12}   phi_t(1, 10) = {w:.10}");
    Ok(())
}

#[test]
fn it_runs() {
    main().unwrap();
}
