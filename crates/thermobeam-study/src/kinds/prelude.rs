//! Common imports and helpers of all kinds of study.

pub(crate) use std::path::Path;

pub(crate) use convergence_study::input::{Field, InputError, Section};
pub(crate) use convergence_study::judge::random::SplitMix;
pub(crate) use convergence_study::judge::verdict::{Judge, Verdict};
pub(crate) use convergence_study::plots;
pub(crate) use convergence_study::plots::xy::Xy;
pub(crate) use convergence_study::run::time_limit::Patience;
pub(crate) use convergence_study::study::kind::completion;
pub(crate) use convergence_study::study::levels::{ErrorColumn, Levels, summary};
pub(crate) use convergence_study::study::{
    Axis, Case, CaseFailure, Check, Claim, Described, Figure, FromFile, Header, Kind, KindRow, Outcome, Quantity, Ran,
    Reading, Refinement, Table, read_claim, reader, readings,
};
pub(crate) use convergence_study::text::number::{max_or_nan, min_or_nan, plain_text};
pub(crate) use thermobeam::equilibrium::{Contact, Equilibrium};
pub(crate) use thermobeam::error::{StepError, StepFailure};
pub(crate) use thermobeam::kirchhoff::BUCKLING;
pub(crate) use thermobeam::mesh::{Mesh, MeshError};
pub(crate) use thermobeam::parameters::{Beam, Obstacles};
pub(crate) use thermobeam::scheme::{EULER_CRANK_NICOLSON, MIDPOINT, SCHEMES, Scheme};
pub(crate) use thermobeam::simulation::{Initial, Problem, Stepping};
pub(crate) use thermobeam::solve::{Level, Settings, Solver};

pub(crate) use crate::exact::norm::{Norm, Norms};
pub(crate) use crate::exact::solution::{Manufactured, Product};
pub(crate) use crate::expression::Expression;
pub(crate) use crate::run::RunError;
pub(crate) use crate::run::driver::{Driver, Step};
pub(crate) use crate::run::simulate;
pub(crate) use crate::scene::{Method, Scene, limits, resampled, tables};

/// Whether each value is larger than its predecessor.
pub(crate) fn increases<T: PartialOrd>(list: &[T]) -> bool {
    list.windows(2).all(|pair| pair[0] < pair[1])
}

/// The result of the case with these data; `None` if it failed or was not run.
pub(crate) fn found<'r, D: PartialEq, F>(ran: &'r [Ran<D, F>], data: &D) -> Option<&'r F> {
    ran.iter().find(|ran| ran.case.data == *data)?.ok()
}

/// Names of the numbers that are NaN or infinite, for [`completion`].
pub(crate) fn not_finite(numbers: &[(&str, f64)]) -> Vec<String> {
    numbers.iter().filter(|(_, value)| !value.is_finite()).map(|(name, _)| (*name).to_owned()).collect()
}

/// Whether every number of a level is finite.
pub(crate) fn is_finite(level: &Level) -> bool {
    let fields = [&level.u, &level.v, &level.phi, &level.w, &level.theta];
    level.contact_force.is_finite() && fields.into_iter().flatten().all(|value| value.is_finite())
}
