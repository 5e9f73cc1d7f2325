//! What is compared between two runs of different resolution.

use super::Traced;
use crate::error::curve;
use crate::error::levels::{distance, prolong, restrict};
use crate::kinds::prelude::*;

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

    /// Those that a refinement of this axis tells apart: without refinement in space both distances in the norm of Theorem
    /// 3.4 are the same.
    pub(super) fn of(axis: Axis) -> impl Iterator<Item = Observable> {
        Self::ALL.into_iter().filter(move |observable| axis != Axis::Time || *observable != Observable::Superclose)
    }

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

    /// Which look it has in all figures: norms that are also those of errors have the same.
    pub(super) fn look(self) -> usize {
        match self {
            Observable::Theorem34 => Norm::Theorem34 as usize,
            Observable::Superclose => Norm::Superclose as usize,
            other => Norm::ALL.len() + other as usize,
        }
    }

    /// The order for a smooth solution, in dt where time is refined, else in h.
    ///
    /// * `in_time`: the scheme's order in the step that is refined.
    pub(super) fn order(self, axis: Axis, in_time: f64) -> f64 {
        let in_space = if self == Observable::Theorem34 { 1.0 } else { 2.0 };
        if axis == Axis::Time { in_time } else { in_time.min(in_space) }
    }

    /// The difference of two runs, the second on a mesh that is the first's or nested in it; NaN where the runs cannot be
    /// compared.
    pub(super) fn difference(self, coarse: &Traced, fine: &Traced) -> f64 {
        let stride = fine.mesh.elements() / coarse.mesh.elements();
        if coarse.levels.len() != fine.levels.len() || stride * coarse.mesh.elements() != fine.mesh.elements() {
            return f64::NAN;
        }
        let largest = |of: &dyn Fn(&Level, &Level) -> f64| {
            coarse.levels.iter().zip(&fine.levels).map(|(coarse, fine)| of(coarse, fine)).fold(0.0, max_or_nan)
        };
        let [few, many] = [coarse, fine].map(|run| run.mesh.lengths().collect::<Vec<f64>>());
        let extended = |level: &Level| prolong(level, coarse.mesh.nodes(), fine.mesh.nodes());
        match self {
            Observable::TipMax => (coarse.tip_range[1] - fine.tip_range[1]).abs(),
            Observable::Tip => largest(&|a, b| (last(&a.u) - last(&b.u)).abs()),
            Observable::Rotation => largest(&|a, b| (last(&a.phi) - last(&b.phi)).abs()),
            Observable::Energy => curve::distance(&coarse.energies, &fine.energies),
            Observable::Theorem34 => largest(&|a, b| distance(&many, &extended(a), b)),
            Observable::Superclose => largest(&|a, b| distance(&few, a, &restrict(b, stride))),
        }
    }
}

pub(super) fn last(values: &[f64]) -> f64 {
    values.last().copied().unwrap_or(f64::NAN)
}
