//! Laws of running a scene.

use std::time::Duration;

use convergence_study::run::time_limit::within;
use thermobeam::dg::Stepping;
use thermobeam::error::StepFailure;
use thermobeam::solve::Solver;
use thermobeam_study::run::any_order::{self, AnyOrderFailure};
use thermobeam_study::run::driver::RunError;
use thermobeam_study::run::simulate::{MOST_ROWS, Object, Recording, Run, Simulator, figures, run_together};
use thermobeam_study::scene::{Method, Scene};

/// The paper's first experiment on a coarse mesh, with more lines for the table `[time]`.
fn thrown(dt: &str, more: &str) -> Scene {
    let text = format!(
        "[obstacles]\n[initial]\nu = \"0.01*x*(x-2)\"\nu_t = \"20*x*(x-1)^2\"\ntheta = \"sin(pi*x)\"\n\
         [mesh]\nelements = 20\n[time]\nt_end = 1\ndt = {dt}\n{more}"
    );
    Scene::parse(&text, "thrown.toml").unwrap()
}

fn run(scene: &Scene, recording: Recording) -> Run {
    Simulator::new(scene).unwrap().run(recording, &mut |_| ())
}

#[test]
fn recording_changes_nothing_but_the_record() {
    let scene = thrown("1e-3", "");
    let (plain, recorded) = (run(&scene, Recording::Summary), run(&scene, Recording::History));
    assert_eq!(plain.history, None);
    let history = recorded.history.clone().unwrap();
    assert_eq!(Run { history: None, wall: plain.wall, ..recorded.clone() }, plain);

    assert_eq!((history.rows.len(), history.steps_per_row), (1001, 1));
    assert_eq!([history.rows[0].sample, history.rows[1000].sample], [plain.first, plain.last]);
    let tips = history.rows.iter().map(|row| row.sample.u_tip);
    assert_eq!(tips.clone().fold(f64::INFINITY, f64::min), plain.extremes.u_tip_min);
    assert_eq!(tips.fold(f64::NEG_INFINITY, f64::max), plain.extremes.u_tip_max);
    let worst = history.rows.iter().map(|row| row.dissipation.residual.abs()).fold(0.0, f64::max);
    assert_eq!(worst, plain.energy.largest_balance_residual);
    assert_eq!(history.rows.iter().filter(|row| row.sample.contact_force != 0.0).count(), plain.contact_steps);
}

#[test]
fn the_steps_are_told_one_by_one() {
    let mut told = Vec::new();
    Simulator::new(&thrown("0.1", "")).unwrap().run(Recording::Summary, &mut |step| told.push(step));
    assert_eq!(told, (1..=10).collect::<Vec<_>>());
}

#[test]
fn both_schemes_keep_their_balance_and_lose_energy() {
    for scheme in ["euler-crank-nicolson", "midpoint"] {
        for solver in Solver::ALL {
            let scene =
                thrown("1e-3", &format!("scheme = \"{scheme}\"\nsolver = \"{}\"\ntolerance = 1e-13", solver.name()));
            let run = run(&scene, Recording::Summary);
            assert_eq!((run.steps, &run.failure), (1000, &None), "{scheme} {solver:?}");
            assert!(run.energy.largest_increase < 0.0, "{scheme} {solver:?}: {}", run.energy.largest_increase);
            assert!(run.energy.largest_balance_residual < 2e-12, "{scheme} {solver:?}: {:?}", run.energy);
            assert_eq!([run.energy.initial, run.energy.last], [run.first.energy, run.last.energy]);
            assert!(run.contact_steps > 100);
        }
    }
}

#[test]
fn a_long_history_is_thinned_and_loses_no_energy() {
    let text = "[initial]\nu_t = \"x\"\n[mesh]\nelements = 2\n[time]\nt_end = 500.001\ndt = 1e-3";
    let scene = Scene::parse(text, "long.toml").unwrap();
    let run = run(&scene, Recording::History);
    let history = run.history.unwrap();
    assert_eq!((scene.steps(), history.steps_per_row), (500_001, 3));
    assert_eq!(history.rows.len(), 1 + 500_001 / 3);
    assert!(history.rows.len() <= MOST_ROWS + 1);
    assert_eq!(history.rows.last().unwrap().sample, run.last);
    assert_eq!(history.frames.times.last(), Some(&run.last.t));
    assert!(history.frames.times.len() <= 442);
    let lost: f64 = history.rows.iter().map(|row| row.dissipation.change).sum();
    assert!((lost - (run.energy.last - run.energy.initial)).abs() < 1e-12);
}

