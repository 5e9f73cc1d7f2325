//! Runs for a wanted error, against much finer runs that share neither mesh nor steps with them,
//! and against known numbers.

use std::time::Duration;

use convergence_judge::time_limit;
use convergence_study::file::Positive;
use thermobeam::dg::DgStepping;
use thermobeam::mesh::Mesh;
use thermobeam_study::accuracy::{OutOfReach, Reached, StopReason, reach};
use thermobeam_study::run::RunError;
use thermobeam_study::run::simulate::{Recording, Run, Simulator};
use thermobeam_study::scene::{Method, Scene};
use thermobeam_study::studies::experiments::digits::FRONTS;

/// Times of comparison: most of them lie inside steps, and none is a time of the search.
const TIMES: usize = 2999;

fn scene(name: &str) -> Scene {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../studies/scenes/");
    Scene::read(format!("{folder}{name}.toml")).expect("a scene")
}

fn fronts() -> Scene {
    Scene::parse(FRONTS, "fronts.toml").expect("a scene")
}

fn parsed(initial: &str) -> Scene {
    let text = format!("[beam]\na = 0.5\n[initial]\n{initial}\n[time]\ndt = 0.01\nt_end = 0.2\n");
    Scene::parse(&text, "s.toml").expect("a scene")
}

fn reached(scene: &Scene, target: f64) -> Result<Reached, OutOfReach> {
    let target = Positive::new(target).expect("a positive number");
    reach(scene, target, Recording::Curve(TIMES), &mut |_| ())
}

/// Why a search was refused, and the error that it reached.
#[track_caller]
fn stopped(scene: &Scene, target: f64) -> (StopReason, f64) {
    match reached(scene, target) {
        Err(OutOfReach {
            reason, reached, ..
        }) => (reason, reached),
        other => panic!("{other:?}"),
    }
}

fn tips(run: &Run) -> Vec<(f64, f64)> {
    run.history.as_ref().expect("a history").tip()
}

/// The largest difference of u(1) to a run with ten digits, from a discretisation that the search
/// never tries.
fn error(scene: &Scene, run: &Run) -> f64 {
    let stepping = DgStepping {
        degree: 5,
        dt: 0.003,
        restart_dt: 1e-5,
        growth: 1.12,
        ..DgStepping::default()
    };
    let fine = Scene {
        mesh: Mesh::from_nodes(vec![0.0, 0.7, 0.9, 0.97, 0.99, 1.0]).expect("nodes"),
        degree: 20,
        method: Method::Dg(stepping),
        ..scene.clone()
    };
    let fine = Simulator::new(&fine)
        .expect("a motion")
        .run(Recording::Curve(TIMES), &mut |_, _| ());
    let (own, fine) = (tips(run), tips(&fine));
    assert_eq!((own.len(), fine.len()), (TIMES + 1, TIMES + 1));
    let mut most = 0.0_f64;
    for ((t, own), (other, fine)) in own.iter().zip(&fine) {
        assert_eq!(t, other);
        most = most.max((own - fine).abs());
    }
    most
}

#[test]
fn the_error_is_at_most_the_estimate_and_the_estimate_at_most_the_target() {
    for name in ["impact", "lasting-contact", "free-motion"] {
        let scene = scene(name);
        for target in [1e-4, 1e-7] {
            let reached = reached(&scene, target).unwrap_or_else(|error| panic!("{name}: {error}"));
            let error = error(&scene, &reached.run);
            assert!(reached.estimate <= target, "{name}: {reached:?}");
            assert!(
                error <= reached.estimate.max(1e-11),
                "{name}, {target:e}: {error:e}, {:e}",
                reached.estimate
            );
            assert!(reached.runs >= 3, "{name}: {}", reached.runs);
        }
    }
}

/// The numbers of studies: for the experiment two discretisations agree on ten decimals, for the
/// fast fronts of small viscosity on eight.
#[test]
fn the_end_of_a_run_is_where_studies_know_it_to_be() {
    for (scene, targets, t_end, u_tip) in [
        (scene("paper-1-beta-0"), [1e-4, 1e-8], 10.0, 0.0084825987),
        (fronts(), [1e-4, 1e-5], 1.0, -0.01497289065),
    ] {
        for target in targets {
            let reached = reached(&scene, target).expect("a run");
            let last = reached.run.last;
            assert_eq!(last.t, t_end);
            assert!((last.u_tip - u_tip).abs() <= target + 1e-10, "{last:?}");
        }
    }
}

/// Both runs of a pair miss it, but not the comparison of the data.
#[test]
fn a_feature_that_the_first_mesh_misses_is_resolved_or_refused() {
    let bump = |width: &str| parsed(&format!("u_t = \"x*exp(-((x - 0.9)/{width})^2)\""));
    let wide = bump("0.02");
    let found = reached(&wide, 1e-6).expect("a run");
    assert!(found.scene.mesh.elements() > 8, "{:?}", found.scene.mesh);
    assert!(found.run.extremes.u_tip_max > 1e-3);
    let (refused, _) = stopped(&bump("3e-4"), 1e-6);
    assert!(matches!(refused, StopReason::Finest), "{refused}");
    let jump = parsed("u_t = \"(x - 0.37123)/abs(x - 0.37123) + 1\"");
    let refused = reached(&jump, 1e-6).expect_err("a refusal").to_string();
    assert!(refused.contains("u_t between x = 0 and"), "{refused}");
}

#[test]
fn a_kink_and_listed_nodes_are_nodes() {
    let kinked = parsed("u_t = \"max(0, x - 0.3)\"\n[mesh]\nnodes = [0.0, 0.4, 1.0]");
    let found = reached(&kinked, 1e-3).expect("a run");
    let nodes = found.scene.mesh.nodes();
    assert!(nodes.contains(&0.3) && nodes.contains(&0.4), "{nodes:?}");
}

#[test]
fn round_off_and_the_limits_of_work_and_time_refuse() {
    let swing = parsed("u_t = \"x\"");
    let (refused, reached_error) = stopped(&swing, 1e-17);
    assert!(matches!(refused, StopReason::RoundOff), "{refused}");
    assert!(
        (1e-17..=1e-11).contains(&reached_error),
        "{reached_error:e}"
    );
    let until = |t_end| Scene {
        t_end,
        ..swing.clone()
    };
    let (refused, _) = stopped(&until(1e8), 1e-3);
    assert!(matches!(refused, StopReason::Work), "{refused}");
    let long = until(1e3);
    let (refused, _) = time_limit::within(Some(Duration::ZERO), || stopped(&long, 1e-3).0);
    let is_time = matches!(refused, StopReason::Run(RunError::TimeUp(_)));
    assert!(is_time, "{refused}");
}

#[test]
fn a_beam_at_rest_stays_there() {
    let found = reached(&parsed("u_t = \"0*x\""), 1e-6).expect("a run");
    assert_eq!((found.estimate, found.run.last.u_tip), (0.0, 0.0));
}
