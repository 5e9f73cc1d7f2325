use convergence_study::judge::verdict::Verdict;
use convergence_study::study::{FromFile, Kind, Origin};
use thermobeam_exact::equilibrium::{Equilibrium, Phase};
use thermobeam_study::kinds::experiment::{AtRest, Experiments, Found, Measured, Nearest, ROW};

use super::file;
use super::planted::verdict_with;
use super::refused::refusal;
use super::typed::{changed, passes_but_not_without_each_case};

fn study(name: &str) -> Experiments {
    Experiments::read(file(name)).unwrap_or_else(|error| panic!("{error}"))
}

fn run(change: fn(&mut Measured)) -> Box<dyn Fn(&mut Found)> {
    Box::new(move |found| match found {
        Found::Run(run) => change(run),
        Found::Rest(_) => panic!("no experiment"),
    })
}

fn rest(change: fn(&mut AtRest)) -> Box<dyn Fn(&mut Found)> {
    Box::new(move |found| match found {
        Found::Rest(rest) => change(rest),
        Found::Run(_) => panic!("no run to rest"),
    })
}

fn state(nearest: &mut Option<Nearest>) -> &mut Equilibrium {
    &mut nearest.as_mut().expect("a steady state").state
}

fn far(nearest: &mut Option<Nearest>, distance: f64) {
    nearest.as_mut().expect("a steady state").distance = distance;
}

#[test]
fn each_claim_of_section_5_can_fail() {
    let study = study("section-5.toml");
    let sound = passes_but_not_without_each_case(&study);
    let (straight, resting, bent) = (
        "paper-1-beta-0",
        "paper-2-beta-minus-0.5",
        "paper-3-beta-minus-0.8",
    );
    for (number, (label, plant)) in [
        (straight, run(|run| run.energy = 1e-5)),
        (straight, run(|run| run.largest_field = 0.01)),
        (straight, run(|run| run.largest_increase = 1e-10)),
        (straight, run(|run| run.first_upper = Some(3.0))),
        (straight, run(|run| run.first_lower = Some(3.0))),
        (straight, run(|run| run.first_upper = None)),
        (straight, run(|run| run.first_lower = None)),
        (straight, run(|run| run.frequency = Some(0.9))),
        (straight, run(|run| run.frequency = Some(0.1))),
        (straight, run(|run| run.frequency = None)),
        (straight, run(|run| run.phi_amplitude = 0.5)),
        (resting, run(|run| run.contact_force = 0.0)),
        (
            resting,
            run(|run| state(&mut run.end.nearest).contact = Phase::Free),
        ),
        (
            resting,
            run(|run| state(&mut run.end.nearest).stable = false),
        ),
        (resting, run(|run| far(&mut run.end.nearest, 0.01))),
        (resting, run(|run| run.end.nearest = None)),
        ("paper-2-beta-5", run(|run| run.contact_force = 1e-3)),
        (bent, run(|run| run.end.tip[0] = 0.0)),
        (bent, run(|run| state(&mut run.end.nearest).stable = false)),
        ("to rest, beta = -0.45", rest(|rest| rest.states = 3)),
        ("to rest, beta = -0.6", rest(|rest| rest.states = 3)),
        ("to rest, beta = -0.6", rest(|rest| rest.tip[0] = 0.05)),
        ("to rest, beta = -0.72", rest(|rest| rest.states = 1)),
        ("to rest, beta = -0.72", rest(|rest| rest.stable = 1)),
        ("to rest, beta = -0.72", rest(|rest| rest.tip[0] = 0.0)),
        (
            "to rest, beta = -0.72",
            rest(|rest| state(&mut rest.nearest).stable = false),
        ),
        ("to rest, beta = -0.72", rest(|rest| rest.nearest = None)),
        // No number may be NaN, whether or not a claim depends on it.
        (resting, run(|run| run.end.t = f64::NAN)),
        (resting, run(|run| run.energy = f64::NAN)),
        (resting, run(|run| run.end.tip[0] = f64::NAN)),
        (resting, run(|run| run.end.tip[1] = f64::NAN)),
        (resting, run(|run| run.contact_force = f64::NAN)),
        (resting, run(|run| run.largest_field = f64::NAN)),
        (resting, run(|run| far(&mut run.end.nearest, f64::NAN))),
        (resting, run(|run| run.first_upper = Some(f64::NAN))),
        (resting, run(|run| run.first_lower = Some(f64::NAN))),
        (resting, run(|run| run.frequency = Some(f64::NAN))),
        (resting, run(|run| run.phi_amplitude = f64::NAN)),
        (resting, run(|run| run.largest_increase = f64::NAN)),
        ("to rest, beta = 0", rest(|rest| rest.tip[0] = f64::NAN)),
        ("to rest, beta = 0", rest(|rest| rest.t = f64::NAN)),
        (
            "to rest, beta = 0",
            rest(|rest| far(&mut rest.nearest, f64::NAN)),
        ),
    ]
    .into_iter()
    .enumerate()
    {
        let case = sound
            .iter()
            .position(|ran| ran.case.label == label)
            .unwrap_or_else(|| panic!("no case {label}"));
        assert_eq!(
            verdict_with(&study, &sound, case, plant),
            Verdict::Fail,
            "defect {number}, in {label}"
        );
    }
}

