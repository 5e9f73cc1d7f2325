//! The contraction factor in contact, measured against α.

use convergence_study::plots;
use convergence_study::study::{Case, CaseFailure, Check, Figure, Quantity, Table};
use convergence_study::text::number::max_or_nan;
use thermobeam::mesh::Mesh;
use thermobeam::parameters::{Beam, Obstacles};
use thermobeam::simulation::{Initial, Problem};

use super::step::{FixedPointStep, factors};
use super::{Part, Task};
use crate::figures;

/// Iterations after which an iteration with a factor near 1 is given up.
const ITERATIONS: usize = 1000;
/// Increment at which a measurement stops: small enough for the slowest mode to dominate, large against round-off.
const TOLERANCE: f64 = 1e-9;
/// Largest relative difference between measured and predicted factor.
const AGREEMENT: f64 = 0.03;
/// How many times γ the factor α must be to dominate: γ then changes it by a percent at most.
const DOMINANCE: f64 = 100.0;
/// Slope of the beam pressed into the upper obstacle by a fifth of the gap.
const PRESSED: f64 = 0.12;

/// The table `[contraction]`.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Grid {
    pub(super) elements: usize,
    pub(super) dt: Vec<f64>,
    pub(super) epsilon: Vec<f64>,
    pub(super) zeta: Vec<f64>,
}

/// Predicted and measured factor of one step in contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contraction {
    /// The factor α of the contact.
    pub alpha: f64,
    /// The factor γ of the coupling between rotation and displacement.
    pub gamma: f64,
    /// What the fixed point did.
    pub step: FixedPointStep,
}

impl Contraction {
    pub(super) fn not_finite(&self) -> Vec<&'static str> {
        let named = [("alpha", self.alpha), ("gamma", self.gamma)];
        named.into_iter().filter(|(_, value)| !value.is_finite()).map(|(name, _)| name).collect()
    }
}

impl Grid {
    pub(super) fn cases(&self) -> Vec<Case<Task>> {
        let cost = self.elements as f64 * ITERATIONS as f64;
        let mut cases = vec![];
        for &zeta in &self.zeta {
            for &epsilon in &self.epsilon {
                for &dt in &self.dt {
                    let data = Task::Contraction { dt, epsilon, zeta };
                    cases.push(Case { label: name([dt, epsilon, zeta]), cost, data });
                }
            }
        }
        cases
    }
}

fn name([dt, epsilon, zeta]: [f64; 3]) -> String {
    format!("dt = {dt:e}, epsilon = {epsilon:e}, zeta = {zeta}")
}

/// One step of a beam at rest, pressed into the upper obstacle.
pub(super) fn measure(elements: usize, [dt, epsilon, zeta]: [f64; 3]) -> Result<Contraction, CaseFailure> {
    let mesh = Mesh::uniform(elements)?;
    let mut initial = Initial::at_rest(&mesh, 0.0);
    initial.u = mesh.nodes().iter().map(|x| PRESSED * x).collect();
    let beam = Beam { zeta, ..Beam::default() };
    let obstacles = Some(Obstacles { epsilon, ..Obstacles::default() });
    let problem = Problem { beam, obstacles, mesh, initial };
    let [alpha, gamma] = factors(&problem, dt, beam.axial_force(PRESSED * PRESSED));
    Ok(Contraction { alpha, gamma, step: FixedPointStep::run(&problem, dt, TOLERANCE, ITERATIONS)? })
}

/// * `found`: the results, each with its (dt, ε, ζ).
pub(super) fn judge(id: &str, found: &[([f64; 3], &Contraction)]) -> Part {
    let (mut checks, mut rows, mut quantities) = (vec![], vec![], vec![]);
    let mut worst = 0.0;
    for &(at, &Contraction { alpha, gamma, step }) in found {
        let name = name(at);
        let factor = step.contraction.unwrap_or(f64::NAN);
        let deviation = (factor / alpha - 1.0).abs();
        let evidence = format!("alpha {alpha:.5}, measured {factor:.5}");
        if alpha < 1.0 - AGREEMENT && alpha >= DOMINANCE * gamma {
            worst = max_or_nan(worst, deviation);
            let holds = step.converged && deviation <= AGREEMENT;
            checks.push(Check::that(holds, format!("{name}: the contraction factor is alpha"), evidence));
            quantities.push(Quantity { name: format!("contraction, {name}"), value: factor, tolerance: 1e-2 });
        } else if alpha > 1.0 + AGREEMENT {
            checks.push(Check::that(!step.converged, format!("{name}: diverges, since alpha > 1"), evidence));
        }
        let [dt, epsilon, zeta] = at;
        rows.push(vec![
            format!("{dt:e}"),
            format!("{epsilon:e}"),
            zeta.to_string(),
            format!("{alpha:.5}"),
            if step.converged { format!("{factor:.5}") } else { "diverges".to_owned() },
            step.iterations.to_string(),
        ]);
    }
    let head = ["dt", "epsilon", "zeta", "alpha", "measured", "iterations"].map(str::to_owned).to_vec();
    let summary = format!("contraction within {:.1} % of alpha", 100.0 * worst);
    Part {
        headline: summary.clone(),
        summary,
        checks,
        tables: vec![Table { title: "Contraction factor in contact".to_owned(), head, rows }],
        figures: vec![figure(id, found)],
        quantities,
    }
}

fn figure(id: &str, found: &[([f64; 3], &Contraction)]) -> Figure {
    let mut zetas: Vec<f64> = found.iter().map(|([_, _, zeta], _)| *zeta).collect();
    zetas.dedup();
    let series = zetas.iter().map(|zeta| {
        let of_zeta = found.iter().filter(|([_, _, z], _)| z == zeta);
        let points = of_zeta.map(|(_, found)| (found.alpha, found.step.contraction.unwrap_or(f64::NAN))).collect();
        plots::Series { label: format!("ζ = {zeta}"), points }
    });
    let svg = figures::contraction(&figures::Contraction { title: None, series: series.collect() });
    let caption =
        "Contraction factor of the fixed point in contact, measured over predicted; from 1 on it does not converge.";
    Figure { file: format!("{id}-contraction.svg"), caption: caption.to_owned(), svg }
}
