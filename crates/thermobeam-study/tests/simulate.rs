//! Laws of running a scene.

use std::cell::Cell;
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use convergence_judge::time_limit::within_by;
use thermobeam::dg::Phase;
use thermobeam::motion::StepReport;
use thermobeam::solve::Solver;
use thermobeam_study::run::AnyMotion;
use thermobeam_study::run::RunError;
use thermobeam_study::run::object::Object;
use thermobeam_study::run::simulate::{Recording, Run, Simulator};
use thermobeam_study::run::together::run_together;
use thermobeam_study::scene::Scene;

fn scene(text: &str) -> Scene {
    Scene::parse(text, "s.toml").unwrap()
}

/// The paper's first experiment on a coarse mesh, with more lines for the table `[time]`.
fn thrown(dt: &str, more: &str) -> Scene {
    let text = format!(
        "[obstacles]\n[initial]\nu = \"0.01*x*(x-2)\"\nu_t = \"20*x*(x-1)^2\"\ntheta = \"sin(pi*x)\"\n\
         [mesh]\nelements = 20\n[time]\nt_end = 1\ndt = {dt}\n{more}"
    );
    scene(&text)
}

fn run(scene: &Scene, recording: Recording) -> Run {
    Simulator::new(scene)
        .unwrap()
        .run(recording, &mut |_, _| ())
}

#[test]
fn recording_changes_nothing_but_the_record() {
    let by_dg = located("t_end = 1.0", "0.01*x*(x-2)");
    for (scene, rows, frames) in [(thrown("1e-3", ""), 1001, 201), (by_dg, 4001, 201)] {
        let plain = run(&scene, Recording::Summary);
        let recorded = run(&scene, Recording::History);
        assert_eq!(plain.history, None);
        let history = recorded.history.clone().unwrap();
        let unrecorded = Run {
            history: None,
            wall: plain.wall,
            ..recorded
        };
        assert_eq!(unrecorded, plain);
        let found = [
            history.frames.times.len(),
            history.frames.u.len(),
            history.rows.len(),
        ];
        assert_eq!(found, [frames, frames, rows]);
        let [first, .., last] = &history.rows[..] else {
            panic!("no rows");
        };
        assert_eq!([first.sample, last.sample], [plain.first, plain.last]);
        let lost: f64 = history.rows.iter().map(|row| row.balance.change).sum();
        assert!((lost - (plain.energy.last - plain.energy.initial)).abs() < 1e-12);
        if scene.one_step().is_err() {
            continue;
        }
        // Each step has its row.
        let tips = history.rows.iter().map(|row| row.sample.u_tip);
        let [low, high] = [
            tips.clone().fold(f64::INFINITY, f64::min),
            tips.fold(f64::NEG_INFINITY, f64::max),
        ];
        assert_eq!(
            [low, high],
            [plain.extremes.u_tip_min, plain.extremes.u_tip_max]
        );
        let residuals = history.rows.iter().map(|row| row.balance.residual.abs());
        assert_eq!(
            residuals.fold(0.0, f64::max),
            plain.energy.largest_balance_residual
        );
        let touching = history
            .rows
            .iter()
            .filter(|row| row.sample.contact_force != 0.0);
        assert_eq!(touching.count(), plain.contact_steps);
    }
}

#[test]
fn the_steps_are_told_one_by_one() {
    let mut steps = Vec::new();
    Simulator::new(&thrown("0.1", ""))
        .unwrap()
        .run(Recording::Summary, &mut |step, t| steps.push((step, t)));
    assert_eq!(
        steps,
        (1..=10)
            .map(|step| (step, step as f64 * 0.1))
            .collect::<Vec<_>>()
    );
}

#[test]
fn both_schemes_keep_their_balance_and_lose_energy() {
    for scheme in ["euler-crank-nicolson", "midpoint"] {
        for solver in Solver::ALL {
            let scene = thrown(
                "1e-3",
                &format!(
                    "scheme = \"{scheme}\"\nsolver = \"{}\"\ntolerance = 1e-13",
                    solver.name()
                ),
            );
            let run = run(&scene, Recording::Summary);
            assert_eq!(
                (run.steps, &run.failure),
                (1000, &None),
                "{scheme} {solver:?}"
            );
            let energy = run.energy;
            let is_lost = energy.largest_increase < 0.0 && energy.largest_balance_residual < 2e-12;
            assert!(is_lost, "{scheme} {solver:?}: {energy:?}");
            let ends = [run.first.energy, run.last.energy];
            assert_eq!([energy.initial, energy.last], ends);
            assert!(run.contact_steps > 100);
        }
    }
}

