//! The paper's experiments: each statement of Section 5 and each of the ten digits can fail.

use thermobeam_exact::equilibrium::Equilibrium;
use thermobeam_study::studies::experiments::digits::{self, TenDigits};
use thermobeam_study::studies::experiments::{
    self, AtRest, FixedPoint, Found, Nearest, PaperRun, SectionFive, SteadyRun, Trace,
};

use super::*;

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

/// Changes of the motion, of the end of a run, and of a run to rest. Some keep every order and
/// every contact, and one is an error that a figure would show.
fn each_claim_fails(sound: &Sound<SectionFive>) {
    sound.fails_in(
        "paper-1-beta-0",
        run,
        defects!(|run| [
            run.energy = 1e-5,
            run.largest_field = 0.01,
            run.trace.largest_increase = 1e-10,
            run.trace.first_upper = Some(3.0),
            run.trace.first_lower = None,
            run.trace.frequency = Some(0.9),
            run.trace.frequency = Some(0.1),
            run.trace.frequency = None,
            run.trace.phi_amplitude = 0.5,
            run.trace.frequency = Some(0.413_816),
            run.trace.phi_amplitude += 2e-4,
            run.trace.first_upper = Some(0.203_613),
            run.trace.first_lower = Some(0.858_034),
        ]),
    );
    sound.fails_in(
        "paper-1-beta-0, 2 x p = 7, q = 2",
        run,
        defects!(|run| [
            run.trace.phi_amplitude -= 2e-4,
            run.trace.points[1500].u_tip += 1e-3,
            run.trace.points[1500].t += 1e-3,
        ]),
    );
    sound.fails_in(
        "paper-2-beta-minus-0.5",
        run,
        defects!(|run| [
            run.contact_force = 0.0,
            state(&mut run.end.nearest).contact = Phase::Free,
            state(&mut run.end.nearest).stable = false,
            run.end.nearest = None,
            run.energy = f64::NAN,
        ]),
    );
    let free = "paper-2-beta-5";
    sound.fails_in(free, run, defects!(|run| [run.contact_force = 1e-3]));
    sound.fails_in(
        "paper-3-beta-minus-0.8",
        run,
        defects!(|run| [
            run.end.tip[0] = 0.0,
            state(&mut run.end.nearest).stable = false,
        ]),
    );
    let several = "to rest, beta = -0.45";
    sound.fails_in(several, rest, defects!(|rest| [rest.states = 3]));
    sound.fails_in(
        "to rest, beta = -0.6",
        rest,
        defects!(|rest| [rest.states = 3, rest.tip[0] = 0.05]),
    );
    let never = "to rest, beta = 0";
    sound.fails_in(never, rest, defects!(|rest| [rest.t = f64::NAN]));
    sound.fails_in(
        "to rest, beta = -0.72",
        rest,
        defects!(|rest| [
            rest.states = 1,
            rest.stable = 1,
            rest.tip[0] = 0.0,
            state(&mut rest.nearest).stable = false,
            rest.nearest = None,
        ]),
    );
}

/// The threshold that is not sharp is named, and a list that may lack states gives a least number.
#[test]
fn each_claim_of_section_5_can_fail_and_the_headline_counts_statements() {
    let sound = Sound::checked(experiments::study().kind);
    each_claim_fails(&sound);
    let whole = sound.with(|_, _| ());
    let threshold = "1 has a threshold that is not sharp: several steady states for β < -1/2, where it is -B = -π²/4 / (1 + π²/4) = -0.7116 for θ_A = 0";
    assert_eq!(
        whole.headline.to_string(),
        format!("the paper's 12 statements: 11 hold as printed, {threshold}; 3 of 3 of ours hold")
    );
    let says = |label, plant: fn(&mut Found), words| {
        let headline = sound.at(label, plant).headline.to_string();
        assert!(headline.contains(words), "{headline}");
    };
    says(
        "paper-3-beta-minus-0.8",
        |found| run(found).end.tip[0] = 0.0,
        ": 10 hold as printed, 1 has",
    );
    says(
        "to rest, beta = -0.6",
        |found| rest(found).states = 3,
        ": 11 hold as printed, the last is not decided",
    );
    let of_buckled = |title: &str| title.starts_with("For β < -0.7116");
    let mut tables = whole.tables.iter();
    let buckled = tables.find(|table| of_buckled(&table.title));
    let row = &buckled.expect("a table").rows[0];
    assert_eq!(row[..2], ["β = -1", "at least 33"]);
}

