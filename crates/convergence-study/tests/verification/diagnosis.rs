//! Which settings a diagnosis names, and its words.

use std::num::NonZeroUsize;

use convergence_study::{
    Case, CaseFailure, Check, Finished, Header, Kind, Outcome, Ran, Study, Subject, boxed_study,
    internal::{
        program,
        report::text_of_diagnosis,
        run::run,
        store::{GuardedChange, Movement, diagnosis::diagnose},
        study::header::SettingWords,
    },
};

use super::fake::{Does, fake, finished};

/// A study whose items exercise nothing but their method.
struct Methods;

impl Kind for Methods {
    type Data = ();
    type Found = ();

    fn cases(&self) -> Vec<Case<()>> {
        vec![Case::new("all", 1.0, ())]
    }

    fn run(&self, (): &()) -> Result<(), CaseFailure> {
        Ok(())
    }

    fn judge(&self, _: &[Ran<(), ()>]) -> Outcome {
        Outcome::new("", vec![], vec![Check::that(true, "c", "")])
    }

    fn settings(&self, _: &Header, subject: &Subject) -> Vec<SettingWords> {
        vec![method(subject.method.as_deref().unwrap_or_default())]
    }
}

fn method(name: &str) -> SettingWords {
    ("method".to_owned(), name.to_owned())
}

/// A study whose checks are about these methods; those of `failing` fail.
fn of_methods(id: &str, failing: &[Subject], passing: &[&str]) -> (Box<dyn Study>, Outcome) {
    let mut checks = vec![];
    for subject in failing {
        checks.push(Check::that(false, "c", "").about(subject.clone()));
    }
    for method in passing {
        checks.push(Check::that(true, "c", "").about(Subject::of("error").by(*method)));
    }
    let study = boxed_study(Header::new(id, "c"), Methods);
    (study, Outcome::new("", vec![], checks))
}

fn by(method: &str) -> Subject {
    Subject::of("work").by(method)
}

/// What is named of studies with these outcomes.
fn named(studies: Vec<(Box<dyn Study>, Outcome)>) -> Vec<SettingWords> {
    let (studies, outcomes): (Vec<_>, Vec<_>) = studies.into_iter().unzip();
    let mut ran: Vec<Finished> = run(&studies, NonZeroUsize::MIN, &|_| ()).unwrap();
    for (ran, outcome) in ran.iter_mut().zip(outcomes) {
        ran.outcome = outcome;
    }
    let found = diagnose(&program::PROJECT, &studies, &ran, &[]).expect("a check fails");
    assert_eq!(text_of_diagnosis(&found).is_empty(), found.shared.is_none());
    found.shared.map_or(vec![], |shared| shared.settings)
}

#[test]
fn what_two_studies_share_where_they_fail_is_named() {
    let one = || of_methods("a", &[by("midpoint")], &["dg"]);
    let two = || of_methods("b", &[by("midpoint")], &["one-step"]);
    assert_eq!(named(vec![one(), two()]), [method("midpoint")]);
    // A study that passes is no evidence against it: it may not exercise what is wrong.
    let passes = of_methods("c", &[], &["midpoint"]);
    assert_eq!(named(vec![one(), two(), passes]), [method("midpoint")]);
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
    let found = diagnose(&program::PROJECT, &[], &ran, &changes).expect("numbers moved");
    let shared = found.shared.expect("both are of one field");
    assert_eq!((shared.cases, shared.studies), (2, 2));
    assert_eq!(diagnose(&program::PROJECT, &[], &ran, &[]), None);
    let one = diagnose(&program::PROJECT, &[], &ran, &changes[..1]).expect("a number moved");
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
