//! A simulation, which holds one level and does steps: their lengths, and where contact cuts them.

use super::contact_event::{ContactEvent, Fall, Polynomial, bounds};
use super::lengths::Lengths;
use super::problem::{Problem, Stepping, check_problem, initial_level};
use super::residual::Equations;
use super::space::Space;
use super::stages::{Stages, stepper};
use super::time::Load;
use super::{Level, Work};
use crate::contact::Phase;
use crate::error::{SetupError, StepError, StepFailure};
use crate::parameters::{Beam, Obstacles};

/// Rounding errors of the free end's position, relative to the numbers from which it is computed.
pub(super) const TIP_SLACK: f64 = 4.0 * f64::EPSILON;

/// Rounding errors of the free end's position, in units of its slack, below which a length cannot be improved.
const COLLAPSED: f64 = 64.0;

/// Force of the wrong sign at which contact contradicts the motion, for an axial force of at most 1. If rounding errors of the free
/// end's position are a larger force, the balance of momentum decides instead ([`Simulation::is_blurred`]).
const WRONG_FORCE: f64 = 1e-2;

/// Force of the wrong sign, for an axial force of at most 1, at which contact ends by the balance of momentum: it exceeds the error
/// of the iteration, and moves the end of contact by less than a millionth.
const WRONG_BALANCE: f64 = 1e-6;

/// Attempts to end a step on an obstacle: the method is safeguarded by bisection and never needs them all.
const ATTEMPTS: usize = 100;

/// Number of contact events within the smallest step after which a simulation fails.
const CROWD: usize = 64;

/// Maximum number of cuts of one step: at a crossing, at an earlier one that the shorter step shows, and so on.
const CUTS: usize = 64;

/// Initial capacity of the list of contact events.
const EVENTS: usize = 1024;

/// The result of a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StepReport {
    /// Its length.
    pub dt: f64,
    /// Iterations of the last attempt.
    pub iterations: usize,
    /// The contact event at its end, if any.
    pub event: Option<ContactEvent>,
}

/// A bound of the phase in a step.
#[derive(Debug, Clone, Copy)]
struct PhaseBound {
    /// What is positive in the phase: the distance of the free end from the bound, or the force that keeps it on the obstacle.
    distance: Polynomial,
    /// Its rounding errors.
    slack: f64,
    /// The phase beyond the bound.
    next: Phase,
}

/// A running simulation at one level, with the step that led there.
pub struct Simulation {
    pub(super) beam: Beam,
    pub(super) obstacles: Option<Obstacles>,
    pub(super) space: Space,
    pub(super) stepping: Stepping,
    pub(super) lengths: Lengths,
    pub(super) stages: Box<dyn Stages>,
    pub(super) load: Option<Box<Load>>,
    pub(super) level: Level,
    /// The level before the last step.
    pub(super) old: Level,
    /// The length of the last step, 0 at the start.
    pub(super) last_dt: f64,
    /// The phase of the free end during the last step.
    pub(super) last_phase: Phase,
    pub(super) phase: Phase,
    /// Whether the last step's polynomials predict those of the next one.
    pub(super) smooth: bool,
    pub(super) events: Vec<ContactEvent>,
    /// Steps repeated with a shorter length.
    pub(super) shortened: usize,
    /// Number of events since the given time, all within `restart_dt`.
    pub(super) crowd: (f64, usize),
}

impl Simulation {
    /// Checks all data once and starts at t = 0.
    ///
    /// # Errors
    /// [`SetupError`] for coefficients, degrees or settings out of range, and for initial data that are not finite or
    /// violate a boundary condition.
    pub fn new(problem: Problem, stepping: Stepping) -> Result<Self, SetupError> {
        Self::build(problem, stepping, |_| None)
    }

    /// The same with loads on the right-hand sides of the equations; `load` creates them for the elements.
    ///
    /// # Errors
    /// Those of [`Self::new`].
    pub fn with_load(
        problem: Problem,
        stepping: Stepping,
        load: impl FnOnce(&Space) -> Box<Load>,
    ) -> Result<Self, SetupError> {
        Self::build(problem, stepping, |space| Some(load(space)))
    }

