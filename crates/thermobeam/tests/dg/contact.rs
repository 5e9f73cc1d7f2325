//! All forms of contact: immediate, with an obstacle at zero, between two coincident obstacles, and
//! grazing.

use super::opened;
use crate::prelude::*;
use std::f64::consts::FRAC_PI_2;

/// A straight, cold beam whose free end moves with the given velocity.
fn thrown(velocity: f64, obstacles: Obstacles, degree: usize) -> DgProblem {
    let initial = InitialFunctions {
        u_t: Box::new(move |x| velocity * (FRAC_PI_2 * x).sin()),
        ..InitialFunctions::at_rest(0.0)
    };
    let mesh = Mesh::from_nodes(vec![0.0, 0.6, 0.9, 1.0]).unwrap();
    DgProblem {
        beam: Beam::default(),
        obstacles: Some(obstacles),
        mesh,
        degree,
        initial,
    }
}

/// The same by `midpoint` on a fine graded P1 mesh: u(1, t).
fn by_linear_elements(thrown: &DgProblem, t: f64) -> f64 {
    let mesh = Mesh::mapped(200, |s| 1.0 - (1.0 - s).powi(3)).unwrap();
    let stepping = with(MIDPOINT, Settings::default(), t / 4000.0);
    after(&on_mesh(thrown, mesh), stepping, 4000).u[200]
}

/// Runs to the end; the worst residual of the balance, relative to the initial energy, must be
/// round-off.
#[track_caller]
fn balanced(mut simulation: Dg, t: f64) -> Dg {
    let scale = simulation.energy(simulation.level()).total();
    let open = opened(&mut simulation, t);
    let allowed = 1e-13 * scale;
    assert!(
        open.worst <= allowed && open.contact <= allowed,
        "{open:?} of {scale}"
    );
    simulation
}

fn phases(events: &[ContactEvent]) -> Vec<Phase> {
    events.iter().map(|event| event.to).collect()
}

fn stepping() -> DgStepping {
    DgStepping {
        dt: 0.01,
        restart_dt: 2e-4,
        ..of_degree(2)
    }
}

/// The first experiment between other obstacles, on one element.
fn between(obstacles: Obstacles, degree: usize) -> DgProblem {
    DgProblem {
        obstacles: Some(obstacles),
        ..experiment((0.0, 0.0), degree)
    }
}

#[test]
fn an_obstacle_at_zero_is_touched_from_the_first_moment() {
    let Obstacles { epsilon, g1, g2 } = Obstacles::default();
    for (g1, g2, velocity, phase) in [(g1, 0.0, 1.0, Phase::Upper), (0.0, g2, -1.0, Phase::Lower)] {
        let thrown = || thrown(velocity, Obstacles { epsilon, g1, g2 }, 10);
        let simulation = balanced(of_any_order(thrown(), stepping()), 0.01);
        assert_eq!(phases(simulation.events()), [phase]);
        assert_eq!(simulation.events()[0].t, 0.0);
        let expected = by_linear_elements(&thrown(), 0.01);
        close(tip(&simulation, Field::U), expected, 2e-3 * expected.abs());
        assert!(expected.abs() > 1e-3);
    }
}

/// Obstacles of compliance 1e-2 at -gap and gap.
fn narrow(gap: f64) -> Obstacles {
    Obstacles {
        epsilon: 1e-2,
        g1: -gap,
        g2: gap,
    }
}

#[test]
fn two_obstacles_at_one_place_are_touched_in_turn() {
    let thrown = |velocity: f64| thrown(velocity, narrow(0.0), 10);
    let simulation = balanced(of_any_order(thrown(1.0), stepping()), 3.0);
    let events = simulation.events();
    assert!(events.len() >= 3, "{events:?}");
    assert!(events.iter().all(|event| event.from != Phase::Free
        && event.to != Phase::Free
        && event.from != event.to));
    let early = advanced(thrown(1.0), stepping(), 0.2);
    let expected = by_linear_elements(&thrown(1.0), 0.2);
    close(tip(&early, Field::U), expected, 2e-4);
    // With g_1 = g_2 = 0 the obstacle is a two-sided spring: started from the other side, the
    // motion is mirrored.
    let mirrored = advanced(thrown(-1.0), stepping(), 3.0);
    close(tip(&mirrored, Field::U), -tip(&simulation, Field::U), 1e-10);
}