#[test]
fn a_long_history_is_thinned_and_loses_no_energy() {
    let text = "[initial]\nu_t = \"x\"\n[mesh]\nelements = 2\n[time]\nt_end = 500.001\ndt = 1e-3";
    let scene = scene(text);
    let run = run(&scene, Recording::History);
    let history = run.history.unwrap();
    assert_eq!(scene.steps(), 500_001);
    assert_eq!(history.rows.len(), 1 + 500_001 / 3);
    assert_eq!(history.rows.last().unwrap().sample, run.last);
    assert_eq!(history.frames.times.last(), Some(&run.last.t));
    assert!(history.frames.times.len() <= 202);
    let lost: f64 = history.rows.iter().map(|row| row.balance.change).sum();
    assert!((lost - (run.energy.last - run.energy.initial)).abs() < 1e-12);
}

/// A clock that gains a millisecond each time it is read.
fn ticking() -> Instant {
    thread_local!(static NEXT: Cell<Instant> = Cell::new(Instant::now()));
    NEXT.replace(NEXT.get() + Duration::from_millis(1))
}

#[test]
fn a_limit_on_the_time_ends_a_run_and_what_was_done_is_kept() {
    let scene = thrown("1e-4", "");
    let limit = Duration::from_millis(3);
    let (stopped, up) = within_by(ticking, Some(limit), || run(&scene, Recording::Summary));
    let Some(RunError::TimeUp(time_up)) = stopped.failure else {
        panic!("{:?}", stopped.failure)
    };
    assert_eq!(Some(time_up), up);
    assert_eq!(
        (time_up.step, time_up.t, time_up.limit),
        (stopped.steps, stopped.last.t, limit)
    );
    assert!(0 < stopped.steps && stopped.steps < scene.steps());
    let json = serde_json::to_value(Object::new(&scene, &stopped)).unwrap();
    assert_eq!(json["failure"]["kind"], "time-limit");
    assert_eq!(json["failure"]["limit_seconds"], 3e-3);
    let (whole, up) = within_by(ticking, Some(Duration::from_secs(600)), || {
        run(&scene, Recording::Summary)
    });
    assert_eq!(
        (whole.steps, whole.failure, up),
        (scene.steps(), None, None)
    );
}

#[test]
fn the_temperature_is_the_physical_one_on_any_mesh() {
    for mesh in ["elements = 7", "elements = 8", "nodes = [0, 0.3, 1]"] {
        let text = format!(
            "[beam]\na = 0\ntheta_a = 20\n[initial]\ntheta = \"20*(1-x)\"\n[mesh]\n{mesh}\n[time]\nt_end = 1\ndt = 0.1"
        );
        let run = run(&scene(&text), Recording::Summary);
        assert!(
            (run.first.theta_mid - 10.0).abs() < 1e-14 && (run.last.theta_mid - 10.0).abs() < 1e-14,
            "{mesh}"
        );
        assert!(!run.is_heated || run.work.passes > 0);
    }
}

#[test]
fn boundary_values_that_the_scene_accepts_do_not_trouble_the_solver() {
    let text = "[initial]\ntheta = \"sin(1000*pi*x)\"\nu = \"1e6*sin(x)\"\n[time]\nt_end = 0.01\ndt = 0.01";
    let scene = scene(text);
    assert!(Simulator::new(&scene).is_ok());
}

#[test]
fn a_run_by_any_method_stops_at_the_step_that_breaks_the_law_of_the_energy() {
    let start = "[beam]\nrho = 5000\n[initial]\nu_t = \"20*x\"\n[time]\nt_end = 2.0\ndt = 0.1\n";
    for method in ["scheme = \"dg\"\nrestart_dt = 0.1", "scheme = \"midpoint\""] {
        // Steps that cannot be solved.
        let loose = scene(&format!("{start}{method}\ntolerance = 100.0"));
        let alone = run(&loose, Recording::Summary);
        assert_eq!(
            serde_json::to_value(Object::new(&loose, &alone)).unwrap()["failure"]["kind"],
            "unsound"
        );
        for run in run_together(&[&loose, &loose])
            .unwrap()
            .into_iter()
            .chain([alone])
        {
            let Some(RunError::Unsound { step, t, dt, .. }) = run.failure else {
                panic!("{:?}", run.failure)
            };
            assert_eq!((step, t + dt), (run.steps, run.last.t));
            assert!(run.last.t < 2.0, "{:?}", run.last);
            let complaint = run.complaint().unwrap();
            let words = format!("step {step} (from t = {t}");
            assert!(
                complaint.starts_with(&words) && complaint.contains("in a step"),
                "{complaint}"
            );
        }
    }
}

/// Steps that one iteration does not solve, and a contact stiffer than the digits of a position.
#[test]
fn a_run_whose_energy_explodes_fails_by_whatever_solver() {
    for (epsilon, more, expected) in [
        ("1e-3", "solver = \"fixed-point\"\niterations = 1", None),
        (
            "1e-6",
            "solver = \"fixed-point\"\niterations = 1",
            Some("the energy rose by"),
        ),
        ("1e-12", "", None),
        ("1e-40", "", Some("the contact cannot be resolved")),
        ("1e-300", "", Some("the contact cannot be resolved")),
    ] {
        let scene = scene(&format!(
            "[obstacles]\nepsilon = {epsilon}\n[initial]\nu = \"0.01*x*(x-2)\"\nu_t = \"20*x*(x-1)^2\"\n\
             [mesh]\nelements = 100\n[time]\nt_end = 1.0\ndt = 1e-3\n{more}"
        ));
        let complaint = run(&scene, Recording::Summary).complaint();
        let is_expected = match (&complaint, expected) {
            (Some(found), Some(words)) => found.contains(words),
            (found, expected) => found.is_none() && expected.is_none(),
        };
        assert!(is_expected, "{epsilon} {more}: {complaint:?}");
    }
}