    fn build(
        problem: Problem,
        stepping: Stepping,
        load: impl FnOnce(&Space) -> Option<Box<Load>>,
    ) -> Result<Self, SetupError> {
        let Problem {
            beam,
            obstacles,
            mesh,
            degree,
            initial,
        } = problem;
        check_problem(&beam, obstacles.as_ref(), degree, &stepping)?;
        let space = Space::new(mesh, degree);
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
            shortened: 0,
            crowd: (0.0, 0),
        })
    }

    /// Does steps until t_end, which the last step meets exactly.
    ///
    /// # Errors
    /// [`StepError`] with step, time and numbers; the simulation then remains at the start of that step.
    pub fn advance(&mut self, t_end: f64) -> Result<(), StepError> {
        while self.step(t_end)?.is_some() {}
        Ok(())
    }

    /// Does one step that does not exceed `limit`; allocates nothing up to 1024 contact events.
    ///
    /// A step that fails is repeated with at most half of its length, down to a thousandth of `restart_dt`.
    ///
    /// Returns `None` if the simulation has reached the limit.
    ///
    /// # Errors
    /// [`StepError`] with step, time and numbers; the simulation then remains at its old level.
    pub fn step(&mut self, limit: f64) -> Result<Option<StepReport>, StepError> {
        let (phase, events, crowd) = (self.phase, self.events.len(), self.crowd);
        let rung = self.lengths.next;
        let mut first = None;
        loop {
            let outcome = self.try_step(limit);
            let Err(error) = outcome else { return outcome };
            self.phase = phase;
            self.events.truncate(events);
            self.crowd = crowd;
            self.smooth = false;
            // Shorter steps may succeed after a failure; otherwise the first failure is the most informative.
            let error = first.get_or_insert(error);
            if !self.lengths.shorten() {
                self.lengths.next = rung;
                return Err(error.clone());
            }
            self.shortened += 1;
        }
    }

    fn try_step(&mut self, limit: f64) -> Result<Option<StepReport>, StepError> {
        let remaining = limit - self.level.t;
        if !(remaining > 0.0) {
            return Ok(None);
        }
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
                // It leaves the other phase as well: polynomials of this length are too coarse to decide.
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

    /// Finds the polynomials of a step of length τ (`h`) in another phase; `None` if the free end leaves that phase too.
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
        let event = next.and(self.events.last().copied());
        Ok(StepReport {
            dt: h,
            iterations,
            event,
        })
    }

    /// Whether the phase of the free end agrees with the step just found.
    ///
    /// A free end must not penetrate, and closed contact must not pull. If ε is so small that the position does not
    /// determine the force, the balance of momentum does.
    fn check_contact(&self, h: f64) -> Result<(), StepFailure> {
        let Some(obstacles) = &self.obstacles else {
            return Ok(());
        };
        let tip = self.stages.tip(&self.space);
        let slack = self.slack(&tip);
        let noise = slack / obstacles.epsilon;
        let force = match self.phase {
            Phase::Free => {
                let end = tip.at(1.0);
                let depth = (end - obstacles.g2).max(obstacles.g1 - end);
                if depth > slack {
                    depth / obstacles.epsilon
                } else {
                    0.0
                }
            }
            _ if self.is_blurred(slack) => -self.pressure().coefficients[0],
            _ => 0.0,
        };
        let least = match self.phase {
            Phase::Free => {
                WRONG_FORCE * self.stages.axial_force().abs().max(1.0)
                    + self.rounding_of_velocity(h)
            }
            _ => self.rounding_of_force(h),
        };
        if force > least {
            Err(StepFailure::WrongContact { force, noise })
        } else {
            Ok(())
        }
    }

    /// Whether rounding errors of the free end's position are so large a force that its position does not show when contact ends.
    fn is_blurred(&self, slack: f64) -> bool {
        let least = WRONG_FORCE * self.stages.axial_force().abs().max(1.0);
        self.phase != Phase::Free
            && self
                .obstacles
                .is_some_and(|obstacles| slack / obstacles.epsilon > least)
    }

    /// The force of the obstacle over the step just found, by the balance of momentum, positive where it pushes.
    fn pressure(&self) -> Polynomial {
        let mut force = self.stages.contact_force();
        if self.phase == Phase::Lower {
            force.coefficients.iter_mut().for_each(|c| *c = -*c);
        }
        force
    }

    /// Rounding errors of the free end's velocity, converted to a force over the step.
    fn rounding_of_velocity(&self, h: f64) -> f64 {
        TIP_SLACK * self.level.rates[self.space.tip()][0].abs() / h
    }

    /// Errors of the contact force by the balance of momentum: of the iteration, and rounding errors of the free end's velocity and
    /// position over the step.
    fn rounding_of_force(&self, h: f64) -> f64 {
        let position = self.level.places[self.space.tip()][0].abs();
        WRONG_BALANCE * self.stages.axial_force().abs().max(1.0)
            + self.rounding_of_velocity(h)
            + TIP_SLACK * position / (h * h)
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
    fn shortest(&self) -> f64 {
        16.0 * f64::EPSILON * (self.level.t + self.stepping.restart_dt)
    }

    fn failed(&self, dt: f64, failure: StepFailure) -> StepError {
        StepError {
            step: self.stages.work().steps + 1,
            t: self.level.t,
            dt,
            failure,
        }
    }

    /// Finds the polynomials of a step of length τ (`h`) in the current phase.
    fn attempt(&mut self, h: f64) -> Result<usize, StepError> {
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

    /// Rounding errors of the free end's position in the step just found.
    fn slack(&self, tip: &Polynomial) -> f64 {
        let obstacles = self
            .obstacles
            .map_or(0.0, |obstacles| obstacles.g1.abs().max(obstacles.g2));
        let size: f64 = tip.coefficients.iter().map(|c| c.abs()).sum();
        TIP_SLACK * (obstacles + size)
    }

    /// The bounds of the phase in the step just found, of length h: of the free end's position, or of its contact force where
    /// rounding errors blur the position.
    fn phase_bounds(&self, h: f64) -> [Option<PhaseBound>; 2] {
        let Some(obstacles) = &self.obstacles else {
            return [None; 2];
        };
        let tip = self.stages.tip(&self.space);
        let slack = self.slack(&tip);
        let of_position = bounds(self.phase, &tip, obstacles);
        if !self.is_blurred(slack) {
            return of_position.map(|bound| {
                bound.map(|(distance, next)| PhaseBound {
                    distance,
                    slack,
                    next,
                })
            });
        }
        // The first step of a contact holds the impulse of the impact, whose projection oscillates; `check_contact` sees its mean.
        if self.last_phase != self.phase || self.last_dt == 0.0 {
            return [None; 2];
        }
        let of_force = |(_, next)| PhaseBound {
            distance: self.pressure(),
            slack: self.rounding_of_force(h),
            next,
        };
        of_position.map(|bound| bound.map(of_force))
    }

    /// Where the step just found, of length h, first leaves its phase, and the phase that it enters.
    fn first_fall(&self, h: f64) -> Option<(Fall, Phase)> {
        let falls = self.phase_bounds(h).into_iter().flatten();
        let falls = falls.filter_map(
            |PhaseBound {
                 distance,
                 slack,
                 next,
             }| distance.first_fall(slack).map(|fall| (fall, next)),
        );
        falls.min_by(|(one, _), (other, _)| one.crossing.total_cmp(&other.crossing))
    }

    /// Finds the length of a step that ends on the obstacle, between 0 and the point where the polynomial of a longer
    /// step was clearly beyond it.
    ///
    /// Returns length, iterations, and the phase beyond; that phase is `None` if a shorter step does not reach the obstacle.
    fn meet(
        &mut self,
        whole: f64,
        fall: Fall,
        next: Phase,
    ) -> Result<(f64, usize, Option<Phase>), StepError> {
        let (mut low, mut high, mut beyond) = (0.0, fall.below * whole, false);
        let (mut h, mut solved) = (fall.crossing * whole, whole);
        // The previous attempt: length and miss.
        let mut before: Option<(f64, f64)> = None;
        let mut miss = f64::NAN;
        for attempt in 1..=ATTEMPTS {
            self.stages.restrict(h / solved);
            solved = h;
            let iterations = self.attempt(h)?;
            let PhaseBound {
                distance, slack, ..
            } = self.distance(next, h);
            miss = distance.at(1.0);
            if miss.abs() <= slack {
                return Ok((h, iterations, Some(next)));
            }
            if miss < 0.0 {
                (high, beyond) = (h, true);
            } else {
                low = h;
                if h == high {
                    return Ok((h, iterations, None));
                }
            }
            if !(high - low > self.shortest()) && miss.abs() <= COLLAPSED * slack {
                // Round-off cannot distinguish these lengths.
                return Ok((h, iterations, Some(next)));
            }
            // The first rate is the velocity of the free end, up to the error of the step; then secants are used.
            let rate = match before {
                Some((other, its_miss)) => (miss - its_miss) / (h - other),
                None => distance.derivative().at(1.0) / h,
            };
            before = Some((h, miss));
            let guess = h - miss / rate;
            // Occasional bisections ensure that the bracket shrinks for any guesses; before that, a bracket is needed.
            h = if attempt % 4 != 0 && guess > low && guess < high {
                guess
            } else if !beyond {
                high
            } else {
                0.5 * (low + high)
            };
        }
        Err(self.failed(h, StepFailure::EventNotFound { miss }))
    }

    /// The bound beyond which `next` begins, in the step just found, of length h.
    fn distance(&self, next: Phase, h: f64) -> PhaseBound {
        let tip = self.stages.tip(&self.space);
        let bound = self
            .phase_bounds(h)
            .into_iter()
            .flatten()
            .find(|bound| bound.next == next);
        bound.unwrap_or_else(|| PhaseBound {
            distance: tip,
            slack: self.slack(&tip),
            next,
        })
    }

    /// Enters another phase at time t.
    fn change_phase(&mut self, to: Phase, t: f64) -> Result<(), StepFailure> {
        if t - self.crowd.0 > self.stepping.restart_dt {
            self.crowd = (t, 0);
        }
        self.crowd.1 += 1;
        if self.crowd.1 > CROWD {
            return Err(StepFailure::EventsTooClose {
                events: self.crowd.1,
                within: t - self.crowd.0,
            });
        }
        self.events.push(ContactEvent {
            t,
            from: self.phase,
            to,
        });
        self.phase = to;
        Ok(())
    }

    /// The current time.
    pub fn t(&self) -> f64 {
        self.level.t
    }

    /// The current level.
    pub fn level(&self) -> &Level {
        &self.level
    }

    /// The level at the start of the last step.
    pub fn old_level(&self) -> &Level {
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

    /// Counts of the work done so far.
    pub fn work(&self) -> Work {
        Work {
            events: self.events.len(),
            shortened: self.shortened,
            ..self.stages.work()
        }
    }
}
