//! [`Dg`], which holds one level and does steps of the right lengths.

use super::DgLevel;
use super::lengths::Lengths;
use super::problem::{DgProblem, DgStepping, check_problem, initial_level};
use super::residual::Equations;
use super::space::{Field, Space};
use super::stages::{Stages, stepper};
use super::time::Load;
use crate::contact::{ContactEvent, Phase};
use crate::error::{SetupError, StepError, StepFailure};
use crate::motion::{Motion, StepReport, TipRange, Work};
use crate::norms::max_or_nan;
use crate::parameters::{Beam, Obstacles};

/// Maximum number of cuts of one step: at a crossing, at an earlier one that the shorter step
/// shows, and so on.
const CUTS: usize = 64;

/// Initial capacity of the list of contact events.
const EVENTS: usize = 1024;

/// A beam at one level, in motion by dG, with the step that led there.
pub struct Dg {
    pub(super) beam: Beam,
    pub(super) obstacles: Option<Obstacles>,
    pub(super) space: Space,
    pub(super) stepping: DgStepping,
    pub(super) lengths: Lengths,
    pub(super) stages: Box<dyn Stages>,
    pub(super) load: Option<Box<Load>>,
    pub(super) level: DgLevel,
    /// The level before the last step.
    pub(super) old: DgLevel,
    /// The length of the last step, 0 at the start.
    pub(super) last_dt: f64,
    /// The phase of the free end during the last step.
    pub(super) last_phase: Phase,
    pub(super) phase: Phase,
    /// Whether the last step's polynomials predict those of the next one.
    pub(super) smooth: bool,
    pub(super) events: Vec<ContactEvent>,
    /// Steps done.
    pub(super) steps: usize,
    /// Steps repeated with a shorter length.
    pub(super) shortened: usize,
    pub(super) crowd: Crowd,
}

/// Contact events that follow each other within `restart_dt`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Crowd {
    /// The time of the first.
    pub(super) since: f64,
    /// How many there are.
    pub(super) events: usize,
}

/// What an attempt at a step changes before it can fail.
#[derive(Debug, Clone, Copy)]
struct BeforeAttempt {
    phase: Phase,
    /// The number of contact events.
    events: usize,
    crowd: Crowd,
}

impl Dg {
    /// Checks all data once and starts at t = 0.
    ///
    /// # Errors
    /// [`SetupError`] for coefficients, degrees or settings out of range, and for initial data that
    /// are not finite or violate a boundary condition.
    pub fn new(problem: DgProblem, stepping: DgStepping) -> Result<Self, SetupError> {
        Self::build(problem, stepping, |_| None)
    }

    /// The same with loads on the right-hand sides of the equations; `load` creates them for the
    /// elements.
    ///
    /// # Errors
    /// Those of [`Self::new`].
    pub fn with_load(
        problem: DgProblem,
        stepping: DgStepping,
        load: impl FnOnce(&Space) -> Box<Load>,
    ) -> Result<Self, SetupError> {
        Self::build(problem, stepping, |space| Some(load(space)))
    }

    fn build(
        problem: DgProblem,
        stepping: DgStepping,
        load: impl FnOnce(&Space) -> Option<Box<Load>>,
    ) -> Result<Self, SetupError> {
        let DgProblem {
            beam,
            obstacles,
            mesh,
            degree,
            initial,
        } = problem;
        check_problem(&beam, obstacles.as_ref(), &stepping)?;
        let space = Space::new(mesh, degree)?;
        let level = initial_level(&space, &beam, &initial)?;
        let lengths = Lengths::new(stepping.restart_dt, stepping.growth, stepping.dt);
        let load = load(&space);
        let stages = stepper(stepping.degree, &space, lengths.count(), load.is_some());
        let phase = Phase::of(level.places[space.tip()][0], obstacles.as_ref());
        let old = level.clone();
        Ok(Self {
            beam,
            obstacles,
            space,
            stepping,
            lengths,
            stages,
            load,
            level,
            old,
            last_dt: 0.0,
            last_phase: phase,
            phase,
            smooth: false,
            events: Vec::with_capacity(EVENTS),
            steps: 0,
            shortened: 0,
            crowd: Crowd::default(),
        })
    }

