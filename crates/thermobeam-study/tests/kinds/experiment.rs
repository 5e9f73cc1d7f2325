use convergence_study::{
    Case, CaseFailure, Check, FromFile, Kind, Origin, Verdict,
    internal::study::kind::run_cases_here,
};
use thermobeam_exact::equilibrium::{Equilibrium, Phase};
use thermobeam_study::kinds::runs::RunStudy;
use thermobeam_study::kinds::runs::experiment::{
    self, AtRest, ExperimentResult, MeasuredRun, Nearest, PaperRun, ROW, Task,
};
use thermobeam_study::scene::Scene;

use super::planted::verdict_with;
use super::refused::refusal;
use super::typed::{changed, passes_but_not_without_each_case, report};
use super::{file, text};

type Experiments = RunStudy<experiment::Experiments>;

fn study(name: &str) -> Experiments {
    Experiments::read(file(name)).unwrap_or_else(|error| panic!("{error}"))
}

fn run(change: fn(&mut MeasuredRun)) -> Box<dyn Fn(&mut ExperimentResult)> {
    Box::new(move |found| match found {
        ExperimentResult::Run(run) => change(run),
        _ => panic!("no experiment"),
    })
}

fn rest(change: fn(&mut AtRest)) -> Box<dyn Fn(&mut ExperimentResult)> {
    Box::new(move |found| match found {
        ExperimentResult::Rest(rest) => change(rest),
        _ => panic!("no run to rest"),
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
        (straight, run(|run| run.trace.largest_increase = 1e-10)),
        (straight, run(|run| run.trace.first_upper = Some(3.0))),
        (straight, run(|run| run.trace.first_lower = Some(3.0))),
        (straight, run(|run| run.trace.first_upper = None)),
        (straight, run(|run| run.trace.first_lower = None)),
        (straight, run(|run| run.trace.frequency = Some(0.9))),
        (straight, run(|run| run.trace.frequency = Some(0.1))),
        (straight, run(|run| run.trace.frequency = None)),
        // Numbers that keep every order and every contact.
        (
            straight,
            run(|run| run.trace.frequency = Some(0.413_616 + 2e-4)),
        ),
        (straight, run(|run| run.trace.phi_amplitude += 2e-4)),
        (
            straight,
            run(|run| run.trace.first_upper = Some(0.203_413 + 2e-4)),
        ),
        (
            straight,
            run(|run| run.trace.first_lower = Some(0.858_234 - 2e-4)),
        ),
        (
            "paper-1-beta-0, 2 x p = 7, q = 2",
            run(|run| run.trace.phi_amplitude -= 2e-4),
        ),
        (straight, run(|run| run.trace.phi_amplitude = 0.5)),
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
        // An error that a figure would show.
        (
            "paper-1-beta-0, 2 x p = 7, q = 2",
            run(|run| run.trace.points[1500].u_tip += 1e-3),
        ),
        // A time at which the other discretisation was not observed.
        (
            "paper-1-beta-0, 2 x p = 7, q = 2",
            run(|run| run.trace.points[1500].t += 1e-3),
        ),
        // No number may be NaN, whether or not a claim depends on it.
        (resting, run(|run| run.end.t = f64::NAN)),
        (resting, run(|run| run.energy = f64::NAN)),
        (resting, run(|run| run.end.tip[0] = f64::NAN)),
        (resting, run(|run| run.end.tip[1] = f64::NAN)),
        (resting, run(|run| run.contact_force = f64::NAN)),
        (resting, run(|run| run.largest_field = f64::NAN)),
        (resting, run(|run| far(&mut run.end.nearest, f64::NAN))),
        (resting, run(|run| run.trace.first_upper = Some(f64::NAN))),
        (resting, run(|run| run.trace.first_lower = Some(f64::NAN))),
        (resting, run(|run| run.trace.frequency = Some(f64::NAN))),
        (resting, run(|run| run.trace.phi_amplitude = f64::NAN)),
        (resting, run(|run| run.trace.largest_increase = f64::NAN)),
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

/// Without one of the runs, failed or not made, the study fails and judges nothing but completion.
#[test]
fn nothing_is_judged_without_all_runs() {
    let study = study("section-5.toml");
    let sound = run_cases_here(&study);
    assert!(study.judge(&sound).checks.len() > 10);
    let mut failed = sound.clone();
    failed[3].found = Err(CaseFailure::new("planted"));
    let mut missing = sound;
    missing.remove(3);
    for ran in [failed, missing] {
        let outcome = study.judge(&ran);
        assert_ne!(outcome.verdict, Verdict::Pass);
        assert_eq!(outcome.checks.len(), 1, "{}", report(&outcome));
        assert!(
            outcome.summary.to_string().starts_with("1 of "),
            "{}",
            outcome.summary
        );
    }
}

/// Every experiment by the paper's algorithm too, which is most of the work.
#[test]
fn the_full_study_has_the_cases_of_the_quick_one_and_the_papers_algorithm() {
    let (full, quick) = (
        study("section-5-full.toml").cases(),
        study("section-5.toml").cases(),
    );
    let (by_the_paper, others): (Vec<_>, Vec<_>) = full
        .iter()
        .partition(|case| matches!(case.data, Task::FixedPoint(_)));
    assert!(
        others
            .iter()
            .map(|case| case.data)
            .eq(quick.iter().map(|case| case.data))
    );
    let places: Vec<_> = by_the_paper.iter().map(|case| case.data).collect();
    assert_eq!(places, (0..7).map(Task::FixedPoint).collect::<Vec<_>>());
    let cost = |cases: &[&Case<Task>]| cases.iter().map(|case| case.cost).sum::<f64>();
    assert!(cost(&by_the_paper) > cost(&others));
}

/// The full study, whose scenes `change` changes, from a folder of its own.
fn full_study_with(tolerance: &str, change: impl Fn(String) -> String) -> Experiments {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::create_dir(folder.path().join("scenes")).expect("a folder");
    let study = text("section-5-full.toml").replace("tolerance = 1e-7", tolerance);
    let names = study.split('"').filter(|name| name.starts_with("scenes/"));
    for name in names {
        std::fs::write(folder.path().join(name), change(text(name))).expect("a scene");
    }
    let path = folder.path().join("section-5-full.toml");
    std::fs::write(&path, &study).expect("a study");
    Experiments::read(path).unwrap_or_else(|error| panic!("{error}"))
}

/// The full study on ten elements and with 20,000 steps.
fn coarse_full_study(tolerance: &str) -> Experiments {
    full_study_with(tolerance, |scene| {
        scene
            .replace("elements = 100", "elements = 10")
            .replace("dt = 1e-4", "dt = 5e-4")
    })
}

/// What the study says of the data of its scenes, which needs no run.
fn data_of(study: &Experiments) -> Check {
    study.0.data()
}

/// Each change, which leaves all statements about the motion as they are, and the data that it
/// concerns.
#[test]
fn scenes_with_other_data_than_the_papers_fail() {
    let unchanged = full_study_with("tolerance = 1e-7", |scene| scene);
    assert_eq!(data_of(&unchanged).verdict, Verdict::Pass);
    for (from, to, named) in [
        ("rho = 1.0", "rho = 2.0", "rho"),
        ("a = 0.017", "a = 0.03", "a"),
        ("epsilon = 1e-3", "epsilon = 1e-2", "epsilon"),
        ("g1 = -0.01", "g1 = -0.02", "g1"),
        ("g2 = 0.1", "g2 = 0.12", "g2"),
        ("zeta = 0.1", "zeta = 0.1000001", "zeta"),
        ("beta = 5.0", "beta = 5.5", "beta"),
        ("\"sin(pi*x)\"", "\"2*sin(pi*x)\"", "θ_0"),
        ("20*cos(5*pi*x/2)", "20*cos(3*pi*x/2)+20*(x-1)^2*x", "θ_0"),
        ("20*x*(x-1)^2", "10*x*(x-1)^2", "u_1"),
        ("0.01*x*(x-2)", "0.02*x*(x-2)", "u_0"),
        ("[mesh]", "phi = \"0.01*x\"\n[mesh]", "φ_0"),
        ("t_end = 10.0", "t_end = 20.0", "the end of the figures"),
    ] {
        let study = full_study_with("tolerance = 1e-7", |scene| scene.replace(from, to));
        let check = data_of(&study);
        assert_eq!(check.verdict, Verdict::Fail, "{to}");
        assert!(
            check.evidence.to_string().contains(&format!(": {named}")),
            "{}",
            check.evidence
        );
    }
}

/// (5.2): the discretisation parameters of the paper's algorithm.
#[test]
fn the_scenes_of_the_full_study_have_the_papers_resolution() {
    let study = text("section-5-full.toml");
    assert!(study.contains("tolerance = 1e-7"));
    for name in study.split('"').filter(|name| name.starts_with("scenes/")) {
        let scene = Scene::read(file(name)).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(
            (scene.mesh.elements(), scene.steps()),
            (100, 100_000),
            "{name}"
        );
    }
}

fn paper(change: fn(&mut PaperRun)) -> Box<dyn Fn(&mut ExperimentResult)> {
    Box::new(move |found| match found {
        ExperimentResult::FixedPoint(run) => change(run),
        _ => panic!("no run by the paper's algorithm"),
    })
}

#[test]
fn the_papers_algorithm_is_judged_beside_newtons_method() {
    let study = coarse_full_study("tolerance = 1e-7");
    let sound = run_cases_here(&study);
    assert_eq!(study.judge(&sound).verdict, Verdict::Pass);
    let label = "paper-1-beta-0, fixed point and Newton";
    let case = sound.iter().position(|ran| ran.case.label == label);
    let case = case.expect("a run by the paper's algorithm");
    let mut missing = sound.clone();
    missing.remove(case);
    assert_eq!(study.judge(&missing).verdict, Verdict::Fail);
    for (number, plant) in [
        paper(|run| run.solvers.distance = 1e-2),
        paper(|run| run.solvers.distance = f64::NAN),
        paper(|run| run.solvers.mean_iterations = f64::NAN),
        // Statements about the motion are those of the paper's algorithm.
        paper(|run| run.trace.largest_increase = 1e-10),
        paper(|run| run.trace.first_lower = None),
        paper(|run| run.trace.frequency = Some(0.9)),
        paper(|run| run.trace.phi_amplitude = 0.5),
    ]
    .into_iter()
    .enumerate()
    {
        let verdict = verdict_with(&study, &sound, case, plant);
        assert_eq!(verdict, Verdict::Fail, "defect {number}");
    }
    let outcome = study.judge(&sound);
    let guarded = |name: &str| {
        let name = format!("paper-1-beta-0: {name}");
        let quantity = outcome.quantities.iter().find(|of| of.name == name);
        quantity.unwrap_or_else(|| panic!("no {name}")).value
    };
    // Two iterations are the least that can show convergence, and no step of these needs more than
    // five.
    let iterations = guarded("iterations_per_step");
    assert!((2.0..5.0).contains(&iterations), "{iterations}");
    assert!(guarded("distance_to_newton") > 0.0);
}

/// A tolerance of the size of the scheme's error makes both solvers differ by as much.
#[test]
fn a_loose_tolerance_fails() {
    let study = coarse_full_study("tolerance = 1e-1");
    let outcome = study.judge(&run_cases_here(&study));
    assert_eq!(outcome.verdict, Verdict::Fail);
    let failed: Vec<_> = outcome
        .checks
        .iter()
        .filter(|check| check.verdict == Verdict::Fail)
        .collect();
    assert!(
        failed
            .iter()
            .any(|check| check.claim.to_string().contains("η*")),
        "{failed:?}"
    );
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
        ("degree = 7", "degree = 12", "two with the same degree"),
        (
            "[steady]",
            "[fixed_point]\ntolerance = 0\n[steady]",
            "fixed_point.tolerance",
        ),
    ] {
        let error = refusal(&ROW, "section-5.toml", from, to);
        assert!(error.contains(message), "{error}");
    }
}

/// Completion is no statement, the threshold that is not sharp is named, and a list that may lack
/// states gives a least number.
#[test]
fn the_headline_counts_statements_by_whose_they_are() {
    let study = study("section-5.toml");
    let sound = passes_but_not_without_each_case(&study);
    let outcome = study.judge(&sound);
    let threshold = "1 has a threshold that is not sharp: several steady states for β < -1/2, where it is -B = -π²/4 / (1 + π²/4) = -0.7116 for θ_A = 0";
    assert_eq!(
        outcome.headline.to_string(),
        format!("the paper's 12 statements: 11 hold as printed, {threshold}; 4 of 4 of ours hold")
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
        [1, 11, 1, 4]
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
            .to_string()
            .starts_with("the paper's 12 statements: 10 hold"),
        "{}",
        outcome.headline
    );
}