#[test]
fn the_full_study_has_the_cases_of_the_quick_one() {
    let (full, quick) = (
        study("section-5-full.toml").cases(),
        study("section-5.toml").cases(),
    );
    assert_eq!(full.len(), quick.len());
    assert!(
        full.iter()
            .zip(&quick)
            .all(|(full, quick)| full.label == quick.label)
    );
    assert!(full[0].cost > 10.0 * quick[0].cost);
}

#[test]
fn files_with_errors_are_refused() {
    for (from, to, message) in [
        ("rate = 1e-8", "rate = -1", "run.rate"),
        ("\"upper\", \"free\"", "\"upper\"", "experiments.rests"),
        (
            "paper-1-beta-5",
            "paper-1-beta-minus-0.5",
            "experiments.first",
        ),
        ("window", "windows", "run.windows"),
        ("[-1.0, -0.9", "[-0.9, -1.0", "steady.beta"),
    ] {
        let error = refusal(&ROW, "section-5.toml", from, to);
        assert!(error.contains(message), "{error}");
    }
}

/// Completion is no statement, the refuted one is named, and a list that may lack states gives a least number.
#[test]
fn the_headline_counts_statements_by_whose_they_are() {
    let study = study("section-5.toml");
    let sound = passes_but_not_without_each_case(&study);
    let outcome = study.judge(&sound);
    let refuted = "1 is refuted: several steady states for β < -1/2, where there are several only for β < -0.7116";
    assert_eq!(
        outcome.headline,
        format!("the paper's 12 statements: 11 hold as printed, {refuted}; 1 of 1 of ours hold")
    );
    let origins = |origin: Origin| {
        outcome
            .checks
            .iter()
            .filter(|check| check.origin == origin)
            .count()
    };
    assert_eq!(
        [
            Origin::Completion,
            Origin::Source,
            Origin::Correction,
            Origin::Own
        ]
        .map(origins),
        [1, 11, 1, 1]
    );
    let counts: Vec<&str> = outcome.tables[1]
        .rows
        .iter()
        .map(|row| row[1].as_str())
        .collect();
    assert_eq!(
        (counts[0], counts[counts.len() - 1]),
        ("at least 33", "1"),
        "{counts:?}"
    );
    let bent = sound
        .iter()
        .position(|ran| ran.case.label.contains("paper-3"))
        .expect("the third experiment");
    let broken = changed::<Experiments>(&sound, |index, found| {
        if index == bent {
            run(|run| run.end.tip[0] = 0.0)(found);
        }
    });
    assert!(
        study
            .judge(&broken)
            .headline
            .starts_with("the paper's 12 statements: 10 hold"),
        "{}",
        outcome.headline
    );
}
