//! What the free end does: recorded step by step, by any method.

use std::ops::ControlFlow;

use crate::run::{AnyMotion, Loaded, RunError, Sample, Watch};
use crate::scene::{Method, Scene};
use crate::studies::paper::OBSTACLES;
use convergence_judge::text::number::{max_or_nan, min_or_nan};
use thermobeam::{
    dg::{ContactEvent, Dg},
    motion::StepReport,
};
use thermobeam_exact::equilibrium::Phase;

/// Intervals of a curve in a figure: more than the figure has columns.
const POINTS: usize = 4000;

/// Intervals at whose ends a run of fixed steps is observed; passings are interpolated between
/// them.
const LEVELS: usize = 5 * POINTS;

/// After t_end only slow, smooth motion is left: this many times fewer points.
const FEWER: f64 = 10.0;

/// The motion of a beam until t_end, and its energy until the end of the run.
#[derive(Debug, Clone, PartialEq)]
pub struct Trace {
    /// When u(1) first passes the upper obstacle.
    pub first_upper: Option<f64>,
    /// When u(1) first passes the lower obstacle.
    pub first_lower: Option<f64>,
    /// Frequency of u(1); `None` with fewer than two upward crossings of zero.
    pub frequency: Option<f64>,
    /// Largest minus smallest φ(1).
    pub phi_amplitude: f64,
    /// Largest change of the energy in a step: negative if the energy falls in every step.
    pub largest_increase: f64,
    /// Largest residual of the energy's balance in a step.
    pub largest_residual: f64,
    /// Free end and energy over time, at 4000 equal steps until t_end, and beyond.
    pub points: Vec<Sample>,
    /// Contact events; none by a one-step scheme, which does not locate them.
    pub events: Vec<ContactEvent>,
    /// Steps done.
    pub steps: usize,
}

impl Trace {
    /// The state at a time at which a point is; `None` if the run ended before.
    pub(super) fn at(&self, t: f64) -> Option<&Sample> {
        let mut points = self.points.iter();
        points.find(|point| (point.t - t).abs() <= SAME_TIME * t)
    }
}

/// Relative difference of two times that are the same up to round-off.
pub(super) const SAME_TIME: f64 = 1e-9;

/// What has been recorded of a run so far.
pub(super) struct Recorder {
    /// The span of the figures.
    t_end: f64,
    /// Latest end of the run.
    t_max: f64,
    /// Intervals until t_end at whose ends the free end is observed: a multiple of [`POINTS`].
    intervals: usize,
    /// The start and the end of each interval.
    levels: Vec<Sample>,
    /// Points beyond t_end.
    later: Vec<Sample>,
    largest_increase: f64,
    largest_residual: f64,
    /// Change of the energy since it was last read: summed from differences, since the round-off of
    /// the total would hide a slow fall.
    change: f64,
}

impl Recorder {
    /// The motion of a scene stands at t = 0.
    ///
    /// * `t_end`: the span of the figures.
    pub(super) fn new(motion: &mut AnyMotion, scene: &Scene, t_end: f64) -> Self {
        Self {
            t_end,
            t_max: scene.t_end,
            intervals: match scene.method {
                Method::OneStep(_) => scene.steps().min(LEVELS),
                Method::Dg(_) => POINTS,
            },
            levels: vec![motion.sample()],
            later: vec![],
            largest_increase: f64::NEG_INFINITY,
            largest_residual: 0.0,
            change: 0.0,
        }
    }

    /// The change of the energy since this was last asked.
    pub(super) fn change(&mut self) -> f64 {
        std::mem::take(&mut self.change)
    }

    /// Adds the last step.
    ///
    /// # Errors
    /// [`Loaded`]: a beam with loads has no balance of its energy.
    pub(super) fn add(&mut self, motion: &mut AnyMotion) -> Result<(), Loaded> {
        let balance = motion.balance()?;
        self.change += balance.change;
        self.largest_increase = max_or_nan(self.largest_increase, balance.change);
        self.largest_residual = max_or_nan(self.largest_residual, balance.residual.abs());
        let times = motion.parts(self.t_end, self.intervals);
        let samples = times.into_iter().map(|t| motion.inside(t));
        self.levels.extend(samples);
        if self.t_max > self.t_end && motion.motion().t() > self.t_end {
            let count = (self.t_max / self.t_end * POINTS as f64 / FEWER).round() as usize;
            let times = motion.parts(self.t_max, count).into_iter();
            let t_end = self.t_end;
            let times = times.filter(|&t| t > t_end);
            self.later.extend(times.map(|t| motion.inside(t)));
        }
        Ok(())
    }

    /// When u(1) passes a value between two levels that `passes` accepts, interpolated.
    fn passings(&self, at: f64, passes: impl Fn(f64, f64) -> bool) -> Vec<f64> {
        let pairs = self.levels.windows(2).map(|pair| (pair[0], pair[1]));
        pairs
            .filter(|(before, now)| passes(before.u_tip, now.u_tip))
            .map(|(before, now)| {
                now.t - (now.t - before.t) * (now.u_tip - at) / (now.u_tip - before.u_tip)
            })
            .collect()
    }

    /// When the free end first touches an obstacle until t_end: located by the method, or
    /// interpolated.
    fn first_contact(&self, events: Option<&[ContactEvent]>, phase: Phase) -> Option<f64> {
        if let Some(events) = events {
            let mut events = events.iter();
            let touch = events.find(|event| event.to == phase && event.t <= self.t_end);
            return touch.map(|event| event.t);
        }
        let [g1, g2] = [OBSTACLES.g1, OBSTACLES.g2];
        let passings = match phase {
            Phase::Upper => self.passings(g2, |before, now| before <= g2 && now > g2),
            _ => self.passings(g1, |before, now| before >= g1 && now < g1),
        };
        passings.first().copied()
    }

    /// The motion so far.
    pub(super) fn finish(self, motion: &AnyMotion) -> Trace {
        let events = motion.dg().map(Dg::events);
        let crossings = self.passings(0.0, |before, now| before < 0.0 && now >= 0.0);
        let count = crossings.len();
        let frequency =
            (count >= 2).then(|| (count as f64 - 1.0) / (crossings[count - 1] - crossings[0]));
        // The start is not a step.
        let phi = self.levels.iter().skip(1).map(|level| level.phi_tip);
        let largest = phi.clone().fold(f64::NEG_INFINITY, max_or_nan);
        let smallest = phi.fold(f64::INFINITY, min_or_nan);
        let points = self.levels.iter().step_by(self.intervals / POINTS);
        Trace {
            first_upper: self.first_contact(events, Phase::Upper),
            first_lower: self.first_contact(events, Phase::Lower),
            frequency,
            phi_amplitude: largest - smallest,
            largest_increase: self.largest_increase,
            largest_residual: self.largest_residual,
            points: points.chain(&self.later).copied().collect(),
            events: events.unwrap_or_default().to_vec(),
            steps: motion.motion().steps(),
        }
    }
}

impl Watch for Recorder {
    fn see(&mut self, motion: &mut AnyMotion, _: &StepReport) -> Result<ControlFlow<()>, RunError> {
        self.add(motion)?;
        Ok(ControlFlow::Continue(()))
    }
}