    fn try_step(&mut self, limit: f64) -> Result<Option<StepReport>, StepError> {
        if self.has_reached(limit) {
            return Ok(None);
        }
        let remaining = limit - self.level.t;
        let mut h = self.propose(remaining);
        if self.smooth {
            self.stages.guess_continued(h / self.last_dt);
        } else {
            self.stages.guess_constant(&self.level);
        }
        let mut event = None;
        let mut iterations = self.attempt(h)?;
        for _ in 0..CUTS {
            let Some((fall, next)) = self.first_fall(h) else {
                return self.finish(h, limit, iterations, event).map(Some);
            };
            if fall.crossing * h > self.shortest() {
                (h, iterations, event) = self.meet(h, fall, next)?;
                continue;
            }
            // The free end leaves its phase immediately.
            event = None;
            self.stages.guess_constant(&self.level);
            if let Some(iterations) = self.stays(next, h)? {
                self.change_phase(next, self.level.t)
                    .map_err(|failure| self.failed(h, failure))?;
                return self.finish(h, limit, iterations, None).map(Some);
            } else if self.lengths.descend() {
                // It leaves the other phase as well: polynomials of this length are too coarse to
                // decide.
                h = self.propose(remaining);
            } else {
                // It grazes the obstacle, by less than the shortest step can resolve.
                iterations = self.attempt(h)?;
                return self.finish(h, limit, iterations, None).map(Some);
            }
            self.stages.guess_constant(&self.level);
            iterations = self.attempt(h)?;
        }
        let miss = self
            .first_fall(h)
            .map_or(0.0, |(_, next)| self.distance(next, h).distance.at(1.0));
        Err(self.failed(h, StepFailure::EventNotFound { miss }))
    }

    /// Finds the polynomials of a step of length τ (`h`) in another phase; `None` if the free end
    /// leaves that phase too.
    fn stays(&mut self, phase: Phase, h: f64) -> Result<Option<usize>, StepError> {
        let present = std::mem::replace(&mut self.phase, phase);
        let outcome = self.attempt(h);
        let fall = self.first_fall(h);
        self.phase = present;
        outcome.map(|iterations| fall.is_none().then_some(iterations))
    }

    /// Accepts the step just found: its end is the new level.
    fn finish(
        &mut self,
        h: f64,
        limit: f64,
        iterations: usize,
        next: Option<Phase>,
    ) -> Result<StepReport, StepError> {
        self.check_contact(h)
            .map_err(|failure| self.failed(h, failure))?;
        let start = self.level.t;
        let t = if h == limit - start { limit } else { start + h };
        let (phase, rung) = (self.phase, self.lengths.get());
        if let Some(next) = next {
            self.change_phase(next, t)
                .map_err(|failure| self.failed(h, failure))?;
        }
        self.stages.accept(&self.level);
        std::mem::swap(&mut self.level, &mut self.old);
        self.stages.level_into(1.0, &self.old, h, &mut self.level);
        self.level.t = t;
        if let Some(next) = next {
            // The free end is on the obstacle up to round-off; now the round-off is removed.
            let touched = if phase == Phase::Free { next } else { phase };
            if let Some(g) = touched.obstacle(self.obstacles.as_ref()) {
                self.level.places[self.space.tip()][0] = g;
            }
            self.lengths.restart();
        } else if h >= rung {
            self.lengths.climb();
        }
        (self.last_dt, self.last_phase, self.smooth) = (h, phase, next.is_none());
        self.steps += 1;
        let event = next.and(self.events.last().copied());
        Ok(StepReport {
            dt: h,
            iterations,
            increment: self.stages.increment(),
            contraction: None,
            in_contact: phase != Phase::Free,
            event,
        })
    }

    /// The length of the next step, cut or stretched by a rounding error to end at the limit.
    fn propose(&self, remaining: f64) -> f64 {
        let h = self.lengths.get();
        if h * (1.0 + 1e-9) >= remaining {
            remaining
        } else {
            h
        }
    }

