//! Common imports and helpers of all kinds of study.

pub(crate) use std::path::Path;

pub(crate) use convergence_judge::{
    judge::{random::SplitMix, richardson, verdict::Judge},
    text::number::{counted, decimals, max_or_nan, min_or_nan, plain_text, short_text},
    time_limit::Patience,
};
pub(crate) use convergence_study::{
    Axis, Case, CaseFailure, Check, Claim, Coverage, Field, Figure, Floor, Form, FromFile, Header,
    InputError, Key, Keys, Kind, KindRow, NamedRate, Origin, Outcome, Quantity, Ran, Reading,
    Refinement, Section, Sort, Study, Subject, Table, Untested, Verdict, completion_check,
    internal::{
        input::POSITIVE,
        plots::{self, xy::Xy},
        study::{
            Described, allow_only,
            coverage::NO_RESULT,
            header::Setting,
            over_levels::{ErrorColumn, Levels, summary},
            readings,
        },
    },
    read_claim, read_study,
};
pub(crate) use thermobeam::dg::{MAX_DEGREE, MAX_TIME_DEGREE};
pub(crate) use thermobeam::error::{StepError, StepFailure};
pub(crate) use thermobeam::kirchhoff::BUCKLING;
pub(crate) use thermobeam::mesh::{Mesh, MeshError};
pub(crate) use thermobeam::motion::{Motion, TipRange};
pub(crate) use thermobeam::one_step::{InitialValues, Problem, Stepping};
pub(crate) use thermobeam::parameters::{Beam, Obstacles};
pub(crate) use thermobeam::scheme::{EULER_CRANK_NICOLSON, MIDPOINT, SCHEMES, Scheme};
pub(crate) use thermobeam::solve::{Level, Settings, Solver, Stopping};
pub(crate) use thermobeam_exact::equilibrium::{Completeness, Equilibrium, Phase, completeness};
pub(crate) use thermobeam_exact::vibration::Mode;

pub(crate) use super::settings::{
    CONTACT, ENERGY, Exercise, FREE_VIBRATIONS, Integration, ItemMethod, MANUFACTURED, Nodes,
    Terms, axis_in_words,
};
pub(crate) use crate::error::{ErrorMeasure, free_vibration};
pub(crate) use crate::exact::errors::ErrorMeter;
pub(crate) use crate::exact::norm::{Norm, Norms};
pub(crate) use crate::exact::solution::{Factors, Manufactured, Product};
pub(crate) use crate::expression::{Expression, Variable};
pub(crate) use crate::figures::{self, looks};
pub(crate) use crate::run::driver::Driver;
pub(crate) use crate::run::family::{Family, OnMesh};
pub(crate) use crate::run::simulate::{self, Recording, Run, Simulator};
pub(crate) use crate::run::{AnyMotion, ObservableMotion, Report, RunError, Sample, run, run_to};
pub(crate) use crate::scene::{Coefficients, Method, Scene, limits, resampled, tables};

/// The largest number, NaN if one is NaN; `None` of no numbers, where 0 would look like a perfect
/// result.
pub(crate) fn largest_of(numbers: impl IntoIterator<Item = f64>) -> Option<f64> {
    numbers.into_iter().reduce(max_or_nan)
}

/// Whether each value is larger than its predecessor.
pub(crate) fn increases<T: PartialOrd>(list: &[T]) -> bool {
    list.windows(2).all(|pair| pair[0] < pair[1])
}

/// The table of a file that may have only one of these.
pub(crate) fn only_table<'t>(
    root: &Section<'_>,
    tables: [&'t str; 3],
    allowed: &str,
) -> Result<&'t str, InputError> {
    match tables
        .into_iter()
        .filter(|table| root.get(table).is_some())
        .collect::<Vec<_>>()[..]
    {
        [] => Err(root.missing(tables[0], allowed)),
        [only] => Ok(only),
        [_, second, ..] => Err(root.refuse(second, "a second table", allowed)),
    }
}

/// The result of the case with these data; `None` if it failed or was not run.
pub(crate) fn found<'r, D: PartialEq, F>(ran: &'r [Ran<D, F>], data: &D) -> Option<&'r F> {
    ran.iter().find(|ran| ran.case.data == *data)?.ok()
}

/// Names of the numbers that are NaN or infinite, for [`completion_check`]; `None` is neither.
pub(crate) fn not_finite<'n>(
    numbers: impl IntoIterator<Item = (&'n str, impl Into<Option<f64>>)>,
) -> Vec<String> {
    let numbers = numbers
        .into_iter()
        .map(|(name, value)| (name, value.into()));
    let broken = numbers.filter(|(_, value)| value.is_some_and(|value| !value.is_finite()));
    broken.map(|(name, _)| name.to_owned()).collect()
}

/// Whether every number of a level is finite.
pub(crate) fn is_finite(level: &Level) -> bool {
    let fields = [&level.u, &level.v, &level.phi, &level.w, &level.theta];
    level.contact_force.is_finite() && fields.into_iter().flatten().all(|value| value.is_finite())
}
