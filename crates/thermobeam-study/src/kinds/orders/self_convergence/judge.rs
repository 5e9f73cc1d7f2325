//! The verdict: rates of both readings where an order is claimed, and contact where the study is
//! one of contact.

use convergence_study::study::LevelErrors;
use convergence_study::study::levels::{Rates, rate_table};

use super::{SelfConvergence, Traced};
use crate::error::reference::distance_of_curves;
use crate::kinds::prelude::*;
use crate::kinds::tables::Refine;

/// Half-width of the band about the order for quantities that are shown but not claimed.
const SHOWN_TOLERANCE: f64 = 0.1;

/// Relative change that the baseline tolerates in a value of the solution itself.
const VALUE_TOLERANCE: f64 = 1e-8;

/// The part of the finest level's error that the two references may differ by.
const KNOWN: f64 = 1e-2;

/// A difference of two runs, the second on a mesh that is the first's or nested in it; each the
/// maximum over the times compared.
#[derive(Debug)]
pub(super) struct Observable {
    /// The name in study files and tables.
    pub(super) name: &'static str,
    /// The notation of the paper.
    symbol: &'static str,
    /// The order in h for a smooth solution.
    in_space: f64,
    of: fn(&Traced, &Traced) -> f64,
}

static OBSERVABLES: [Observable; 7] = [
    TIP,
    Observable {
        name: "rotation",
        symbol: "φ(1, t)",
        in_space: 2.0,
        of: |a, b| largest(a, b, |a, b| (last(&a.phi) - last(&b.phi)).abs()),
    },
    // The energy (3.9).
    Observable {
        name: "energy",
        symbol: "E",
        in_space: 2.0,
        of: |a, b| distance_of_curves(&a.energies, &b.energies),
    },
    // The largest u(1) over all time levels.
    Observable {
        name: "tip-max",
        symbol: "max u(1, t)",
        in_space: 2.0,
        of: |a, b| (a.tip_range[1] - b.tip_range[1]).abs(),
    },
    // The largest defect of the energy balance in a step; of a fixed number of iterations it has an
    // order of its own.
    Observable {
        name: "balance",
        symbol: "defect of the balance",
        in_space: 2.0,
        of: |a, b| (a.energy_defect - b.energy_defect).abs(),
    },
    // The solutions as functions.
    Observable {
        name: "theorem-3.4",
        symbol: Norm::Theorem34.symbol(),
        in_space: 1.0,
        of: |coarse, fine| functions(coarse, fine)[0],
    },
    // The same norm of their values at the nodes of the coarser mesh.
    Observable {
        name: "superclose",
        symbol: Norm::Superclose.symbol(),
        in_space: 2.0,
        of: |coarse, fine| functions(coarse, fine)[1],
    },
];

const TIP: Observable = Observable {
    name: "tip",
    symbol: "u(1, t)",
    in_space: 2.0,
    of: |a, b| largest(a, b, |a, b| (last(&a.u) - last(&b.u)).abs()),
};

/// The largest over the times compared.
fn largest(coarse: &Traced, fine: &Traced, of: impl Fn(&Level, &Level) -> f64) -> f64 {
    coarse
        .levels
        .iter()
        .zip(&fine.levels)
        .map(|(coarse, fine)| of(coarse, fine))
        .fold(0.0, max_or_nan)
}

fn functions(coarse: &Traced, fine: &Traced) -> [f64; 2] {
    let errors = coarse
        .levels
        .iter()
        .enumerate()
        .map(|(k, level)| fine.errors_of(level, &coarse.mesh, k));
    errors.fold([0.0; 2], |[a, b], [c, d]| {
        [max_or_nan(a, c), max_or_nan(b, d)]
    })
}

fn last(values: &[f64]) -> f64 {
    values.last().copied().unwrap_or(f64::NAN)
}

