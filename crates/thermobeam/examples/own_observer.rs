//! An observer of one's own: when does the free end meet an obstacle, and what does each impact cost?
//!
//! `cargo run -p thermobeam --example own_observer`

use std::error::Error;

use thermobeam::mesh::Mesh;
use thermobeam::parameters::{Beam, Obstacles};
use thermobeam::scheme::MIDPOINT;
use thermobeam::simulation::{Initial, Problem, Simulation, Stepping};
use thermobeam::solve::{Level, Settings};

/// An observer is what you make of the levels that the time loop hands out.
#[derive(Default)]
struct Impacts {
    touching: bool,
    before: f64,
    found: Vec<(f64, f64)>,
}

impl Impacts {
    /// Time and loss of energy of each impact.
    fn observe(&mut self, t: f64, level: &Level, energy: f64) {
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
    let initial = Initial { u_t: mesh.nodes().to_vec(), ..Initial::at_rest(&mesh, 0.0) };
    let problem = Problem { beam: Beam::default(), obstacles: Some(Obstacles::default()), mesh, initial };
    let stepping = Stepping { scheme: MIDPOINT, settings: Settings::default(), dt: 1e-3, loaded: false };

    let (mut simulation, mut impacts) = (Simulation::new(problem, stepping)?, Impacts::default());
    let mut level = simulation.level();
    for _ in 0..5000 {
        simulation.advance()?;
        simulation.observe(&mut level);
        impacts.observe(simulation.t(), &level, simulation.energy(&level).total());
    }
    for (t, loss) in &impacts.found {
        println!("left the obstacle at t = {t:.3}, {loss:.3e} of energy the poorer");
    }
    // Nothing gains energy, not even an impact.
    assert!(!impacts.found.is_empty() && impacts.found.iter().all(|(_, loss)| *loss > 0.0));
    Ok(())
}

#[test]
fn it_runs() {
    main().unwrap();
}
