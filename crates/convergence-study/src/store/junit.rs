//! The verdicts as JUnit XML, for CI systems.
//!
//! One suite for each study, one test case for each rate and check; inconclusive is a separate type
//! of failure. There are no times: the file is committed and must not change when nothing has
//! changed.

use quick_junit::{NonSuccessKind, Report, SerializeError, TestCase, TestCaseStatus, TestSuite};

use crate::judge::verdict::Verdict;
use crate::run::{Finished, Item, items};
use crate::store::{GuardedChange, Record, diagnosis::Diagnosis, without_baseline};

/// The document, for the project of this name.
///
/// Differences from the baseline form a separate suite, if there is a baseline.
pub fn junit(name: &str, record: &Record) -> Result<String, SerializeError> {
    let mut report = Report::new(name);
    report.add_test_suites(record.studies.iter().map(suite));
    let changes = record.changes.as_deref();
    report.add_test_suites(changes.map(|changes| baseline(&record.studies, changes)));
    report.add_test_suites(record.diagnosis.as_ref().map(cause));
    report.to_string()
}

/// The verdicts on a table, for [`junit_of`].
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct JudgedSuite {
    /// The name of the suite.
    pub name: String,
    /// The name of each test case, its verdict, and the reason unless it is a pass.
    pub cases: Vec<(String, Verdict, String)>,
}

/// A document with these suites.
pub(crate) fn junit_of(name: &str, suites: &[JudgedSuite]) -> Result<String, SerializeError> {
    let suite = |judged: &JudgedSuite| {
        let mut suite = TestSuite::new(judged.name.as_str());
        let cases = judged.cases.iter();
        suite.add_test_cases(
            cases.map(|(name, verdict, reason)| case(&judged.name, name, *verdict, reason)),
        );
        suite
    };
    let mut report = Report::new(name);
    report.add_test_suites(suites.iter().map(suite));
    report.to_string()
}

fn suite(study: &Finished) -> TestSuite {
    let id = study.header.id.as_str();
    let mut suite = TestSuite::new(id);
    suite.add_property(("claim", study.header.claim.as_str()));
    for item in items(study) {
        // Cases without a result are no test cases: they fail the check that all complete.
        if matches!(item, Item::Cases { .. }) {
            continue;
        }
        let mut judged = case(id, &item.name(), item.verdict(), &item.why());
        if let (Some(code), Some(advice)) = (item.code(), item.advice()) {
            judged.status.set_description(format!("{code}: {advice}"));
        }
        suite.add_test_case(judged);
    }
    if !study.failed_cases.is_empty() {
        let lines = study
            .failed_cases
            .iter()
            .map(|failed| format!("{}: {}\n", failed.label, failed.reason));
        suite.set_system_err(lines.collect::<String>());
    }
    suite
}

fn case(study: &str, name: &str, verdict: Verdict, reason: &str) -> TestCase {
    let mut status = match verdict {
        Verdict::Pass => TestCaseStatus::success(),
        Verdict::Fail | Verdict::Inconclusive => {
            TestCaseStatus::non_success(NonSuccessKind::Failure)
        }
    };
    if verdict != Verdict::Pass {
        status.set_type(verdict.name()).set_message(reason);
    }
    let mut case = TestCase::new(name, status);
    case.set_classname(study);
    case
}

/// The known facts about the cause, as properties of a suite without test cases.
fn cause(diagnosis: &Diagnosis) -> TestSuite {
    let mut suite = TestSuite::new("what fails and what does not");
    for (word, text) in diagnosis.lines() {
        suite.add_property((word, text.as_str()));
    }
    suite
}

fn baseline(studies: &[Finished], changes: &[GuardedChange]) -> TestSuite {
    let mut suite = TestSuite::new("baseline");
    if let Some(numbers) = without_baseline(studies, changes) {
        let why = format!("no baseline yet: {numbers} numbers");
        suite.add_test_case(case("baseline", "a baseline", Verdict::Fail, &why));
        return suite;
    }
    if changes.is_empty() {
        suite.add_test_case(case(
            "baseline",
            "all baseline values unchanged",
            Verdict::Pass,
            "",
        ));
    }
    for change in changes {
        let name = format!("{}: {}", change.study, change.subject());
        suite.add_test_case(case(
            "baseline",
            &name,
            Verdict::Fail,
            &change.movement.to_string(),
        ));
    }
    suite
}
