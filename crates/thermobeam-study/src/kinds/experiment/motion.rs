//! The beam hitting its obstacles, as an animation.

use thermobeam::solve::Level;

use super::Experiment;
use crate::figures::{Animation, animation};
use crate::kinds::untyped::Measured;

/// The time that is shown: both obstacles are hit several times.
pub(super) const SPAN: f64 = 6.0;
/// Parts into which the time is divided, with a frame at each end; what lies between two frames is interpolated.
const PARTS: usize = 100;
/// Seconds that one run of the animation takes: slower than the beam, so that the impacts can be followed.
const SECONDS: f64 = 16.0;

/// Shapes of the beam, kept while it moves: for each node the curve of its displacement.
pub(super) struct Shapes {
    steps: usize,
    stride: usize,
    nodes: Vec<Vec<(f64, f64)>>,
}

impl Shapes {
    /// For a beam with so many nodes and a time step.
    pub(super) fn new(nodes: usize, dt: f64) -> Self {
        let steps = (SPAN / dt).round() as usize;
        Self { steps, stride: (steps / PARTS).max(1), nodes: vec![vec![]; nodes] }
    }

    /// Keeps the level after so many steps, if it is one of the frames.
    pub(super) fn add(&mut self, step: usize, t: f64, level: &Level) {
        if step <= self.steps && step.is_multiple_of(self.stride) {
            self.nodes.iter_mut().zip(&level.u).for_each(|(curve, u)| curve.push((t, *u)));
        }
    }

    /// Puts the curves into what was measured.
    pub(super) fn hand_over(self, measured: &mut Measured) {
        let named = self.nodes.into_iter().enumerate().map(|(i, curve)| (name(i), curve));
        measured.series.extend(named);
    }
}

fn name(node: usize) -> String {
    format!("u at node {node}")
}

/// The animation of an experiment.
pub(super) fn draw(experiment: &Experiment, run: &Measured) -> String {
    let scene = &experiment.scene;
    let nodes = scene.mesh.nodes();
    let curves: Vec<_> = (0..nodes.len()).map(|i| run.curve(&name(i))).collect();
    let times: Vec<f64> = curves.first().map_or(vec![], |curve| curve.iter().map(|(t, _)| *t).collect());
    let at = |frame: usize| curves.iter().filter_map(|curve| Some(curve.get(frame)?.1)).collect();
    animation(&Animation {
        title: Some("The beam between its obstacles".to_owned()),
        frames: (0..times.len()).map(at).collect(),
        times,
        nodes: nodes.to_vec(),
        obstacles: scene.obstacles.map(|obstacles| (obstacles.g1, obstacles.g2)),
        seconds: SECONDS,
    })
}