impl Observable {
    /// Those that a refinement of this axis tells apart: without refinement in space both distances
    /// in the norm of Theorem 3.4 are the same, and the balance of solved steps closes to
    /// round-off.
    pub(super) fn all(axis: Axis, stopping: Stopping) -> impl Iterator<Item = &'static Self> {
        OBSERVABLES
            .iter()
            .filter(move |observable| match observable.name {
                "superclose" => axis != Axis::Time,
                "balance" => stopping.tolerance().is_none(),
                _ => true,
            })
    }

    /// The order for a smooth solution in the step that is refined, in which the scheme has the
    /// order `in_time`.
    fn order(&self, axis: Axis, in_time: f64) -> f64 {
        if axis == Axis::Time {
            in_time
        } else {
            in_time.min(self.in_space)
        }
    }

    /// The difference of two runs; NaN where they cannot be compared.
    fn difference(&self, coarse: &Traced, fine: &Traced) -> f64 {
        let is_nested = fine.mesh.elements().is_multiple_of(coarse.mesh.elements());
        if coarse.levels.len() == fine.levels.len() && is_nested {
            (self.of)(coarse, fine)
        } else {
            f64::NAN
        }
    }
}

/// Each level is compared with the next finer one, or with the reference.
const READINGS: [&str; 2] = ["successive", "reference"];

pub(super) fn judge(study: &SelfConvergence, ran: &[Ran<usize, Traced>]) -> Outcome {
    let (mut rates, mut shown, mut quantities, mut errors) = (vec![], vec![], vec![], vec![]);
    for reading in READINGS {
        let claimed = differences(study, ran, reading, |claim| claim.is_some());
        let judged = claimed.judge();
        quantities.extend(claimed.quantities(&judged));
        rates.extend(judged);
        let others = differences(study, ran, reading, |claim| claim.is_none());
        shown.extend(others.judge());
        append(&mut errors, claimed.errors());
        append(&mut errors, others.errors());
    }
    quantities.extend(values_guarded(study, ran));
    let mut checks = vec![completion(ran, not_finite), reference_known(study, ran)];
    checks.extend(contact(study, ran));
    let mut tables = vec![values(study, ran)];
    if !shown.is_empty() {
        tables.insert(
            0,
            rate_table("Rates shown, not claimed: not needed for a pass", &shown),
        );
    }
    Outcome {
        levels: errors,
        tables,
        figures: vec![to_reference(study, ran, &rates, &shown), tip(study, ran)],
        quantities,
        ..Outcome::new(summary(&rates), rates, checks).summed_up_by_rates("")
    }
}

/// All differences to the reference; the legend marks those without a claim.
fn to_reference(
    study: &SelfConvergence,
    ran: &[Ran<usize, Traced>],
    claimed: &Rates,
    shown: &Rates,
) -> Figure {
    let not_claimed = |name: &str| format!("{name} (not claimed)");
    let mut rates = claimed.to_vec();
    rates.extend(
        shown
            .iter()
            .map(|(name, rate)| (not_claimed(name), rate.clone())),
    );
    let mut differences = differences(study, ran, READINGS[1], |_| true);
    for column in differences
        .columns
        .iter_mut()
        .filter(|column| shown.iter().any(|(name, _)| *name == column.name))
    {
        column.name = not_claimed(&column.name);
        column.symbol = column.symbol.as_deref().map(not_claimed);
    }
    let subject = study.scene.name.clone();
    let caption = "Differences to a run of any order, with the orders of a smooth solution.";
    differences.figure("errors", Some(subject), caption.to_owned(), &rates)
}

