//! The runs that a budget is made of.

use super::EstimateError;
use crate::run::driver::RunError;
use crate::run::rerun::{at, resampled, traced};
use crate::scene::{Method, Scene};
use thermobeam::error::SetupError;
use thermobeam::mesh::Mesh;
use thermobeam::simulation::Stepping;
use thermobeam::solve::{Settings, Solver};

/// Times at which curves are compared, at most.
const SAMPLES: usize = 200;

/// By how much the tolerance is tightened.
const TIGHTENING: f64 = 100.0;

/// No tolerance is tightened below this: increments of quantities of order 1 are not known better.
const TIGHTEST: f64 = 1e-13;

/// What is read off a run.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Reading {
    /// Smallest and largest u(1) over all levels.
    pub(super) extremes: [f64; 2],
    /// u(1) at the samples.
    pub(super) tip: Vec<f64>,
    /// φ(1) at the samples.
    pub(super) rotation: Vec<f64>,
    /// The energy at the samples.
    pub(super) energy: Vec<f64>,
}

/// All runs of a scene.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Runs {
    /// Elements and steps of the finest runs.
    pub(super) resolution: [usize; 2],
    /// By the scene's own solver and tolerance.
    pub(super) own: Reading,
    /// By Newton's method, tightly: what the others are held against.
    pub(super) tight: Reading,
    /// A half and a quarter of the elements.
    pub(super) space: [Reading; 2],
    /// A half and a quarter of the steps.
    pub(super) time: [Reading; 2],
    /// Nodes moved by a rounding error.
    pub(super) moved: Reading,
}

impl Runs {
    pub(super) fn new(scene: &Scene) -> Result<Self, EstimateError> {
        let elements = scene.mesh.elements().next_multiple_of(4);
        let stepping = named_stepping(scene)?;
        let steps = scene.steps().next_multiple_of(4);
        let samples = (1..=SAMPLES.min(steps / 4)).rev().find(|&k| (steps / 4).is_multiple_of(k)).unwrap_or(1);
        let mesh = |elements| resampled(&scene.mesh, elements);
        let run = |mesh: Result<Mesh, _>, steps: usize, settings: Settings| {
            let method = Method::OneStep(Stepping { settings, ..stepping });
            let scene = Scene { method, ..scene.clone() };
            read(&at(&scene, mesh?, steps, scene.t_end), samples)
        };
        let named = |mesh, steps: usize, settings, name: &str| {
            run(mesh, steps, settings).map_err(|failure| EstimateError { run: name.into(), failure })
        };
        let tolerance = stepping.settings.tolerance;
        let tight = Settings {
            solver: Solver::Newton,
            tolerance: (tolerance / TIGHTENING).max(TIGHTEST).min(tolerance),
            ..stepping.settings
        };
        let fewer = |name: &str, part: usize| format!("1/{part} of the {name}");
        let space = |part| named(mesh(elements / part), steps, tight, &fewer("elements", part));
        let time = |part| named(mesh(elements), steps / part, tight, &fewer("time steps", part));
        Ok(Self {
            resolution: [elements, steps],
            own: named(mesh(elements), steps, stepping.settings, "the scene's own settings")?,
            tight: named(mesh(elements), steps, tight, "a tighter tolerance")?,
            space: [space(2)?, space(4)?],
            time: [time(2)?, time(4)?],
            moved: named(
                mesh(elements).and_then(|mesh| moved(&mesh)),
                steps,
                tight,
                "nodes moved by a rounding error",
            )?,
        })
    }
}

fn named_stepping(scene: &Scene) -> Result<Stepping, EstimateError> {
    let failed = |error: SetupError| EstimateError { run: "the scene's own settings".into(), failure: error.into() };
    scene.one_step().map_err(failed)
}

fn read(scene: &Scene, samples: usize) -> Result<Reading, RunError> {
    let last = scene.mesh.elements();
    let trace =
        traced(scene, samples, |simulation, level| [level.u[last], level.phi[last], simulation.energy(level).total()])?;
    let curve = |k: usize| trace.samples.iter().map(|sample| sample[k]).collect();
    Ok(Reading { extremes: trace.tip, tip: curve(0), rotation: curve(1), energy: curve(2) })
}

/// Every inner node moved by one rounding error of 1, up or down as the bits of its index have it.
fn moved(mesh: &Mesh) -> Result<Mesh, thermobeam::mesh::MeshError> {
    let mut nodes = mesh.nodes().to_vec();
    let last = nodes.len() - 1;
    for (i, node) in nodes.iter_mut().enumerate().take(last).skip(1) {
        *node += if i.count_ones() % 2 == 0 { f64::EPSILON } else { -f64::EPSILON };
    }
    Mesh::from_nodes(nodes)
}
