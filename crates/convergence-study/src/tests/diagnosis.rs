//! Which settings a diagnosis names, and its words.

use crate::{
    Check, Finished, Header, Outcome, Subject,
    report::text_of_diagnosis,
    store::{GuardedChange, Movement, diagnosis::diagnose},
};

use super::fake::{Does, fake, finished};

fn method(name: &str) -> (String, String) {
    ("method".to_owned(), format!("method {name}"))
}

/// A study whose checks are about these methods; those of `failing` fail.
fn of_methods(id: &str, failing: &[Subject], passing: &[&str]) -> Finished {
    let mut checks = vec![];
    for subject in failing {
        checks.push(Check::that(false, "c", "").about(subject.clone()));
    }
    for method in passing {
        checks.push(Check::that(true, "c", "").about(Subject::of("error").by(*method)));
    }
    with(Header::new(id, "c"), checks)
}

/// A study that has run.
fn with(header: Header, checks: Vec<Check>) -> Finished {
    let mut finished = finished(vec![fake("", Does::Converge).erased()]).remove(0);
    finished.header = header;
    finished.outcome = Outcome::new("", vec![], checks);
    finished
}

fn by(method: &str) -> Subject {
    Subject::of("error").by(method)
}

/// What is named of studies with these outcomes.
fn named(studies: Vec<Finished>) -> Vec<(String, String)> {
    let found = diagnose(&studies, &[]).expect("a check fails");
    assert_eq!(text_of_diagnosis(&found).is_empty(), found.shared.is_none());
    found.shared.map_or(vec![], |shared| shared.settings)
}

/// Values of the file, and of the entry with the name of the case; not those of other entries.
#[test]
fn the_settings_of_a_case_are_the_values_of_its_file_and_of_its_entry() {
    let study = |id: &str, coupling: &str| {
        let mut header = Header::new(id, "c");
        for (path, value) in [
            ("heat.rate", coupling),
            ("case[0].name", "\"bounces\""),
            ("case[0].heat.size", "2"),
            ("case[1].name", "\"rests\""),
            ("case[1].heat.size", "1"),
        ] {
            header.settings.push((path.to_owned(), value.to_owned()));
        }
        let about = |case: &str| Subject::of("u").in_case(case);
        let fails = Check::that(false, "c", "").about(about("bounces"));
        let passes = Check::that(true, "c", "").about(about("rests"));
        with(header, vec![fails, passes])
    };
    let pair = |path: &str, value: &str| (path.to_owned(), format!("{path} {value}"));
    assert_eq!(
        named(vec![study("a", "0.5"), study("b", "0")]),
        [pair("name", "bounces"), pair("heat.size", "2")]
    );
}

#[test]
fn what_two_studies_share_where_they_fail_is_named() {
    let one = || of_methods("a", &[by("midpoint")], &["dg"]);
    let two = || of_methods("b", &[by("midpoint")], &["one-step"]);
    assert_eq!(named(vec![one(), two()]), [method("midpoint")]);
    // A case that passes is evidence against it, whatever its study says.
    let passes = of_methods("c", &[], &["midpoint"]);
    assert_eq!(named(vec![one(), two(), passes]), []);
}

#[test]
fn what_a_single_study_shows_is_not_named() {
    let one = || of_methods("a", &[by("midpoint")], &["dg"]);
    assert_eq!(named(vec![one()]), []);
    let other = of_methods("b", &[by("dg")], &["one-step"]);
    assert_eq!(named(vec![one(), other]), []);
}

#[test]
fn what_passes_in_one_of_the_studies_is_not_named() {
    let one = of_methods("a", &[by("midpoint")], &["dg"]);
    let two = of_methods("b", &[by("midpoint"), by("dg")], &["one-step"]);
    // The check of the error passes by the midpoint rule, too, but that of the work fails: its case
    // does.
    let three = of_methods("c", &[by("midpoint")], &["midpoint"]);
    assert_eq!(named(vec![one, two, three]), [method("midpoint")]);
    let both = |id| of_methods(id, &[by("dg")], &["midpoint"]);
    let passing = of_methods("c", &[by("midpoint")], &["dg"]);
    assert_eq!(named(vec![both("a"), both("b"), passing]), []);
}

#[test]
fn a_ratio_blames_both_its_parts() {
    let ratio = || by("midpoint").against("dg");
    let studies = ["a", "b"].map(|id| of_methods(id, &[ratio()], &["one-step"]));
    assert_eq!(
        named(studies.into()),
        [method("midpoint"), method("dg")],
        "either may be wrong"
    );
}

#[test]
fn numbers_that_moved_are_failing_cases_where_all_studies_pass() {
    let studies = ["a", "b"].map(|id| fake(id, Does::Converge).erased());
    let ran = finished(studies.into());
    let changes = ["a", "b"].map(|id| moved(id, "finest error", 2.0, 3.0));
    let found = diagnose(&ran, &changes).expect("numbers moved");
    let shared = found.shared.expect("both are of one field");
    assert_eq!((shared.cases, shared.studies), (2, 2));
    assert_eq!(diagnose(&ran, &[]), None);
    let one = diagnose(&ran, &changes[..1]).expect("a number moved");
    assert_eq!(one.lines(), []);
}

fn moved(study: &str, name: &str, from: f64, to: f64) -> GuardedChange {
    let movement = Movement::Moved {
        from,
        to,
        tolerance: 1e-3,
    };
    GuardedChange {
        study: study.to_owned(),
        name: name.to_owned(),
        movement,
    }
}

#[test]
fn a_change_is_said_in_per_cent_or_in_numbers_that_differ() {
    for (from, to, words) in [
        (1.0, 8.0, "by +700 %"),
        (1.0, 0.99, "by -1 %"),
        (-1.0, -0.999, "by +0.1 %"),
    ] {
        let words_of = moved("s", "loss", from, to).to_string();
        assert!(words_of.contains(words), "{words_of}");
        assert!(!words_of.contains("-0.000"), "{words_of}");
    }
}
