//! The tests of the harness, in one program.

mod asserted;
#[cfg(feature = "reports")]
mod compare;
#[cfg(feature = "files")]
mod error_table;
#[cfg(feature = "command-line")]
mod explain;
mod fit;
mod grid;
#[cfg(feature = "reports")]
mod plots;
mod richardson;
#[cfg(feature = "tables")]
mod table_attacks;
mod verdict_laws;
mod verdict_rule;
mod verdict_tables;
#[cfg(feature = "reports")]
mod verification;
