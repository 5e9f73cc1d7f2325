//! Laws of the paper's experiments to ten digits: two discretisations must agree, and planted
//! differences fail.

use convergence_study::{CaseFailure, FromFile, Kind, Verdict};
use thermobeam_study::kinds::runs::RunStudy;
use thermobeam_study::kinds::runs::exact_experiments::{self, ROW, ShownStates};

use super::planted::verdict_with;
use super::refused::refusal;
use super::typed::{changed, counted, passes_but_not_without_each_case, report};
use super::{file, text};

type ExactExperiments = RunStudy<exact_experiments::ExactExperiments>;

/// The first scene alone, over its first second: two contact events and the first moments of a
/// third phase.
fn study(change: impl Fn(String) -> String) -> ExactExperiments {
    let all = text("experiments-exact.toml");
    let (before, rest) = all.split_once("scenes = [").expect("scenes");
    let (_, after) = rest.split_once(']').expect("the end of the list");
    let one = format!("{before}scenes = [\"scenes/paper-1-beta-0.toml\"]{after}");
    let short = change(one.replace("times = [1.0, 10.0]", "times = [0.5, 1.0]"));
    ExactExperiments::parse(&short, &file("short.toml")).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn two_discretisations_agree_and_every_planted_difference_fails() {
    let study = study(|text| text);
    let sound = passes_but_not_without_each_case(&study);
    assert_eq!(sound.len(), 2);
    let fails = |what: &str, change: &dyn Fn(&mut ShownStates)| {
        for index in 0..sound.len() {
            assert_eq!(
                verdict_with(&study, &sound, index, change),
                Verdict::Fail,
                "{what} in run {index}"
            );
        }
    };
    for by in [2e-10, -2e-10, f64::NAN] {
        fails("u(1)", &|found| found.states[0].u_tip += by);
        fails("phi(1)", &|found| found.states[1].phi_tip += by);
        fails("u_t(1)", &|found| found.states[1].u_t_tip += by);
        fails("phi_t(1)", &|found| found.states[0].phi_t_tip += by);
        fails("theta(1/2)", &|found| found.states[1].theta_mid += by);
        fails("E", &|found| found.states[1].energy += by);
        // The tolerance for times of events is ten times larger.
        fails("the time of an event", &|found| {
            found.events[1].t += 10.0 * by;
        });
    }
    fails("a missing event", &|found| _ = found.events.pop());
    fails("an event the other way round", &|found| {
        found.events[0].to = found.events[0].from;
    });
    fails("a missing state", &|found| _ = found.states.pop());
    fails("a balance that does not close", &|found| {
        found.balance[0] = 1e-11;
    });
    fails("an energy that grows", &|found| found.balance[1] = 1e-15);
    fails("a curve with a hole", &|found| found.tip[7].1 = f64::NAN);
    // Changes well below the tolerance give no complaint.
    assert_eq!(
        verdict_with(&study, &sound, 0, |found| found.states[0].u_tip += 1e-12),
        Verdict::Pass
    );
    // This study cannot notice the same error in both runs, but empty results are a failure.
    let empty = changed::<ExactExperiments>(&sound, |_, found| found.states.clear());
    assert_eq!(study.judge(&empty).verdict, Verdict::Fail);
}

#[test]
fn the_published_digits_are_those_of_the_prototype() {
    let study = study(|text| text);
    let outcome = convergence_study::run_one(&study);
    let value = |name: &str| {
        let found = outcome
            .quantities
            .iter()
            .find(|quantity| quantity.name == name);
        found.unwrap_or_else(|| panic!("no {name}")).value
    };
    let is_asked = outcome
        .coverage
        .iter()
        .any(|one| one.items == "own schemes");
    assert!(!is_asked, "the study does not run the scenes' own schemes");
    assert!((value("paper-1-beta-0: u(1) at t = 1") - -0.011_764_243_810).abs() < 2e-11);
}

#[test]
fn the_scenes_own_scheme_is_compared_where_asked_for() {
    let study =
        study(|text| text.replace("agreement = 1e-10", "agreement = 1e-10\ncompare = true"));
    let cases = study.cases();
    assert!(cases.len() == 3 && cases[2].data.by.is_none());
    let mut sound: Vec<_> = convergence_study::internal::study::run_cases_here(&study);
    let outcome = study.judge(&sound);
    assert_eq!(outcome.verdict, Verdict::Pass, "{}", report(&outcome));
    assert!(
        outcome
            .figures
            .iter()
            .any(|figure| figure.file == "error.svg")
    );
    let own = "0 of 1 own schemes judged; 1 not: measured, without a claim";
    assert_eq!(counted(&outcome, "own schemes").to_string(), own);
    sound[2].found = Err(CaseFailure::new("planted"));
    assert_eq!(study.judge(&sound).verdict, Verdict::Fail);
}

#[test]
fn files_with_errors_are_refused_with_the_field() {
    for (from, to, message) in [
        (
            "times = [1.0, 10.0]",
            "times = [10.0, 1.0]",
            "experiments.times",
        ),
        ("times = [1.0, 10.0]", "times = [1.0, 10.5]", "at most 10.0"),
        (
            "times = [1.0, 10.0]",
            "times = [0.0, 1.0]",
            "experiments.times",
        ),
        (
            "agreement = 1e-10",
            "agreement = 0",
            "experiments.agreement",
        ),
        (
            "scenes/paper-1-beta-0.toml",
            "scenes/paper-9.toml",
            "paper-9.toml",
        ),
        (
            "elements = 2\ndegree = 20",
            "elements = 1\ndegree = 20",
            "discretisations",
        ),
        ("degree = 20", "degree = 28", "discretisations"),
        ("time_degree = 5", "time_degree = 4", "discretisations"),
        ("time_degree = 5", "time_degree = 6", "time_degree"),
        ("dt = 0.0035", "dt = 0.003", "discretisations"),
        ("degree = 28", "degree = 0", "degree"),
        (
            "restart_dt = 1e-4",
            "restart_dt = 0.01",
            "at most dt = 0.003",
        ),
        ("growth = 1.3\n", "growth = 0.9\n", "growth"),
        (
            "times = [1.0, 10.0]",
            "times = [1.0, 9.99995]\ncompare = true",
            "whose dt is 0.0001",
        ),
        (
            "times = [1.0, 10.0]",
            "times = [1.0, 9.9999]\ncompare = true",
            "a multiple of 1000 steps",
        ),
        ("[experiments]", "[experiment]", "experiment"),
    ] {
        let error = refusal(&ROW, "experiments-exact.toml", from, to);
        assert!(error.contains(message), "{to}: {error}");
    }
}
