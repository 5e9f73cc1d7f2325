//! What two runs of a study without an exact solution are compared in.

use super::Traced;
use crate::kinds::prelude::*;
use crate::{error::reference::largest_difference, exact::norm::Norm};
use convergence_study::file::Choices;
use thermobeam::solve::{Stopping, TimeLevel};

/// A difference of two runs, the second on a mesh that is the first's or nested in it; each the
/// maximum over the times compared.
#[derive(Debug)]
pub(super) struct Observable {
    /// The name in study files and tables.
    pub(super) name: &'static str,
    /// The notation of the paper.
    pub(super) symbol: &'static str,
    /// The order in h for a smooth solution.
    in_space: f64,
    distance: fn(&Traced, &Traced) -> f64,
}

static OBSERVABLES: [Observable; 7] = [
    TIP,
    Observable {
        name: "rotation",
        symbol: "φ(1, t)",
        in_space: 2.0,
        distance: |a, b| largest(a, b, |a, b| (last(&a.phi) - last(&b.phi)).abs()),
    },
    // The energy (3.9).
    Observable {
        name: "energy",
        symbol: "E",
        in_space: 2.0,
        distance: |a, b| {
            let shared: Vec<f64> = shared(&a.energies, &b.energies).copied().collect();
            largest_difference(&a.energies, &shared)
        },
    },
    // The largest u(1) over all time levels.
    Observable {
        name: "tip-max",
        symbol: "max u(1, t)",
        in_space: 2.0,
        distance: |a, b| (a.tip_range.high - b.tip_range.high).abs(),
    },
    // The largest defect of the energy balance in a step; of a fixed number of iterations it has an
    // order of its own.
    Observable {
        name: "balance",
        symbol: "defect of the balance",
        in_space: 2.0,
        distance: |a, b| (a.energy_defect - b.energy_defect).abs(),
    },
    // The solutions as functions.
    Observable {
        name: "theorem-3.4",
        symbol: Norm::Theorem34.symbol(),
        in_space: 1.0,
        distance: |coarse, fine| functions(coarse, fine)[0],
    },
    // The same norm of their values at the nodes of the coarser mesh.
    Observable {
        name: "superclose",
        symbol: Norm::Superclose.symbol(),
        in_space: 2.0,
        distance: |coarse, fine| functions(coarse, fine)[1],
    },
];

impl Choices for Observable {
    type Value = &'static Self;

    fn all() -> Vec<(&'static str, &'static Self)> {
        OBSERVABLES
            .iter()
            .map(|observable| (observable.name, observable))
            .collect()
    }
}

pub(super) const TIP: Observable = Observable {
    name: "tip",
    symbol: "u(1, t)",
    in_space: 2.0,
    distance: |a, b| largest(a, b, |a, b| (last(&a.u) - last(&b.u)).abs()),
};

/// The largest over the times compared.
fn largest(
    coarse: &Traced,
    fine: &Traced,
    distance: impl Fn(&TimeLevel, &TimeLevel) -> f64,
) -> f64 {
    coarse
        .levels
        .iter()
        .zip(shared(&coarse.levels, &fine.levels))
        .map(|(coarse, fine)| distance(coarse, fine))
        .fold(0.0, max_or_nan)
}

/// What the run with as many times or more has at the times of the other.
fn shared<'f, T>(coarse: &[T], fine: &'f [T]) -> impl Iterator<Item = &'f T> {
    let stride = stride(coarse, fine);
    fine.iter().skip(stride - 1).step_by(stride)
}

/// How many times of the finer run end at one of the other.
fn stride<T>(coarse: &[T], fine: &[T]) -> usize {
    (fine.len() / coarse.len().max(1)).max(1)
}

fn functions(coarse: &Traced, fine: &Traced) -> [f64; 2] {
    let mut largest = [0.0; 2];
    let stride = stride(&coarse.levels, &fine.levels);
    for (k, level) in coarse.levels.iter().enumerate() {
        let [as_functions, at_nodes] = fine.errors_of(level, &coarse.mesh, (k + 1) * stride - 1);
        largest[0] = max_or_nan(largest[0], as_functions);
        largest[1] = max_or_nan(largest[1], at_nodes);
    }
    largest
}

/// The value at the free end.
pub(super) fn last(values: &[f64]) -> f64 {
    values.last().copied().unwrap_or(f64::NAN)
}

impl Observable {
    /// Those that a refinement of this axis tells apart: without refinement in space both distances
    /// in the norm of Theorem 3.4 are the same, and the balance of solved steps closes to
    /// round-off.
    pub(super) fn all(axis: RefinedIn, stopping: Stopping) -> impl Iterator<Item = &'static Self> {
        OBSERVABLES
            .iter()
            .filter(move |observable| match observable.name {
                "superclose" => axis != RefinedIn::Time,
                "balance" => stopping.tolerance().is_none(),
                _ => true,
            })
    }

    /// The order for a smooth solution in the step that is refined, in which the scheme has the
    /// order `in_time`.
    pub(super) fn order(&self, axis: RefinedIn, in_time: f64) -> f64 {
        if axis == RefinedIn::Time {
            in_time
        } else {
            in_time.min(self.in_space)
        }
    }

    /// The difference of two runs; NaN where they cannot be compared.
    pub(super) fn difference(&self, coarse: &Traced, fine: &Traced) -> f64 {
        let is_nested = fine.mesh.elements().is_multiple_of(coarse.mesh.elements());
        let [times, more] = [coarse, fine].map(|run| run.levels.len());
        let has_its_times = times > 0 && more > 0 && more.is_multiple_of(times);
        if has_its_times && is_nested {
            (self.distance)(coarse, fine)
        } else {
            f64::NAN
        }
    }
}
