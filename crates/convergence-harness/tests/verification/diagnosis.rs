//! Which settings a diagnosis names.

use convergence_harness::program;
use convergence_harness::project::Project;
use convergence_harness::run::Finished;
use convergence_harness::store::diagnosis::diagnose;
use convergence_harness::study::header::Setting;
use convergence_harness::study::{Check, Header, KindRow, Outcome, Subject};

use super::fake::{Does, fake, finished};

/// A kind whose items exercise nothing but their method.
const KIND: KindRow = KindRow {
    settings: |_, subject| vec![method(subject.method.as_deref().unwrap_or_default())],
    ..program::ROW
};

fn method(name: &str) -> Setting {
    ("method".to_owned(), name.to_owned())
}

/// What is named where a ratio of two methods fails, and a check of each method passes.
fn settings_named(ratio: Subject) -> Vec<Setting> {
    let project = Project {
        kinds: &[KIND],
        ..Project::new("a", "a")
    };
    let mut checks = vec![Check::that(false, "c", "").about(ratio)];
    for method in ["midpoint", "dg", "one-step", "fixed-point"] {
        checks.push(Check::that(true, "c", "").about(Subject::of("error").by(method)));
    }
    let mut studies: Vec<Finished> = finished(vec![fake("s", Does::Converge).erased()]);
    studies[0].header = Header {
        kind: KIND.name.to_owned(),
        ..Header::new("s", "c")
    };
    studies[0].outcome = Outcome::new("", vec![], checks);
    let found = diagnose(&project, &studies, &[]);
    found.expect("a check fails").contrast.settings
}

#[test]
fn a_ratio_blames_both_its_parts() {
    let alone = Subject::of("work").by("midpoint");
    assert_eq!(settings_named(alone.clone()), [method("midpoint")]);
    assert_eq!(settings_named(alone.against("dg")), []);
}
