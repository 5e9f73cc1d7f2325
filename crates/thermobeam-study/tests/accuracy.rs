//! Laws of asking for an accuracy: held against exact answers, and against much finer runs where the tip is in contact.

use convergence_study::study::FromFile as _;
use thermobeam::dg::Stepping;
use thermobeam::scheme::{SCHEMES, Scheme};
use thermobeam::solve::Settings;
use thermobeam_study::error::evaluator::{ErrorMeasure, Evaluator};
use thermobeam_study::error::free_vibration::{beam, vibration};
use thermobeam_study::error::reference::{Reference, fine_mesh};
use thermobeam_study::kinds::convergence::Convergence;
use thermobeam_study::kinds::tables::Discretisation;
use thermobeam_study::predict::accuracy::{Choice, Request, Trust, Unreachable, choose};
use thermobeam_study::run::family::Family;
use thermobeam_study::scene::Scene;

fn vibrating(modes: &[usize], zeta: f64, t_end: f64) -> Family {
    let modes: Vec<_> = modes.iter().map(|&mode| (mode, 0.1)).collect();
    Family::of_free_solution(vibration(&modes, zeta).unwrap(), beam(zeta), t_end)
}

fn manufactured() -> Family {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../studies/midpoint-coupled.toml");
    let spec = Convergence::read(path).unwrap();
    Family::of_solution(spec.exact, spec.beam, spec.obstacles, spec.refine.t_end)
}

/// The error made, over all time levels.
fn made(family: &Family, quantity: ErrorMeasure, scheme: Scheme, settings: Settings, [n, steps]: [usize; 2]) -> f64 {
    let on = family.on(n).unwrap();
    let mut evaluator = Evaluator::new(family, &on, None).unwrap();
    let mut run = on.start(scheme, settings, steps).unwrap();
    let mut worst = 0.0_f64;
    for index in 0..steps {
        run.advance(1).unwrap();
        let t = run.t();
        let errors = evaluator.measure(run.level(), index, t);
        let error = errors[ErrorMeasure::ALL.iter().position(|&other| other == quantity).unwrap()];
        assert!(error.is_finite());
        worst = worst.max(error);
    }
    worst
}

/// Node-steps of the cheapest run with the error `target`, by search over meshes, steps and schemes.
fn searched(family: &Family, quantity: ErrorMeasure, target: f64, about: &Choice) -> f64 {
    let mut best = f64::INFINITY;
    for scheme in SCHEMES {
        for k in -3..=3 {
            let elements = (about.elements as f64 * 1.25_f64.powi(k)).round() as usize;
            let fits = |steps: usize| made(family, quantity, scheme, about.settings, [elements, steps]) <= target;
            let most = (best / elements as f64).min(2.0 * about.node_steps() / elements as f64) as usize;
            if most < 2 || !fits(most) {
                continue;
            }
            let (mut low, mut high) = (1, most);
            while high - low > 1 + high / 20 {
                let middle = (low + high) / 2;
                if fits(middle) { high = middle } else { low = middle }
            }
            best = (elements * high) as f64;
        }
    }
    best
}

/// The error made is that asked for; the run costs at most twice the best, and so does it with its pilots.
#[track_caller]
fn check(family: &Family, quantity: ErrorMeasure, target: f64) {
    let choice = choose(family, &Request::new(quantity, target)).unwrap();
    let error = made(family, quantity, choice.scheme, choice.settings, [choice.elements, choice.steps]);
    let context = format!("{} {target:e}: {error:e} made by {choice:?}", quantity.name());
    assert!((0.2 * target..=target).contains(&error), "{context}");
    assert!((0.7..=1.4).contains(&(error / choice.expected_error)), "{context}");
    assert_eq!((choice.scheme.name, choice.trust), ("midpoint", Trust::Firm), "{context}");
    let best = searched(family, quantity, target, &choice);
    let cost = choice.node_steps() + choice.pilots.node_steps;
    assert!(cost <= 2.0 * best, "{context}: with pilots {cost:e}, the best {best:e}");
}

#[test]
fn a_vibrating_tip_is_as_accurate_as_asked_for_at_little_cost() {
    for target in [1e-5, 1e-6] {
        check(&vibrating(&[0, 1], 0.1, 2.0), ErrorMeasure::Tip, target);
        check(&vibrating(&[0], 0.5, 4.0), ErrorMeasure::Tip, target);
    }
}

#[test]
fn a_manufactured_solution_is_as_accurate_as_asked_for_at_little_cost() {
    for target in [1e-4, 1e-5] {
        check(&manufactured(), ErrorMeasure::Tip, target);
    }
    for target in [1e-2, 3e-3] {
        check(&manufactured(), ErrorMeasure::Theorem34, target);
    }
}

