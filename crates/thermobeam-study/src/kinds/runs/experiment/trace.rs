//! What the free end does: recorded step by step, by any method.

use crate::kinds::prelude::*;
use crate::run::{AnyMotion, Loaded, Sample};
use convergence_judge::text::number::min_or_nan;
use thermobeam::parameters::Obstacles;
use thermobeam_exact::equilibrium::Phase;

/// Intervals of a curve in a figure: more than the figure has columns.
pub(super) const POINTS: usize = 4000;

/// Intervals at whose ends a run of fixed steps is observed; passings are interpolated between
/// them.
pub(super) const LEVELS: usize = 5 * POINTS;

/// After t_end only slow, smooth motion is left: this many times fewer points.
const FEWER: f64 = 10.0;

/// The motion of a beam within the figures' span, and its energy until the end of the run.
#[derive(Debug, Clone, PartialEq)]
pub struct Trace {
    /// When u(1) first passes the upper obstacle.
    pub first_upper: Option<f64>,
    /// When u(1) first passes the lower obstacle.
    pub first_lower: Option<f64>,
    /// Upward crossings of zero by u(1).
    pub crossings: usize,
    /// Frequency of u(1); `None` with fewer than two crossings.
    pub frequency: Option<f64>,
    /// Largest minus smallest φ(1).
    pub phi_amplitude: f64,
    /// Largest change of the energy in a step: negative if the energy falls in every step.
    pub largest_increase: f64,
    /// Largest residual of the energy's balance in a step.
    pub largest_residual: f64,
    /// Free end and energy over time, at 4000 equal steps of the figures' span, and beyond.
    pub points: Vec<Sample>,
}

/// What is observed of a run.
#[derive(Debug, Clone, Copy)]
pub(super) struct Observed {
    /// End of the figures' span.
    pub(super) t_end: f64,
    /// Latest end of the run.
    pub(super) t_max: f64,
    /// Intervals of the span at whose ends the free end is observed: a multiple of [`POINTS`].
    pub(super) levels: usize,
}

/// A free end at one time.
#[derive(Debug, Clone, Copy)]
struct FreeEnd {
    t: f64,
    u: f64,
    phi: f64,
}

/// What has been recorded of a run so far.
pub(super) struct Recorder {
    observed: Observed,
    /// The free end at the start and at the end of each interval of the span.
    levels: Vec<FreeEnd>,
    largest_increase: f64,
    largest_residual: f64,
    points: Vec<Sample>,
}

impl Recorder {
    /// The motion stands at t = 0.
    pub(super) fn new(observed: Observed, motion: &mut AnyMotion) -> Self {
        let mut recorder = Self {
            observed,
            levels: vec![],
            largest_increase: f64::NEG_INFINITY,
            largest_residual: 0.0,
            points: vec![],
        };
        recorder.push(motion.sample());
        recorder
    }

    /// Adds the last step; returns the change of the energy in it.
    ///
    /// # Errors
    /// [`Loaded`]: a beam with loads has no balance of its energy.
    pub(super) fn add(&mut self, motion: &mut AnyMotion) -> Result<f64, Loaded> {
        let Observed {
            t_end,
            t_max,
            levels,
        } = self.observed;
        let balance = motion.balance()?;
        self.largest_increase = max_or_nan(self.largest_increase, balance.change);
        self.largest_residual = max_or_nan(self.largest_residual, balance.residual.abs());
        let times = motion.snapshot().parts(t_end, levels);
        for t in times {
            self.push(motion.inside(t));
        }
        if t_max > t_end && motion.work().t > t_end {
            let later = (t_max / t_end * POINTS as f64 / FEWER).round() as usize;
            let times = motion.snapshot().parts(t_max, later);
            for t in times.into_iter().filter(|&t| t > t_end) {
                self.points.push(motion.inside(t));
            }
        }
        Ok(balance.change)
    }

    fn push(&mut self, sample: Sample) {
        let stride = (self.observed.levels / POINTS).max(1);
        if self.levels.len().is_multiple_of(stride) {
            self.points.push(sample);
        }
        self.levels.push(FreeEnd {
            t: sample.t,
            u: sample.u_tip,
            phi: sample.phi_tip,
        });
    }

    /// When u(1) passes a value between two levels that `passes` accepts, interpolated.
    fn passings(&self, at: f64, passes: impl Fn(f64, f64) -> bool) -> Vec<f64> {
        let pairs = self.levels.windows(2).map(|pair| (pair[0], pair[1]));
        pairs
            .filter(|(before, now)| passes(before.u, now.u))
            .map(|(before, now)| now.t - (now.t - before.t) * (now.u - at) / (now.u - before.u))
            .collect()
    }

    /// When the free end first touches an obstacle in the span: located by the method, or
    /// interpolated.
    fn first_contact(&self, motion: &AnyMotion, phase: Phase, obstacles: Obstacles) -> Option<f64> {
        if let Some((_, events)) = motion.snapshot().contact() {
            let touch = events
                .iter()
                .find(|event| event.to == phase && event.t <= self.observed.t_end);
            return touch.map(|event| event.t);
        }
        let Obstacles { g1, g2, .. } = obstacles;
        let passings = match phase {
            Phase::Upper => self.passings(g2, |before, now| before <= g2 && now > g2),
            _ => self.passings(g1, |before, now| before >= g1 && now < g1),
        };
        passings.first().copied()
    }

    /// The motion so far.
    pub(super) fn finish(self, motion: &AnyMotion, obstacles: Option<Obstacles>) -> Trace {
        let (first_upper, first_lower) = match obstacles {
            Some(obstacles) => (
                self.first_contact(motion, Phase::Upper, obstacles),
                self.first_contact(motion, Phase::Lower, obstacles),
            ),
            None => (None, None),
        };
        let crossings = self.passings(0.0, |before, now| before < 0.0 && now >= 0.0);
        let count = crossings.len();
        let frequency =
            (count >= 2).then(|| (count as f64 - 1.0) / (crossings[count - 1] - crossings[0]));
        let mut largest = f64::NEG_INFINITY;
        let mut smallest = f64::INFINITY;
        // The start is not a step.
        for level in self.levels.iter().skip(1) {
            largest = max_or_nan(largest, level.phi);
            smallest = min_or_nan(smallest, level.phi);
        }
        Trace {
            first_upper,
            first_lower,
            crossings: count,
            frequency,
            phi_amplitude: largest - smallest,
            largest_increase: self.largest_increase,
            largest_residual: self.largest_residual,
            points: self.points,
        }
    }
}
