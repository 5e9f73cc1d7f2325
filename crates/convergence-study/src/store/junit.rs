//! The verdicts as JUnit XML, for CI systems.
//!
//! One suite for each study, one test case for each rate and check; inconclusive is a separate type
//! of failure. There are no times: the file must not change when nothing has changed.

use std::fmt::Write as _;

use crate::judge::verdict::Verdict;
use crate::plots::attributes::{escape, escape_attribute};
use crate::run::{Finished, Item, items};
use crate::store::{GuardedChange, Record, diagnosis::Diagnosis, without_baseline};

/// The document, for the project of this name.
///
/// Differences from the baseline form a separate suite, if there is a baseline.
pub fn junit(name: &str, record: &Record) -> String {
    let mut suites: Vec<Suite> = record.studies.iter().map(suite).collect();
    let changes = record.changes.as_deref();
    suites.extend(changes.map(|changes| baseline(&record.studies, changes)));
    suites.extend(record.diagnosis.as_ref().map(cause));
    document(name, &suites)
}

/// The verdicts on a table, for [`junit_of`].
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct JudgedSuite {
    /// The name of the suite.
    pub name: String,
    /// The name of each test case, its verdict, and the reason unless it is a pass.
    pub cases: Vec<(String, Verdict, String)>,
    /// The name of each column that is set aside, and the reason.
    pub skipped: Vec<(String, String)>,
}

/// A document with these suites.
pub(crate) fn junit_of(name: &str, suites: &[JudgedSuite]) -> String {
    let suites = suites.iter().map(|suite| {
        let name = &suite.name;
        let cases = suite.cases.iter();
        let cases = cases.map(|(case, verdict, reason)| Case::new(name, case, *verdict, reason));
        let skipped = suite.skipped.iter();
        let skipped = skipped.map(|(case, reason)| Case {
            is_skipped: true,
            ..Case::new(name, case, Verdict::Inconclusive, reason)
        });
        Suite {
            cases: cases.chain(skipped).collect(),
            ..Suite::new(name)
        }
    });
    document(name, &suites.collect::<Vec<_>>())
}

/// Test cases about one subject.
struct Suite {
    name: String,
    /// Names and values.
    properties: Vec<[String; 2]>,
    cases: Vec<Case>,
    /// A text of lines, empty without errors.
    errors: String,
}

impl Suite {
    fn new(name: &str) -> Self {
        Self {
            name: name.to_owned(),
            properties: vec![],
            cases: vec![],
            errors: String::new(),
        }
    }
}

struct Case {
    name: String,
    /// What it is about: the name of the suite.
    class: String,
    verdict: Verdict,
    reason: String,
    /// More about a failure, empty if there is no more.
    description: String,
    /// Whether it is not judged.
    is_skipped: bool,
}

impl Case {
    fn new(class: &str, name: &str, verdict: Verdict, reason: &str) -> Self {
        Self {
            name: name.to_owned(),
            class: class.to_owned(),
            verdict,
            reason: reason.to_owned(),
            description: String::new(),
            is_skipped: false,
        }
    }

    fn fails(&self) -> bool {
        self.verdict != Verdict::Pass && !self.is_skipped
    }
}

fn suite(study: &Finished) -> Suite {
    let id = study.header.id.as_str();
    let mut suite = Suite::new(id);
    suite.properties = vec![["claim".to_owned(), study.header.claim.clone()]];
    for item in items(study) {
        // Cases without a result are no test cases: they fail the check that all complete.
        if matches!(item, Item::Cases { .. }) {
            continue;
        }
        let mut case = Case::new(id, &item.name(), item.verdict(), &item.why());
        if let (Some(code), Some(advice)) = (item.code(), item.advice()) {
            case.description = format!("{code}: {advice}");
        }
        suite.cases.push(case);
    }
    for failed in &study.failed_cases {
        let _ = writeln!(suite.errors, "{}: {}", failed.label, failed.reason);
    }
    suite
}

