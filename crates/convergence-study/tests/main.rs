//! The tests of the harness, of its program and of the pages that document both, in one program.

mod asserted;
#[cfg(feature = "command-line")]
mod ci;
#[cfg(all(feature = "tables", feature = "reports"))]
mod doubted;
#[cfg(feature = "command-line")]
mod examples;
#[cfg(feature = "command-line")]
mod fit;
mod grid;
#[cfg(feature = "command-line")]
mod readme;
mod richardson;
#[cfg(feature = "tables")]
mod table_attacks;
mod verdict_laws;
mod verdict_rule;
mod verdict_tables;
