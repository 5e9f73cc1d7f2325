//! What is compared between two runs of different resolution.

use crate::kinds::untyped::Measured;
use convergence_study::study::Axis;
use convergence_study::text::number::max_or_nan;
use thermobeam::norms::TheoremSquares;
use thermobeam::solve::Level;

/// Names of the fields of a level, in the order in which they are stored.
const FIELDS: [&str; 5] = ["u", "v", "phi", "w", "theta"];

/// A difference of two runs; each the maximum over the times compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Observable {
    /// Of u(1).
    Tip,
    /// Of φ(1).
    Rotation,
    /// Of the energy (3.9).
    Energy,
    /// Of the largest u(1) over all time levels.
    TipMax,
    /// Of the solutions as functions, in the norm of Theorem 3.4.
    Theorem34,
    /// The same of their values at the nodes of the coarser mesh.
    Superclose,
}

impl Observable {
    /// All of them.
    pub const ALL: [Observable; 6] = [
        Observable::Tip,
        Observable::Rotation,
        Observable::Energy,
        Observable::TipMax,
        Observable::Theorem34,
        Observable::Superclose,
    ];

    /// The name in study files and tables.
    pub fn name(self) -> &'static str {
        match self {
            Observable::Tip => "tip",
            Observable::Rotation => "rotation",
            Observable::Energy => "energy",
            Observable::TipMax => "tip-max",
            Observable::Theorem34 => "theorem-3.4",
            Observable::Superclose => "superclose",
        }
    }

    /// The order for a smooth solution.
    pub(super) fn order(self, axis: Axis, scheme_order: f64) -> f64 {
        match (axis, self) {
            (Axis::Space, Observable::Theorem34) => 1.0,
            (Axis::Space, _) => 2.0,
            _ => scheme_order,
        }
    }

    /// The difference of two runs, the second on a mesh that is the first's or nested in it; NaN where data are missing.
    pub(super) fn difference(self, coarse: &Measured, fine: &Measured, samples: usize) -> f64 {
        let number = |name: &str| (coarse.value(name) - fine.value(name)).abs();
        let largest = |f: &dyn Fn(usize) -> f64| (1..=samples).map(f).fold(0.0, max_or_nan);
        match self {
            Observable::TipMax => number("tip max"),
            Observable::Tip => largest(&|k| number(&format!("tip {k}"))),
            Observable::Rotation => largest(&|k| number(&format!("rotation {k}"))),
            Observable::Energy => largest(&|k| number(&format!("energy {k}"))),
            Observable::Theorem34 => largest(&|k| between(coarse, fine, k, true)),
            Observable::Superclose => largest(&|k| between(coarse, fine, k, false)),
        }
    }
}

/// Stores what is compared at sample `k`.
pub(super) fn store(measured: &mut Measured, k: usize, nodes: &[f64], level: &Level, energy: f64) {
    let last = nodes.len() - 1;
    measured.push(format!("tip {k}"), level.u[last]);
    measured.push(format!("rotation {k}"), level.phi[last]);
    measured.push(format!("energy {k}"), energy);
    let fields = [&level.u, &level.v, &level.phi, &level.w, &level.theta];
    for (name, values) in FIELDS.iter().zip(fields) {
        let curve = nodes.iter().copied().zip(values.iter().copied()).collect();
        measured.series.push((format!("{name} {k}"), curve));
    }
}

/// The distance of two runs at sample `k` in the norm of Theorem 3.4: of the functions themselves (`whole`), which are
/// both P1 on the finer mesh, or of their values at the nodes of the coarser mesh.
fn between(coarse: &Measured, fine: &Measured, k: usize, whole: bool) -> f64 {
    let mut differences: [Vec<f64>; 5] = Default::default();
    let mut nodes: Vec<f64> = vec![];
    for (name, difference) in FIELDS.iter().zip(&mut differences) {
        let name = format!("{name} {k}");
        let (few, many) = (coarse.curve(&name), fine.curve(&name));
        let ratio = many.len().saturating_sub(1) / few.len().saturating_sub(1).max(1);
        if few.is_empty() || ratio == 0 {
            return f64::NAN;
        }
        let every = if whole { 1 } else { ratio };
        let at = (0..many.len()).step_by(every);
        *difference = at.clone().map(|j| interpolated(few, j, ratio, many[j].0) - many[j].1).collect();
        nodes = at.map(|j| many[j].0).collect();
    }
    let lengths: Vec<f64> = nodes.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let [u, v, phi, w, theta] = &differences;
    TheoremSquares::of(&lengths, v, u, w, phi, theta).norm()
}

/// The coarse function at node `j` of a mesh that has `ratio` elements in each of its own.
fn interpolated(coarse: &[(f64, f64)], j: usize, ratio: usize, x: f64) -> f64 {
    let (left, inside) = (j / ratio, j % ratio);
    if inside == 0 {
        return coarse[left].1;
    }
    let ((x0, y0), (x1, y1)) = (coarse[left], coarse[left + 1]);
    y0 + (y1 - y0) * (x - x0) / (x1 - x0)
}
