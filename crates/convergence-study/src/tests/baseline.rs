//! The baseline: what differs from it is named, and blessed if it may be.
//!
//! It keeps the numbers of each study with their claims, and a hash of the study's settings.

use std::path::PathBuf;
use std::{fs, io};

use crate::{
    Finished, Header, Must, Sheet, measured,
    report::{sentence, words::blessing},
    run::listed,
    store::{Baseline, GuardedChange, diagnosis::diagnose},
    study::Quantity,
};
use tempfile::TempDir;

use crate::refused::each_is_refused;
use crate::rows::rows;

use super::fake::{Does, Fake, PROJECT, converging, fake, finished, says};
use convergence_judge::verdict::Verdict;

const SETTINGS: [(&str, &str); 3] = [
    ("study.tier", "\"quick\""),
    ("expect[0].order", "1"),
    ("expect[0].tolerance", "0.002"),
];

/// A study that converges, whose file has settings and whose number has a claim.
fn named(id: &str) -> Fake {
    let settings = SETTINGS.map(|(path, value)| (path.to_owned(), value.to_owned()));
    let mut study = converging(id).claiming(Some(Must::AtMost(0.01)));
    study.header.settings = settings.into();
    study
}

fn a() -> Fake {
    named("a")
}

impl Fake {
    /// With another value at a path of its file; `None`: without that path.
    fn with(mut self, path: &str, value: Option<&str>) -> Self {
        self.header.settings.retain(|(of, _)| of != path);
        let added = value.map(|value| (path.to_owned(), value.to_owned()));
        self.header.settings.extend(added);
        self
    }

    fn guarded(mut self, guard: Option<f64>) -> Self {
        self.header.guard = guard;
        self
    }

    /// Its header with its cases.
    fn listed(self) -> Header {
        listed(self.erased().as_ref())
    }
}

fn ran(studies: impl IntoIterator<Item = Fake>) -> Vec<Finished> {
    finished(studies.into_iter().map(Fake::erased).collect())
}

fn blessed(finished: &[Finished]) -> Baseline {
    let mut baseline = Baseline::default();
    baseline.bless(finished, None, false).unwrap();
    baseline
}

/// The changes in words, without the hashes of settings.
fn words(changes: &[GuardedChange]) -> Vec<String> {
    let word = |change: &GuardedChange| {
        let words = change.to_string();
        words.split_inclusive(": hash").next().unwrap().to_owned()
    };
    changes.iter().map(word).collect()
}

/// Whether a run is blessed without leave; what then differs is nothing.
#[track_caller]
fn is_blessed(baseline: &mut Baseline, ran: &[Finished], known: Option<&[Header]>) -> bool {
    let (before, changes) = (baseline.clone(), baseline.compare(ran, known));
    let plainly = baseline.bless(ran, known, false);
    match &plainly {
        Ok(loosened) => assert_eq!(loosened, &[]),
        Err(refused) => {
            says(refused, "--bless --loosened\n  ");
            assert_eq!(*baseline, before);
            let taken = baseline.bless(ran, known, true).unwrap();
            assert!(!taken.is_empty() && taken.iter().all(|one| changes.contains(one)));
        }
    }
    assert_eq!(baseline.compare(ran, known), []);
    plainly.is_ok()
}

const HASH: &str = "a: settings have changed: hash";

/// The study `a`, changed as a cell says.
fn changed(cell: &str) -> Fake {
    let mut study = a();
    for part in cell.split_terminator(", ") {
        let (key, value) = part.split_once(" = ").expect(part);
        let number = || value.parse().expect("a number");
        match key {
            "id" => study = named(value),
            "scale" => study.scale = number(),
            "tolerance" => study.tolerance = number(),
            "claim" => study.claim = Must::try_from(value.to_owned()).ok(),
            "guard" => study.header.guard = Some(number()),
            path => study = study.with(path, Some(value).filter(|value| *value != "none")),
        }
    }
    study
}

#[test]
fn what_differs_is_named_and_blessed_on_demand_if_less_is_guarded() {
    let baseline = blessed(&ran([a()]));
    for [change, leave, said] in rows(include_str!("baseline.md")) {
        let study = changed(change);
        let (claim, ran) = (study.claim, ran([study]));
        assert_eq!(words(&baseline.compare(&ran, None)).join("; "), said);
        let mut plain = baseline.clone();
        assert_eq!(
            is_blessed(&mut plain, &ran, None),
            leave.is_empty(),
            "{said}"
        );
        let number = plain.number(&ran[0].header.id, "finest error");
        assert_eq!(number.unwrap().claim, claim);
    }
}

