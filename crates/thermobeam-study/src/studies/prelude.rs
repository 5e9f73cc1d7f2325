//! Common imports and helpers of the studies in code.

pub(super) use crate::kinds::prelude::{Known, Parts, Solver, largest_of, none_of, some_of};
pub(super) use convergence_judge::text::number::max_or_nan;
pub(super) use convergence_study::{
    About, Case, CaseFailure, Described, Kind, Measured, Must, Outcome, Ran, Sheet, Tier, measured,
};

/// What a run shows.
///
/// # Panics
/// The study has no such run.
pub(super) fn of<'r, R: PartialEq, S>(shown: &[(&R, &'r S)], run: &R) -> &'r S {
    let known = shown.iter().find(|(known, _)| *known == run);
    known.map(|(_, shown)| *shown).expect("a run of the study")
}
