//! Figures of beams, drawn with the harness's canvas: plain data in, a self-contained SVG document out.

mod animation;
mod bifurcation;
mod contraction;
mod scene;

pub use animation::{Animation, animation};
pub use bifurcation::{Branch, bifurcation};
pub use contraction::contraction;
pub use scene::energy_at_rest;

use convergence_study::plots::Guide;
use thermobeam::parameters::Obstacles;

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

/// For each scene of a figure, which [`look`](convergence_study::plots::look::look) it has: an experiment of the paper its own,
/// any other scene one that no experiment has, by its place in the figure.
pub(crate) fn looks<'n>(scenes: impl IntoIterator<Item = &'n str>) -> Vec<usize> {
    let look =
        |(place, name): (usize, &str)| PAPER.iter().position(|known| *known == name).unwrap_or(PAPER.len() + place);
    scenes.into_iter().enumerate().map(look).collect()
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
