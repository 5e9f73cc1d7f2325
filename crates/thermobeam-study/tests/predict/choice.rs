//! `--target-error`: runs that are chosen by their error.

use convergence_judge::{SpaceTime, time_limit};
use thermobeam::scheme::SCHEMES;
use thermobeam_study::error::{Evaluator, free_vibration};
use thermobeam_study::predict::choice::{Choice, ErrorQuantity};
use thermobeam_study::predict::{self, StopReason, Unreachable, Work};
use thermobeam_study::run::ObservableMotion;
use thermobeam_study::run::family::Family;
use thermobeam_study::run::simulate::{Recording, Simulator};

use super::{
    CONTACT, TIMES, ZETA, choose, chosen, keep, largest_difference, limited, parsed, reference,
    run, scene, vibration,
};

#[test]
fn the_error_asked_for_is_made_inside_steps_too_and_the_checks_cost_a_few_runs() {
    for beam in ["", "beta = 5"] {
        let scene = scene(beam, "t_end = 1.0");
        let exact = reference(&scene);
        for target in [1e-4, 1e-6, 1e-8] {
            let (choice, spent) =
                limited(|work| predict::choice::choose(&scene, ErrorQuantity::Tip, target, work));
            let choice = choice.unwrap_or_else(|error| panic!("{target:e}: {error}"));
            let made = largest_difference(&run(&choice.scene, TIMES), &exact);
            assert!(
                made <= target,
                "{beam}, {target:e}: {made:e} with {choice:?}"
            );
            assert!(choice.error <= target);
            // The estimate is honest: it is correct within a factor of two.
            assert!(
                made <= 2.0 * choice.error && choice.error <= 10.0 * made,
                "{made:e} with {choice:?}"
            );
            let ratio = spent.work / choice.run.work;
            assert!(
                ratio <= 8.0,
                "{beam}, {target:e}: the checks cost {ratio:.1} runs"
            );
        }
    }
}

#[test]
fn the_scenes_own_degrees_and_steps_do_not_matter_and_the_choice_repeats() {
    let one = chosen(&scene("", "t_end = 0.5"), 1e-5);
    let other = chosen(
        &scene(
            "",
            "t_end = 0.5\ndegree = 0\ndt = 0.4\nrestart_dt = 0.3\ngrowth = 2",
        ),
        1e-5,
    );
    assert_eq!(
        (&one.scene, one.parts, one.error),
        (&other.scene, other.parts, other.error)
    );
    let nodes = one.scene.mesh.nodes();
    assert!(
        nodes.len() > 2 && 1.0 - nodes[nodes.len() - 2] < 0.2,
        "graded towards x = 1: {nodes:?}"
    );
}

#[test]
fn a_smaller_error_takes_finer_discretisations() {
    let scene = scene("", "t_end = 0.5");
    let [coarse, fine] = [1e-3, 1e-9].map(|target| chosen(&scene, target));
    assert!(fine.scene.degree > coarse.scene.degree && fine.scene.dt() < coarse.scene.dt());
    assert!(fine.run.work > 2.0 * coarse.run.work);
}

#[test]
fn what_cannot_be_reached_is_refused_with_what_can() {
    let scene = scene("beta = 5", "t_end = 0.3");
    for target in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(
            matches!(choose(&scene, target), Err(Unreachable::Target { .. })),
            "{target}"
        );
    }
    match choose(&scene, 1e-17) {
        Err(Unreachable::NotReached {
            reached,
            reason: StopReason::RoundOff,
            ..
        }) => {
            assert!(reached > 1e-17 && reached < 1e-10, "{reached:e}");
        }
        other => panic!("{other:?}"),
    }
    // Enough work for two rounds: the message gives the error reached and the limit.
    let mut progress = |_: f64| ();
    let mut work = Work::new(2e6, &mut progress);
    let error = predict::choice::choose(&scene, ErrorQuantity::Tip, 1e-12, &mut work).unwrap_err();
    let Unreachable::NotReached {
        reached,
        reason: StopReason::Work { limit: 2e6 },
        ..
    } = error
    else {
        panic!("{error}")
    };
    assert!(reached < 1e-6 && work.spent().work <= 2e6, "{error}");
    assert!(
        error.to_string().contains("limit of 2.0e6")
            && error.to_string().contains("can be reached"),
        "{error}"
    );
    let (stopped, _) = time_limit::within(Some(std::time::Duration::ZERO), || choose(&scene, 1e-6));
    let error = stopped.unwrap_err();
    assert!(
        matches!(&error, Unreachable::NotReached { reason: StopReason::Run(run), .. } if run.contains("limit")),
        "{error}"
    );
}

fn vibrating(modes: &[usize], t_end: f64) -> Family {
    let modes: Vec<_> = modes.iter().map(|&mode| (mode, 0.1)).collect();
    Family::of_free_solution(
        free_vibration::vibration(&modes, ZETA).unwrap(),
        free_vibration::beam(ZETA),
        t_end,
    )
}

