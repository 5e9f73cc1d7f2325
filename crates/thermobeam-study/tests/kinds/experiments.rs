//! The paper's experiments: each statement of Section 5 and each of the ten digits can fail.

use convergence_study::{Kind, Verdict};
use thermobeam_exact::equilibrium::{Equilibrium, Phase};
use thermobeam_study::studies::experiments::{
    self, AtRest, FixedPoint, Found, Nearest, PaperRun, SectionFive, SteadyRun, Trace,
    digits::{self, TenDigits},
};

use super::planted::{defects, each_fails, place, verdict_with};
use super::typed::{Runs, changed, passes_but_not_without_each_case};

fn run(found: &mut Found) -> &mut SteadyRun {
    match found {
        Found::Run(run) => run,
        _ => panic!("no experiment"),
    }
}

fn rest(found: &mut Found) -> &mut AtRest {
    match found {
        Found::Rest(rest) => rest,
        _ => panic!("no run to rest"),
    }
}

fn paper(found: &mut Found) -> &mut PaperRun {
    match found {
        Found::FixedPoint(run) => run,
        _ => panic!("no run by the paper's algorithm"),
    }
}

fn state(nearest: &mut Option<Nearest>) -> &mut Equilibrium {
    &mut nearest.as_mut().expect("a steady state").state
}

/// Changes of the motion, of the end of a run, and of a run to rest. Some keep every order and every
/// contact, and one is an error that a figure would show.
fn each_claim_fails(study: &SectionFive, sound: &Runs<SectionFive>) {
    each_fails(
        study,
        sound,
        place(sound, "paper-1-beta-0"),
        defects!(|found| [
            run(found).energy = 1e-5,
            run(found).largest_field = 0.01,
            run(found).trace.largest_increase = 1e-10,
            run(found).trace.first_upper = Some(3.0),
            run(found).trace.first_lower = None,
            run(found).trace.frequency = Some(0.9),
            run(found).trace.frequency = Some(0.1),
            run(found).trace.frequency = None,
            run(found).trace.phi_amplitude = 0.5,
            run(found).trace.frequency = Some(0.413_816),
            run(found).trace.phi_amplitude += 2e-4,
            run(found).trace.first_upper = Some(0.203_613),
            run(found).trace.first_lower = Some(0.858_034),
        ]),
    );
    each_fails(
        study,
        sound,
        place(sound, "paper-1-beta-0, 2 x p = 7, q = 2"),
        defects!(|found| [
            run(found).trace.phi_amplitude -= 2e-4,
            run(found).trace.points[1500].u_tip += 1e-3,
            run(found).trace.points[1500].t += 1e-3,
        ]),
    );
    each_fails(
        study,
        sound,
        place(sound, "paper-2-beta-minus-0.5"),
        defects!(|found| [
            run(found).contact_force = 0.0,
            state(&mut run(found).end.nearest).contact = Phase::Free,
            state(&mut run(found).end.nearest).stable = false,
            run(found).end.nearest = None,
            run(found).energy = f64::NAN,
        ]),
    );
    each_fails(
        study,
        sound,
        place(sound, "paper-2-beta-5"),
        defects!(|found| [run(found).contact_force = 1e-3,]),
    );
    each_fails(
        study,
        sound,
        place(sound, "paper-3-beta-minus-0.8"),
        defects!(|found| [
            run(found).end.tip[0] = 0.0,
            state(&mut run(found).end.nearest).stable = false,
        ]),
    );
    each_fails(
        study,
        sound,
        place(sound, "to rest, beta = -0.45"),
        defects!(|found| [rest(found).states = 3,]),
    );
    each_fails(
        study,
        sound,
        place(sound, "to rest, beta = -0.6"),
        defects!(|found| [rest(found).states = 3, rest(found).tip[0] = 0.05,]),
    );
    each_fails(
        study,
        sound,
        place(sound, "to rest, beta = 0"),
        defects!(|found| [rest(found).t = f64::NAN,]),
    );
    each_fails(
        study,
        sound,
        place(sound, "to rest, beta = -0.72"),
        defects!(|found| [
            rest(found).states = 1,
            rest(found).stable = 1,
            rest(found).tip[0] = 0.0,
            state(&mut rest(found).nearest).stable = false,
            rest(found).nearest = None,
        ]),
    );
}

/// The threshold that is not sharp is named, and a list that may lack states gives a least number.
#[test]
fn each_claim_of_section_5_can_fail_and_the_headline_counts_statements() {
    let study = experiments::study().kind;
    let sound = passes_but_not_without_each_case(&study);
    each_claim_fails(&study, &sound);
    let headline = |sound: &Runs<SectionFive>| study.judge(sound).headline.to_string();
    let threshold = "1 has a threshold that is not sharp: several steady states for β < -1/2, where it is -B = -π²/4 / (1 + π²/4) = -0.7116 for θ_A = 0";
    assert_eq!(
        headline(&sound),
        format!("the paper's 12 statements: 11 hold as printed, {threshold}; 3 of 3 of ours hold")
    );
    let broken = |label: &str, plant: fn(&mut Found)| {
        let place = place(&sound, label);
        let broken = changed::<SectionFive>(&sound, |index, found| {
            if index == place {
                plant(found);
            }
        });
        headline(&broken)
    };
    let bent = broken("paper-3-beta-minus-0.8", |found| {
        run(found).end.tip[0] = 0.0;
    });
    assert!(bent.contains(": 10 hold as printed, 1 has"), "{bent}");
    let open = broken("to rest, beta = -0.6", |found| rest(found).states = 3);
    assert!(
        open.contains(": 11 hold as printed, the last is not decided"),
        "{open}"
    );
    let of_buckled = |title: &str| title.starts_with("For β < -0.7116");
    let tables = study.judge(&sound).tables;
    let buckled = tables.iter().find(|table| of_buckled(&table.title));
    assert_eq!(
        buckled.expect("a table").rows[0][..2],
        ["β = -1", "at least 33"]
    );
}

