//! A study: what it claims, its cases, and what it found.
//!
//! A study is a TOML file, or a page of code ([`About`]). Its [`Kind`] says what its cases are
//! (pure computations, run on any thread in any order) and how their results become an [`Outcome`]:
//! checks with verdicts, rates, tables, figures, and the numbers that the baseline guards. Only the
//! runner uses threads, and only the report writes Markdown.

mod caught;
pub(crate) mod erased;
mod errors_over_levels;
#[cfg(feature = "files")]
mod file;
pub(crate) mod grid;
pub(crate) mod header;
mod in_code;
pub(crate) mod kind;
pub(crate) mod left_out;
mod measured;
mod must;
pub(crate) mod norms;
#[cfg(feature = "files")]
mod order;
pub(crate) mod outcome;
pub(crate) mod over_levels;
pub(crate) mod sampled;
pub(crate) mod settings;
pub(crate) mod subject;
pub(crate) mod until_decided;
pub(crate) mod variants;
mod views;

pub(crate) use caught::catch;
pub(crate) use erased::Plan;
pub use erased::{Described, Study};

pub use errors_over_levels::{ErrorsOverLevels, IntoErrors, levels, levels_of_samples};
#[cfg(feature = "reports")]
pub(crate) use file::Lines;
#[cfg(feature = "files")]
pub use file::{FromFile, KindRow};
#[cfg(feature = "command-line")]
pub(crate) use file::{STUDY, StudyFile, study_schema};
pub use header::{Header, Tier};
pub use in_code::About;
pub use kind::{Case, CaseFailure, Kind, Ran, Untested};
pub use left_out::left_out;
pub use measured::{Measured, Sheet, measured};
pub use must::Must;
#[cfg(feature = "files")]
pub use order::Order;
#[cfg(feature = "reports")]
pub(crate) use order::{Constant, ORDER};
pub(crate) use outcome::content_hash;
pub use outcome::{
    Check, Figure, HashedFile, LevelErrors, NamedRate, Outcome, Quantity, Table, TableOrigin,
};
pub(crate) use over_levels::Claim;
pub use over_levels::{ErrorColumn, Levels, RefinedIn, Refinement};
pub use sampled::{Sampled, SampledLevel};
pub(crate) use subject::Sort;
pub use subject::Subject;
pub use until_decided::Budget;
