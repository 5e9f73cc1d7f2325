//! The verdict: rates of both readings where an order is claimed, and contact where the study is one of contact.

use convergence_study::judge::verdict::RateVerdict;
use convergence_study::study::levels::{self, Claim, ErrorColumn, Levels, Refinement};
use convergence_study::study::{Axis, Check, Figure, LevelErrors, Outcome, Quantity, Ran, Table};

use super::{Observable, Resolution, Run, Sample, SelfConvergence, Traced, figures};
use crate::kinds::tables::Refine;
use crate::run::rerun::resampled;
use convergence_study::judge::richardson;
use convergence_study::text::number::max_or_nan;

/// Half-width of the band about the order for quantities that are shown but not claimed.
const SHOWN_TOLERANCE: f64 = 0.1;

/// Relative change that the baseline tolerates in a value of the solution itself.
const VALUE_TOLERANCE: f64 = 1e-8;

/// The part of the finest level's error that the two references may differ by.
const KNOWN: f64 = 1e-2;

pub(super) type Found = Ran<Run, Traced>;

/// Which run a level is compared with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Reading {
    /// The next finer one.
    Successive,
    /// The reference.
    Reference,
}

impl Reading {
    const ALL: [Reading; 2] = [Reading::Successive, Reading::Reference];

    fn name(self) -> &'static str {
        match self {
            Reading::Successive => "successive",
            Reading::Reference => "reference",
        }
    }
}

