//! Convergence studies of any numerical code: rates with intervals, verdicts, a baseline, reports.
//!
//! # The rule
//!
//! [`judge`] knows neither norm nor scheme, only steps and errors.
//!
//! ```
//! use convergence_study::judge::verdict::{Verdict, judge_pairs};
//!
//! // The midpoint rule for the integral of exp, claimed to be of second order; then, of fourth.
//! let error = |n: i32| {
//!     let h = 1.0 / f64::from(n);
//!     let sum: f64 = (0..n).map(|i| h * ((f64::from(i) + 0.5) * h).exp()).sum();
//!     (h, (sum - 1f64.exp_m1()).abs())
//! };
//! let errors = [4, 8, 16, 32, 64].map(error);
//! assert_eq!(judge_pairs(errors, 2.0, 0.05).verdict, Verdict::Pass);
//! assert_eq!(judge_pairs(errors, 4.0, 0.05).verdict, Verdict::Fail);
//! ```
//!
//! # From levels to a report
//!
//! [`ErrorsOverLevels`](study::ErrorsOverLevels) makes a study of a function that computes errors, and
//! [`run_and_report`](verify::run_and_report) writes the report on it: see the example `heat_equation` and the README.
//!
//! # From a file to a report
//!
//! ```text
//! TOML ── StudyFile::read ──> Study ── run::run ──> Finished ── baseline, record, junit, report ──> verify
//!           input               cases     threads      Outcome
//! ```
//!
//! A study is data. Its [`Kind`](study::Kind), which a project writes, says what its cases compute and how their results are
//! judged; all that was found is an [`Outcome`](study::Outcome). A [`Project`](project::Project) names its kinds, [`verify`]
//! runs, judges, compares with the baseline and writes the report, and [`cli`] is the command line for all of it.
//!
//! # Without reports
//!
//! With `default-features = false` there are [`text`], [`judge`], [`input`], [`study`] and [`run`]: verdicts, tables of errors, and
//! studies on all threads, whose outcomes have no figures. The feature `reports` adds all but the command line, `command-line` that.
//!
//! Each module uses only those before it: `text`, `judge`, `input`, `plots`, `study`, `run`, `project`, `store`, `program`,
//! `compare`, `report`, `explain`, `verify`, `cli`. (One exception: a calibration in `judge` asks `run::time_limit`
//! for the time left.)

#[cfg(feature = "command-line")]
pub mod cli;
#[cfg(feature = "reports")]
pub mod compare;
#[cfg(feature = "reports")]
pub mod explain;
pub mod input;
pub mod judge;
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
pub mod text;
#[cfg(feature = "reports")]
pub mod verify;

/// The programs of the README are tests.
#[cfg(all(doctest, feature = "command-line"))]
#[doc = include_str!("../README.md")]
struct Readme;