/// How far u(1) of each level is from the reference over time.
fn tip(study: &SelfConvergence, ran: &[Ran<usize, Traced>]) -> Figure {
    let reference = study.levels.len();
    let name = |k: usize| match study.axis {
        Axis::Time => format!("{} steps", study.levels[k].1),
        Axis::Space | Axis::Both => format!("n = {}", study.levels[k].0),
    };
    let curve = |level: usize| {
        let distance = |k: usize| (tip_at(ran, level, k) - tip_at(ran, reference, k)).abs();
        let point = |k: usize| (study.t_end * k as f64 / study.samples as f64, distance(k));
        plots::Series::new(name(level), (1..=study.samples).map(point))
    };
    let curves: Vec<_> = (0..reference).map(curve).collect();
    let y = plots::Axis::log("|u(1, t) − reference| (dimensionless)");
    let drawn = plots::history(y, &curves)
        .marked()
        .titled("Each refinement brings the tip nearer to the reference, at all times");
    Figure::new(
        "tip",
        "Distance of u(1, t) to the reference on each level.",
        drawn.draw(),
    )
}

/// Adds errors to those of the same level; the coarsest levels are the first of both.
fn append(levels: &mut Vec<LevelErrors>, more: Vec<LevelErrors>) {
    let mut more = more.into_iter();
    for (known, level) in levels.iter_mut().zip(more.by_ref()) {
        known.errors.extend(level.errors);
        known.without.extend(level.without);
    }
    levels.extend(more);
}

/// Differences of each level to what it is compared with, of the observables whose claim is
/// `wanted`.
fn differences(
    study: &SelfConvergence,
    ran: &[Ran<usize, Traced>],
    reading: &str,
    wanted: impl Fn(Option<&Claim>) -> bool,
) -> Levels {
    let (reference, is_successive) = (study.levels.len(), reading == READINGS[0]);
    let count = if is_successive {
        reference - 1
    } else {
        reference
    };
    let finer = |k: usize| if is_successive { k + 1 } else { reference };
    let column = |(place, observable): (usize, &Observable)| {
        // A norm that is also one of errors has its look wherever it is drawn.
        let norm = Norm::ALL
            .iter()
            .position(|norm| norm.name() == observable.name);
        let claim = study
            .claims
            .iter()
            .find(|(of, _)| of.name == observable.name)
            .map(|(_, claim)| claim);
        let difference =
            |k: usize| Some(observable.difference(found(ran, k)?, found(ran, finer(k))?));
        let smooth = Claim::new(
            observable.order(study.axis, study.order_in_time),
            SHOWN_TOLERANCE,
        );
        wanted(claim).then(|| ErrorColumn {
            name: format!("{}, {reading}", observable.name),
            symbol: Some(observable.symbol.to_owned()),
            errors: (0..count).map(difference).collect(),
            claim: Some(claim.copied().unwrap_or(smooth)),
            look: norm.unwrap_or(Norm::ALL.len() + place),
        })
    };
    let refinement =
        |k: usize| Refine::level(study.levels[k].0, study.levels[k].1, study.step_size(k));
    Levels::new(
        study.axis,
        (0..count).map(refinement),
        Observable::all(study.axis, study.scene.method.stopping())
            .enumerate()
            .filter_map(column),
    )
}

/// The result of a run: the levels, then the references.
fn found(ran: &[Ran<usize, Traced>], run: usize) -> Option<&Traced> {
    ran.get(run)?.ok()
}

fn not_finite(found: &Traced) -> Vec<String> {
    let range = found
        .tip_range
        .iter()
        .any(|tip| !tip.is_finite())
        .then(|| "the range of u(1)".to_owned());
    let mut samples = found.levels.iter().zip(&found.energies);
    let broken = samples.position(|(level, energy)| !(energy.is_finite() && is_finite(level)));
    range
        .into_iter()
        .chain(broken.map(|k| format!("sample {}", k + 1)))
        .collect()
}

/// u(1) of a run at sample `k` from 1; NaN where there is none.
fn tip_at(ran: &[Ran<usize, Traced>], run: usize, k: usize) -> f64 {
    found(ran, run)
        .and_then(|found| found.levels.get(k - 1))
        .map_or(f64::NAN, |level| last(&level.u))
}

