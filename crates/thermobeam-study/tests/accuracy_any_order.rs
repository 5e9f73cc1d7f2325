//! Laws of asking a scene of any order for an accuracy: held against much finer runs that share neither mesh nor steps.

use thermobeam::dg::Stepping;
use thermobeam::mesh::Mesh;
use thermobeam_study::predict::any_order::{Choice, Source, Unreachable, choose, estimate};
use thermobeam_study::run::any_order::{AnyOrderRun, run};
use thermobeam_study::scene::any_order::{AnyOrderScene, SceneFile};

/// Times of comparison: most of them lie inside steps.
const TIMES: usize = 3000;

fn scene(beam: &str, time: &str) -> AnyOrderScene {
    let text = format!(
        "[beam]\n{beam}\n[obstacles]\n[initial]\nu = \"0.01*x*(x-2)\"\nu_t = \"20*x*(x-1)^2\"\ntheta = \"sin(pi*x)\"\n\
         [time]\nscheme = \"dg\"\n{time}\n"
    );
    match SceneFile::parse(&text, "s.toml").unwrap_or_else(|error| panic!("{error}")) {
        SceneFile::AnyOrder(scene) => scene,
        SceneFile::OneStep(_) => panic!("a one-step scene"),
    }
}

/// Ten digits and more, from a discretisation that the search never tries.
fn reference(scene: &AnyOrderScene) -> AnyOrderRun {
    let mesh = Mesh::from_nodes(vec![0.0, 0.7, 0.9, 0.97, 1.0]).expect("nodes");
    let stepping = Stepping { degree: 5, dt: 0.003, restart_dt: 1e-4, growth: 1.12, ..Stepping::default() };
    let fine = AnyOrderScene { mesh, degree: 20, stepping, ..scene.clone() };
    run(&fine, TIMES, &mut |_| ()).expect("a run")
}

fn largest_difference(one: &AnyOrderRun, other: &AnyOrderRun) -> f64 {
    assert_eq!(one.history.len(), TIMES + 1);
    let pairs = one.history.iter().zip(&other.history);
    pairs.map(|(a, b)| (a.u_tip - b.u_tip).abs()).fold(0.0, |most, difference| {
        assert!(difference.is_finite());
        most.max(difference)
    })
}

fn chosen(scene: &AnyOrderScene, target: f64) -> Choice {
    choose(scene, target).unwrap_or_else(|error| panic!("{target:e}: {error}"))
}

#[test]
fn the_error_asked_for_is_made_inside_steps_too_and_the_checks_cost_a_few_runs() {
    for beam in ["", "beta = 5"] {
        let scene = scene(beam, "t_end = 1.0");
        let exact = reference(&scene);
        for target in [1e-4, 1e-6, 1e-8] {
            let choice = chosen(&scene, target);
            let made = largest_difference(&run(&choice.scene, TIMES, &mut |_| ()).expect("a run"), &exact);
            assert!(made <= target, "{beam}, {target:e}: {made:e} with {choice:?}");
            assert!(choice.expected_error() <= target);
            // The belief is no flattery: it is the error within a factor of two.
            assert!(
                made <= 2.0 * choice.expected_error() && choice.expected_error() <= 10.0 * made,
                "{made:e} with {choice:?}"
            );
            let ratio = choice.checks.unknown_solves / choice.run.unknown_solves;
            assert!(ratio <= 8.0, "{beam}, {target:e}: the checks cost {ratio:.1} runs");
        }
    }
}

#[test]
fn the_scenes_own_degrees_and_steps_do_not_matter_and_the_choice_repeats() {
    let one = chosen(&scene("", "t_end = 0.5"), 1e-5);
    let other = chosen(&scene("", "t_end = 0.5\ndegree = 0\ndt = 0.4\nrestart_dt = 0.3\ngrowth = 2"), 1e-5);
    assert_eq!((&one.scene, one.space, one.time), (&other.scene, other.space, other.time));
    let nodes = one.scene.mesh.nodes();
    assert!(nodes.len() > 2 && 1.0 - nodes[nodes.len() - 2] < 0.2, "graded towards x = 1: {nodes:?}");
}

#[test]
fn a_smaller_error_takes_finer_discretisations() {
    let scene = scene("", "t_end = 0.5");
    let [coarse, fine] = [1e-3, 1e-9].map(|target| chosen(&scene, target));
    assert!(fine.scene.degree > coarse.scene.degree && fine.scene.stepping.dt < coarse.scene.stepping.dt);
    assert!(fine.run.unknown_solves > 2.0 * coarse.run.unknown_solves);
}

#[test]
fn what_cannot_be_reached_is_told_with_what_can() {
    let scene = scene("beta = 5", "t_end = 0.3");
    for target in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(choose(&scene, target), Err(Unreachable::Target { .. })), "{target}");
    }
    match choose(&scene, 1e-17) {
        Err(Unreachable::NotReached { reached, reason, .. }) => {
            assert!(reached > 1e-17 && reached < 1e-10, "{reached:e}, {reason}");
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn the_budget_is_the_error_and_names_what_dominates() {
    let fine_space = "t_end = 0.6\ndegree = 1\ndt = 0.02";
    for (degree, time, expected) in
        [(20, fine_space, Source::Time), (5, "t_end = 0.6\ndegree = 4\ndt = 0.004\ngrowth = 1.1", Source::Space)]
    {
        let scene = AnyOrderScene { degree, ..scene("", time) };
        let budget = estimate(&scene).expect("a budget");
        assert_eq!(budget.dominant, Some(expected), "{budget}");
        let exact = reference(&scene);
        let own = run(&scene, TIMES, &mut |_| ()).expect("a run");
        let made = largest_difference(&own, &exact);
        let tip = budget.quantities.iter().find(|of| of.name == "u(1) over time").expect("the curve");
        assert!(made <= 2.0 * tip.total && tip.total <= 4.0 * made, "{made:e} against {budget}");
        let end = budget.quantities.iter().find(|of| of.name == "u(1) at the end").expect("the number");
        assert_eq!(end.value, own.ends[1].u_tip);
        assert!((end.value - exact.ends[1].u_tip).abs() <= 3.0 * end.total);
    }
}
