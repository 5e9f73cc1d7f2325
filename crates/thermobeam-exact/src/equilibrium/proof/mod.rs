//! Which steady states are proved, and their number: a theorem about real numbers.
//!
//! The beam's coefficients are the doubles that it has; all else is enclosed by outward rounding.
//! The steps, in the order of the code and of THEORY.md, "Proven steady states":
//!
//! 1. Poles. Those of the free law are `1/(1 + κ²)`, those of a support are enclosed by signs of h.
//! 2. Between two poles f is concave, `scan`. Signs at three points prove two roots, a tangent
//!    proves none, and above the largest pole there is one. The sign of the determinant must be
//!    that of the number of poles above: a pole that was left out changes it.
//! 3. Interval Newton sharpens.
//! 4. The inequality of the contact, at the enclosure.
//! 5. What is no root of f: the straight beam and the buckled pairs at poles, N = -1, and ρ = 0.
//! 6. `completeness` proves that there is nothing below the last pole.
//!
//! What cannot be decided by these enclosures is named, with the width at which it was given up.

mod law;
mod roots;
mod undecided;

use super::law::{ForceLaw, Support, free_kappa, free_pole};
use super::{BUCKLING_VALUES, Completeness, Equilibrium, completeness, laws};
use crate::interval::Interval;
use law::IntervalLaw;
use roots::{poles_above, supported_pole};
use thermobeam::contact::Phase;
use thermobeam::parameters::{Beam, Obstacles, ParameterError};
pub use undecided::{Undecided, UndecidedReason};

/// A listed state belongs to a proved one if their N and u(1) agree to this, relative to one plus
/// their size.
const SAME: f64 = 1e-8;

/// A steady state whose existence is proved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProvedState {
    /// The obstacle that it presses.
    pub contact: Phase,
    /// Encloses the axial force N.
    pub n_value: Interval,
    /// Encloses u(1).
    pub u_tip: Interval,
}

/// What is proved about the steady states of a beam.
#[derive(Debug, Clone, PartialEq)]
pub struct Proof {
    /// The states that are proved to exist, each once.
    pub states: Vec<ProvedState>,
    /// Where others may be.
    pub undecided: Vec<Undecided>,
    /// Whether there are others that are not looked for.
    pub completeness: Completeness,
}

impl Proof {
    /// The number of all steady states, if it is proved.
    pub fn count(&self) -> Option<usize> {
        let is_proved = self.undecided.is_empty() && self.completeness == Completeness::Complete;
        is_proved.then_some(self.states.len())
    }

    /// The proved state that a listed one is: the only one with its contact, N and u(1) to
    /// round-off.
    pub fn of(&self, state: &Equilibrium) -> Option<&ProvedState> {
        let is_near = |interval: Interval, value: f64| {
            let gap = SAME * (1.0 + value.abs());
            interval.lo - gap <= value && value <= interval.hi + gap
        };
        let mut same = self.states.iter().filter(|proved| {
            proved.contact == state.contact
                && is_near(proved.n_value, state.n_value)
                && is_near(proved.u_tip, state.u_tip)
        });
        let first = same.next();
        if same.next().is_some() { None } else { first }
    }

    /// The number of all states in `list` if `list` has each proved state once, and no other.
    pub fn count_of(&self, list: &[Equilibrium]) -> Option<usize> {
        let count = self.count()?;
        let all = list.iter().all(|state| self.of(state).is_some());
        (all && list.len() == count).then_some(count)
    }
}

