//! The verdicts as JUnit XML, for CI systems.
//!
//! One suite for each study, one test case for each rate and check; inconclusive is a separate type
//! of failure. There are no times: the file must not change when nothing has changed.

use std::io;

use serde::Serialize;

use super::templates::render;
use crate::judge::verdict::Verdict;
use crate::run::{FailedCase, Finished, Item, items};
use crate::store::{GuardedChange, Record, diagnosis::Diagnosis, without_baseline};

/// Test cases about one subject.
#[derive(Debug, Serialize)]
pub(crate) struct Suite<'f> {
    /// The subject.
    pub name: &'f str,
    /// Names and values.
    pub properties: Vec<(&'f str, String)>,
    /// At least one, except in a suite of properties.
    pub cases: Vec<TestCase>,
    /// What ended without a result.
    pub without_result: &'f [FailedCase],
}

/// Something that was judged, or set aside.
#[derive(Debug, Serialize)]
pub(crate) struct TestCase {
    name: String,
    /// A verdict, or `skipped`.
    outcome: &'static str,
    why: String,
    /// What to do about a failure.
    advice: String,
}

const SKIPPED: &str = "skipped";

impl<'f> Suite<'f> {
    pub(crate) fn new(name: &'f str, cases: Vec<TestCase>) -> Self {
        Self {
            name,
            properties: vec![],
            cases,
            without_result: &[],
        }
    }

    /// The judged items of a study.
    fn of(study: &'f Finished) -> Self {
        let mut cases = vec![];
        for item in items(study) {
            // Cases without a result are no test cases: they fail the check that all complete.
            if matches!(item, Item::Cases { .. }) {
                continue;
            }
            let mut case = TestCase::new(item.name(), item.verdict(), item.why());
            if let (Some(code), Some(advice)) = (item.code(), item.advice()) {
                case.advice = format!("{code}: {advice}");
            }
            cases.push(case);
        }
        Self {
            properties: vec![("claim", study.header.claim.clone())],
            without_result: &study.failed_cases,
            ..Self::new(&study.header.id, cases)
        }
    }
}

impl TestCase {
    pub(crate) fn new(name: impl Into<String>, verdict: Verdict, why: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            outcome: verdict.name(),
            why: why.into(),
            advice: String::new(),
        }
    }

    /// Something that is not judged.
    pub(crate) fn skipped(name: impl Into<String>, why: impl Into<String>) -> Self {
        Self {
            outcome: SKIPPED,
            ..Self::new(name, Verdict::Inconclusive, why)
        }
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

fn baseline(studies: &[Finished], changes: &[GuardedChange]) -> Vec<TestCase> {
    if let Some(numbers) = without_baseline(studies, changes) {
        let why = format!("no baseline yet: {numbers} numbers");
        return vec![TestCase::new("a baseline", Verdict::Fail, why)];
    }
    if changes.is_empty() {
        let name = "all baseline values unchanged";
        return vec![TestCase::new(name, Verdict::Pass, "")];
    }
    let case = |change: &GuardedChange| {
        let name = format!("{}: {}", change.study, change.name);
        TestCase::new(name, Verdict::Fail, change.movement.to_string())
    };
    changes.iter().map(case).collect()
}

/// A document with these suites.
///
/// # Errors
/// Those of the template.
pub(crate) fn junit_of(name: &str, suites: &[Suite<'_>]) -> io::Result<String> {
    #[derive(Serialize)]
    struct Document<'d> {
        name: &'d str,
        suites: &'d [Suite<'d>],
        tests: usize,
        skipped: usize,
        failures: usize,
    }
    let outcomes: Vec<&str> = suites
        .iter()
        .flat_map(|suite| &suite.cases)
        .map(|case| case.outcome)
        .collect();
    let count = |outcome: &str| outcomes.iter().filter(|own| **own == outcome).count();
    let [passing, skipped] = [Verdict::Pass.name(), SKIPPED].map(count);
    let document = Document {
        name,
        suites,
        tests: outcomes.len(),
        skipped,
        failures: outcomes.len() - passing - skipped,
    };
    render("junit.xml", &document)
}