#[test]
fn what_could_be_done_before_a_failure_is_kept() {
    let scene = thrown("1e-2", "solver = \"fixed-point\"");
    let run = run(&scene, Recording::History);
    let failure = run.failure.as_ref().expect("the contact force lags too far behind");
    let RunError::Step(failure) = failure else { panic!("{failure}") };
    assert!(matches!(failure.failure, StepFailure::Diverged { contraction, .. } if contraction >= 1.0), "{failure}");
    assert!(run.steps > 0 && run.steps + 1 == failure.step);
    assert!((run.last.t - 0.01 * run.steps as f64).abs() < 1e-15);
    let history = run.history.as_ref().unwrap();
    assert_eq!(history.rows.len(), run.steps + 1);
    assert_eq!(history.rows.last().unwrap().sample, run.last);
    assert_eq!(history.csv().lines().count(), run.steps + 2);
    assert_eq!(figures(&scene, &run).len(), 5);
}

#[test]
fn a_limit_on_the_time_ends_a_run_and_what_was_done_is_kept() {
    let scene = thrown("1e-4", "");
    let limit = Duration::from_millis(1);
    let (stopped, up) = within(Some(limit), || {
        let simulator = Simulator::new(&scene).unwrap();
        // Each step hears that it is done, and this one dawdles.
        simulator.run(Recording::Summary, &mut |_| std::thread::sleep(limit))
    });
    let Some(RunError::TimeUp(told)) = stopped.failure else { panic!("{:?}", stopped.failure) };
    assert_eq!(Some(told), up);
    assert_eq!((told.step, told.t, told.limit), (stopped.steps, stopped.last.t, limit));
    assert!(0 < stopped.steps && stopped.steps < scene.steps());
    let json = serde_json::to_value(Object::new(&scene, &stopped)).unwrap();
    assert_eq!(json["failure"]["kind"], "time-limit");
    assert_eq!(json["failure"]["limit_seconds"], 1e-3);
    let (whole, up) = within(Some(Duration::from_secs(600)), || run(&scene, Recording::Summary));
    assert_eq!((whole.steps, whole.failure, up), (scene.steps(), None, None));
}

#[test]
fn a_run_that_fails_at_once_has_its_start_and_no_largest_increase() {
    let scene = thrown("0.1", "solver = \"fixed-point\"\nmax_iterations = 1");
    let run = run(&scene, Recording::History);
    assert_eq!((run.steps, run.iterations.total), (0, 0));
    assert_eq!(run.first, run.last);
    assert!(run.energy.largest_increase.is_nan());
    assert_eq!(run.history.as_ref().map(|history| (history.rows.len(), history.frames.times.len())), Some((1, 1)));
    assert_eq!(figures(&scene, &run).len(), 5);
}

#[test]
fn the_temperature_is_the_physical_one_on_any_mesh() {
    for mesh in ["elements = 7", "elements = 8", "nodes = [0, 0.3, 1]"] {
        let text = format!(
            "[beam]\na = 0\ntheta_a = 20\n[initial]\ntheta = \"20*(1-x)\"\n[mesh]\n{mesh}\n[time]\nt_end = 1\ndt = 0.1"
        );
        let run = run(&Scene::parse(&text, "steady.toml").unwrap(), Recording::Summary);
        assert!((run.first.theta_mid - 10.0).abs() < 1e-14 && (run.last.theta_mid - 10.0).abs() < 1e-14, "{mesh}");
        assert!(!run.is_heated || run.work.passes > 0);
    }
}

#[test]
fn boundary_values_that_the_scene_accepts_do_not_trouble_the_solver() {
    let scene = "[initial]\ntheta = \"sin(1000*pi*x)\"\nu = \"1e6*sin(x)\"\n[time]\nt_end = 0.01\ndt = 0.01";
    let scene = Scene::parse(scene, "wild.toml").unwrap();
    assert!(Simulator::new(&scene).is_ok());
}

