//! The beam hitting its obstacles, as an animation.

use thermobeam::solve::Level;

use crate::figures::{Animation, animation};
use crate::scene::Scene;

/// The time that is shown: both obstacles are hit several times.
pub(super) const SPAN: f64 = 6.0;
/// Parts into which the time is divided, with a frame at each end; what lies between two frames is interpolated.
const PARTS: usize = 100;
/// Seconds that one run of the animation takes: slower than the beam, so that the impacts can be followed.
const SECONDS: f64 = 16.0;

/// The shape of the beam at one time.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame {
    /// The time.
    pub t: f64,
    /// u at each node.
    pub u: Vec<f64>,
}

/// Shapes of the beam, kept while it moves.
pub(super) struct Shapes {
    steps: usize,
    stride: usize,
    pub(super) frames: Vec<Frame>,
}

impl Shapes {
    /// For a beam with that time step.
    pub(super) fn new(dt: f64) -> Self {
        let steps = (SPAN / dt).round() as usize;
        Self { steps, stride: (steps / PARTS).max(1), frames: vec![] }
    }

    /// Keeps the level after so many steps, if it is one of the frames.
    pub(super) fn add(&mut self, step: usize, t: f64, level: &Level) {
        if step <= self.steps && step.is_multiple_of(self.stride) {
            self.frames.push(Frame { t, u: level.u.clone() });
        }
    }
}

/// The animation of a run of this scene.
pub(super) fn draw(scene: &Scene, frames: &[Frame]) -> String {
    animation(&Animation {
        title: Some("The beam between its obstacles".to_owned()),
        frames: frames.iter().map(|frame| frame.u.clone()).collect(),
        times: frames.iter().map(|frame| frame.t).collect(),
        nodes: scene.mesh.nodes().to_vec(),
        obstacles: scene.obstacles.map(|obstacles| (obstacles.g1, obstacles.g2)),
        seconds: SECONDS,
    })
}