    /// The shortest possible step: a few units of round-off of the time.
    pub(super) fn shortest(&self) -> f64 {
        16.0 * f64::EPSILON * (self.level.t + self.stepping.restart_dt)
    }

    pub(super) fn failed(&self, dt: f64, failure: StepFailure) -> StepError {
        StepError {
            step: self.steps + 1,
            t: self.level.t,
            dt,
            failure,
        }
    }

    /// Finds the polynomials of a step of length τ (`h`) in the current phase.
    pub(super) fn attempt(&mut self, h: f64) -> Result<usize, StepError> {
        let Self {
            space,
            beam,
            level,
            phase,
            ..
        } = self;
        let equations = Equations {
            space,
            beam,
            obstacles: self.obstacles.as_ref(),
            level,
            h,
            phase: *phase,
        };
        let outcome = self
            .stages
            .solve(&equations, &self.stepping, self.load.as_deref_mut());
        outcome.map_err(|failure| self.failed(h, failure))
    }

    fn before_attempt(&self) -> BeforeAttempt {
        BeforeAttempt {
            phase: self.phase,
            events: self.events.len(),
            crowd: self.crowd,
        }
    }

    /// Undoes an attempt that has failed. Its polynomials predict nothing.
    fn put_back(&mut self, before: BeforeAttempt) {
        let BeforeAttempt {
            phase,
            events,
            crowd,
        } = before;
        self.phase = phase;
        self.events.truncate(events);
        self.crowd = crowd;
        self.smooth = false;
    }

    /// The current level.
    pub fn level(&self) -> &DgLevel {
        &self.level
    }

    /// The level at the start of the last step.
    pub fn old_level(&self) -> &DgLevel {
        &self.old
    }

    /// The elements.
    pub fn space(&self) -> &Space {
        &self.space
    }

    /// The current phase of the free end.
    pub fn phase(&self) -> Phase {
        self.phase
    }

    /// All contact events so far.
    pub fn events(&self) -> &[ContactEvent] {
        &self.events
    }

    /// Number of steps that failed and were repeated with a shorter length.
    pub fn shortened(&self) -> usize {
        self.shortened
    }
}

impl Motion for Dg {
    /// The last step before the limit ends exactly there. Up to 1024 contact events nothing is
    /// allocated.
    ///
    /// A step that fails is repeated with at most half of its length, down to a thousandth of
    /// `restart_dt`.
    ///
    /// # Errors
    /// [`StepError`] of the first attempt, which is the most informative.
    fn step(&mut self, limit: f64) -> Result<Option<StepReport>, StepError> {
        let before = self.before_attempt();
        let rung = self.lengths.next;
        let mut first = None;
        loop {
            let outcome = self.try_step(limit);
            let Err(error) = outcome else { return outcome };
            self.put_back(before);
            // Shorter steps may succeed after a failure; otherwise the first failure is the most
            // informative.
            let error = first.get_or_insert(error);
            if !self.lengths.shorten() {
                self.lengths.next = rung;
                return Err(error.clone());
            }
            self.shortened += 1;
        }
    }

    fn has_reached(&self, limit: f64) -> bool {
        !(limit - self.level.t > 0.0)
    }

    fn t(&self) -> f64 {
        self.level.t
    }

    fn steps(&self) -> usize {
        self.steps
    }

    fn work(&self) -> Work {
        self.stages.work()
    }

    /// Extrema inside the last step count.
    fn tip_range(&self) -> TipRange {
        let u = self.level.places[self.space.tip()][0];
        if self.last_dt == 0.0 {
            return TipRange::at(u);
        }
        let tip = self.stages.coefficient(Field::U, self.space.tip(), 0);
        let (extrema, count) = tip.derivative().sign_changes();
        let values = extrema[..count]
            .iter()
            .map(|&s| tip.at(s))
            .chain([tip.at(0.0)]);
        values.fold(TipRange::at(u), |TipRange { low, high }, value| TipRange {
            low: -max_or_nan(-low, -value),
            high: max_or_nan(high, value),
        })
    }

    fn is_loaded(&self) -> bool {
        self.load.is_some()
    }

    fn is_heated(&self) -> bool {
        true
    }
}
