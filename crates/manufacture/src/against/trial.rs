//! One edit, tried at a few points.

use super::candidates::{Candidate, EditKind};
use super::solve::{self, Curve, Sample, Solved};
use super::text;
use super::whole::Component;
use crate::fit::Column;

/// The points of a trial, and the values there.
pub(super) struct Trial {
    pub(super) points: Vec<Vec<f64>>,
    /// Of each component that is answered.
    pub(super) samples: Vec<Sample>,
    pub(super) is_wrong: Vec<bool>,
}

impl Trial {
    pub(super) fn fits(&self, columns: &[Column]) -> Vec<bool> {
        let samples = self.samples.iter();
        samples
            .map(|sample| sample.fits(&columns[sample.component]))
            .collect()
    }

    pub(super) fn wrong(&self) -> impl Iterator<Item = &Sample> {
        let pairs = self.samples.iter().zip(&self.is_wrong);
        pairs.filter(|pair| *pair.1).map(|pair| pair.0)
    }
}

pub(super) fn sample(component: &Component<'_, '_>, places: &[usize]) -> Sample {
    let places = || places.iter().copied();
    Sample {
        component: component.place.component,
        right: places().map(|place| component.source[place]).collect(),
        foreign: places().map(|place| component.foreign[place]).collect(),
        allowed: places().map(|place| component.allowed[place]).collect(),
    }
}

/// How near an edit comes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Near {
    pub(super) candidate: usize,
    pub(super) factor: f64,
    pub(super) left: f64,
}

#[derive(Default)]
pub(super) struct TrialResult {
    /// The factors with which a component fits.
    pub(super) factors: Vec<f64>,
    pub(super) near: Option<Near>,
}

/// Tries one edit on all components that are wrong.
pub(super) fn attempt(curve: &mut Curve<'_>, candidate: &Candidate, trial: &Trial) -> TrialResult {
    let mut outcome = TrialResult::default();
    if !candidate.has_factor() {
        let columns = curve.at(1.0).to_vec();
        let mut left = 0.0_f64;
        for sample in trial.wrong() {
            let values = &columns[sample.component];
            if sample.fits(values) {
                outcome.factors = vec![1.0];
            }
            left = left.max(sample.left_by(values));
        }
        outcome.near = Some(Near {
            candidate: 0,
            factor: 1.0,
            left,
        });
        return outcome;
    }
    let solved: Vec<Option<Solved>> = trial
        .wrong()
        .map(|sample| solve::factor(curve, sample))
        .collect();
    for solved in solved.iter().flatten() {
        outcome.factors.extend(solved.factor);
    }
    outcome.factors.sort_by(f64::total_cmp);
    outcome.factors.dedup();
    if let Some(first) = solved.iter().flatten().next() {
        let left = solved.iter().map(|solved| match solved {
            Some(solved) => solved.left,
            None => 1.0,
        });
        outcome.near = Some(Near {
            candidate: 0,
            factor: first.nearest,
            left: left.fold(0.0, f64::max),
        });
    }
    outcome
}

/// The cost of an edit with a simple number that the file does not have there.
pub(super) const NEW_NUMBER: usize = 20;

/// The cost of an edit with a number that nobody writes.
pub(super) const FAR_FETCHED: usize = 40;

/// How much an edit changes; those that people make most often are cheapest.
pub(super) fn cost(candidate: &Candidate, factor: f64) -> usize {
    let is_lost = factor == -1.0 || factor == 0.0;
    let is_simple = solve::complexity(factor) < 1000.0;
    match candidate.change {
        EditKind::Term | EditKind::Summand if is_lost => 10,
        EditKind::LostFactor | EditKind::LostDivisor | EditKind::LostOperator => 10,
        EditKind::Normal | EditKind::TimeFactor => 9,
        EditKind::TransposedGradient | EditKind::MissingTranspose | EditKind::Held => 11,
        EditKind::Exponent if text::has_simple_number(candidate, factor) => 11,
        EditKind::TimesForOver
        | EditKind::Typed
        | EditKind::Order
        | EditKind::Operator
        | EditKind::Function => 12,
        EditKind::Derivative | EditKind::Index | EditKind::Branch | EditKind::LostBracket => 13,
        EditKind::Name => 16,
        EditKind::Term | EditKind::Summand | EditKind::Part
            if text::has_simple_number(candidate, factor) =>
        {
            12
        }
        EditKind::Parameters | EditKind::Basis => 13,
        EditKind::Part if is_lost => 14,
        EditKind::LostTime
        | EditKind::OneDifferentiated
        | EditKind::TakenBelow
        | EditKind::Square => 15,
        _ if candidate.has_factor() && is_simple => NEW_NUMBER,
        _ => FAR_FETCHED,
    }
}
