//! Pictures of a run.

use super::{Row, Run, RunHistory};
use crate::figures::{self, Animation};
use crate::scene::Scene;
use convergence_study::plots::{self, Axis, Guide, History, Phases, Series, SpaceTime};

/// Names of files and their SVG documents; none where no history was recorded.
///
/// Tip displacement with the obstacles, tip rotation, energy with its limit β²/(4ρ), u over space and time, the beam in
/// motion.
pub fn figures(scene: &Scene, run: &Run) -> Vec<(&'static str, String)> {
    let Some(history) = &run.history else { return Vec::new() };
    vec![
        ("tip-displacement.svg", tip_displacement(scene, history)),
        ("tip-rotation.svg", tip_rotation(scene, history)),
        ("energy.svg", energy(scene, history)),
        ("space-time.svg", space_time(scene, history)),
        ("motion.svg", motion(scene, history)),
    ]
}

fn tip_displacement(scene: &Scene, history: &RunHistory) -> String {
    let guides = scene.obstacles.map_or(vec![], |obstacles| {
        let guide = |label: &str, value| Guide { label: label.into(), value };
        vec![guide("g₁", obstacles.g1), guide("g₂", obstacles.g2)]
    });
    let title = format!("{}: displacement of the free end", scene.name);
    let y = Axis::linear("displacement u(1, t) (dimensionless)");
    let figure = over_time(title, y, history, "u(1, t)", |row| row.sample.u_tip);
    let phases = Phases { label: "in contact".into(), intervals: history.contact_phases() };
    plots::history(&History { guides, phases, ..figure })
}

fn tip_rotation(scene: &Scene, history: &RunHistory) -> String {
    let title = format!("{}: rotation of the free end", scene.name);
    let y = Axis::linear("rotation φ(1, t) (dimensionless)");
    plots::history(&over_time(title, y, history, "φ(1, t)", |row| row.sample.phi_tip))
}

fn energy(scene: &Scene, history: &RunHistory) -> String {
    let title = format!("{}: energy", scene.name);
    let figure = over_time(title, Axis::linear("energy E (dimensionless)"), history, "E", |row| row.sample.energy);
    let guides = energy_at_rest(scene).map(|value| Guide { label: "β²/(4ρ)".into(), value }).into_iter().collect();
    plots::history(&History { guides, ..figure })
}

/// β²/(4ρ), the energy of the straight beam at rest: where the energy tends to if that state is the one it comes to.
pub fn energy_at_rest(scene: &Scene) -> Option<f64> {
    let beam = &scene.beam;
    (beam.rho > 0.0).then(|| beam.beta * beam.beta / (4.0 * beam.rho))
}

fn over_time(title: String, y: Axis, history: &RunHistory, label: &str, value: impl Fn(&Row) -> f64) -> History {
    let points = history.rows.iter().map(|row| (row.sample.t, value(row))).collect();
    History { title: Some(title), y, series: vec![Series { label: label.into(), points }], ..History::default() }
}

fn space_time(scene: &Scene, history: &RunHistory) -> String {
    let frames = &history.frames;
    plots::space_time(&SpaceTime {
        title: Some(format!("{}: displacement over space and time", scene.name)),
        label: "displacement u (dimensionless)".into(),
        times: frames.times.clone(),
        nodes: frames.nodes.clone(),
        frames: frames.u.clone(),
    })
}

fn motion(scene: &Scene, history: &RunHistory) -> String {
    let frames = &history.frames;
    figures::animation(&Animation {
        title: Some(format!("{}: the beam between its obstacles", scene.name)),
        times: frames.times.clone(),
        nodes: frames.nodes.clone(),
        frames: frames.u.clone(),
        obstacles: scene.obstacles.map(|obstacles| (obstacles.g1, obstacles.g2)),
        seconds: 20.0,
    })
}
