//! What the paper prints of its experiments, (5.1)-(5.5), and numbers of their motion: a scene with
//! another beam, or a beam that moves otherwise, fails.

use std::f64::consts::PI;

use super::{
    Experiment, Experiments, SectionGroup,
    group::{OfExperiment, OfGroup},
};
use crate::kinds::prelude::*;
use crate::{
    kinds::{
        runs::checks::{Condition, all},
        settings::ItemMethod,
    },
    scene::Coefficients,
};
use thermobeam::parameters::{Beam, Obstacles};

/// (5.1), without β and θ_A, which differ between the experiments.
const BEAM: Beam = Beam {
    zeta: 0.1,
    a: 0.017,
    rho: 1.0,
    beta: 0.0,
    theta_a: 0.0,
};

/// The obstacles of (5.1).
const OBSTACLES: Obstacles = Obstacles {
    epsilon: 1e-3,
    g1: -0.01,
    g2: 0.1,
};

/// The values of β in the first two groups, and that of the third.
const BETAS: [f64; 3] = [-0.5, 0.0, 5.0];
const BUCKLED: f64 = -0.8;

/// End of the figures.
const T_END: f64 = 10.0;

/// Places at which initial data are compared, and round-off of an expression with values up to 20.
const SAMPLES: usize = 64;
const ROUND_OFF: f64 = 1e-13;

/// Numbers of the first experiment, which the paper shows in figures without printing them. dG gave
/// them; the paper's own algorithm at h = 1e-2, dt = 1e-4 is within 5e-4 of each.
struct Motion {
    beta: f64,
    first_upper: f64,
    first_lower: f64,
    frequency: f64,
    phi_amplitude: f64,
}

const MOTIONS: [Motion; 3] = [
    Motion {
        beta: -0.5,
        first_upper: 0.217_341,
        first_lower: 0.911_357,
        frequency: 0.341_148,
        phi_amplitude: 0.336_345,
    },
    Motion {
        beta: 0.0,
        first_upper: 0.203_413,
        first_lower: 0.858_234,
        frequency: 0.413_616,
        phi_amplitude: 0.237_139,
    },
    Motion {
        beta: 5.0,
        first_upper: 0.144_932,
        first_lower: 0.498_252,
        frequency: 0.821_006,
        phi_amplitude: 0.091_158,
    },
];

/// Distance to these numbers within which both discretisations lie. They differ by up to 3.4e-5, in
/// the frequency for β = 5.
const AGREED: f64 = 1e-4;

/// The scenes are the paper's experiments.
pub(super) fn data(study: &Experiments) -> Check {
    let mut wrong = vec![];
    let mut places = [0; 2];
    for experiment in &study.experiments {
        let beta = match experiment.group {
            SectionGroup::First => next(&mut places[0]),
            SectionGroup::Second(_) => next(&mut places[1]),
            SectionGroup::Third => BUCKLED,
        };
        let names = differing(experiment, beta);
        if !names.is_empty() {
            wrong.push(format!("{}: {}", experiment.scene.name, names.join(", ")));
        }
    }
    let is_complete = places == [BETAS.len(); 2];
    let evidence = if wrong.is_empty() {
        format!(
            "{} scenes, coefficient by coefficient",
            study.experiments.len()
        )
    } else {
        format!("not those of the paper: {}", wrong.join("; "))
    };
    all(
        "the scenes hold the data of (5.1) and (5.3)-(5.5)",
        Subject::of("data of the scenes"),
        [
            Condition::that(wrong.is_empty(), evidence),
            Condition::or(
                is_complete,
                "not three experiments in each of the first two groups",
            ),
        ],
    )
}

/// The next β of a group; NaN, which no scene has, after the last.
fn next(place: &mut usize) -> f64 {
    let beta = BETAS.get(*place).copied().unwrap_or(f64::NAN);
    *place += 1;
    beta
}

/// What of a scene is not that of the paper's experiment.
fn differing(Experiment { group, scene }: &Experiment, beta: f64) -> Vec<String> {
    let is_heated = matches!(group, SectionGroup::Second(_));
    let theory = Coefficients {
        beam: Beam {
            beta,
            theta_a: if is_heated { 20.0 } else { 0.0 },
            ..BEAM
        },
        obstacles: Some(OBSTACLES),
    };
    let own = Coefficients {
        beam: scene.beam,
        obstacles: scene.obstacles,
    };
    let mut names: Vec<String> = own.differing(theory).map(|name| name.to_string()).collect();
    let theta_0 = |x: f64| {
        if is_heated {
            20.0 * (2.5 * PI * x).cos()
        } else {
            (PI * x).sin()
        }
    };
    let initial = &scene.initial;
    for (name, found, printed) in [
        (
            "u_0",
            &initial.u,
            &(|x| 0.01 * x * (x - 2.0)) as &dyn Fn(f64) -> f64,
        ),
        ("u_1", &initial.u_t, &|x| 20.0 * x * (x - 1.0).powi(2)),
        ("φ_0", &initial.phi, &|_| 0.0),
        ("φ_1", &initial.phi_t, &|_| 0.0),
        ("θ_0", &initial.theta, &theta_0),
    ] {
        let value = |x: f64| found.as_ref().map_or(0.0, |function| function.eval(x));
        let mut places = (0..=SAMPLES).map(|k| k as f64 / SAMPLES as f64);
        if !places.all(|x| (value(x) - printed(x)).abs() <= ROUND_OFF) {
            names.push(name.to_owned());
        }
    }
    if scene.t_end != T_END {
        names.push("the end of the figures".to_owned());
    }
    names
}

/// First contacts, frequency and amplitude of the first experiment are numbers.
pub(super) fn motion(group: &OfGroup<'_>) -> Check {
    let evidence = group.list(|runs| {
        let [first, second] = distances(runs);
        format!("{first:.1e} and {second:.1e} from the numbers")
    });
    let largest = group.largest(|runs| {
        let [first, second] = distances(runs);
        max_or_nan(first, second)
    });
    all(
        format!(
            "first contacts, frequency and amplitude are those known, within {AGREED:e}, by both discretisations"
        ),
        Subject::of("motion").by(ItemMethod::AnyOrder),
        [Condition::that(largest <= AGREED, evidence)],
    )
}

/// The largest distance of either discretisation to the numbers of the experiment; NaN if there are
/// none, or a number is missing.
fn distances(runs: &OfExperiment<'_>) -> [f64; 2] {
    let beta = runs.beam().beta;
    let Some(known) = MOTIONS.iter().find(|motion| motion.beta == beta) else {
        return [f64::NAN; 2];
    };
    [runs.first, runs.second].map(|run| {
        let trace = &run.trace;
        let pairs = [
            (trace.first_upper, known.first_upper),
            (trace.first_lower, known.first_lower),
            (trace.frequency, known.frequency),
            (Some(trace.phi_amplitude), known.phi_amplitude),
        ];
        pairs.into_iter().fold(0.0, |largest, (found, known)| {
            max_or_nan(largest, (found.unwrap_or(f64::NAN) - known).abs())
        })
    })
}
