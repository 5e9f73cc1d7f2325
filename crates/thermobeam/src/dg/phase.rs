//! The phase of the free end in a step of a [`Dg`]: where the step leaves it, and whether
//! the contact force agrees.

use super::contact_event::{Fall, Polynomial, bounds};
use super::simulation::{Crowd, Dg};
use crate::contact::{ContactEvent, Phase};
use crate::error::{StepError, StepFailure};

/// Rounding errors of the free end's position, relative to the numbers from which it is computed.
pub(super) const TIP_SLACK: f64 = 4.0 * f64::EPSILON;

/// Rounding errors of the free end's position, in units of its slack, below which a length cannot
/// be improved.
const COLLAPSED: f64 = 64.0;

/// Force of the wrong sign at which contact contradicts the motion, for an axial force of at
/// most 1. If rounding errors of the free end's position are a larger force, the balance of
/// momentum decides instead ([`Dg::is_blurred`]).
const WRONG_FORCE: f64 = 1e-2;

/// Force of the wrong sign, for an axial force of at most 1, at which contact ends by the balance
/// of momentum: it exceeds the error of the iteration, and moves the end of contact by less than a
/// millionth.
const WRONG_BALANCE: f64 = 1e-6;

/// Attempts to end a step on an obstacle: the method is safeguarded by bisection and never needs
/// them all.
const ATTEMPTS: usize = 100;

/// Number of contact events within the smallest step after which a simulation fails.
const CROWD: usize = 64;

/// A bound of the phase in a step.
#[derive(Debug, Clone, Copy)]
pub(super) struct PhaseBound {
    /// What is positive in the phase: the distance of the free end from the bound, or the force
    /// that keeps it on the obstacle.
    pub(super) distance: Polynomial,
    /// Its rounding errors.
    slack: f64,
    /// The phase beyond the bound.
    next: Phase,
}

impl Dg {
    /// Whether the phase of the free end agrees with the step just found.
    ///
    /// A free end must not penetrate, and closed contact must not pull. If ε is so small that the
    /// position does not determine the force, the balance of momentum does.
    pub(super) fn check_contact(&self, h: f64) -> Result<(), StepFailure> {
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

    /// Whether rounding errors of the free end's position are so large a force that its position
    /// does not show when contact ends.
    fn is_blurred(&self, slack: f64) -> bool {
        let least = WRONG_FORCE * self.stages.axial_force().abs().max(1.0);
        self.phase != Phase::Free
            && self
                .obstacles
                .is_some_and(|obstacles| slack / obstacles.epsilon > least)
    }

    /// The force of the obstacle over the step just found, by the balance of momentum, positive
    /// where it pushes.
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

    /// Errors of the contact force by the balance of momentum: of the iteration, and rounding
    /// errors of the free end's velocity and position over the step.
    fn rounding_of_force(&self, h: f64) -> f64 {
        let position = self.level.places[self.space.tip()][0].abs();
        WRONG_BALANCE * self.stages.axial_force().abs().max(1.0)
            + self.rounding_of_velocity(h)
            + TIP_SLACK * position / (h * h)
    }

    /// Rounding errors of the free end's position in the step just found.
    pub(super) fn slack(&self, tip: &Polynomial) -> f64 {
        let obstacles = self
            .obstacles
            .map_or(0.0, |obstacles| obstacles.g1.abs().max(obstacles.g2));
        let size: f64 = tip.coefficients.iter().map(|c| c.abs()).sum();
        TIP_SLACK * (obstacles + size)
    }

    /// The bounds of the phase in the step just found, of length h: of the free end's position, or
    /// of its contact force where rounding errors blur the position.
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
        // The first step of a contact holds the impulse of the impact, whose projection oscillates;
        // `check_contact` sees its mean.
        if self.last_phase != self.phase || self.last_dt == 0.0 {
            return [None; 2];
        }
        of_position.map(|bound| {
            bound.map(|(_, next)| PhaseBound {
                distance: self.pressure(),
                slack: self.rounding_of_force(h),
                next,
            })
        })
    }

    /// Where the step just found, of length h, first leaves its phase, and the phase that it
    /// enters.
    pub(super) fn first_fall(&self, h: f64) -> Option<(Fall, Phase)> {
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

    /// Finds the length of a step that ends on the obstacle, between 0 and the point where the
    /// polynomial of a longer step was clearly beyond it.
    ///
    /// Returns length, iterations, and the phase beyond; that phase is `None` if a shorter step
    /// does not reach the obstacle.
    pub(super) fn meet(
        &mut self,
        whole: f64,
        fall: Fall,
        next: Phase,
    ) -> Result<(f64, usize, Option<Phase>), StepError> {
        let mut low = 0.0;
        let mut high = fall.below * whole;
        let mut beyond = false;
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
            // The first rate is the velocity of the free end, up to the error of the step; then
            // secants are used.
            let rate = match before {
                Some((other, its_miss)) => (miss - its_miss) / (h - other),
                None => distance.derivative().at(1.0) / h,
            };
            before = Some((h, miss));
            let guess = h - miss / rate;
            // Occasional bisections ensure that the bracket shrinks for any guesses; before that, a
            // bracket is needed.
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
    pub(super) fn distance(&self, next: Phase, h: f64) -> PhaseBound {
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
    pub(super) fn change_phase(&mut self, to: Phase, t: f64) -> Result<(), StepFailure> {
        if t - self.crowd.since > self.stepping.restart_dt {
            self.crowd = Crowd {
                since: t,
                events: 0,
            };
        }
        self.crowd.events += 1;
        let Crowd { since, events } = self.crowd;
        if events > CROWD {
            return Err(StepFailure::EventsTooClose {
                events,
                within: t - since,
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
}