/// Proves the steady states that [`equilibria`](super::equilibria) lists.
///
/// # Errors
/// A coefficient out of range.
///
/// ```
/// use thermobeam::kirchhoff::BUCKLING;
/// use thermobeam::parameters::{Beam, Obstacles};
/// use thermobeam_exact::equilibrium::prove;
///
/// let beam = Beam { beta: -0.8, ..Beam::default() };
/// let proof = prove(&beam, Some(&Obstacles::default()))?;
/// assert_eq!(proof.count(), Some(3));
/// let buckled = prove(&beam, None)?.states[1].n_value;
/// assert!((buckled.midpoint() + BUCKLING).abs() < 1e-15 && buckled.width() < 1e-14);
/// # Ok::<(), thermobeam::parameters::ParameterError>(())
/// ```
pub fn prove(beam: &Beam, obstacles: Option<&Obstacles>) -> Result<Proof, ParameterError> {
    beam.validate()?;
    obstacles.map_or(Ok(()), Obstacles::validate)?;
    let mut proof = Proof {
        states: Vec::new(),
        undecided: Vec::new(),
        completeness: completeness(beam, obstacles),
    };
    for (contact, law) in laws(beam, obstacles) {
        let mut branch = ProvedBranch {
            contact,
            law,
            intervals: IntervalLaw::new(&law, Interval::from(beam.a) * beam.theta_a),
            obstacles: obstacles.copied(),
            proof: &mut proof,
        };
        branch.prove();
    }
    Ok(proof)
}

/// Encloses the β at which the answer changes, between two at which it is proved to differ.
///
/// * `is_before`: the answer of a proof; `None` if it is not proved.
/// * Returns `None` if the answers at the ends are not proved, or not yes and no.
///
/// # Errors
/// A coefficient out of range.
pub fn enclose_change(
    beam: &Beam,
    obstacles: Option<&Obstacles>,
    [low, high]: [f64; 2],
    is_before: impl Fn(&Proof) -> Option<bool>,
) -> Result<Option<Interval>, ParameterError> {
    let answer = |beta: f64| Ok(is_before(&prove(&Beam { beta, ..*beam }, obstacles)?));
    if answer(low)? != Some(true) || answer(high)? != Some(false) {
        return Ok(None);
    }
    let mut change = Interval { lo: low, hi: high };
    loop {
        let mut is_narrower = false;
        for part in [0.5, 0.25, 0.75, 0.1, 0.9] {
            let beta = change.lo + part * change.width();
            if beta <= change.lo || change.hi <= beta {
                continue;
            }
            match answer(beta)? {
                Some(true) => change.lo = beta,
                Some(false) => change.hi = beta,
                None => continue,
            }
            is_narrower = true;
            break;
        }
        if !is_narrower {
            return Ok(Some(change));
        }
    }
}

/// The proof of the states of one law.
struct ProvedBranch<'p> {
    contact: Phase,
    law: ForceLaw,
    intervals: IntervalLaw,
    obstacles: Option<Obstacles>,
    proof: &'p mut Proof,
}

