//! The numbers that a run of a scene shows, by the names of `run --format json`.

use std::ops::ControlFlow;

use convergence_study::NamedNumber;

use crate::kinds::prelude::*;
use crate::{
    kinds::runs::{cases::End, watch::SOLVED},
    run::{
        RunError,
        driver::Driver,
        run, run_to,
        simulate::{self, Run},
        tally::Extremes,
    },
    scene::Scene,
};
use thermobeam::{
    motion::StepReport,
    one_step::{InitialValues, Stepping},
    solve::{Settings, Stopping},
};

use super::norm::OwnNorm;

/// Keys of an answer whose values are lists of pairs.
pub(super) const PAIRS: [&str; 3] = ["history", "contact", "steady"];
pub(super) const STEADY: &str = "steady states";

/// The numbers that a list of pairs stands for.
pub(super) fn listed(key: &str, pairs: impl IntoIterator<Item = [f64; 2]>) -> Vec<NamedNumber> {
    let [what, first, second] = match key {
        "contact" => ["contacts", "begin of contact", "end of contact"],
        "steady" => [
            STEADY,
            "u(1) of steady state",
            "unstable directions of steady state",
        ],
        _ => {
            let history = pairs.into_iter();
            return history
                .map(|[t, u]| NamedNumber::new(format!("u(1, {t})"), u))
                .collect();
        }
    };
    let mut numbers = vec![];
    for ([one, other], k) in pairs.into_iter().zip(1..) {
        numbers.push(NamedNumber::new(format!("{first} {k}"), one));
        numbers.push(NamedNumber::new(format!("{second} {k}"), other));
    }
    let count = (numbers.len() / 2) as f64;
    numbers.insert(0, NamedNumber::new(what, count));
    numbers
}

/// What a run shows.
#[derive(Debug, Clone, PartialEq)]
pub struct Shown {
    /// How it ended.
    pub end: End,
    /// The last level, the free end's range and the energy's largest change, in the order of
    /// [`NUMBERS`].
    pub numbers: [f64; NUMBERS.len()],
    /// Counts, in the order of [`COUNTS`].
    pub counts: [usize; COUNTS.len()],
    /// Whether the scene has the same bits in lanes, by itself and in each group that it can share;
    /// `None` where it can only run alone.
    pub alike_in_lanes: Option<bool>,
    /// Steps whose contact is counted wrongly; `None` for the scheme of any order.
    pub miscounted: Option<usize>,
    /// `(t, u(1, t))`.
    pub tip: Vec<(f64, f64)>,
    /// Beginning and end of each contact.
    pub contact: Vec<(f64, f64)>,
    /// Predictions and steady states, where the answer has them.
    pub(super) others: Vec<NamedNumber>,
    /// Distance of the least solved step to its solution over the tolerance, where the case bounds
    /// it.
    pub unsolved: Option<f64>,
}

/// Names of numbers, as in the object of `run --format json`.
pub const NUMBERS: [&str; 9] = [
    "u_tip",
    "phi_tip",
    "u_t_tip",
    "phi_t_tip",
    "theta_mid",
    "energy",
    "u_tip_min",
    "u_tip_max",
    "largest_increase",
];

/// Names of counts; `contact` counts steps in contact, or the contact events of the scheme of any
/// order.
pub const COUNTS: [&str; 6] = [
    "steps",
    "iterations",
    "most iterations",
    "passes",
    "factorizations",
    "contact",
];

impl Shown {
    /// All numbers by their names.
    pub(super) fn named(&self) -> Vec<NamedNumber> {
        let mut named: Vec<NamedNumber> = NUMBERS
            .into_iter()
            .zip(self.numbers)
            .map(|(name, value)| NamedNumber::new(name, value))
            .collect();
        for (key, list) in PAIRS.iter().zip([&self.tip, &self.contact]) {
            named.extend(listed(key, list.iter().map(|&(one, other)| [one, other])));
        }
        named.extend(self.others.clone());
        named
    }

    /// Whether anything moves or cools: otherwise any scheme keeps the start.
    pub(super) fn moves(&self) -> bool {
        let [_, _, u_t_tip, phi_t_tip, _, _, low, high, rise] = self.numbers;
        low != high
            || [u_t_tip, phi_t_tip, rise]
                .iter()
                .any(|number| *number != 0.0)
    }

    /// Whether end, numbers and counts are the same, to the bit.
    pub(super) fn has_the_bits_of(&self, other: &Self) -> bool {
        self.end == other.end
            && self.numbers.map(f64::to_bits) == other.numbers.map(f64::to_bits)
            && self.counts == other.counts
    }

    pub(super) fn of(run: &Run) -> Result<Self, RunError> {
        let Run {
            last,
            iterations,
            work,
            ..
        } = run;
        let [u_tip, phi_tip, u_t_tip, phi_t_tip, theta_mid, energy] = last.numbers();
        let Extremes {
            u_tip_min,
            u_tip_max,
        } = run.extremes;
        let rise = run.energy.largest_increase;
        let contact = run
            .contact
            .as_ref()
            .map_or(run.contact_steps, |contact| contact.events.len());
        Ok(Self {
            end: End::of(run.failure.as_ref())?,
            numbers: [
                u_tip, phi_tip, u_t_tip, phi_t_tip, theta_mid, energy, u_tip_min, u_tip_max, rise,
            ],
            counts: [
                run.steps,
                iterations.total,
                iterations.max,
                work.passes,
                work.factorizations,
                contact,
            ],
            alike_in_lanes: None,
            miscounted: None,
            tip: run.tip(),
            contact: run.contact_phases(),
            others: vec![],
            unsolved: None,
        })
    }
}

/// The largest distance of a step to the same step solved to round-off from the same level, in the
/// norm of (3.14), over the tolerance of the scene.
pub(super) fn unsolved(scene: &Scene) -> Result<f64, CaseFailure> {
    let stepping = scene.one_step()?;
    let tolerance = stepping.settings.stopping.tolerance();
    let tolerance = tolerance
        .ok_or_else(|| CaseFailure::new("a fixed number of iterations has no tolerance"))?;
    let solved = Settings {
        stopping: Stopping::below(SOLVED),
        ..stepping.settings
    };
    let solved = Stepping {
        settings: solved,
        ..stepping
    };
    let mut problem = simulate::problem(scene);
    let lifting: Vec<f64> = scene
        .mesh
        .nodes()
        .iter()
        .map(|x| scene.beam.theta_a * (1.0 - x))
        .collect();
    let norm = OwnNorm::new(&scene.mesh);
    let mut driver = Driver::new(problem.clone(), stepping)?;
    let mut farthest = 0.0;
    let mut solve_again = |driver: &mut Driver<'_>, _: &StepReport| {
        let old = driver.old_level();
        let theta = old
            .theta
            .iter()
            .zip(&lifting)
            .map(|(theta, lifting)| theta + lifting)
            .collect();
        let [u, u_t, phi, phi_t] = [&old.u, &old.v, &old.phi, &old.w].map(Clone::clone);
        problem.initial = InitialValues {
            u,
            u_t,
            phi,
            phi_t,
            theta,
        };
        let mut same = Driver::new(problem.clone(), solved)?;
        run_to(&mut same, solved.dt, |_, _| ())?;
        farthest = max_or_nan(farthest, norm.of_difference(driver.level(), same.level()));
        Ok(ControlFlow::Continue(()))
    };
    run(&mut driver, scene.t_end, &[], &mut [&mut solve_again])?;
    Ok(farthest / tolerance)
}
