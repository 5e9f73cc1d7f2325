//! Which settings a diagnosis names, and its words.

use std::num::NonZeroUsize;

use convergence_study::{
    Case, CaseFailure, Check, Finished, Header, Kind, Outcome, Ran, Subject, boxed_study,
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

/// What is named where a ratio of two methods fails, and a check of each method passes.
fn settings_named(ratio: Subject) -> Vec<SettingWords> {
    let mut checks = vec![Check::that(false, "c", "").about(ratio)];
    for method in ["midpoint", "dg", "one-step", "fixed-point"] {
        checks.push(Check::that(true, "c", "").about(Subject::of("error").by(method)));
    }
    let studies = [boxed_study(Header::new("s", "c"), Methods)];
    let mut ran: Vec<Finished> = run(&studies, NonZeroUsize::MIN, &|_| ()).unwrap();
    ran[0].outcome = Outcome::new("", vec![], checks);
    let found = diagnose(&program::PROJECT, &studies, &ran, &[]);
    found.expect("a check fails").contrast.settings
}

#[test]
fn a_ratio_blames_both_its_parts() {
    let alone = Subject::of("work").by("midpoint");
    assert_eq!(settings_named(alone.clone()), [method("midpoint")]);
    assert_eq!(settings_named(alone.against("dg")), []);
}

fn moved(name: &str, from: f64, to: f64) -> GuardedChange {
    let movement = Movement::Moved {
        from,
        to,
        tolerance: 1e-3,
    };
    GuardedChange {
        study: "s".to_owned(),
        name: name.to_owned(),
        movement,
    }
}

#[test]
fn checks_also_fail_and_a_zero_is_multiplied_by_nothing() {
    let mut studies = finished(vec![fake("s", Does::Converge).erased()]);
    let check = Check::that(false, "the energy falls", "it rises");
    studies[0].outcome = Outcome::new("", vec![], vec![check]);
    for (from, to, words) in [
        (0.0, 1e-3, "loss (no longer zero)"),
        (2e-3, 1e-3, "loss (by a factor up to 0.5)"),
    ] {
        let changes = [moved("loss", from, to)];
        let found = diagnose(&program::PROJECT, &[], &studies, &changes).expect("a check fails");
        let text = text_of_diagnosis(&found);
        assert!(text.contains("also fails the energy falls"), "{text}");
        assert!(text.contains(words) && !text.contains("infinity"), "{text}");
    }
}

#[test]
fn a_change_is_said_in_per_cent_or_in_numbers_that_differ() {
    for (from, to, words) in [
        (1.0, 8.0, "by +700 %"),
        (1.0, 0.99, "by -1 %"),
        (-1.0, -0.999, "by +0.1 %"),
    ] {
        let words_of = moved("loss", from, to).to_string();
        assert!(words_of.contains(words), "{words_of}");
        assert!(!words_of.contains("-0.000"), "{words_of}");
    }
}