/// The known facts about the cause, as properties of a suite without test cases.
fn cause(diagnosis: &Diagnosis) -> Suite {
    let lines = diagnosis.lines().into_iter();
    Suite {
        properties: lines.map(|(word, text)| [word.to_owned(), text]).collect(),
        ..Suite::new("what fails and what does not")
    }
}

fn baseline(studies: &[Finished], changes: &[GuardedChange]) -> Suite {
    const NAME: &str = "baseline";
    let mut suite = Suite::new(NAME);
    if let Some(numbers) = without_baseline(studies, changes) {
        let why = format!("no baseline yet: {numbers} numbers");
        suite.cases = vec![Case::new(NAME, "a baseline", Verdict::Fail, &why)];
        return suite;
    }
    if changes.is_empty() {
        let name = "all baseline values unchanged";
        suite.cases = vec![Case::new(NAME, name, Verdict::Pass, "")];
    }
    for change in changes {
        let name = format!("{}: {}", change.study, change.name);
        let why = change.movement.to_string();
        suite
            .cases
            .push(Case::new(NAME, &name, Verdict::Fail, &why));
    }
    suite
}

fn document(name: &str, suites: &[Suite]) -> String {
    let cases: Vec<&Case> = suites.iter().flat_map(|suite| &suite.cases).collect();
    let failures = cases.iter().filter(|case| case.fails()).count();
    let skipped = cases.iter().filter(|case| case.is_skipped).count();
    let mut text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n".to_owned();
    let name = attribute("name", name);
    let tests = cases.len();
    let _ = writeln!(
        text,
        "<testsuites{name} tests=\"{tests}\" skipped=\"{skipped}\" failures=\"{failures}\" errors=\"0\">"
    );
    for suite in suites {
        write_suite(&mut text, suite);
    }
    text + "</testsuites>\n"
}

fn write_suite(text: &mut String, suite: &Suite) {
    let failures = suite.cases.iter().filter(|case| case.fails()).count();
    let skipped = suite.cases.iter().filter(|case| case.is_skipped).count();
    let name = attribute("name", &suite.name);
    let tests = suite.cases.len();
    let _ = writeln!(
        text,
        "    <testsuite{name} tests=\"{tests}\" skipped=\"{skipped}\" errors=\"0\" failures=\"{failures}\">"
    );
    if !suite.properties.is_empty() {
        *text += "        <properties>\n";
        for [name, value] in &suite.properties {
            let [name, value] = [attribute("name", name), attribute("value", value)];
            let _ = writeln!(text, "            <property{name}{value}/>");
        }
        *text += "        </properties>\n";
    }
    for case in &suite.cases {
        write_case(text, case);
    }
    if !suite.errors.is_empty() {
        let errors = content(&suite.errors);
        let _ = writeln!(text, "        <system-err>{errors}</system-err>");
    }
    *text += "    </testsuite>\n";
}

fn write_case(text: &mut String, case: &Case) {
    let attributes = attribute("name", &case.name) + &attribute("classname", &case.class);
    if !case.fails() && !case.is_skipped {
        let _ = writeln!(text, "        <testcase{attributes}/>");
        return;
    }
    let _ = writeln!(text, "        <testcase{attributes}>");
    if case.is_skipped {
        let why = attribute("message", &case.reason);
        let _ = writeln!(text, "            <skipped{why}/>\n        </testcase>");
        return;
    }
    let why = attribute("message", &case.reason) + &attribute("type", case.verdict.name());
    let description = content(&case.description);
    let _ = writeln!(
        text,
        "            <failure{why}>{description}</failure>\n        </testcase>"
    );
}

/// An attribute with a blank in front. The name needs no escapes.
fn attribute(name: &str, value: &str) -> String {
    format!(" {name}=\"{}\"", escape_attribute(value))
}

/// Lines as the content of an element: no control character but line ends.
fn content(text: &str) -> String {
    text.split('\n').map(escape).collect::<Vec<_>>().join("\n")
}
