//! Common imports and helpers of all kinds of study.

pub(crate) use std::path::Path;

pub(crate) use convergence_judge::text::number::{counted, max_or_nan};
pub(crate) use convergence_study::file::{Count, OneOf, Positive, Refusal, named_file, schema};
pub(crate) use convergence_study::{
    Case, CaseFailure, Check, Claim, Figure, FromFile, Header, InputError, Kind, KindRow, Measured,
    Must, NamedRate, Outcome, Ran, RefinedIn, Sheet, Subject, Table, Verdict, measured,
};

pub(crate) use crate::scene::parts::{Known, Parts};
pub(crate) use schemars::JsonSchema;
pub(crate) use serde::Deserialize;
pub(crate) use thermobeam::solve::Solver;
use thermobeam::solve::TimeLevel;

/// The largest number, NaN if one is NaN; `None` of no numbers, where 0 would look like a perfect
/// result.
pub(crate) fn largest_of(numbers: impl IntoIterator<Item = f64>) -> Option<f64> {
    numbers.into_iter().reduce(max_or_nan)
}

/// A number that counts what must not happen.
pub(crate) fn none_of(case: impl Into<String>, name: &str, happened: usize) -> Measured {
    measured(case, name, happened as f64)
        .fixed(0)
        .must_be(Must::Count(0))
}

/// A number that counts what a claim is about: of nothing it would hold.
pub(crate) fn some_of(case: impl Into<String>, name: &str, count: usize) -> Measured {
    measured(case, name, count as f64)
        .fixed(0)
        .must_be(Must::AtLeast(1.0))
}

/// What must not be: how many there are, and which.
pub(crate) fn none_listed<T: AsRef<str>>(name: &str, list: &[T]) -> Measured {
    let count = none_of("", name, list.len());
    if list.is_empty() {
        return count;
    }
    let list: Vec<&str> = list.iter().map(AsRef::as_ref).collect();
    count.words(format!("{}: {}", list.len(), list.join("; ")))
}

/// The result of the case with these data; `None` if it failed or was not run.
pub(crate) fn found<'r, D: PartialEq, F>(ran: &'r [Ran<D, F>], data: &D) -> Option<&'r F> {
    ran.iter().find(|ran| ran.case.data == *data)?.ok()
}

/// Whether every number of a level is finite.
pub(crate) fn is_finite(level: &TimeLevel) -> bool {
    let fields = [&level.u, &level.v, &level.phi, &level.w, &level.theta];
    level.contact_force.is_finite() && fields.into_iter().flatten().all(|value| value.is_finite())
}
