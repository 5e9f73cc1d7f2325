//! The kinds of study, one file each, behind one interface.
//!
//! A study is a TOML file: data. Its kind says what its cases are (pure computations, run on any thread in any order),
//! and how their results become an [`Outcome`]: checks with verdicts, tables, figures, and the numbers that the baseline
//! guards. The runner knows threads, the report knows Markdown, a study knows neither.

pub mod bifurcation;
pub mod calibration;
mod complete;
pub mod controls;
pub mod convergence;
pub mod energy;
pub mod equilibrium;
pub mod experiment;
pub mod extremes;
pub mod frequencies;
mod ladder;
pub mod random_scenes;
pub mod rigid;
pub mod self_convergence;
pub mod sensitivity;
pub mod solvers;
mod steady;
mod table;
pub mod tables;
mod terms;
pub mod untyped;
pub mod vibration;
mod watch;
pub mod work_precision;

pub use table::KINDS;
pub use terms::TERMS;
pub use untyped::{FromFile, Study};
