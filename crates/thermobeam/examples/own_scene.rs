//! A scene in Rust: a beam with an upward initial velocity between two obstacles.
//!
//! `cargo run -p thermobeam --example own_scene`

#![allow(clippy::disallowed_methods, reason = "an example of the solver alone")]

use std::error::Error;

use thermobeam::mesh::Mesh;
use thermobeam::motion::Motion;
use thermobeam::one_step::{InitialValues, OneStep, Problem, Stepping};
use thermobeam::parameters::{Beam, Obstacles};
use thermobeam::scheme::EULER_CRANK_NICOLSON;
use thermobeam::solve::Settings;

fn main() -> Result<(), Box<dyn Error>> {
    let mesh = Mesh::uniform(100)?;
    let beam = Beam {
        beta: 0.5,
        ..Beam::default()
    };
    let u_t = mesh
        .nodes()
        .iter()
        .map(|x| 20.0 * x * (x - 1.0) * (x - 1.0))
        .collect();
    let initial = InitialValues {
        u_t,
        ..InitialValues::at_rest(&mesh, beam.theta_a)
    };
    let problem = Problem {
        beam,
        obstacles: Some(Obstacles::default()),
        mesh,
        initial,
    };
    let stepping = Stepping {
        scheme: EULER_CRANK_NICOLSON,
        settings: Settings::default(),
        dt: 1e-3,
        loaded: false,
    };

    let mut simulation = OneStep::new(problem, stepping)?;
    let mut level = simulation.level();
    for step in 1..=1000 {
        simulation.step_once()?;
        if step % 100 == 0 {
            simulation.observe(&mut level);
            let (tip, energy) = (
                level.u[level.u.len() - 1],
                simulation.energy(&level).total(),
            );
            println!(
                "t = {:.1}   u(1) = {tip:9.6}   contact force {:8.3}   energy {energy:.6}",
                simulation.t(),
                level.contact_force
            );
        }
    }
    Ok(())
}

#[test]
fn it_runs() {
    main().unwrap();
}