#[test]
fn a_coarse_answer_is_as_accurate_as_asked_for_whatever_the_pilots_cost() {
    for target in [1e-2, 1e-3, 1e-4] {
        let family = vibrating(&[0, 1], 0.1, 2.0);
        let choice = choose(&family, &Request::new(ErrorMeasure::Tip, target)).unwrap();
        let error = made(&family, ErrorMeasure::Tip, choice.scheme, choice.settings, [choice.elements, choice.steps]);
        assert!((0.2 * target..=target).contains(&error), "{target:e}: {error:e}, {choice:?}");
        assert!(choice.pilots.node_steps < 3000.0);
    }
}

fn thrown(t_end: f64) -> Scene {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../studies/scenes/paper-1-beta-0.toml");
    Scene { t_end, ..Scene::read(path).unwrap() }
}

/// Exact to eight digits.
const EXACT: Discretisation = Discretisation {
    elements: 1,
    degree: 24,
    stepping: Stepping { degree: 4, dt: 0.005, restart_dt: 2e-4, growth: 1.4, tolerance: 1e-14, max_iterations: 100 },
};

#[test]
fn in_contact_the_error_is_kept_too_and_no_order_is_taken_for_granted() {
    const OBSERVATIONS: usize = 200;
    for (t_end, quantity, target) in [
        (0.5, ErrorMeasure::Tip, 1e-4),
        (0.5, ErrorMeasure::Theorem34, 1e-2),
        (2.0, ErrorMeasure::Tip, 1e-3),
        (2.0, ErrorMeasure::Tip, 1e-4),
    ] {
        let scene = thrown(t_end);
        let family = Family::of_scene(&scene);
        let choice = choose(&family, &Request::new(quantity, target)).unwrap();
        let steps = choice.steps.next_multiple_of(OBSERVATIONS);
        let mesh = fine_mesh(&scene, choice.elements).unwrap();
        let reference = Reference::compute(&scene, &EXACT, mesh, t_end, OBSERVATIONS, 0).unwrap();
        let on = family.on(choice.elements).unwrap();
        let mut evaluator = Evaluator::new(&family, &on, Some(&reference)).unwrap();
        let mut run = on.start(choice.scheme, choice.settings, steps).unwrap();
        let mut worst = 0.0_f64;
        for index in 0..OBSERVATIONS {
            run.advance(steps / OBSERVATIONS).unwrap();
            let errors = evaluator.measure(run.level(), index, 0.0);
            worst = worst.max(errors[if quantity == ErrorMeasure::Tip { 2 } else { 0 }]);
        }
        let context = format!("T = {t_end}, {} {target:e}: {worst:e}, {choice:?}", quantity.name());
        assert!((0.2 * target..=target).contains(&worst), "{context}");
        assert!(choice.trust < Trust::Firm, "{context}");
    }
}

#[test]
fn what_cannot_be_reached_is_refused_with_what_can() {
    let family = vibrating(&[0, 1], 0.1, 2.0);
    let limited = Request { max_node_steps: 1e5, ..Request::new(ErrorMeasure::Tip, 1e-7) };
    let error = choose(&family, &limited).unwrap_err();
    let Unreachable::Cost { reachable, cost, .. } = error else { panic!("{error}") };
    assert!(reachable > 1e-7 && reachable < 1e-4 && cost > 1e5, "{error}");
    // What is called reachable can be reached.
    let within = choose(&family, &Request { target: reachable, ..limited }).unwrap();
    assert!(within.node_steps() + within.pilots.node_steps <= 1e5);
    let limitless = Request { max_node_steps: f64::INFINITY, ..Request::new(ErrorMeasure::Tip, 1e-13) };
    let error = choose(&family, &limitless).unwrap_err();
    assert!(
        matches!(error, Unreachable::RoundOff { reachable, .. } if reachable > 1e-13 && reachable < 1e-9),
        "{error}"
    );
    // Too costly and below round-off: what is called reachable is neither.
    let error = choose(&family, &Request::new(ErrorMeasure::Tip, 1e-14)).unwrap_err();
    let Unreachable::Cost { reachable, .. } = error else { panic!("{error}") };
    assert!(choose(&family, &Request::new(ErrorMeasure::Tip, reachable)).is_ok(), "{error}");
    let endless = choose(&family, &Request::new(ErrorMeasure::Tip, 1e-40)).unwrap_err().to_string();
    assert!(endless.contains("would take more than 1e12 steps"), "{endless}");
    for target in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(choose(&family, &Request::new(ErrorMeasure::Tip, target)), Err(Unreachable::Target { .. })));
    }
}

#[test]
fn round_off_is_below_the_floor_that_is_assumed() {
    // The error in space falls fourfold; by how much it does not is round-off.
    let family = vibrating(&[0, 1], 0.1, 2.0);
    let tip = |n: usize| {
        let on = family.on(n).unwrap();
        let settings = Settings { tolerance: 1e-13, ..Settings::default() };
        let mut run = on.start(SCHEMES[1], settings, 64).unwrap();
        run.advance(64).unwrap();
        run.level().u[n]
    };
    let [a, b, c] = [8192, 16384, 32768].map(tip);
    let noise = ((a - b) / 4.0 - (b - c)).abs();
    assert!(noise < 1e-4 * f64::EPSILON * 32768.0_f64.powi(2), "{noise:e}");
}