#[test]
fn what_is_not_finite_has_moved_and_is_not_blessed() {
    let baseline = blessed(&ran([converging("a")]));
    for (scale, text) in [(f64::NAN, "NaN"), (f64::INFINITY, "inf")] {
        let found = words(&baseline.compare(&ran([converging("a").scaled(scale)]), None));
        let said = format!(
            "a: finest error moved from 0.00234375 to {text}, which is not finite and matches nothing"
        );
        assert_eq!(found, [said]);
    }
    for (value, tolerance) in [
        (f64::NAN, 0.1),
        (f64::INFINITY, 0.1),
        (1.0, f64::NAN),
        (1.0, -0.1),
        (1.0, f64::INFINITY),
    ] {
        let mut run = ran([a()]);
        let odd = Quantity::new("odd", value, tolerance);
        run[0].outcome.quantities.push(odd);
        let refused = Baseline::default().bless(&run, None, true).unwrap_err();
        let refused = refused.to_string();
        assert!(
            refused.starts_with("not blessed: `odd` of `a` is "),
            "{refused}"
        );
    }
}

#[test]
fn a_run_that_does_not_pass_is_not_blessed() {
    for (does, verdict) in [
        (Does::Stay, "fail"),
        (Does::TooShort, "inconclusive"),
        (Does::Nothing, "inconclusive"),
    ] {
        let mut baseline = blessed(&ran([a()]));
        let before = baseline.clone();
        let run = ran([converging("b"), fake("a", does)]);
        let refused = baseline.bless(&run, None, true).unwrap_err().to_string();
        let said = format!("the verdict on `a` is {verdict}");
        says(&refused, &said);
        assert_eq!(baseline, before);
    }
}

#[test]
fn studies_and_numbers_that_are_new_or_gone_are_named_and_others_that_were_not_run_are_not() {
    let mut baseline = blessed(&ran([a(), named("gone"), named("c")]));
    let renamed = Fake {
        quantity: "coarsest error",
        ..a()
    };
    let run = ran([renamed, named("new")]);
    let in_these = [
        "a: coarsest error is new: 0.00234375",
        "a: finest error has vanished: was 0.00234375",
        "new: study is new",
        "new: finest error is new: 0.00234375",
    ];
    assert_eq!(words(&baseline.compare(&run, None)), in_these);
    let gone = "gone: study was deleted: it had 1 guarded number";
    let loose = named("c").with("expect[0].tolerance", Some("0.49"));
    let known = [a(), named("new"), loose].map(Fake::listed);
    let changes = baseline.compare(&run, Some(&known));
    let settings = "c: settings have changed: hash";
    assert_eq!(words(&changes), [&in_these[..], &[settings, gone]].concat());
    let said = "; 1 study not yet in the baseline, 1 study with changed settings, 1 study deleted";
    let mut studies = changes.clone();
    studies.remove(3);
    let all = sentence(&run, Some(&studies[2..]));
    assert!(all.ends_with(said), "{all}");
    // The tier that runs a study blesses it.
    let asks = |changes| blessing(&PROJECT, "cargo xtask verify", &run, changes);
    assert_eq!(
        asks(&changes),
        "cargo xtask verify --tier full --bless --loosened"
    );
    assert_eq!(asks(&changes[5..]), "cargo xtask verify --bless --loosened");
    assert_eq!(asks(&[]), "cargo xtask verify --bless");
    // A blessing of some leaves the others, and drops what is gone on demand.
    let known = [a(), named("c")].map(Fake::listed);
    let run = ran([a().scaled(2.0)]);
    let refused = baseline.bless(&run, Some(&known), false).unwrap_err();
    assert!(
        refused.to_string().ends_with(&format!("\n  {gone}")),
        "{refused}"
    );
    assert_eq!(baseline.bless(&run, Some(&known), true).unwrap().len(), 1);
    assert_eq!(["a", "c", "gone"].map(|id| baseline.guards(id)), [1, 1, 0]);
    assert_eq!(
        baseline.compare(&ran([a().scaled(2.0), named("c")]), None),
        []
    );
}