/// Tip displacements of the finest level, what Richardson adds to them, and those of the reference.
fn values(study: &SelfConvergence, ran: &[Ran<usize, Traced>]) -> Table {
    let reference = study.levels.len();
    let [before, finest] = [reference - 2, reference - 1];
    let ratio = study.step_size(before) / study.step_size(finest);
    let order = TIP.order(study.axis, study.order_in_time);
    let row = |k: usize| {
        let value = |run: usize| tip_at(ran, run, k);
        let correction = richardson::correction(value(before), value(finest), ratio, order);
        vec![
            format!("{:.4}", study.t_end * k as f64 / study.samples as f64),
            format!("{:.10}", value(finest)),
            format!("{:.10}", value(finest) + correction),
            format!("{:.10}", value(reference)),
            format!("{:.1e}", correction.abs()),
            format!("{:.1e}", (value(finest) - value(reference)).abs()),
        ]
    };
    let head = [
        "t",
        "u(1), finest",
        "extrapolated",
        "reference",
        "error estimated",
        "against reference",
    ];
    Table::new(
        "Tip displacement: finest level, extrapolated, reference",
        head,
        (1..=study.samples).map(row),
    )
}

fn contact(study: &SelfConvergence, ran: &[Ran<usize, Traced>]) -> Option<Check> {
    let obstacles = study.scene.obstacles.filter(|_| study.contact)?;
    let [low, high] = found(ran, study.levels.len()).map_or([f64::NAN; 2], |found| found.tip_range);
    let evidence = format!(
        "u(1) runs from {low:.6} to {high:.6}; the obstacles are at {} and {}",
        obstacles.g1, obstacles.g2
    );
    Some(
        Check::that(
            low < obstacles.g1 || high > obstacles.g2,
            "the tip meets an obstacle",
            evidence,
        )
        .about(Subject::of("contact")),
    )
}

/// Does another discretisation give the same reference, to a small part of the smallest error that
/// is measured with it?
fn reference_known(study: &SelfConvergence, ran: &[Ran<usize, Traced>]) -> Check {
    let reference = study.levels.len();
    let part = |observable: &Observable| {
        let (finest, one, other) = (
            found(ran, reference - 1)?,
            found(ran, reference)?,
            found(ran, reference + 1)?,
        );
        Some(observable.difference(one, other) / observable.difference(finest, one))
    };
    let parts: Vec<(&str, f64)> = study
        .claims
        .iter()
        .map(|(of, _)| (of.name, part(of).unwrap_or(f64::NAN)))
        .collect();
    let worst = parts.iter().map(|(_, part)| *part).fold(0.0, max_or_nan);
    Check::that(
        worst <= KNOWN,
        format!(
            "another discretisation gives the same reference, to {KNOWN:e} of the finest level's error"
        ),
        parts
            .iter()
            .map(|(name, part)| format!("{name} {part:.0e}"))
            .collect::<Vec<_>>()
            .join(", "),
    )
    .about(Subject::of("reference"))
}

/// Values of the finest level.
fn values_guarded(study: &SelfConvergence, ran: &[Ran<usize, Traced>]) -> [Quantity; 3] {
    let (finest, samples) = (study.levels.len() - 1, study.samples);
    let energy = found(ran, finest).and_then(|found| found.energies.get(samples - 1).copied());
    let tip_max = found(ran, finest).map_or(f64::NAN, |found| found.tip_range[1]);
    [
        (format!("tip {samples}"), tip_at(ran, finest, samples)),
        (format!("energy {samples}"), energy.unwrap_or(f64::NAN)),
        ("tip max".to_owned(), tip_max),
    ]
    .map(|(name, value)| {
        Quantity::new(format!("{name}, finest level"), value, VALUE_TOLERANCE)
            .about(Subject::of(name).at("finest level"))
    })
}

impl SelfConvergence {
    /// h of a level, or dt where time alone is refined.
    fn step_size(&self, level: usize) -> f64 {
        match self.axis {
            Axis::Space | Axis::Both => resampled(&self.scene.mesh, self.levels[level].0)
                .map_or(f64::NAN, |mesh| mesh.size()),
            Axis::Time => self.t_end / self.levels[level].1 as f64,
        }
    }
}