/// The full study on ten elements and with 20,000 steps.
fn coarse_full_study(tolerance: f64) -> Sound<SectionFive> {
    let mut study = experiments::full().kind;
    let resolution = "mesh = { elements = 10 }
time = { dt = 5e-4, t_end = 10.0, tolerance = 1e-10 }";
    study.fixed_point = Some(FixedPoint {
        tolerance,
        resolution,
    });
    Sound::run(study)
}

#[test]
fn the_papers_algorithm_is_judged_beside_newtons_method() {
    let mut sound = coarse_full_study(1e-7);
    assert_eq!(sound.with(|_, _| ()).verdict, Verdict::Pass);
    let case = "paper-1-beta-0, fixed point and Newton";
    // Statements about the motion are those of the paper's algorithm.
    sound.fails_in(
        case,
        paper,
        defects!(|run| [
            run.solvers.distance = 1e-2,
            run.solvers.distance = f64::NAN,
            run.solvers.mean_iterations = f64::NAN,
            run.trace.largest_increase = 1e-10,
            run.trace.first_lower = None,
            run.trace.frequency = Some(0.9),
            run.trace.phi_amplitude = 0.5,
        ]),
    );
    let solvers = &paper(sound.found_mut(case)).solvers;
    // Two iterations are the least that can show convergence, and no step of these needs more than
    // five.
    let iterations = solvers.mean_iterations;
    assert!((2.0..5.0).contains(&iterations), "{iterations}");
    assert!(solvers.distance > 0.0);
}

/// A tolerance of the size of the scheme's error makes both solvers differ by as much.
#[test]
fn a_loose_tolerance_fails() {
    let mut failed = failed(&coarse_full_study(1e-1).with(|_, _| ())).into_iter();
    assert!(failed.any(|claim| claim.contains("η*")));
}

/// The first experiment over its first two seconds, with contact events; by its own scheme, too.
fn first_two_seconds() -> TenDigits {
    let mut study = digits::study().kind;
    study.compare = true;
    study.times = [1.0, 2.0];
    study.beams = vec![study.beams[1]];
    study
}

#[test]
fn two_discretisations_agree_and_every_planted_difference_fails() {
    let sound = Sound::checked(first_two_seconds());
    assert_eq!(sound.runs.len(), 3);
    let outcome = sound.with(|_, _| ());
    let mut figures = outcome.figures.iter();
    assert!(figures.any(|figure| figure.file == "error.svg"));
    let guarded = |name: &str| {
        let mut quantities = outcome.quantities.iter();
        quantities.find(|of| of.name == name).expect(name).value
    };
    assert!((guarded("paper-1-beta-0: u(1) at t = 1") - -0.011_764_243_810).abs() < 2e-11);
    let largest = guarded("paper-1-beta-0: largest |error| of u(1, t)");
    assert!((1e-6..1e-3).contains(&largest), "{largest}");
    // The states at t = 1 and t = 2.
    let numbers: Named<fn(&mut Trace) -> &mut f64, 6> = [
        ("u(1)", |trace| &mut trace.points[2000].u_tip),
        ("phi(1)", |trace| &mut trace.points[4000].phi_tip),
        ("u_t(1)", |trace| &mut trace.points[4000].u_t_tip),
        ("phi_t(1)", |trace| &mut trace.points[2000].phi_t_tip),
        ("theta(1/2)", |trace| &mut trace.points[4000].theta_mid),
        ("E", |trace| &mut trace.points[4000].energy),
    ];
    for run in 0..2 {
        for by in [2e-10, -2e-10, f64::NAN] {
            let verdict = |change: &dyn Fn(&mut Trace)| sound.at(run, change).verdict;
            for (what, number) in numbers {
                let moved = verdict(&|trace| *number(trace) += by);
                assert_eq!(moved, Verdict::Fail, "{what}, run {run}");
            }
            // The tolerance for times of events is ten times larger.
            let moved = verdict(&|trace| trace.events[1].t += 10.0 * by);
            assert_eq!(moved, Verdict::Fail, "the time of an event, run {run}");
        }
        sound.fails(
            run,
            defects!(|trace| [
                trace.events.pop(),
                // The other way round.
                trace.events[0].to = trace.events[0].from,
                trace.points.pop(),
                trace.largest_residual = 1e-11 * trace.points[0].energy,
                trace.largest_increase = 1e-15,
            ]),
        );
    }
    // Changes well below the tolerance give no complaint.
    let small = sound.at(0, |trace| trace.points[2000].u_tip += 1e-12);
    assert_eq!(small.verdict, Verdict::Pass);
    sound.fails(
        2,
        defects!(|trace| [
            trace.points[7].u_tip = f64::NAN,
            // At another time than the other's.
            trace.points[7].t += 1e-3,
        ]),
    );
}
