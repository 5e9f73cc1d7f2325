//! Pictures of a run.

use super::Run;
use crate::figures::SceneMotion;
use crate::scene::Scene;

/// Names of files and their SVG documents; none where no history was recorded.
pub fn figures(scene: &Scene, run: &Run) -> Vec<(&'static str, String)> {
    let Some(record) = &run.record else { return Vec::new() };
    let over_time =
        |value: fn(&super::Sample) -> f64| record.rows.iter().map(|row| (row.sample.t, value(&row.sample))).collect();
    let motion = SceneMotion {
        name: &scene.name,
        beam: &scene.beam,
        obstacles: scene.obstacles,
        u_tip: over_time(|sample| sample.u_tip),
        phi_tip: over_time(|sample| sample.phi_tip),
        energy: over_time(|sample| sample.energy),
        contact: record.contact_phases(),
        times: &record.frames.times,
        points: &record.frames.nodes,
        frames: &record.frames.u,
    };
    motion.pictures()
}
