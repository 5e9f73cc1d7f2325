//! From studies to reports: runner, baseline, record, report and its files, with studies of a
//! prescribed behaviour. And charts.

mod baseline;
mod browser;
mod chart;
mod diagnosis;
mod failures;
mod fake;
mod page;
mod record;
mod report;
mod report_folder;
mod runner;
mod tables_of_errors;
mod whole;