/// The full study on ten elements and with 20,000 steps.
fn coarse_full_study(tolerance: f64) -> SectionFive {
    let mut study = experiments::full().kind;
    let resolution = "mesh = { elements = 10 }
time = { dt = 5e-4, t_end = 10.0, tolerance = 1e-10 }";
    study.fixed_point = Some(FixedPoint {
        tolerance,
        resolution,
    });
    study
}

#[test]
fn the_papers_algorithm_is_judged_beside_newtons_method() {
    let study = coarse_full_study(1e-7);
    let sound = study.run_here();
    assert_eq!(study.judge(&sound).verdict, Verdict::Pass);
    let case = place(&sound, "paper-1-beta-0, fixed point and Newton");
    // Statements about the motion are those of the paper's algorithm.
    each_fails(
        &study,
        &sound,
        case,
        defects!(|found| [
            paper(found).solvers.distance = 1e-2,
            paper(found).solvers.distance = f64::NAN,
            paper(found).solvers.mean_iterations = f64::NAN,
            paper(found).trace.largest_increase = 1e-10,
            paper(found).trace.first_lower = None,
            paper(found).trace.frequency = Some(0.9),
            paper(found).trace.phi_amplitude = 0.5,
        ]),
    );
    let Some(Found::FixedPoint(run)) = sound[case].ok() else {
        panic!("no run by the paper's algorithm");
    };
    // Two iterations are the least that can show convergence, and no step of these needs more than
    // five.
    let iterations = run.solvers.mean_iterations;
    assert!((2.0..5.0).contains(&iterations), "{iterations}");
    assert!(run.solvers.distance > 0.0);
}

/// A tolerance of the size of the scheme's error makes both solvers differ by as much.
#[test]
fn a_loose_tolerance_fails() {
    let study = coarse_full_study(1e-1);
    let outcome = study.judge(&study.run_here());
    let mut failed = outcome
        .checks
        .iter()
        .filter(|check| check.verdict == Verdict::Fail);
    assert!(failed.any(|check| check.claim.to_string().contains("η*")));
}

/// The first experiment over its first second: two contact events and the first moments of a third
/// phase; by its own scheme, too.
fn first_second() -> TenDigits {
    let mut study = digits::error().kind;
    study.times = [0.5, 1.0];
    study.beams = &study.beams[1..2];
    study
}

#[test]
fn two_discretisations_agree_and_every_planted_difference_fails() {
    let study = first_second();
    let sound = passes_but_not_without_each_case(&study);
    assert_eq!(sound.len(), 3);
    let outcome = study.judge(&sound);
    assert!(
        outcome
            .figures
            .iter()
            .any(|figure| figure.file == "error.svg")
    );
    let name = "paper-1-beta-0: u(1) at t = 1";
    let found = outcome.quantities.iter().find(|of| of.name == name);
    assert!((found.expect(name).value - -0.011_764_243_810).abs() < 2e-11);
    let verdict =
        |index: usize, change: &dyn Fn(&mut Trace)| verdict_with(&study, &sound, index, change);
    let fails = |what: &str, change: &dyn Fn(&mut Trace)| {
        for index in 0..2 {
            assert_eq!(verdict(index, change), Verdict::Fail, "{what}, run {index}");
        }
    };
    // The states at t = 0.5 and t = 1.
    for by in [2e-10, -2e-10, f64::NAN] {
        fails("u(1)", &|trace| trace.points[2000].u_tip += by);
        fails("phi(1)", &|trace| trace.points[4000].phi_tip += by);
        fails("u_t(1)", &|trace| trace.points[4000].u_t_tip += by);
        fails("phi_t(1)", &|trace| trace.points[2000].phi_t_tip += by);
        fails("theta(1/2)", &|trace| trace.points[4000].theta_mid += by);
        fails("E", &|trace| trace.points[4000].energy += by);
        // The tolerance for times of events is ten times larger.
        fails("the time of an event", &|trace| {
            trace.events[1].t += 10.0 * by;
        });
    }
    fails("a missing event", &|trace| _ = trace.events.pop());
    fails("an event the other way round", &|trace| {
        trace.events[0].to = trace.events[0].from;
    });
    fails("a missing state", &|trace| _ = trace.points.pop());
    fails("an open balance", &|trace| {
        trace.largest_residual = 1e-11 * trace.points[0].energy;
    });
    fails("an energy that grows", &|trace| {
        trace.largest_increase = 1e-15;
    });
    // Changes well below the tolerance give no complaint.
    let small = verdict(0, &|trace| trace.points[2000].u_tip += 1e-12);
    assert_eq!(small, Verdict::Pass);
    let hole = verdict(2, &|trace| trace.points[7].u_tip = f64::NAN);
    assert_eq!(hole, Verdict::Fail);
}