/// One program of a project may have studies in code, and another none: a blessing by that one must
/// not take them from the baseline.
#[test]
fn studies_in_code_are_not_deleted_by_a_program_that_has_none() {
    let in_code = |id: &str| Fake {
        header: Header {
            home: Some("src/studies.rs"),
            ..converging(id).header
        },
        ..converging(id)
    };
    let mut baseline = blessed(&ran([a(), in_code("b"), in_code("c")]));
    let [one, other] = [[a()].map(Fake::listed), [in_code("b")].map(Fake::listed)];
    let run = ran([a().scaled(2.0)]);
    let changes = baseline.compare(&[], Some(&one));
    let elsewhere = "study is in code, and this program has no studies in code";
    for (change, id) in changes.iter().zip(["b", "c"]) {
        says(change.to_string(), &format!("{id}: {elsewhere}"));
        assert_eq!(change.movement.verdict(), Verdict::Inconclusive);
    }
    assert_eq!(baseline.bless(&run, Some(&one), true), Ok(vec![]));
    assert_eq!(["a", "b", "c"].map(|id| baseline.guards(id)), [1, 1, 1]);
    // A program with studies in code misses those that are gone.
    let gone = words(&baseline.compare(&[], Some(&other)));
    says(&gone[1], "c: study was deleted");
}

#[test]
fn a_case_less_is_another_setting() {
    let baseline = blessed(&ran([a()]));
    let mut fewer = a().listed();
    assert_eq!(baseline.compare(&[], Some(&[fewer.clone()])), []);
    fewer.cases.pop();
    assert_eq!(words(&baseline.compare(&[], Some(&[fewer]))), [HASH]);
}

/// A baseline in its file.
struct File {
    path: PathBuf,
    _folder: TempDir,
}

impl File {
    fn of(baseline: &Baseline) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("baseline.json");
        baseline.write(&path).unwrap();
        Self {
            path,
            _folder: folder,
        }
    }

    fn text(&self) -> String {
        fs::read_to_string(&self.path).unwrap()
    }

    /// What is read after a change of the file as it was.
    fn edited(&self, text: &str, from: &str, to: &str) -> Baseline {
        assert!(text.contains(from), "{from}");
        fs::write(&self.path, text.replace(from, to)).unwrap();
        Baseline::read(&self.path).unwrap()
    }
}

/// Such as a constant in code that somebody loosens a thousandfold.
#[test]
fn a_claim_of_a_number_that_is_not_guarded_stands_in_the_baseline_by_its_name() {
    let claiming = |bounds: [Option<f64>; 2]| {
        let mut ran = ran([a()]);
        let numbers = ["t = 1", "t = 2"].into_iter().zip(bounds);
        let numbers = numbers
            .map(|(case, bound)| measured(case, "change", 1e-4).must_be(bound.map(Must::AtMost)));
        ran[0].outcome.sheets = vec![Sheet::new("Changes", "time", numbers)];
        ran
    };
    let same = claiming([Some(1e-3); 2]);
    let file = File::of(&blessed(&same));
    let claims = "\"claims\": {\n        \"change\": \"<= 0.001\"\n      }";
    assert!(file.text().contains(claims));
    let baseline = Baseline::read(&file.path).unwrap();
    assert_eq!(baseline.compare(&same, None), []);
    let looser = |is: &str| format!("a: change has a looser claim: was <= 0.001, is {is}");
    let tighter =
        |of: &str, is: &str| format!("a: {of}: change has a tighter claim: was none, is <= {is}");
    for (bounds, said) in [
        ([Some(1.0); 2], vec![looser("<= 1")]),
        ([None; 2], vec![looser("none")]),
        (
            [Some(1e-3), Some(1.0)],
            vec![
                looser("none"),
                tighter("t = 1", "0.001"),
                tighter("t = 2", "1"),
            ],
        ),
    ] {
        let ran = claiming(bounds);
        assert_eq!(words(&baseline.compare(&ran, None)), said);
        assert!(!is_blessed(&mut baseline.clone(), &ran, None));
    }
}

#[test]
fn a_guard_counts_once_it_is_blessed_and_is_kept() {
    let guarded = |guard, scale| {
        ran([Fake {
            tolerance: 1e-6,
            ..a().guarded(guard).scaled(scale)
        }])
    };
    let scattered = guarded(Some(1e-4), 1.00005);
    let mut baseline = blessed(&guarded(None, 1.0));
    let moved =
        "a: finest error moved from 0.00234375 to 0.00234387, by +0.005 %, tolerated 0.0001 %";
    let found = words(&baseline.compare(&scattered, None));
    assert_eq!(found, ["a: guard was none, is 1e-4", moved]);
    assert!(baseline.bless(&scattered, None, false).is_err());
    baseline
        .bless(&guarded(Some(1e-4), 1.0), None, true)
        .unwrap();
    let mut baseline = Baseline::read(&File::of(&baseline).path).unwrap();
    assert_eq!(baseline.compare(&scattered, None), []);
    // A blessing of numbers keeps it, and their digits.
    baseline.bless(&scattered, None, false).unwrap();
    assert_eq!(baseline.compare(&scattered, None), []);
    let number = baseline.number("a", "finest error").unwrap();
    assert_eq!(number.value, 0.002_343_75);
    for wider in [Some(1e-3), Some(0.1)] {
        let wider = guarded(wider, 1.0);
        assert!(baseline.bless(&wider, None, false).is_err());
    }
    for narrower in [Some(1e-5), None] {
        let narrower = guarded(narrower, 1.0);
        assert_eq!(baseline.bless(&narrower, None, false), Ok(vec![]));
    }
    let moved = baseline.compare(&guarded(None, 1.00005), None);
    assert_eq!(moved.len(), 1, "{moved:?}");
}

