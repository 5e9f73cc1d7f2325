//! From studies to reports: the runner, the baseline, the record, the shelf, with small studies that do as they are told.

mod baseline;
mod browser;
mod fake;
mod page;
mod record;
mod report;
mod runner;
mod shelf;
mod whole;