impl ProvedBranch<'_> {
    fn prove(&mut self) {
        if self.law.rho == 0.0 {
            self.linear();
        } else if self.law.homogeneous() {
            self.straight_and_buckled();
        } else {
            let poles = poles_above(&self.law, BUCKLING_VALUES + 1);
            self.bent_above(poles);
            self.bent_below();
        }
        self.at_minus_one();
    }

    /// With a load: the roots above N = -1.
    fn bent_above(&mut self, poles: Result<Vec<Interval>, Undecided>) {
        let poles = match poles {
            Ok(poles) => poles,
            Err(undecided) => return self.give_up(undecided),
        };
        let reaches = |pole: &Interval| pole.hi < self.intervals.rest.lo;
        if poles.len() <= BUCKLING_VALUES && !poles.last().is_some_and(reaches) {
            let s = self.intervals.rest;
            return self.give_up(Undecided::new(UndecidedReason::Pole, s, s.width()));
        }
        let mut upper: Option<Interval> = None;
        for (above, pole) in poles.into_iter().enumerate() {
            if self.intervals.load(pole).contains(0.0) {
                return self.give_up(Undecided::new(UndecidedReason::Pole, pole, pole.width()));
            }
            let high = upper.map_or(f64::INFINITY, |upper| upper.lo);
            let roots = match upper {
                None => self.intervals.root_above(pole.hi),
                Some(upper) => self.intervals.roots_between(pole, upper),
            };
            if !self.has_parity(above, pole.hi, high) {
                return self.give_up(Undecided::new(UndecidedReason::Pole, pole, high - pole.hi));
            }
            self.take(roots);
            upper = Some(pole);
        }
    }

    /// Whether the determinant has the sign of `above` poles next to both ends of an interval
    /// between two poles.
    fn has_parity(&self, above: usize, low: f64, high: f64) -> bool {
        let high = if high.is_finite() { high } else { 2.0 * low };
        [0.01, 0.99].into_iter().all(|part| {
            let s = Interval::from(low + part * (high - low));
            let determinant = self.intervals.determinant(s);
            if above.is_multiple_of(2) {
                determinant.is_positive()
            } else {
                determinant.is_negative()
            }
        })
    }

    /// With a load: the roots below N = -1.
    fn bent_below(&mut self) {
        let rest = self.intervals.rest;
        if self.law.beta >= -1.0 {
            return;
        }
        let left = 2.0 * rest.lo;
        let Some(support) = self.law.support else {
            let at_zero = self.defect_at_minus_one();
            if at_zero.is_positive() {
                let roots = self.intervals.root_rising_to_zero();
                self.take(roots);
            } else if at_zero.is_negative() {
                let roots = self.intervals.roots_between(left, 0.0);
                self.take(roots);
            }
            // Otherwise `at_minus_one` says that it is not decided.
            return;
        };
        let Some(pole) = self.pole_below(support) else {
            let s = Interval { lo: left, hi: 0.0 };
            return self.give_up(Undecided::new(UndecidedReason::Pole, s, s.width()));
        };
        if self.intervals.load(pole).contains(0.0) {
            return self.give_up(Undecided::new(UndecidedReason::Pole, pole, pole.width()));
        }
        if rest.lo <= pole.hi {
            let far = left.min(2.0 * pole.lo);
            let roots = self.intervals.roots_between(far, pole);
            self.take(roots);
        }
        let roots = self.intervals.roots_between(pole, 0.0);
        self.take(roots);
    }

    fn pole_below(&self, support: Support) -> Option<Interval> {
        let bounds = Interval {
            lo: f64::NEG_INFINITY,
            hi: 0.0,
        };
        let guess = self.law.buckling_below_minus_one()?;
        supported_pole(support.epsilon, guess, bounds)
    }

    /// Without a load: the straight beam, and the pairs at the buckling values above β. A support
    /// at 0 has one of each pair.
    fn straight_and_buckled(&mut self) {
        let support = self.law.support;
        if support.is_none() {
            self.straight();
        }
        let poles = match poles_above(&self.law, BUCKLING_VALUES) {
            Ok(poles) => poles,
            Err(undecided) => return self.give_up(undecided),
        };
        for (place, pole) in poles.into_iter().enumerate() {
            self.buckled(pole, |squared| {
                support.map_or_else(
                    || squared * 2.0 / free_kappa(place + 1).square(),
                    |support| IntervalLaw::squared_tip_of_mode(support.epsilon, pole, squared),
                )
            });
        }
        if let Some(support) = support.filter(|_| self.law.beta < -1.0) {
            match self.pole_below(support) {
                Some(pole) => self.buckled(pole, |squared| {
                    IntervalLaw::squared_tip_of_mode(support.epsilon, pole, squared)
                }),
                None => self.give_up(Undecided::new(
                    UndecidedReason::Pole,
                    self.intervals.rest,
                    1.0,
                )),
            }
        }
    }

    /// u = φ = 0 with N = β.
    fn straight(&mut self) {
        let n_value = Interval::from(self.law.beta);
        self.admit(n_value, Interval::from(0.0));
    }

    /// The modes of both signs at a buckling value s, `ρS = s - (1 + β)`.
    fn buckled(&mut self, s: Interval, squared_tip: impl Fn(Interval) -> Interval) {
        let excess = s - self.intervals.rest;
        if excess.is_negative() {
            return;
        }
        if !excess.is_positive() {
            return self.give_up(Undecided::new(
                UndecidedReason::Bifurcation,
                s,
                excess.width(),
            ));
        }
        let tip = squared_tip(excess / self.law.rho).sqrt();
        for tip in [tip, -tip] {
            match self.law.support {
                None => self.admit(s - 1.0, tip),
                Some(support) => self.press(s, tip, -tip / support.epsilon),
            }
        }
    }

    /// ρ = 0: N = β, and one linear problem.
    fn linear(&mut self) {
        let s = self.intervals.rest;
        if self.law.beta == -1.0 {
            return self.linear_at_minus_one();
        }
        let determinant = self.intervals.determinant(s);
        let is_regular = s.is_negative() && self.law.support.is_none()
            || determinant.is_positive()
            || determinant.is_negative();
        if !is_regular {
            return self.give_up(Undecided::new(UndecidedReason::Bifurcation, s, s.width()));
        }
        if self.law.homogeneous() {
            if self.law.support.is_none() {
                self.straight();
            }
            return;
        }
        let solution = self.intervals.at(s);
        match self.law.support {
            None => self.admit(Interval::from(self.law.beta), solution.u_tip),
            Some(_) => self.press(s, solution.u_tip, solution.stress),
        }
    }

    /// ρ = 0 and N = -1: φ = 0, u' = -aθ_A and no contact.
    fn linear_at_minus_one(&mut self) {
        if self.law.support.is_none() {
            self.admit(Interval::from(-1.0), -self.intervals.moment);
        }
    }

    /// `-1 - β - ρ(aθ_A)²`: f(0⁻), and the free state at N = -1 exists if it is 0.
    fn defect_at_minus_one(&self) -> Interval {
        -self.intervals.rest - self.intervals.moment.square() * self.law.rho
    }

    /// N = -1 with ρ > 0: φ = c = 0 and u' = -aθ_A, a state without contact.
    fn at_minus_one(&mut self) {
        let moves = self.law.rho != 0.0 && self.law.moment != 0.0;
        let defect = self.defect_at_minus_one();
        if self.law.support.is_none() && moves && defect.contains(0.0) {
            let s = Interval::from(0.0);
            self.give_up(Undecided::new(UndecidedReason::MinusOne, s, defect.width()));
        }
    }

    /// Roots of f: the states among them satisfy the inequality of their contact.
    fn take(&mut self, roots: roots::Roots) {
        let roots = match roots {
            Ok(roots) => roots,
            Err(undecided) => return self.give_up(undecided),
        };
        let last = free_pole(BUCKLING_VALUES + 1);
        for s in roots {
            // Not listed: see `completeness`.
            if s.lo > 0.0 && s.hi < last.lo {
                continue;
            }
            if s.lo > 0.0 && s.lo <= last.hi {
                self.give_up(Undecided::new(UndecidedReason::Pole, s, s.width()));
                continue;
            }
            let solution = self.intervals.at(s);
            match self.law.support {
                None => self.admit(s - 1.0, solution.u_tip),
                Some(_) => self.press(s, solution.u_tip, solution.stress),
            }
        }
    }

    /// A free state if `g₁ <= u(1) <= g₂`.
    fn admit(&mut self, n_value: Interval, u_tip: Interval) {
        let state = ProvedState {
            contact: self.contact,
            n_value,
            u_tip,
        };
        let Some(Obstacles { g1, g2, .. }) = self.obstacles else {
            return self.proof.states.push(state);
        };
        if g1 <= u_tip.lo && u_tip.hi <= g2 {
            self.proof.states.push(state);
        } else if u_tip.hi >= g1 && u_tip.lo <= g2 {
            self.give_up_touch(n_value, u_tip);
        }
    }

    /// A state in contact if its stress c presses: c < 0 on the upper, c > 0 on the lower obstacle.
    fn press(&mut self, s: Interval, u_tip: Interval, stress: Interval) {
        let outward = if self.contact == Phase::Upper {
            -stress
        } else {
            stress
        };
        if outward.is_positive() {
            self.proof.states.push(ProvedState {
                contact: self.contact,
                n_value: s - 1.0,
                u_tip,
            });
        } else if !outward.is_negative() {
            self.give_up_touch(s - 1.0, u_tip);
        }
    }

    fn give_up_touch(&mut self, n_value: Interval, u_tip: Interval) {
        self.proof.undecided.push(Undecided {
            contact: self.contact,
            n_value,
            reason: UndecidedReason::Touch,
            width: u_tip.width(),
        });
    }

    fn give_up(&mut self, undecided: Undecided) {
        self.proof.undecided.push(Undecided {
            contact: self.contact,
            ..undecided
        });
    }
}

#[cfg(test)]
mod tests;
