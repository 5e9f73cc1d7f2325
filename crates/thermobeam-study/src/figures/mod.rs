//! Figures of beams, drawn with the harness's canvas: plain data in, a self-contained SVG document out.

mod animation;
mod bifurcation;
mod contraction;

pub use animation::{Animation, animation};
pub use bifurcation::{Branch, bifurcation};
pub use contraction::contraction;

use convergence_study::plots::{self, Axis, Guide, History, Phases, Series, SpaceTime};
use thermobeam::parameters::{Beam, Obstacles};

use crate::run::motion::Sample;
use crate::run::simulate::Run;
use crate::scene::Scene;

/// The experiments of the paper, in the order of its Section 5.
const PAPER: [&str; 7] = [
    "paper-1-beta-minus-0.5",
    "paper-1-beta-0",
    "paper-1-beta-5",
    "paper-2-beta-minus-0.5",
    "paper-2-beta-0",
    "paper-2-beta-5",
    "paper-3-beta-minus-0.8",
];

/// A line for each obstacle.
pub(crate) fn obstacle_lines(obstacles: Option<Obstacles>) -> Vec<Guide> {
    let line = |label: &str, value: f64| Guide { label: label.to_owned(), value };
    obstacles.map_or(vec![], |obstacles| vec![line("g₁", obstacles.g1), line("g₂", obstacles.g2)])
}

/// The [`look`](convergence_study::plots::look::look) of each scene of a figure: an experiment of the paper has its own; any
/// other scene gets, by its place in the figure, one that no experiment has.
pub(crate) fn looks<'n>(scenes: impl IntoIterator<Item = &'n str>) -> Vec<usize> {
    let look =
        |(place, name): (usize, &str)| PAPER.iter().position(|known| *known == name).unwrap_or(PAPER.len() + place);
    scenes.into_iter().enumerate().map(look).collect()
}

impl Run {
    /// Names of files and their SVG documents: u over space and time, the beam in motion, tip displacement with the obstacles, tip
    /// rotation, energy with its limit β²/(4ρ). None if no frames were kept.
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

/// Energy β²/(4ρ) of the straight beam at rest; `None` without a Kirchhoff term.
pub fn energy_at_rest(beam: &Beam) -> Option<f64> {
    (beam.rho > 0.0).then(|| beam.beta * beam.beta / (4.0 * beam.rho))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_experiment_looks_the_same_in_any_order_and_no_two_scenes_are_alike() {
        let [forwards, backwards] = [looks(PAPER), looks(PAPER.into_iter().rev())];
        assert!(forwards.iter().eq(backwards.iter().rev()));
        assert_eq!(looks(["impact", "paper-1-beta-0", "another"]), [7, 1, 9]);
    }
}
