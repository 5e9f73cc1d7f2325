//! The tests of the harness, in one program.

mod asserted;
#[cfg(feature = "command-line")]
mod ci;
mod circles;
#[cfg(feature = "reports")]
mod compare;
#[cfg(feature = "files")]
mod error_table;
#[cfg(feature = "command-line")]
mod explain;
mod fit;
mod grid;
mod layering;
#[cfg(feature = "reports")]
mod plots;
#[cfg(feature = "command-line")]
mod readme;
mod richardson;
#[cfg(feature = "files")]
mod tables;
mod verdict_laws;
mod verdict_rule;
mod verdict_tables;
#[cfg(feature = "reports")]
mod verification;