/// The actual error over all time levels, and its norm, for a vibration with one mode.
fn made(choice: &Choice) -> [f64; 2] {
    let family = vibrating(&[0], choice.scene.t_end);
    let (on, steps) = (
        family.on(choice.scene.mesh.elements()).unwrap(),
        choice.scene.steps(),
    );
    let mut evaluator = Evaluator::new(&family, &on, None).unwrap();
    let stepping = choice.scene.one_step().unwrap();
    let mut run = on.start(stepping.scheme, stepping.settings, steps).unwrap();
    let mut worst = [0.0_f64; 2];
    for index in 0..steps {
        run.step(f64::INFINITY).unwrap();
        let errors = evaluator.measure(&run.snapshot().on(on.mesh()), index, run.work().t);
        worst = [worst[0].max(errors.tip), worst[1].max(errors.norm)];
    }
    // The family is released with u(1) = 0.1, the scene with 1.
    worst.map(|error| 10.0 * error)
}

#[test]
fn a_scheme_that_is_kept_makes_the_error_asked_for_at_little_cost() {
    for scheme in SCHEMES {
        let (_, scene) = vibration(
            0,
            &format!(
                "[time]\ndt = 0.1\nt_end = 2.0\nscheme = \"{}\"\n",
                scheme.name
            ),
        );
        let targets = if scheme.order > 1.0 {
            [1e-3, 1e-5]
        } else {
            [1e-2, 1e-3]
        };
        for (quantity, target, which) in [
            (ErrorQuantity::Tip, targets[0], 0),
            (ErrorQuantity::Tip, targets[1], 0),
            (ErrorQuantity::Norm, 0.02, 1),
        ] {
            let choice = keep(&scene, quantity, target);
            let error = made(&choice)[which];
            let context = format!(
                "{} {target:e}: {error:e} made by {:?}",
                scheme.name,
                choice.scene.mesh.elements()
            );
            assert_eq!(choice.scene.method.name(), scheme.name);
            assert!((0.3 * target..=target).contains(&error), "{context}");
            assert!(
                (error - choice.error).abs() <= 0.15 * target,
                "{context}, estimated {:e}",
                choice.error
            );
            // Neither space nor time takes nearly all of the error: that would cost more. (Coarser
            // runs are not tried.)
            let SpaceTime { space, time } = choice.parts;
            let is_coarsest = choice.scene.mesh.elements() == 16;
            let is_balanced =
                (0.2..=0.8).contains(&(space / (space + time))) && space + time <= 1.5 * target;
            assert!(
                is_coarsest || is_balanced || quantity == ErrorQuantity::Norm,
                "{context}: {space:e}, {time:e}"
            );
        }
    }
}

#[test]
fn a_scheme_that_is_kept_makes_the_error_asked_for_in_contact() {
    for (scheme, target) in [("midpoint", 1e-4), ("euler-crank-nicolson", 1e-3)] {
        let text = format!("{CONTACT}[time]\ndt = 0.01\nt_end = 1.0\nscheme = \"{scheme}\"\n");
        let choice = keep(&parsed(&text), ErrorQuantity::Tip, target);
        let own = Simulator::new(&choice.scene)
            .expect("a scene")
            .run(Recording::History, &mut |_, _| ());
        let exact = run(
            &parsed(&format!("{CONTACT}[time]\nscheme = \"dg\"\nt_end = 1.0\n")),
            1,
        );
        let last = exact.last;
        assert!(
            (own.last.u_tip - last.u_tip).abs() <= target,
            "{:?}",
            own.last
        );
        assert!(
            (0.2 * target..=target).contains(&choice.error),
            "{}",
            choice.error
        );
    }
}

#[test]
fn the_cheapest_is_dg_and_costs_less_than_the_scenes_own_scheme() {
    let (_, scene) = vibration(0, "[time]\ndt = 0.1\nt_end = 2.0\nscheme = \"midpoint\"\n");
    let choice = choose(&scene, 1e-5).expect("a run");
    assert!(choice.scene.method.name() == "dg" && !choice.is_kept && choice.error <= 1e-5);
    let kept = keep(&scene, ErrorQuantity::Tip, 1e-5);
    assert!(kept.is_kept && choice.run.work < kept.run.work);
    let again = choose(&choice.scene, 1e-5).expect("a run");
    assert_eq!(again.scene, choice.scene);
}

#[test]
fn in_the_norm_dg_makes_the_error_asked_for() {
    let scene = parsed(&format!("{CONTACT}[time]\ndt = 0.01\nt_end = 0.5\n"));
    let (found, _) =
        limited(|work| predict::choice::choose(&scene, ErrorQuantity::Norm, 1e-3, work));
    let choice = found.expect("a run");
    let (finer, _) =
        limited(|work| predict::choice::choose(&scene, ErrorQuantity::Norm, 1e-5, work));
    let finer = finer.expect("a run");
    // The norm bounds the shear, and so the free end's distance except for the rotation's part.
    let [one, other] = [&choice, &finer].map(|choice| run(&choice.scene, TIMES));
    let made = largest_difference(&one, &other);
    assert!(
        choice.error <= 1e-3 && made <= 2.0 * choice.error && made > 1e-8,
        "{made:e}"
    );
    assert!(finer.run.work > choice.run.work);
}

#[test]
fn a_scheme_that_is_kept_keeps_the_listed_nodes() {
    let listed = "[initial]\nu_t = \"x\"\n[mesh]\nnodes = [0.0, 0.3, 0.45, 1.0]\n[time]\nscheme = \"midpoint\"\ndt = 0.1\nt_end = 0.5\n";
    let choice = keep(&parsed(listed), ErrorQuantity::Tip, 1e-3);
    let nodes = choice.scene.mesh.nodes();
    assert!(
        [0.3, 0.45].iter().all(|x| nodes.contains(x)) && nodes.len() > 4,
        "{nodes:?}"
    );
}
