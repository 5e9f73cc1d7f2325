//! Common imports and helpers of the studies in code.

pub(super) use crate::kinds::prelude::{Known, Parts, Solver, largest_of};
pub(super) use convergence_judge::text::number::max_or_nan;
pub(super) use convergence_study::{
    About, Case, CaseFailure, Described, Kind, Measured, Must, Outcome, Ran, Sheet, Tier, measured,
};

/// A number that counts what must not happen.
pub(super) fn none(case: impl Into<String>, name: &str, happened: bool) -> Measured {
    let count = f64::from(u8::from(happened));
    measured(case, name, count).fixed(0).must_be(Must::Count(0))
}

/// What a run shows.
///
/// # Panics
/// The study has no such run.
pub(super) fn of<'r, R: PartialEq, S>(shown: &[(&R, &'r S)], run: &R) -> &'r S {
    let known = shown.iter().find(|(known, _)| *known == run);
    known.map(|(_, shown)| *shown).expect("a run of the study")
}
