//! The pictures of one run: its displacement over space and time, and its numbers over time.

use convergence_study::chart::{Axis, Chart, Guide, Shade};

use super::{energy_at_rest, obstacle_lines, space_time};
use crate::run::Sample;
use crate::run::history::RunHistory;
use crate::run::simulate::Run;
use crate::scene::Scene;

impl Run {
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
        vec![
            (
                "space-time.svg",
                space_time::chart(&history.frames)
                    .titled(title(scene, "displacement over space and time"))
                    .svg(),
            ),
            ("tip-displacement.svg", self.displacement(scene, history)),
            ("tip-rotation.svg", rotation(scene, history)),
            ("energy.svg", energy(scene, history)),
        ]
    }

    fn displacement(&self, scene: &Scene, history: &RunHistory) -> String {
        let curve = PlottedNumber {
            title: "displacement of the free end",
            axis: "displacement u(1, t)",
            label: "u(1, t)",
            value: |sample| sample.u_tip,
        };
        let chart = Chart {
            guides: obstacle_lines(scene.obstacles),
            bands: vec![Shade {
                label: "in contact".into(),
                intervals: self.contact_phases(),
            }],
            ..curve.over_time(scene, history)
        };
        chart.svg()
    }
}

fn title(scene: &Scene, what: &str) -> String {
    format!("{}: {what}", scene.name)
}

/// A number of each step, and its words.
struct PlottedNumber {
    title: &'static str,
    axis: &'static str,
    label: &'static str,
    value: fn(&Sample) -> f64,
}

impl PlottedNumber {
    fn over_time(&self, scene: &Scene, history: &RunHistory) -> Chart {
        let axis = Axis::linear(format!("{} (dimensionless)", self.axis));
        let mut chart = Chart::empty(Axis::linear("time t"), axis);
        chart.curve(self.label, history.over_time(self.value));
        chart.titled(title(scene, self.title))
    }
}

fn rotation(scene: &Scene, history: &RunHistory) -> String {
    PlottedNumber {
        title: "rotation of the free end",
        axis: "rotation φ(1, t)",
        label: "φ(1, t)",
        value: |sample| sample.phi_tip,
    }
    .over_time(scene, history)
    .svg()
}

fn energy(scene: &Scene, history: &RunHistory) -> String {
    let curve = PlottedNumber {
        title: "energy",
        axis: "energy E",
        label: "E",
        value: |sample| sample.energy,
    };
    let at_rest = energy_at_rest(&scene.beam).map(|value| Guide {
        label: "β²/(4ρ)".into(),
        value,
    });
    let chart = Chart {
        guides: at_rest.into_iter().collect(),
        ..curve.over_time(scene, history)
    };
    chart.svg()
}
