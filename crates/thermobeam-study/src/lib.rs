//! Convergence studies for the [`thermobeam`] solver: does it keep what theory promises?
//!
//! # From a file to a verdict
//!
//! ```text
//! TOML ── study::read ──> Study ── runner::run ──> Finished ── report, record, baseline, junit ──> verification
//!                          cases      threads       Outcome
//! ```
//!
//! A study is data: a [`study_file`] or a [`scene`], whose functions are [`expression`]s. Its kind, in [`study`], says what its cases
//! compute and how their results are judged. Errors against a manufactured solution ([`exact`], [`design`]) become rates by
//! [`fit`] and verdicts by [`verdict`], and all that was found is an [`outcome`]. The [`runner`] alone knows threads.
//!
//! ```
//! use convergence_study::judge::verdict::Verdict;
//! use convergence_study::study::{FromFile, run_here};
//! use thermobeam_study::kinds::convergence::Convergence;
//!
//! let study = Convergence::parse(
//!     r#"
//!     study = { id = "my-own", claim = "Second order to the interpolant", tier = "quick" }
//!     exact.u = [{ x = "sin(2*x)", t = "cos(t)" }]
//!     exact.phi = [{ x = "x^2", t = "exp(-t)" }]
//!     refine = { axis = "space", isolate = true, elements = [16, 32, 64, 128], steps = 10, t_end = 1.0, tolerance = 1e-13 }
//!     expect = [{ norm = "superclose", order = 2.0, tolerance = 0.02 }]
//!     "#,
//!     "my-own.toml".as_ref(),
//! )?;
//! assert_eq!(run_here(&study).verdict, Verdict::Pass);
//! # Ok::<(), convergence_study::input::InputError>(())
//! ```
//!
//! # The same rule for any code
//!
//! [`verdict`] knows neither the norm nor the scheme, only steps and errors; [`rates`] reads them from a table.
//!
//! ```
//! use thermobeam_study::verdict::{Verdict, judge_pairs};
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
//! What the solver must obey is derived in [`thermobeam::theory`].

pub mod error;
pub mod figures;
pub mod kinds;
pub mod predict;
pub mod run;
pub mod scene;
pub mod sweep;

pub use thermobeam_exact as exact;
pub use thermobeam_exact::{expression, quadrature};

/// The code of the README, held by the doc tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
