//! Extremes and random scenes: what must make each fail.

use crate::{Results, changed, file, passes_but_not_without_each_case, results, text};
use convergence_study::judge::verdict::Verdict;
use thermobeam_study::kinds::extremes::Extremes;
use thermobeam_study::kinds::random_scenes::RandomScenes;
use thermobeam_study::kinds::{FromFile, Study};

fn extremes() -> Extremes {
    Extremes::read(file("extremes.toml")).unwrap_or_else(|error| panic!("{error}"))
}

fn scenes() -> RandomScenes {
    RandomScenes::read(file("random-scenes-quick.toml")).unwrap_or_else(|error| panic!("{error}"))
}

/// The results with one number of one case changed.
fn with(results: &Results, index: usize, name: &str, value: f64) -> Results {
    let mut results = results.clone();
    let measured = results[index].as_mut().expect("a result");
    let found = measured.values.iter_mut().find(|(key, _)| key == name);
    found.unwrap_or_else(|| panic!("no {name} in case {index}")).1 = value;
    results
}

#[test]
fn the_files_pass_but_not_without_each_case() {
    passes_but_not_without_each_case(&extremes());
    passes_but_not_without_each_case(&scenes());
}

#[test]
fn an_extreme_fails_on_each_of_its_claims() {
    let (study, sound) = (extremes(), results(&extremes()));
    let verdict = |results: Results| study.conclude(&results).verdict;
    let at = |label: &str| study.cases().iter().position(|case| case.label == label).expect("a case");
    for (label, name, value) in [
        ("hat", "end", 1.0),
        ("hat", "steps", 199.0),
        ("hat", "open", 1.1),
        ("hat", "risen", f64::NAN),
        ("buckled-too-long-a-step", "end", 0.0),
        ("compliance-1e-8-fixed-point", "end", 0.0),
        ("no-viscosity-midpoint", "drift", 1.1e-11),
        ("no-viscosity-midpoint", "drift", f64::NAN),
    ] {
        assert_eq!(verdict(with(&sound, at(label), name, value)), Verdict::Fail, "{label}: {name} {value}");
    }
}

#[test]
fn random_scenes_fail_on_each_of_their_claims() {
    let (study, sound) = (scenes(), results(&scenes()));
    for name in ["refused", "broken", "iteration limit", "not finite", "open", "risen", "exceptions", "answers"] {
        for value in [2.0, f64::NAN] {
            let planted = changed(&sound, name, |case, old| if case == 0 { value } else { old });
            assert_eq!(study.conclude(&planted).verdict, Verdict::Fail, "{name} {value}");
        }
    }
}

#[test]
fn files_that_make_no_sense_are_refused() {
    let refuse = |message: &str, error: String| assert!(error.contains(message), "{error}");
    for (from, to, message) in [
        ("name = \"hat\"", "name = \"velocity-step\"", "a name of its own"),
        ("ends = \"indefinite\"", "ends = \"well\"", "ends"),
        ("drift = 1e-11", "drift = 0", "drift"),
        ("zeta = 0.0", "zeta = -1.0", "beam.zeta"),
    ] {
        let changed = text("extremes.toml").replacen(from, to, 1);
        refuse(message, Extremes::parse(&changed, "e.toml".as_ref()).expect_err(to).to_string());
    }
    let changed = text("random-scenes-quick.toml").replace("batches = 2", "batches = 0");
    refuse("random-scenes.batches", RandomScenes::parse(&changed, "r.toml".as_ref()).expect_err("none").to_string());
}
