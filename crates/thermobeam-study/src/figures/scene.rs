//! The pictures of a run of a scene, whatever the scheme.

use convergence_study::plots::{self, Axis, Guide, History, Phases, Series, SpaceTime};
use thermobeam::parameters::Beam;

use super::{Animation, animation, obstacle_lines};
use crate::run::motion::Sample;
use crate::run::simulate::Run;
use crate::scene::Scene;

impl Run {
    /// Names of files and their SVG documents: u over space and time, the beam in motion, tip displacement with the obstacles, tip
    /// rotation, energy with its limit β²/(4ρ). None where no frames were kept.
    pub fn pictures(&self, scene: &Scene) -> Vec<(&'static str, String)> {
        let Some(history) = self.history.as_ref().filter(|history| !history.frames.times.is_empty()) else {
            return vec![];
        };
        let title = |what: &str| Some(format!("{}: {what}", scene.name));
        let over_time = |what: &str, y: &str, label: &str, value: fn(&Sample) -> f64| History {
            title: title(what),
            y: Axis::linear(format!("{y} (dimensionless)")),
            series: vec![Series { label: label.into(), points: history.over_time(value) }],
            ..History::default()
        };
        let frames = &history.frames;
        let space_time = plots::space_time(&SpaceTime {
            title: title("displacement over space and time"),
            label: "displacement u (dimensionless)".into(),
            times: frames.times.clone(),
            nodes: frames.points.clone(),
            frames: frames.u.clone(),
        });
        let motion = animation(&Animation {
            title: title("the beam between its obstacles"),
            times: frames.times.clone(),
            nodes: frames.points.clone(),
            frames: frames.u.clone(),
            obstacles: scene.obstacles.map(|obstacles| (obstacles.g1, obstacles.g2)),
            seconds: 20.0,
        });
        let displacement = plots::history(&History {
            guides: obstacle_lines(scene.obstacles),
            phases: Phases { label: "in contact".into(), intervals: self.contact_phases() },
            ..over_time("displacement of the free end", "displacement u(1, t)", "u(1, t)", |sample| sample.u_tip)
        });
        let rotation = over_time("rotation of the free end", "rotation φ(1, t)", "φ(1, t)", |sample| sample.phi_tip);
        let at_rest = energy_at_rest(&scene.beam).map(|value| Guide { label: "β²/(4ρ)".into(), value });
        let energy = plots::history(&History {
            guides: at_rest.into_iter().collect(),
            ..over_time("energy", "energy E", "E", |sample| sample.energy)
        });
        vec![
            ("space-time.svg", space_time),
            ("motion.svg", motion),
            ("tip-displacement.svg", displacement),
            ("tip-rotation.svg", plots::history(&rotation)),
            ("energy.svg", energy),
        ]
    }
}

/// β²/(4ρ), the energy of the straight beam at rest; `None` without a Kirchhoff term.
pub fn energy_at_rest(beam: &Beam) -> Option<f64> {
    (beam.rho > 0.0).then(|| beam.beta * beam.beta / (4.0 * beam.rho))
}
