//! Pictures of a run.

use super::Run;
use crate::figures::SceneMotion;
use crate::scene::Scene;

/// Names of files and their SVG documents; none where no history was recorded.
pub fn figures(scene: &Scene, run: &Run) -> Vec<(&'static str, String)> {
    let Some(history) = &run.history else { return Vec::new() };
    let over_time =
        |value: fn(&super::Sample) -> f64| history.rows.iter().map(|row| (row.sample.t, value(&row.sample))).collect();
    let motion = SceneMotion {
        name: &scene.name,
        beam: &scene.beam,
        obstacles: scene.obstacles,
        u_tip: over_time(|sample| sample.u_tip),
        phi_tip: over_time(|sample| sample.phi_tip),
        energy: over_time(|sample| sample.energy),
        contact: history.contact_phases(),
        times: &history.frames.times,
        points: &history.frames.nodes,
        frames: &history.frames.u,
    };
    motion.pictures()
}