#[test]
fn a_free_end_that_starts_beyond_an_obstacle_presses_on_it() {
    for (sign, phase) in [(1.0, Phase::Upper), (-1.0, Phase::Lower)] {
        let initial = InitialFunctions {
            u: Box::new(move |x| sign * 0.15 * x * x),
            ..InitialFunctions::at_rest(0.0)
        };
        let problem = DgProblem {
            initial,
            ..experiment((0.0, 0.0), 12)
        };
        let simulation = of_any_order(problem, stepping());
        assert_eq!(simulation.phase(), phase);
        assert!(simulation.energy(simulation.level()).contact > 1.0);
        let simulation = balanced(simulation, 0.5);
        assert_eq!(simulation.events()[0].from, phase);
        assert_eq!(simulation.events()[0].to, Phase::Free);
    }
}

#[test]
fn narrow_gaps_are_crossed() {
    for gap in [1e-3, 1e-6, 1e-9, 1e-12, 1e-15] {
        let simulation = of_any_order(thrown(1.0, narrow(gap), 8), stepping());
        let simulation = balanced(simulation, 1.0);
        let events = simulation.events();
        assert!(events.len() >= 3, "gap {gap}: {events:?}");
    }
}

/// The least and the largest u(1, t) of the last step, at a thousand points.
fn sampled(simulation: &Dg) -> [f64; 2] {
    let (start, end) = (simulation.old_level().t, simulation.t());
    let at = |k: i32| start + (end - start) * f64::from(k) / 1000.0;
    let values = (0..=1000).map(|k| simulation.value(Field::U, 1.0, at(k)).unwrap());
    values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], u| {
        [low.min(u), high.max(u)]
    })
}

#[test]
fn a_free_end_may_graze_an_obstacle() {
    let stepping = DgStepping::default();
    let without = DgProblem {
        obstacles: None,
        ..experiment((0.0, 0.0), 8)
    };
    let mut simulation = of_any_order(without, stepping);
    // The first maximum of u(1, t) without obstacles, to round-off.
    let mut top = f64::NEG_INFINITY;
    while simulation.step(1.0).unwrap().is_some() {
        top = top.max(sampled(&simulation)[1]);
    }
    let mut touched = 0;
    for exponent in 3..=17 {
        for sign in [-1.0, 0.0, 1.0] {
            let obstacles = Obstacles {
                g1: -1.0,
                g2: top + sign * 10.0_f64.powi(-exponent),
                ..Obstacles::default()
            };
            let simulation = balanced(of_any_order(between(obstacles, 8), stepping), 1.2);
            let found = phases(simulation.events());
            assert!(
                found
                    .chunks(2)
                    .all(|pair| pair == [Phase::Upper, Phase::Free]),
                "{exponent} {sign}: {found:?}"
            );
            touched += usize::from(!found.is_empty());
            let (steps, work) = (simulation.steps(), simulation.work());
            assert!(
                steps < 150 && work.passes < 400,
                "{exponent} {sign}: {steps} steps, {work:?}"
            );
        }
    }
    assert!(touched >= 5, "{touched} of them touch");
}

#[test]
fn the_range_of_the_tip_has_its_extrema_inside_steps() {
    let mut simulation = of_any_order(experiment((0.0, 0.0), 8), of_degree(4));
    let start = tip(&simulation, Field::U);
    let TipRange { low, high } = simulation.tip_range();
    assert_eq!([low, high], [start, start]);
    let mut inside = 0;
    while simulation.step(1.0).unwrap().is_some() {
        let TipRange { low, high } = simulation.tip_range();
        let [least, most] = sampled(&simulation);
        // A thousand points miss an extremum by some millionths of the change over the step.
        let slack = 1e-5 * (most - least) + 1e-15;
        assert!(
            low <= least + 1e-15 && low >= least - slack,
            "{low} {least}"
        );
        assert!(
            high >= most - 1e-15 && high <= most + slack,
            "{high} {most}"
        );
        let ends = [simulation.old_level().t, simulation.t()]
            .map(|t| simulation.value(Field::U, 1.0, t).unwrap());
        inside += usize::from(high > ends[0].max(ends[1]) + slack);
    }
    assert!(inside > 0, "no extremum inside a step");
}

