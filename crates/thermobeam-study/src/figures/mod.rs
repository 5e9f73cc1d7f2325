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