/// The bound on a rise is a share of the energy: an infinite energy used to let everything pass.
#[test]
fn a_run_whose_energy_is_infinite_fails() {
    for scheme in ["dg", "euler-crank-nicolson", "midpoint"] {
        for beta in ["1e155", "1e160", "1e300"] {
            let text = format!(
                "[beam]\nbeta = {beta}\n[obstacles]\n[initial]\nu = \"0.01*x*(x-2)\"\n[time]\nscheme = \"{scheme}\"\nt_end = 1.0\n\
                 dt = 0.01\n"
            );
            let complaint = run(&scene(&text), Recording::Summary).complaint();
            let complaint = complaint.unwrap_or_else(|| panic!("{scheme} {beta}: pass"));
            assert!(
                complaint.contains("the energy is inf") || complaint.contains("finite"),
                "{scheme} {beta}: {complaint}"
            );
        }
    }
}

/// The paper's first experiment by dG.
fn located(time: &str, u: &str) -> Scene {
    let text = format!(
        "[obstacles]\n[initial]\nu = \"{u}\"\nu_t = \"20*x*(x-1)^2\"\ntheta = \"sin(pi*x)\"\n\
         [mesh]\ndegree = 12\n[time]\nscheme = \"dg\"\n{time}\n"
    );
    scene(&text)
}

#[test]
fn contact_at_the_start_is_a_phase_and_a_last_phase_ends_with_the_run() {
    let pressed = |t_end: &str| run(&located(t_end, "0.15*x^2"), Recording::Summary);
    let run = pressed("t_end = 0.005");
    let contact = run.contact.as_ref().unwrap();
    assert_eq!(
        (contact.started_in, contact.events.len()),
        (Phase::Upper, 0)
    );
    assert_eq!(run.contact_phases(), [(0.0, 0.005)]);
    assert_eq!(run.contact_steps, run.steps);
    let run = pressed("t_end = 0.02");
    let event = run.contact.as_ref().unwrap().events[0];
    assert_eq!((event.from, event.to), (Phase::Upper, Phase::Free));
    assert_eq!(run.contact_phases()[0], (0.0, event.t));
    assert!(0 < run.contact_steps && run.contact_steps < run.steps);
}

#[test]
fn a_step_by_dg_is_in_contact_if_the_free_end_touches_an_obstacle_in_all_of_it() {
    let mut steps = vec![];
    let mut watch = |motion: &mut AnyMotion, report: &StepReport| {
        steps.push((
            motion.motion().t() - report.dt,
            motion.motion().t(),
            report.in_contact,
        ));
        Ok(ControlFlow::Continue(()))
    };
    let simulator = Simulator::new(&located("t_end = 1.0", "0.01*x*(x-2)")).unwrap();
    let run = simulator.watched(Recording::Summary, &[], &mut watch);
    let phases = run.contact_phases();
    assert!(phases.len() == 2 && steps.len() == run.steps, "{phases:?}");
    for (from, to, in_contact) in steps {
        let is_inside = phases
            .iter()
            .any(|(start, end)| start - 1e-12 <= from && to <= end + 1e-12);
        assert_eq!(in_contact, is_inside, "from {from} to {to}, {phases:?}");
    }
}

#[test]
fn the_first_experiment_by_dg_has_its_events_and_a_curve_each_time_once() {
    let run = run(
        &located("t_end = 1.0", "0.01*x*(x-2)"),
        Recording::Curve(100),
    );
    let rows = &run.history.as_ref().unwrap().rows;
    assert_eq!((rows.len(), rows[100].sample), (101, run.last));
    let mut pairs = rows.windows(2);
    assert!(pairs.all(|pair| (pair[1].sample.t - pair[0].sample.t - 0.01).abs() < 1e-12));
    let extremes = run.extremes;
    assert!(
        extremes.u_tip_max > 0.105 && extremes.u_tip_min < -0.011,
        "{extremes:?}"
    );
    assert_eq!(run.contact.as_ref().unwrap().events.len(), 3);
    let phases = run.contact_phases();
    let (start, end) = phases[0];
    assert!((start - 0.203_413_276).abs() < 1e-7 && (end - 0.648_169_461).abs() < 1e-7);
    assert_eq!(phases[1].1, 1.0);
    // E falls in every step and its balance closes to round-off.
    let energy = run.energy;
    assert!(energy.largest_increase < 0.0);
    assert!(energy.largest_balance_residual < 1e-12 * energy.initial);
}