#[test]
fn without_viscosity_an_impact_takes_the_compliance() {
    let impact_time = |zeta| soft(1e-3).impact_time(zeta);
    assert_eq!([0.0, 0.9e-3].map(impact_time), [1e-3, 1e-3]);
    close(
        impact_time(0.1),
        (1e-3 * 0.1_f64.sqrt()).powf(2.0 / 3.0),
        1e-17,
    );
}

#[test]
fn every_compliance_is_solved() {
    for epsilon in [1e-8, 1e-6, 1e-4, 1e-2, 1.0] {
        let stepping = DgStepping {
            restart_dt: (0.2 * soft(epsilon).impact_time(0.1)).min(5e-3),
            ..DgStepping::default()
        };
        let simulation = advanced(between(soft(epsilon), 8), stepping, 0.7);
        let events = simulation.events().len();
        let (steps, shortened) = (simulation.steps(), simulation.shortened());
        assert!(
            events > 0 && steps < 10_000 && shortened == 0,
            "epsilon {epsilon}: {events} events, {steps} steps, {shortened} shortened"
        );
    }
}

#[test]
fn an_event_ends_its_step_on_the_obstacle_exactly() {
    let mut simulation = of_any_order(experiment((5.0, 0.0), 10), DgStepping::default());
    let mut events = 0;
    while let Some(report) = simulation.step(3.0).unwrap() {
        if let Some(event) = report.event {
            let expected = if [event.from, event.to].contains(&Phase::Upper) {
                0.1
            } else {
                -0.01
            };
            assert_eq!(tip(&simulation, Field::U), expected);
            let end = simulation.value(Field::U, 1.0, simulation.t()).unwrap();
            close(end, expected, 1e-16);
            assert_eq!((event.t, event.to), (simulation.t(), simulation.phase()));
            events += 1;
        }
        let [start, end] = [simulation.old_level().t, simulation.t()];
        assert!(end > start);
    }
    assert_eq!(events, simulation.events().len());
    assert!(events > 8);
}

#[test]
fn a_free_end_that_leaves_the_obstacle_on_which_it_rests_does_not_touch_it() {
    // u_0(1) = -0.01 and u_1(1) = 0 in (5.3). The first polynomials overshoot and dip below that.
    for (degree, q) in [(9, 1), (9, 2), (10, 3), (14, 1)] {
        for zeta in [0.0, 1e-3, 0.1] {
            for distance in [0.0, 1e-14, 1e-12, 1e-11, 1e-10, 1e-9, 1e-8] {
                let mut problem = experiment((-0.5, 20.0), degree);
                problem.beam.zeta = zeta;
                problem.obstacles = Some(Obstacles {
                    g1: -0.01 - distance,
                    ..Obstacles::default()
                });
                let simulation = balanced(of_any_order(problem, of_degree(q)), 0.05);
                assert_eq!(
                    simulation.events(),
                    [],
                    "p = {degree}, q = {q}, zeta = {zeta}, distance {distance}"
                );
                assert!(tip(&simulation, Field::U) > -0.01);
                let steps = simulation.steps();
                let work = simulation.work();
                assert!(steps < 16 && work.passes < 60, "{steps} steps, {work:?}");
            }
        }
    }
}

/// The time scale of an impact's peak falls like ε^(2/3), from 4.6e-3 to 2.2e-4 here; the contact
/// ends when the beam swings back.
#[test]
fn the_first_contact_lasts_as_long_whatever_the_compliance() {
    for epsilon in [1e-3, 1e-4, 1e-5] {
        let fine = DgStepping {
            dt: 0.01,
            restart_dt: 1e-5,
            ..DgStepping::default()
        };
        let simulation = advanced(between(soft(epsilon), 20), fine, 0.7);
        let [touch, release] = [simulation.events()[0], simulation.events()[1]];
        assert_eq!([touch.to, release.to], [Phase::Upper, Phase::Free]);
        close(release.t - touch.t, 0.44, 0.01);
    }
}