/// What somebody may do to the file, by hand or in a merge.
#[test]
fn an_attack_on_the_file_is_named_and_no_guarded_number_comes_back_as_a_new_one() {
    let ran = ran([a()]);
    let known = [ran[0].header.clone()];
    let file = File::of(&blessed(&ran));
    let text = file.text();
    let settings = text.lines().find(|line| line.contains("settings")).unwrap();
    each_is_refused(include_str!("baseline_attacks.txt"), |case| {
        let old = case.old.replace("SETTINGS", settings);
        let mut edited = file.edited(&text, &old, &case.new);
        let changes = edited.compare(&ran, Some(&known));
        let is_free = is_blessed(&mut edited, &ran, Some(&known));
        assert!(!is_free || case.kind != "a number is gone", "{case:?}");
        words(&changes).remove(0)
    });
    // Emptied, it guards nothing, and everything is new.
    let empty = file.edited(&text, &text, "{ \"schema\": 3, \"studies\": {} }");
    let new = ["a: study is new", "a: finest error is new: 0.00234375"];
    assert_eq!(words(&empty.compare(&ran, Some(&known))), new);
}

#[test]
fn a_number_that_did_not_move_keeps_its_digits_when_others_are_blessed() {
    let mut baseline = blessed(&ran([converging("a"), converging("b")]));
    let before = File::of(&baseline).text();
    assert_eq!(before.matches("0.00234375,").count(), 2, "{before}");
    // Within the tolerance of 1e-3, `a` has other digits; `b` has moved.
    let run = ran([converging("a").scaled(1.0005), converging("b").scaled(2.0)]);
    baseline.bless(&run, None, false).unwrap();
    let (first, second) = before.rsplit_once("0.00234375,").unwrap();
    let after = format!("{first}0.0046875,{second}");
    assert_eq!(File::of(&baseline).text(), after);
}

#[test]
fn a_baseline_comes_back_from_its_file_bit_by_bit() {
    let exact = ran([Fake {
        tolerance: 0.0,
        ..a().scaled(std::f64::consts::PI * 1e-5)
    }]);
    let file = File::of(&blessed(&exact));
    let read = Baseline::read(&file.path).unwrap();
    assert_eq!(read.compare(&exact, None), []);
}

#[test]
fn a_file_that_is_no_baseline_is_refused_and_none_at_all_is_empty() {
    let file = File::of(&Baseline::default());
    each_is_refused(include_str!("baseline_refused.txt"), |case| {
        fs::write(&file.path, &case.new).unwrap();
        let refused = Baseline::read(&file.path).expect_err(&case.new);
        assert_eq!(refused.kind(), io::ErrorKind::InvalidData, "{case:?}");
        refused.to_string()
    });
    fs::remove_file(&file.path).unwrap();
    assert_eq!(Baseline::read(&file.path).unwrap(), Baseline::default());
}

#[test]
fn a_diagnosis_names_claims_that_changed() {
    let baseline = blessed(&ran([a(), named("b")]));
    let loose = || a().with("expect[0].tolerance", Some("0.49"));
    let diagnosed = |studies: [Fake; 2], does: Does| {
        let ran = ran(studies.map(|study| Fake { does, ..study }));
        let changes = baseline.compare(&ran, None);
        (diagnose(&ran, &changes), changes)
    };
    let (found, changes) = diagnosed([loose(), named("b")], Does::Stay);
    let found = found.expect("a study fails");
    let changed = changes.iter().map(ToString::to_string);
    let changed = changed
        .filter(|change| change.starts_with(HASH))
        .collect::<Vec<_>>();
    assert_eq!(found.claims, changed);
    assert_eq!(
        found.lines()[0],
        ("claims", format!("changed: {}", changed[0]))
    );
    // Where nothing fails and no number moved, the list of changed claims says it all.
    assert_eq!(diagnosed([loose(), named("b")], Does::Converge).0, None);
    let (found, _) = diagnosed([a(), named("b")], Does::Stay);
    assert!(found.expect("a study fails").claims.is_empty());
}
