//! Convergence studies of any numerical code: rates with intervals, verdicts, a baseline, reports.
//!
//! # In a test
//!
//! [`assert_order`] judges existing errors; [`levels()`](levels()) makes a study of a function that
//! computes them.
//!
//! ```
//! // The midpoint rule for the integral of exp: of second order.
//! let error = |n: usize| {
//!     let h = 1.0 / n as f64;
//!     let sum: f64 = (0..n).map(|i| h * ((i as f64 + 0.5) * h).exp()).sum();
//!     (sum - 1f64.exp_m1()).abs()
//! };
//! convergence_study::levels([4, 8, 16, 32, 64], error).claim("error", 2.0).assert_passes();
//! ```
//!
//! [`judge`] is the rule: it knows neither norm nor scheme, only steps and errors.
//! [`report`](verify::report) writes the report on a study that has run: see the example
//! `heat_equation` and the README.
//!
//! # From a file to a report
//!
//! ```text
//! TOML ── StudyFile::read ──> Study ── run::run ──> Finished ── baseline, record, junit, report ──> verify
//!           input               cases     threads      Outcome
//! ```
//!
//! A study is data. A project writes its [`Kind`](study::Kind), which says what its cases compute
//! and how their results are judged; all findings are an [`Outcome`](study::Outcome). A
//! [`Project`](project::Project) names its kinds, [`verify`] runs, judges, compares with the
//! baseline and writes the report, and [`cli`] is the command line for all of it.
//!
//! # Features
//!
//! `default-features = false` leaves [`text`], [`judge`], [`study`] and [`run`]: verdicts, and
//! studies on all threads, whose outcomes have no figures. The feature `files` adds [`input`] and
//! studies described by files, `reports` all but the command line, `command-line` that.
//!
//! Each module uses only those before it: `text`, `judge`, `input`, `plots`, `study`, `run`,
//! `project`, `store`, `program`, `compare`, `report`, `explain`, `verify`, `cli`. The first two
//! are the crate `convergence-judge`, with `run::time_limit`.

#[cfg(feature = "command-line")]
pub mod cli;
#[cfg(feature = "reports")]
pub mod compare;
#[cfg(feature = "files")]
pub mod input;
#[cfg(feature = "reports")]
pub mod plots;
#[cfg(feature = "reports")]
pub mod program;
#[cfg(feature = "reports")]
pub mod project;
#[cfg(feature = "reports")]
pub mod report;
pub mod run;
#[cfg(feature = "reports")]
pub mod store;
pub mod study;
#[cfg(feature = "reports")]
pub mod verify;

pub use convergence_judge::{judge, text};
pub use run::assert_order;
pub use study::levels;

/// The programs of the README are tests.
#[cfg(all(doctest, feature = "command-line"))]
#[doc = include_str!("../README.md")]
struct Readme;
