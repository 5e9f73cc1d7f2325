//! The pictures of one run: its displacement over space and time, and its numbers over time.

use convergence_study::chart::{Axis, Chart, Guide, Shade};

use super::{energy_at_rest, obstacle_lines, space_time};
use crate::run::Sample;
use crate::run::history::RunHistory;
use crate::run::simulate::Run;
use crate::scene::Scene;

impl Run {
    /// The files of the pictures.
    pub const PICTURES: [&str; 4] = [
        "space-time.svg",
        "tip-displacement.svg",
        "tip-rotation.svg",
        "energy.svg",
    ];

    /// Names of files and their SVG documents: u over space and time, tip displacement with the
    /// obstacles, tip rotation, energy with its limit β²/(4ρ). None if no frames were kept.
    pub fn pictures(&self, scene: &Scene) -> Vec<(&'static str, String)> {
        let Some(history) = self
            .history
            .as_ref()
            .filter(|history| !history.frames.times.is_empty())
        else {
            return vec![];
        };
        let pictures = [
            space_time::chart(&history.frames)
                .titled(title(scene, "displacement over space and time"))
                .svg(),
            self.displacement(scene, history),
            rotation(scene, history),
            energy(scene, history),
        ];
        Self::PICTURES.into_iter().zip(pictures).collect()
    }

    fn displacement(&self, scene: &Scene, history: &RunHistory) -> String {
        let chart = over_time(history, "u(1, t)", "displacement u(1, t)", |now| now.u_tip);
        let chart = Chart {
            guides: obstacle_lines(scene.obstacles),
            bands: vec![Shade {
                label: "in contact".into(),
                intervals: self.contact_phases(),
            }],
            ..chart
        };
        let title = title(scene, "displacement of the free end");
        chart.titled(title).svg()
    }
}

fn title(scene: &Scene, what: &str) -> String {
    format!("{}: {what}", scene.name)
}

/// A number of each step.
fn over_time(history: &RunHistory, label: &str, axis: &str, number: fn(&Sample) -> f64) -> Chart {
    let axis = Axis::linear(format!("{axis} (dimensionless)"));
    let mut chart = Chart::empty(Axis::linear("time t"), axis);
    chart.curve(label, history.over_time(number));
    chart
}

fn rotation(scene: &Scene, history: &RunHistory) -> String {
    over_time(history, "φ(1, t)", "rotation φ(1, t)", |now| now.phi_tip)
        .titled(title(scene, "rotation of the free end"))
        .svg()
}

fn energy(scene: &Scene, history: &RunHistory) -> String {
    let chart = over_time(history, "E", "energy E", |now| now.energy);
    let at_rest = energy_at_rest(&scene.beam).map(|value| Guide {
        label: "β²/(4ρ)".into(),
        value,
    });
    let chart = Chart {
        guides: at_rest.into_iter().collect(),
        ..chart
    };
    chart.titled(title(scene, "energy")).svg()
}