#[test]
fn every_bit_of_the_history_can_be_read_back() {
    let run = run(&thrown("1e-2", ""), Recording::History);
    let history = run.history.unwrap();
    let csv = history.csv();
    let mut lines = csv.lines();
    let names: Vec<_> = lines.next().unwrap().split(',').collect();
    assert_eq!(names[..8], ["t", "u_tip", "phi_tip", "u_t_tip", "phi_t_tip", "theta_mid", "contact_force", "energy"]);
    assert_eq!(names[8..], ["energy_change", "viscous", "thermal", "inertial", "contact_gap", "residual"]);
    for (line, row) in lines.zip(&history.rows) {
        let values: Vec<f64> = line.split(',').map(|value| value.parse().unwrap()).collect();
        let (s, d) = (row.sample, row.dissipation);
        assert_eq!(values[..4], [s.t, s.u_tip, s.phi_tip, s.u_t_tip]);
        assert_eq!(values[4..8], [s.phi_t_tip, s.theta_mid, s.contact_force, s.energy]);
        assert_eq!(values[8..], [d.change, d.viscous, d.thermal, d.inertial, d.contact_gap, d.residual]);
        assert!(values.iter().all(|value| value.is_finite()));
    }
}

#[test]
fn a_run_of_any_order_stops_at_the_step_that_breaks_the_law_of_the_energy() {
    let text = "[beam]\nrho = 5000\n[initial]\nu_t = \"20*x\"\n[mesh]\ndegree = 6\n[time]\nscheme = \"dg\"\nt_end = 2.0\n\
                restart_dt = 0.1\ndt = 0.1\n";
    let scene = Scene::parse(text, "loose.toml").unwrap();
    // Steps that are not solved.
    let method = Method::Dg(Stepping { tolerance: 100.0, ..scene.dg_stepping() });
    let scene = Scene { method, ..scene };
    let run = any_order::run(&scene, 0, &mut |_| ()).unwrap();
    let Some(AnyOrderFailure::Unsound { step, t, dt, .. }) = run.failure else { panic!("{:?}", run.failure) };
    assert_eq!((step, t + dt), (run.steps, run.ends[1].t));
    assert!(run.ends[1].t < 2.0, "{:?}", run.ends);
    let complaint = run.complaint().unwrap();
    assert!(
        complaint.starts_with(&format!("step {step} (from t = {t}")) && complaint.contains("in a step"),
        "{complaint}"
    );
}

#[test]
fn a_one_step_run_stops_at_the_step_that_raises_the_energy_alone_and_in_lanes() {
    // Steps that are not solved.
    let text = "[beam]\nrho = 5000\n[initial]\nu_t = \"x\"\n[mesh]\nelements = 5\n[time]\nscheme = \"midpoint\"\n\
                t_end = 10.0\ndt = 0.1\ntolerance = 1e6\n";
    let scene = Scene::parse(text, "loose.toml").unwrap();
    let alone = run(&scene, Recording::Summary);
    let Some(RunError::Unsound { step, t, dt, unsound }) = &alone.failure else { panic!("{:?}", alone.failure) };
    assert!(alone.steps == *step && alone.steps < scene.steps() && (t + dt - alone.last.t).abs() < 1e-15, "{alone:?}");
    assert!(alone.energy.complaint(alone.steps, alone.failure.as_ref()).unwrap().contains(&unsound.to_string()));
    assert_eq!(serde_json::to_value(Object::new(&scene, &alone)).unwrap()["failure"]["kind"], "unsound");
    let together = run_together(&[scene.clone(), scene]).unwrap();
    for run in together {
        assert_eq!((run.steps, &run.failure, run.last), (alone.steps, &alone.failure, alone.last));
    }
}

/// The bound on a rise of the energy is a share of the energy: an infinite one let everything pass.
#[test]
fn a_run_whose_energy_is_infinite_fails() {
    for scheme in ["dg", "euler-crank-nicolson", "midpoint"] {
        for beta in ["1e155", "1e160", "1e300"] {
            let text = format!(
                "[beam]\nbeta = {beta}\n[obstacles]\n[initial]\nu = \"0.01*x*(x-2)\"\n[time]\nscheme = \"{scheme}\"\nt_end = 1.0\n\
                 dt = 0.01\n"
            );
            let scene = Scene::parse(&text, "s.toml").unwrap();
            let complaint = match scene.method {
                Method::OneStep(_) => {
                    let run = run(&scene, Recording::Summary);
                    run.energy.complaint(run.steps, run.failure.as_ref())
                }
                Method::Dg(_) => any_order::run(&scene, 0, &mut |_| ()).unwrap().complaint(),
            };
            let complaint = complaint.unwrap_or_else(|| panic!("{scheme} {beta}: pass"));
            assert!(
                complaint.contains("the energy is inf") || complaint.contains("finite"),
                "{scheme} {beta}: {complaint}"
            );
        }
    }
}
