//! The verdicts as JUnit XML, for CI systems.
//!
//! One suite for each study, one test case for each rate and check; inconclusive is a separate type
//! of failure. There are no times: the file must not change when nothing has changed.

use std::io;

use minijinja::value::Serde;
use serde::Serialize;
use serde_json::json;

use super::templates::render;
use crate::run::{FailedCase, Finished, Item, items};
use crate::store::{GuardedChange, Record, diagnosis::Diagnosis, without_baseline};
use crate::text::number::counted;
use convergence_judge::verdict::Verdict;

/// Test cases about one subject.
#[derive(Debug, Serialize)]
pub(crate) struct Suite<'f> {
    /// The subject.
    pub name: &'f str,
    /// Names and values.
    pub properties: Vec<(&'f str, String)>,
    /// At least one, except in a suite of properties.
    pub cases: Vec<Item>,
    /// What was not judged, and why.
    pub skipped: Vec<(String, String)>,
    /// What ended without a result.
    pub without_result: &'f [FailedCase],
}

impl<'f> Suite<'f> {
    pub(crate) fn new(name: &'f str, cases: Vec<Item>) -> Self {
        Self {
            name,
            properties: vec![],
            cases,
            skipped: vec![],
            without_result: &[],
        }
    }

    /// The judged items of a study. Cases without a result are none: they fail the check that all
    /// complete.
    fn of(study: &'f Finished) -> Self {
        Self {
            properties: vec![("claim", study.header.claim.clone())],
            without_result: &study.failed_cases,
            ..Self::new(&study.header.id, items(study))
        }
    }

    fn failures(&self) -> usize {
        let failing = self.cases.iter().filter(|case| !case.verdict.is_pass());
        failing.count()
    }
}

/// The document, for the project of this name.
///
/// Differences from the baseline form a separate suite, if there is a baseline.
///
/// # Errors
/// Those of the template.
pub(crate) fn junit(name: &str, record: &Record) -> io::Result<String> {
    let mut suites: Vec<Suite<'_>> = record.studies.iter().map(Suite::of).collect();
    if let Some(changes) = &record.changes {
        suites.push(Suite::new("baseline", baseline(&record.studies, changes)));
    }
    let cause = record.diagnosis.as_ref().map_or(vec![], Diagnosis::lines);
    if !cause.is_empty() {
        suites.push(Suite {
            properties: cause,
            ..Suite::new("what the failures share", vec![])
        });
    }
    junit_of(name, &suites)
}

fn baseline(studies: &[Finished], changes: &[GuardedChange]) -> Vec<Item> {
    if let Some(numbers) = without_baseline(studies, changes) {
        let why = format!("not yet in the baseline: {}", counted(numbers, "number"));
        return vec![Item::new("a baseline", Verdict::Fail, why)];
    }
    if changes.is_empty() {
        let name = "all baseline values unchanged";
        return vec![Item::new(name, Verdict::Pass, "")];
    }
    let changes = changes.iter().map(|change| {
        let name = format!("{}: {}", change.study, change.name);
        Item::new(name, Verdict::Fail, change.movement.to_string())
    });
    changes.collect()
}

/// A document with these suites.
///
/// # Errors
/// Those of the template.
pub(crate) fn junit_of(name: &str, suites: &[Suite<'_>]) -> io::Result<String> {
    let skipped: usize = suites.iter().map(|suite| suite.skipped.len()).sum();
    let cases: usize = suites.iter().map(|suite| suite.cases.len()).sum();
    let failures: usize = suites.iter().map(Suite::failures).sum();
    let document = json!({
        "name": name,
        "suites": suites,
        "tests": cases + skipped,
        "skipped": skipped,
        "failures": failures,
    });
    render("junit.xml", Serde(document))
}
