//! The first discretisation of a search.

use thermobeam::dg::{DgStepping, MAX_TIME_DEGREE};
use thermobeam::mesh::Mesh;
use thermobeam::parameters::Beam;

use super::curves::Wanted;
use super::data::{GRADING, add_node};
use crate::scene::{Method, Scene};

/// Longest step for an error of 1e-5: a tenth of the shortest period that carries much energy.
const LONGEST: f64 = 0.02;

/// Upper bound on the first time steps, in units of the time in which the fastest wave grows by e.
const RISE: f64 = 2.0;

/// Shortest of the equal elements of the first mesh.
const SHORTEST: f64 = 1.0 / 48.0;

/// A node this close to one that is kept, in units of the distance from x = 1, is left out.
const CLOSE: f64 = 0.2;

/// Axial force below which short waves grow.
const SHORT_WAVES_GROW: f64 = -1.0;

/// Time scale t* of the peak of an impact; without obstacles, the longest step.
pub(super) fn impact(scene: &Scene) -> f64 {
    scene
        .obstacles
        .map_or(LONGEST, |obstacles| obstacles.impact_time(scene.beam.zeta))
}

/// The first discretisation, from experience with the scenes of the paper: two degrees in space for
/// every decimal digit, half a degree in time, and steps that shrink by two for every four digits.
///
/// * `kept`: nodes that the mesh must have.
pub(super) fn first(scene: &Scene, wanted: &Wanted, kept: &[f64]) -> Scene {
    let digits = (-wanted.tolerance[0].log10()).clamp(1.0, 11.0);
    let shrink = 10.0_f64.powf(-(digits - 5.0).max(0.0) / 11.0);
    let [wave, rise] = short_waves(&scene.beam);
    let dt = (LONGEST * shrink).min(0.125 * scene.t_end).min(RISE * rise);
    let impact = impact(scene);
    let stepping = DgStepping {
        degree: ((0.5 * digits).round() as usize).clamp(1, MAX_TIME_DEGREE),
        dt,
        restart_dt: (0.2 * impact * shrink).min(dt),
        growth: 1.0 + 0.5 * shrink,
        ..DgStepping::default()
    };
    // Width of the layer at x = 1 some four impacts after a touch.
    let layer = (2.0 * (scene.beam.zeta * 4.0 * impact).sqrt()).clamp(1e-3, 0.5);
    let nodes = if scene.obstacles.is_some() {
        graded(layer)
    } else {
        vec![0.0, 1.0]
    };
    // An odd degree has as many unknowns as the even one below it, so only odd degrees are used.
    let degree = (4.0 + 1.2 * digits).round() as usize | 1;
    let nodes = with_nodes(kept, &no_longer(&nodes, 2.0 * degree as f64 * wave));
    // Nodes that increase from 0 to 1.
    let mesh = Mesh::from_nodes(nodes).unwrap_or_else(|_| scene.mesh.clone());
    Scene {
        mesh,
        degree,
        method: Method::Dg(stepping),
        ..scene.clone()
    }
}

/// 1/k of the shortest wave that still grows faster, and the time in which it grows by e, at the
/// axial force at rest: infinite if no wave grows.
fn short_waves(beam: &Beam) -> [f64; 2] {
    let beyond = (SHORT_WAVES_GROW - beam.beta).max(0.0);
    [beam.zeta / beyond.sqrt(), beam.zeta / beyond]
}

/// The nodes, with equidistant nodes added wherever they are further apart than `length`.
fn no_longer(nodes: &[f64], length: f64) -> Vec<f64> {
    let length = length.max(SHORTEST);
    let mut divided = vec![];
    for ends in nodes.windows(2) {
        let [from, to] = [ends[0], ends[1]];
        let parts = ((to - from) / length).ceil().max(1.0);
        for part in 0..parts as usize {
            divided.push(from + (to - from) * (part as f64 / parts));
        }
    }
    divided.push(1.0);
    divided
}

/// Nodes that are kept, and those others that are not close to them, measured by their distance
/// from x = 1.
fn with_nodes(kept: &[f64], others: &[f64]) -> Vec<f64> {
    let mut nodes = vec![0.0, 1.0];
    for &x in kept {
        add_node(&mut nodes, x, f64::MIN_POSITIVE);
    }
    for &x in &others[1..others.len() - 1] {
        add_node(&mut nodes, x, CLOSE * (1.0 - x));
    }
    nodes
}

/// Elements towards x = 1 that grow by [`GRADING`] away from it; the last one has the given width.
fn graded(layer: f64) -> Vec<f64> {
    let widths = std::iter::successors(Some(layer), |width| Some(GRADING * width));
    let inner: Vec<f64> = widths
        .take_while(|width| *width <= 0.5)
        .map(|width| 1.0 - width)
        .collect();
    let ends = [0.0].into_iter().chain(inner.into_iter().rev());
    ends.chain([1.0]).collect()
}
