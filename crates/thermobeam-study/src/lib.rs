//! Convergence studies for the [`thermobeam`] solver: does it have the properties that theory
//! predicts?
//!
//! # From a file to a verdict
//!
//! ```text
//! TOML ── kinds::read ──> Study ── convergence_study ──> Finished ── report, record, baseline, JUnit
//!                          cases            threads            Outcome
//! ```
//!
//! Studies are data, or code if theirs is the only one of its kind: [`studies`]. [`scene`]s are
//! data, whose functions are [`expression`]s. Each of the [`kinds`] of study defines what its cases
//! compute and how their results are judged; [`run`] steps problems, [`mod@error`] measures errors
//! against exact solutions and finer runs, [`accuracy`] refines until a wanted error is reached.
//! The harness, [`convergence_study`], provides threads, rates, verdicts, baseline, records and
//! reports.
//!
//! ```
//! use convergence_study::Verdict;
//! use convergence_study::run_one;
//! use convergence_study::FromFile;
//! use thermobeam_study::kinds::orders::Orders;
//! use thermobeam_study::kinds::orders::manufactured::Convergence;
//!
//! let study = Orders::<Convergence>::parse(
//!     r#"
//!     study = { id = "my-own", claim = "Second order to the interpolant", tier = "quick" }
//!     exact.u = [{ x = "sin(2*x)", t = "cos(t)" }]
//!     exact.phi = [{ x = "x^2", t = "exp(-t)" }]
//!     refine = { axis = "space", isolate = true, elements = [16, 32, 64, 128], steps = 10, t_end = 1.0, tolerance = 1e-13 }
//!     expect = [{ norm = "superclose", order = 2.0, tolerance = 0.02 }]
//!     "#,
//!     "my-own.toml".as_ref(),
//! )?;
//! assert_eq!(run_one(&study).verdict, Verdict::Pass);
//! # Ok::<(), convergence_study::InputError>(())
//! ```
//!
//! The properties of the solver are derived in [`thermobeam::theory`].

pub mod accuracy;
pub mod error;
pub mod figures;
pub mod kinds;
pub mod run;
pub mod scene;
pub mod studies;
pub mod sweep;

pub use thermobeam_exact as exact;
pub use thermobeam_exact::expression;

/// The code of the README, compiled as doc tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
