//! From studies to reports: runner, baseline, record, report and its files, with studies of a
//! prescribed behaviour.

mod baseline;
mod browser;
mod claims;
mod diagnosis;
mod failures;
mod fake;
mod file_set;
mod page;
mod record;
mod report;
mod runner;
mod shared;
mod tables_of_errors;
mod whole;
