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
