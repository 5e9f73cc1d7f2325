//! The inside of `convergence-study`: studies, runs, verdicts, reports. **No promise of stability**:
//! any version may change any item. Users depend on `convergence-study`, which re-exports what is
//! meant for them; the other crates of its workspace are built on this one.
//!
//! [`judge`] is the rule: it knows neither norm nor scheme, only steps and errors.
//! [`report`](verify::report) writes the report on a study that has run.
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
//! studies described by files, `tables` [`rates`]: tables judged, with figures, without files,
//! threads or clocks. `reports` adds all but the command line, `command-line` that.
//!
//! Each module uses only those before it: `text`, `judge`, `input`, `plots`, `exchange`,
//! `rates`, `study`, `run`, `where_lost`, `project`, `store`, `program`, `compare`, `report`, `verify`, `cli`. The
//! first two are the crate `convergence-judge`, with `run::time_limit`.

#[cfg(feature = "command-line")]
pub mod cli;
#[cfg(feature = "reports")]
pub mod compare;
#[cfg(feature = "tables")]
mod exchange;
#[cfg(feature = "files")]
pub mod input;
#[cfg(feature = "tables")]
pub mod plots;
#[cfg(feature = "reports")]
pub mod program;
#[cfg(feature = "reports")]
pub mod project;
#[cfg(feature = "tables")]
pub mod rates;
#[cfg(feature = "reports")]
pub mod report;
pub mod run;
#[cfg(feature = "reports")]
pub mod store;
pub mod study;
#[cfg(feature = "reports")]
pub mod verify;
#[cfg(feature = "tables")]
pub mod where_lost;

pub use convergence_judge::{interval, judge, text};
pub use run::assert_order;
pub use study::levels;
