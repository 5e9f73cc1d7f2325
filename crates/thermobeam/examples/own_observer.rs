//! An observer that finds the impacts of the tip and the energy lost in each.
//!
//! `cargo run -p thermobeam --example own_observer`

#![allow(clippy::disallowed_methods, reason = "an example of the solver alone")]

use std::error::Error;

use thermobeam::mesh::Mesh;
use thermobeam::motion::Motion;
use thermobeam::one_step::{InitialValues, OneStep, Problem, Stepping};
use thermobeam::parameters::{Beam, Obstacles};
use thermobeam::scheme::MIDPOINT;
use thermobeam::solve::{Settings, TimeLevel};

/// Collects the impacts from the levels of a run.
#[derive(Default)]
struct Impacts {
    touching: bool,
    before: f64,
    found: Vec<(f64, f64)>,
}

impl Impacts {
    /// Updates the list of impacts: time of separation, and loss of energy.
    fn observe(&mut self, t: f64, level: &TimeLevel, energy: f64) {
        let touching = level.contact_force != 0.0;
        match (self.touching, touching) {
            (false, true) => self.before = energy,
            (true, false) => self.found.push((t, self.before - energy)),
            _ => {}
        }
        self.touching = touching;
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let mesh = Mesh::uniform(50)?;
    let initial = InitialValues {
        u_t: mesh.nodes().to_vec(),
        ..InitialValues::at_rest(&mesh, 0.0)
    };
    let problem = Problem {
        beam: Beam::default(),
        obstacles: Some(Obstacles::default()),
        mesh,
        initial,
    };
    let stepping = Stepping {
        scheme: MIDPOINT,
        settings: Settings::default(),
        dt: 1e-3,
        loaded: false,
    };

    let (mut simulation, mut impacts) = (OneStep::new(problem, stepping)?, Impacts::default());
    let mut level = simulation.level();
    for _ in 0..5000 {
        simulation.step_once()?;
        simulation.observe(&mut level);
        impacts.observe(simulation.t(), &level, simulation.energy(&level).total());
    }
    for (t, loss) in &impacts.found {
        println!("separation at t = {t:.3}, energy loss {loss:.3e}");
    }
    // No impact increases the energy.
    assert!(!impacts.found.is_empty() && impacts.found.iter().all(|(_, loss)| *loss > 0.0));
    Ok(())
}

#[test]
fn it_runs() {
    main().unwrap();
}