pub(super) fn judge(study: &SelfConvergence, ran: &[Found]) -> Outcome {
    let (mut rates, mut shown, mut quantities, mut errors) = (vec![], vec![], vec![], vec![]);
    for reading in Reading::ALL {
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
    let mut checks = vec![levels::completion(ran, not_finite)];
    checks.push(reference_known(study, ran));
    checks.extend(contact(study, ran));
    let mut tables = vec![values(study, ran)];
    if !shown.is_empty() {
        tables.insert(0, levels::rate_table("Rates shown, not claimed: not needed for a pass", &shown));
    }
    Outcome {
        levels: errors,
        tables,
        figures: vec![to_reference(study, ran, &rates, &shown), figures::tip(study, ran)],
        quantities,
        ..Outcome::new(levels::summary(&rates), rates, checks)
    }
}

/// All differences to the reference; of those of which nothing is claimed, the legend says so.
fn to_reference(
    study: &SelfConvergence,
    ran: &[Found],
    claimed: &[(String, RateVerdict)],
    shown: &[(String, RateVerdict)],
) -> Figure {
    let not_claimed = |name: &str| format!("{name} (not claimed)");
    let mut rates = claimed.to_vec();
    rates.extend(shown.iter().map(|(name, rate)| (not_claimed(name), rate.clone())));
    let mut differences = differences(study, ran, Reading::Reference, |_| true);
    for column in differences.columns.iter_mut().filter(|column| shown.iter().any(|(name, _)| *name == column.name)) {
        column.name = not_claimed(&column.name);
    }
    differences.figure(
        format!("{}-errors.svg", study.header.id),
        Some(format!("Differences to a run of any order: {}", study.scene.name)),
        "Differences to a run of any order, with the orders of a smooth solution.".to_owned(),
        &rates,
    )
}

/// Adds errors to those of the same level; the coarsest levels are the first of both.
fn append(levels: &mut Vec<LevelErrors>, more: Vec<LevelErrors>) {
    for (k, level) in more.into_iter().enumerate() {
        match levels.get_mut(k) {
            Some(known) => {
                known.errors.extend(level.errors);
                known.without.extend(level.without);
            }
            None => levels.push(level),
        }
    }
}

/// Differences of each level to what the reading compares it with, of the observables whose claim is `wanted`.
fn differences(
    study: &SelfConvergence,
    ran: &[Found],
    reading: Reading,
    wanted: impl Fn(Option<&Claim>) -> bool,
) -> Levels {
    let reference = study.levels.len();
    let count = if reading == Reading::Successive { reference - 1 } else { reference };
    let finer = |k: usize| if reading == Reading::Successive { k + 1 } else { reference };
    let found = |k: usize| ran.get(k).and_then(Ran::ok);
    let column = |observable: Observable| {
        let claim = study.claim(observable);
        let difference = |k: usize| match (found(k), found(finer(k))) {
            (Some(coarse), Some(fine)) => Some(observable.difference(coarse, fine)),
            _ => None,
        };
        let smooth = Claim { order: observable.order(study.axis, study.order_in_time()), tolerance: SHOWN_TOLERANCE };
        wanted(claim).then(|| ErrorColumn {
            name: format!("{}, {}", observable.name(), reading.name()),
            errors: (0..count).map(difference).collect(),
            claim: Some(claim.copied().unwrap_or(smooth)),
            look: observable.look(),
        })
    };
    Levels {
        axis: study.axis,
        refinements: study.levels.iter().take(count).map(|&level| refinement(study, level)).collect(),
        columns: Observable::of(study.axis).filter_map(column).collect(),
    }
}

fn refinement(study: &SelfConvergence, level: Resolution) -> Refinement {
    let Resolution { elements, steps } = level;
    Refinement {
        label: Refine::label(elements, steps),
        parameters: [("elements", elements), ("steps", steps)]
            .map(|(name, count)| (name.to_owned(), count as f64))
            .into(),
        step: study.step(level),
    }
}

fn not_finite(found: &Traced) -> Vec<String> {
    let finite = |sample: &Sample| {
        let level = &sample.level;
        let fields = [&level.u, &level.v, &level.phi, &level.w, &level.theta];
        sample.energy.is_finite() && fields.into_iter().flatten().all(|value| value.is_finite())
    };
    let range = found.tip_range.iter().any(|tip| !tip.is_finite()).then(|| "the range of u(1)".to_owned());
    let broken = found.samples.iter().position(|sample| !finite(sample));
    range.into_iter().chain(broken.map(|k| format!("sample {}", k + 1))).collect()
}

/// A number of a run at sample `k` from 1; NaN where there is none.
fn at_sample(ran: &[Found], run: usize, k: usize, number: impl Fn(&Sample) -> f64) -> f64 {
    ran.get(run).and_then(Ran::ok).and_then(|found| found.samples.get(k - 1)).map_or(f64::NAN, number)
}

/// Tip displacements of the finest level, what Richardson adds to them, and those of the reference.
fn values(study: &SelfConvergence, ran: &[Found]) -> Table {
    let reference = study.levels.len();
    let [before, finest] = [reference - 2, reference - 1];
    let ratio = study.step(study.levels[before]) / study.step(study.levels[finest]);
    let order = Observable::Tip.order(study.axis, study.order_in_time());
    let row = |k: usize| {
        let value = |run: usize| at_sample(ran, run, k, Sample::tip);
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
    let head = ["t", "u(1), finest", "extrapolated", "reference", "error estimated", "against reference"];
    Table {
        title: "Tip displacement: finest level, extrapolated, reference".into(),
        head: head.map(str::to_owned).into(),
        rows: (1..=study.samples).map(row).collect(),
    }
}

fn contact(study: &SelfConvergence, ran: &[Found]) -> Option<Check> {
    let obstacles = study.scene.obstacles.filter(|_| study.contact)?;
    let [low, high] = ran.get(study.levels.len()).and_then(Ran::ok).map_or([f64::NAN; 2], |found| found.tip_range);
    let evidence =
        format!("u(1) runs from {low:.6} to {high:.6}; the obstacles are at {} and {}", obstacles.g1, obstacles.g2);
    Some(Check::that(low < obstacles.g1 || high > obstacles.g2, "the tip meets an obstacle", evidence))
}

/// Does another discretisation give the same reference, to a small part of the smallest error that is measured with it?
fn reference_known(study: &SelfConvergence, ran: &[Found]) -> Check {
    let found = |k: usize| ran.get(study.levels.len() + k).and_then(Ran::ok);
    let finest = ran.get(study.levels.len() - 1).and_then(Ran::ok);
    let part = |&(observable, _): &(Observable, Claim)| {
        let (Some(finest), Some(one), Some(other)) = (finest, found(0), found(1)) else { return f64::NAN };
        observable.difference(one, other) / observable.difference(finest, one)
    };
    let parts: Vec<f64> = study.claims.iter().map(part).collect();
    let worst = parts.iter().copied().fold(0.0, max_or_nan);
    let named =
        study.claims.iter().zip(&parts).map(|((observable, _), part)| format!("{} {part:.0e}", observable.name()));
    Check::that(
        worst <= KNOWN,
        format!("another discretisation gives the same reference, to {KNOWN:e} of the finest level's error"),
        named.collect::<Vec<_>>().join(", "),
    )
}

/// Values of the finest level.
fn values_guarded(study: &SelfConvergence, ran: &[Found]) -> Vec<Quantity> {
    let finest = study.levels.len() - 1;
    let last = study.samples;
    let tip_max = ran.get(finest).and_then(Ran::ok).map_or(f64::NAN, |found| found.tip_range[1]);
    let values = [
        (format!("tip {last}"), at_sample(ran, finest, last, Sample::tip)),
        (format!("energy {last}"), at_sample(ran, finest, last, |sample| sample.energy)),
        ("tip max".to_owned(), tip_max),
    ];
    let quantity =
        |(name, value)| Quantity { name: format!("{name}, finest level"), value, tolerance: VALUE_TOLERANCE };
    values.into_iter().map(quantity).collect()
}

impl SelfConvergence {
    fn claim(&self, observable: Observable) -> Option<&Claim> {
        self.claims.iter().find(|(claimed, _)| *claimed == observable).map(|(_, claim)| claim)
    }

    /// h, or dt where time alone is refined.
    fn step(&self, level: Resolution) -> f64 {
        match self.axis {
            Axis::Space | Axis::Both => {
                resampled(&self.scene.mesh, level.elements).map_or(f64::NAN, |mesh| mesh.size())
            }
            Axis::Time => self.t_end / level.steps as f64,
        }
    }

    /// The scheme's order in that step: with dt = c h² twice as high.
    fn order_in_time(&self) -> f64 {
        self.scheme.order * self.power
    }
}
