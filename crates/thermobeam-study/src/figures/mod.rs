//! Figures of beams, drawn with the harness's canvas: plain data in, a self-contained SVG document out.

mod animation;
mod bifurcation;
mod contraction;
mod looks;
mod scene;

pub use animation::{Animation, animation};
pub use bifurcation::{Bifurcation, Branch, bifurcation};
pub use contraction::{Contraction, contraction};
pub(crate) use looks::looks;
pub use scene::{SceneMotion, energy_at_rest};

use convergence_study::plots::Guide;
use thermobeam::parameters::Obstacles;

/// A line for each obstacle.
pub(crate) fn obstacle_lines(obstacles: Option<Obstacles>) -> Vec<Guide> {
    let line = |label: &str, value: f64| Guide { label: label.to_owned(), value };
    obstacles.map_or(vec![], |obstacles| vec![line("g₁", obstacles.g1), line("g₂", obstacles.g2)])
}
