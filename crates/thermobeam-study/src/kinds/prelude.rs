//! What every kind of study is written with.

pub(crate) use std::path::Path;

pub(crate) use convergence_study::input::{Field, InputError, Section};
pub(crate) use convergence_study::plots;
pub(crate) use convergence_study::study::levels::{ErrorColumn, Levels, completion};
pub(crate) use convergence_study::study::{
    Axis, Case, CaseFailure, Check, Claim, Figure, FromFile, Header, Kind, KindRow, Outcome, Quantity, Ran, Reading,
    Refinement, Table, reader, readings,
};
pub(crate) use convergence_study::text::number::max_or_nan;

pub(crate) use crate::scene::{Scene, limits};

/// Whether each value is larger than the one before.
pub(crate) fn increases<T: PartialOrd>(list: &[T]) -> bool {
    list.windows(2).all(|pair| pair[0] < pair[1])
}

/// What the case of these data has found; `None` where it failed or was not run.
pub(crate) fn found<'r, D: PartialEq, F>(ran: &'r [Ran<D, F>], data: &D) -> Option<&'r F> {
    ran.iter().find(|ran| ran.case.data == *data)?.ok()
}

/// Curves over time, in the file `<id>-<what>.svg`.
pub(crate) fn over_time(id: &str, what: &str, caption: impl Into<String>, history: &plots::History) -> Figure {
    Figure::new(id, what, caption, plots::history(history))
}

/// Names of the numbers that are NaN or infinite, for [`completion`].
pub(crate) fn not_finite(numbers: &[(&str, f64)]) -> Vec<String> {
    numbers.iter().filter(|(_, value)| !value.is_finite()).map(|(name, _)| (*name).to_owned()).collect()
}
