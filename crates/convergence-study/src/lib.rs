//! Convergence studies of any numerical code: rates with intervals, verdicts, a baseline, reports.
//!
//! # In a test
//!
//! [`assert_order`] judges errors that exist; [`levels`] makes a study of a function that computes
//! them. The midpoint rule is of second order, and passes:
//!
//! ```
//! let error = |n: usize| {
//!     let h = 1.0 / n as f64;
//!     let sum: f64 = (0..n).map(|i| h * ((i as f64 + 0.5) * h).exp()).sum();
//!     (sum - 1f64.exp_m1()).abs()
//! };
//! convergence_study::levels([4, 8, 16, 32, 64], error).claim("error", 2.0).assert_passes();
//! ```
//!
//! A table that does not have the claimed order fails, with the rate, its interval and the reason:
//!
//! ```
//! use convergence_study::{Reason, Verdict, judge_pairs};
//!
//! let h = [0.25, 0.125, 0.0625, 0.03125, 0.015625];
//! let errors = h.map(|h| (h, 0.3 * h));
//! let rate = judge_pairs(errors, 2.0, 0.1);
//! assert_eq!((rate.verdict, rate.code), (Verdict::Fail, Reason::TooLow));
//! ```
//!
//! # A project that verifies itself
//!
//! A project names its kinds of study in a [`Project`] and calls [`Project::run_command_line`]: its
//! program then has all commands of `convergence-study`, and `verify` reads the files in
//! `studies/`, runs, judges, compares with the baseline and writes the report. The smallest one has
//! no kind of its own: its studies are programs in any language.
//!
#![cfg_attr(feature = "command-line", doc = "```no_run")]
#![cfg_attr(not(feature = "command-line"), doc = "```ignore")]
//! use convergence_study::{KindRow, Project};
//!
//! const PROJECT: Project = Project {
//!     kinds: &[KindRow::PROGRAM],
//!     ..Project::new("heat", "cargo xtask")
//! };
//!
//! fn main() -> std::process::ExitCode {
//!     PROJECT.run_command_line()
//! }
//! ```
//!
//! The README has a project with a [`Kind`] of its own.
//!
//! # Features
//!
//! `default-features = false` leaves the rule and [`levels`]: verdicts in the tests of a solver, on
//! all threads. `files` adds study files and tables of errors, `tables` their verdicts without
//! files, threads or clocks, `reports` plots, reports and the baseline, `command-line` the commands,
//! and `completions`, the default, completions for shells.
//!
//! # Stability
//!
//! What is listed here follows semantic versioning.

// From a file to a report:
//
//     TOML -- KindRow::read_any -> Study -- run::run --> Finished -- baseline, record, junit, report --> verify
//             input               cases     threads      Outcome
//
// A study is data, or a page of code (`About`). A project writes its `Kind`, which says what its
// cases compute and how their results are judged; all findings are an `Outcome`. A `Project` names
// its kinds, `verify` runs, judges, compares with the baseline and writes the report, and `cli` is
// the command line for all of it. The rule knows neither norm nor scheme, only steps and errors:
// crate `convergence-judge`.
//
// Each module uses only those before it: `column`, `input`, `chart`, `exchange`, `rates`, `study`, `run`,
// `where_lost`, `project`, `store`, `program`, `report`, `verify`, `cli`. Nothing is
// public but what is named here, so that the compiler finds what nobody uses.
// With fewer features some items serve no one: they are searched for with all.
#![cfg_attr(
    not(feature = "command-line"),
    allow(dead_code, unreachable_pub, unused_imports)
)]

