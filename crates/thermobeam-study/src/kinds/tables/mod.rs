//! Tables that several kinds of study file have: exact solution, refinement, orders expected, coefficients of a control,
//! two discretisations of any order.

mod control;
mod discretisation;
mod expectation;
mod levels;
mod manufactured;
mod refine;

pub use crate::exact::norm::{Norm, Norms};
pub use crate::exact::solution::{Manufactured, Product};
pub use control::Control;
pub(crate) use control::control;
pub use discretisation::Discretisation;
pub(crate) use discretisation::{DISCRETISATION_KEYS, discretisations};
pub use expectation::Expectation;
pub(crate) use expectation::expectations;
pub(crate) use levels::{norm_levels, not_finite};
pub(crate) use manufactured::manufactured;
pub(crate) use refine::refine;
pub use refine::{Perturbation, Refine};