#[cfg(feature = "tables")]
pub mod chart;
#[cfg(feature = "command-line")]
mod cli;
mod column;
#[cfg(feature = "tables")]
mod exchange;
#[cfg(feature = "files")]
mod input;
#[cfg(feature = "reports")]
mod program;
#[cfg(feature = "reports")]
mod project;
#[cfg(feature = "tables")]
pub mod rates;
#[cfg(test)]
#[path = "../../convergence-study-tests/src/refusals.rs"]
#[allow(dead_code, unreachable_pub, reason = "it is a library's")]
#[cfg(feature = "reports")]
mod refused;
#[cfg(feature = "reports")]
mod report;
#[cfg(test)]
#[path = "../../convergence-study-tests/src/rows.rs"]
#[allow(unreachable_pub, reason = "it is a library's")]
#[cfg(feature = "reports")]
mod rows;
mod run;
#[cfg(feature = "reports")]
mod store;
mod study;
mod taylor;
#[cfg(test)]
#[cfg(feature = "reports")]
mod tests;
#[cfg(feature = "reports")]
mod verify;
#[cfg(feature = "tables")]
mod where_lost;

use convergence_judge::{interval, text};

// The names of the rule are promised, and described, by its own crate.
#[doc(no_inline)]
pub use convergence_judge::taylor::{Derivative, Finding, Judged};
#[doc(no_inline)]
pub use convergence_judge::{Interval, Prose, text::named::NamedNumber};
#[doc(no_inline)]
pub use convergence_judge::{
    claims::{Bound, Claim},
    grid::SpaceTime,
    richardson::{Estimator, StepValue},
    verdict::{
        Band, Floor, JudgeError, Level, Of, RateVerdict, Reason, Samples, Verdict, judge,
        judge_pairs, observe,
    },
};

#[doc(inline)]
pub use crate::{
    run::{Finished, Progress, RunError, assert_order, run_one},
    study::{
        About, Budget, Case, CaseFailure, Check, Described, ErrorColumn, ErrorsOverLevels, Figure,
        HashedFile, Header, IntoErrors, Kind, LevelErrors, Levels, Measured, Must, NamedRate,
        Outcome, Quantity, Ran, RefinedIn, Refinement, Sampled, SampledLevel, Sheet, Study,
        Subject, Table, TableOrigin, Tier, Untested,
        grid::{Grid, GridColumn},
        left_out, levels, levels_of_samples, measured,
        norms::norms,
    },
    taylor::{TaylorFindings, TaylorTest},
};

/// Variants of a study's solution, by which `--where` names the part that has lost the order.
pub mod variants {
    pub use crate::run::WhereLost;
    pub use crate::study::variants::{LeftOutVariant, SolverPart, Variant, Variants};
    #[cfg(feature = "tables")]
    pub use crate::where_lost::Search;
}

#[cfg(feature = "files")]
#[doc(inline)]
pub use crate::{
    input::{Document, InputError},
    study::{FromFile, KindRow, Order},
};

/// What structs of files are made of: numbers of a range, names of a choice, lists of levels; and
/// how a file that was read is refused.
#[cfg(feature = "files")]
pub mod file {
    pub use crate::input::{
        Ascending, Choices, Count, Counts, Finite, Number, OneOf, Positive, Range, Refusal,
        named_file, schema::of as schema,
    };
}

#[cfg(feature = "reports")]
#[doc(inline)]
pub use crate::{
    project::{Front, Project, Statement, Template, Term},
    verify::{TestRun, Verification, VerificationError, VerifyRequest},
};

/// For projects whose programs have commands of their own, beside those of the harness.
#[cfg(feature = "command-line")]
pub mod command_line {
    pub use crate::cli::{
        Command,
        exit::Unusable,
        flags::{Flags, Titles},
        help::HelpPage,
    };
}

/// Files that are written whole, or not at all.
#[cfg(feature = "reports")]
pub mod atomic {
    pub use crate::store::atomic::{begin_write, prepare_folder, write, write_with};
}

/// The programs of the README and of the book are tests.
#[cfg(all(doctest, feature = "command-line"))]
#[doc = include_str!("../README.md")]
#[doc = include_str!("../book/src/rust.md")]
#[doc = include_str!("../book/src/solver.md")]
#[doc = include_str!("../book/src/gradients.md")]
#[doc = include_str!("../book/src/kinds.md")]
#[doc = include_str!("../book/src/scatter.md")]
#[doc = include_str!("../book/src/values.md")]
#[doc = include_str!("../book/src/which.md")]
struct Pages;
