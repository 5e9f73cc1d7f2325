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

use super::law::{ForceLaw, free_pole};
use super::{BUCKLING_VALUES, Completeness, Equilibrium, completeness, laws};
use crate::interval::Enclosure;
use law::IntervalLaw;
use roots::{Gap, HALVINGS, narrowed};
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
    pub n_value: Enclosure,
    /// Encloses u(1).
    pub u_tip: Enclosure,
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
        let is_near = |interval: Enclosure, value: f64| {
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

    /// Whether nothing is undecided and `list` has each proved state once, and no other.
    pub fn decides(&self, list: &[Equilibrium]) -> bool {
        let all = list.iter().all(|state| self.of(state).is_some());
        self.undecided.is_empty() && all && list.len() == self.states.len()
    }

    /// The number of all states if `list` is proved to be the list of all.
    pub fn count_of(&self, list: &[Equilibrium]) -> Option<usize> {
        self.count().filter(|_| self.decides(list))
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
        let moment = Enclosure::from(beam.a) * beam.theta_a;
        let mut branch = ProvedBranch {
            law: IntervalLaw::new(contact, law, moment),
            obstacles: obstacles.copied(),
            proof: &mut proof,
        };
        if let Err(undecided) = branch.prove() {
            branch.proof.undecided.push(undecided);
        }
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
) -> Result<Option<Enclosure>, ParameterError> {
    let answer = |beta: f64| Ok(is_before(&prove(&Beam { beta, ..*beam }, obstacles)?));
    if answer(low)? != Some(true) || answer(high)? != Some(false) {
        return Ok(None);
    }
    let [lo, hi] = narrowed([low, high], answer)?;
    Ok(Some(Enclosure { lo, hi }))
}

/// The proof of the states of one law.
struct ProvedBranch<'p> {
    law: IntervalLaw,
    obstacles: Option<Obstacles>,
    proof: &'p mut Proof,
}

impl ProvedBranch<'_> {
    fn prove(&mut self) -> Result<(), Undecided> {
        if self.law.force.rho == 0.0 {
            self.linear()
        } else if self.law.force.homogeneous() {
            self.straight_and_buckled()
        } else {
            let poles = self.law.poles_above(BUCKLING_VALUES + 1)?;
            self.bent_above(&poles)?;
            self.bent_below()
        }
    }

    /// With a load: the roots above N = -1, between these poles.
    fn bent_above(&mut self, poles: &[Enclosure]) -> Result<(), Undecided> {
        let rest = self.law.rest;
        let reaches = poles.last().is_some_and(|pole| pole.hi < rest.lo);
        if poles.len() <= BUCKLING_VALUES && !reaches {
            return Err(self
                .law
                .undecided(UndecidedReason::Pole, rest, rest.width()));
        }
        for (above, &pole) in poles.iter().enumerate() {
            let gap = match above.checked_sub(1) {
                // f increases from -∞ to ∞.
                None => {
                    let scale = pole.hi.max(rest.hi.abs());
                    let far = (1..HALVINGS).map(|j| scale * 2.0_f64.powi(j));
                    self.law.rising(pole, far)?
                }
                Some(last) => Gap::between(pole, poles[last]),
            };
            self.is_loaded(pole)?;
            self.has_parity(above, gap)?;
            self.take(gap);
        }
        Ok(())
    }

    /// Refuses a pole at which the load of the mode may be 0: f may have no pole there.
    fn is_loaded(&self, pole: Enclosure) -> Result<(), Undecided> {
        if self.law.load(pole).contains(0.0) {
            return Err(self
                .law
                .undecided(UndecidedReason::Pole, pole, pole.width()));
        }
        Ok(())
    }

    /// Refuses a gap next to whose ends the determinant has not the sign of `above` poles.
    fn has_parity(&self, above: usize, gap: Gap) -> Result<(), Undecided> {
        let low = gap.left.hi;
        // Above the largest pole: next to that.
        let width = if gap.rises { low } else { gap.right.lo - low };
        for part in [0.01, 0.99] {
            let determinant = self.law.determinant(Enclosure::from(low + part * width));
            let has_sign = if above.is_multiple_of(2) {
                determinant.is_positive()
            } else {
                determinant.is_negative()
            };
            if !has_sign {
                return Err(self.law.undecided(UndecidedReason::Pole, gap.left, width));
            }
        }
        Ok(())
    }

    /// With a load: the roots below N = -1.
    fn bent_below(&mut self) -> Result<(), Undecided> {
        let rest = self.law.rest;
        if self.law.force.beta >= -1.0 {
            return Ok(());
        }
        // f < 0 at 2 (1 + β).
        let (far, zero) = (Enclosure::from(2.0 * rest.lo), Enclosure::from(0.0));
        let Some(pole) = self.law.pole_below() else {
            // f(0⁻); where it is 0, N = -1 is a state: φ = c = 0 and u' = -aθ_A.
            let at_zero = -rest - self.law.moment.square() * self.law.force.rho;
            if at_zero.contains(0.0) {
                let width = at_zero.width();
                return Err(self.law.undecided(UndecidedReason::MinusOne, zero, width));
            }
            let gap = if at_zero.is_positive() {
                let near = (1..HALVINGS).map(|j| rest.lo * 2.0_f64.powi(-j));
                self.law.rising(far, near)?
            } else {
                Gap::between(far, zero)
            };
            self.take(gap);
            return Ok(());
        };
        let pole = pole?;
        self.is_loaded(pole)?;
        self.take(Gap::between(pole, zero));
        if rest.lo <= pole.hi {
            let left = far.lo.min(2.0 * pole.lo);
            self.take(Gap::between(Enclosure::from(left), pole));
        }
        Ok(())
    }

    /// Without a load: the straight beam, and the pairs at the buckling values above β. A support
    /// at 0 has one of each pair.
    fn straight_and_buckled(&mut self) -> Result<(), Undecided> {
        self.straight();
        for pole in self.law.poles_above(BUCKLING_VALUES)? {
            self.buckled(pole);
        }
        if self.law.force.beta < -1.0
            && let Some(pole) = self.law.pole_below()
        {
            self.buckled(pole?);
        }
        Ok(())
    }

    /// u = φ = 0 with N = β, which presses nothing.
    fn straight(&mut self) {
        if self.law.force.support.is_none() {
            let n_value = Enclosure::from(self.law.force.beta);
            let zero = Enclosure::from(0.0);
            self.admit(n_value, zero, zero);
        }
    }

    /// The modes of both signs at a buckling value s, `ρS = s - (1 + β)`.
    fn buckled(&mut self, s: Enclosure) {
        let excess = s - self.law.rest;
        if excess.is_negative() {
            return;
        }
        if !excess.is_positive() {
            let width = excess.width();
            let undecided = self.law.undecided(UndecidedReason::Bifurcation, s, width);
            return self.proof.undecided.push(undecided);
        }
        let squared = excess / self.law.force.rho;
        let tip = self.law.squared_tip_of_mode(s, squared).sqrt();
        for tip in [tip, -tip] {
            let stress = self.law.stress(tip);
            self.admit(s - 1.0, tip, stress);
        }
    }

    /// ρ = 0: N = β, and one linear problem.
    fn linear(&mut self) -> Result<(), Undecided> {
        let ForceLaw { beta, support, .. } = self.law.force;
        let (s, n_value) = (self.law.rest, Enclosure::from(beta));
        if beta == -1.0 {
            // φ = 0, u' = -aθ_A and no contact.
            if support.is_none() {
                let stress = Enclosure::from(0.0);
                self.admit(n_value, -self.law.moment, stress);
            }
            return Ok(());
        }
        let determinant = self.law.determinant(s);
        if determinant.contains(0.0) {
            return Err(self
                .law
                .undecided(UndecidedReason::Bifurcation, s, s.width()));
        }
        if self.law.force.homogeneous() {
            self.straight();
        } else {
            let solution = self.law.at(s);
            self.admit(n_value, solution.u_tip, solution.stress);
        }
        Ok(())
    }

    /// The roots of f in a gap: the states among them satisfy the inequality of their contact.
    fn take(&mut self, gap: Gap) {
        let roots = match self.law.roots(gap) {
            Ok(roots) => roots,
            Err(undecided) => return self.proof.undecided.push(undecided),
        };
        let last = free_pole(BUCKLING_VALUES + 1);
        for s in roots {
            // Not listed: see `completeness`.
            if s.lo > 0.0 && s.hi < last.lo {
                continue;
            }
            if s.lo > 0.0 && s.lo <= last.hi {
                let undecided = self.law.undecided(UndecidedReason::Pole, s, s.width());
                self.proof.undecided.push(undecided);
                continue;
            }
            let solution = self.law.at(s);
            self.admit(s - 1.0, solution.u_tip, solution.stress);
        }
    }

    /// A root of the law is a state if `g₁ <= u(1) <= g₂` without contact, and if its stress
    /// presses with it: c < 0 on the upper, c > 0 on the lower obstacle.
    fn admit(&mut self, n_value: Enclosure, u_tip: Enclosure, stress: Enclosure) {
        let contact = self.law.contact;
        let (holds, may_hold) = match (contact, self.obstacles) {
            (Phase::Free, None) => (true, true),
            (Phase::Free, Some(Obstacles { g1, g2, .. })) => (
                g1 <= u_tip.lo && u_tip.hi <= g2,
                g1 <= u_tip.hi && u_tip.lo <= g2,
            ),
            (Phase::Upper, _) => (stress.is_negative(), !stress.is_positive()),
            (Phase::Lower, _) => (stress.is_positive(), !stress.is_negative()),
        };
        if holds {
            self.proof.states.push(ProvedState {
                contact,
                n_value,
                u_tip,
            });
        } else if may_hold {
            let (s, width) = (n_value + 1.0, u_tip.width());
            let undecided = self.law.undecided(UndecidedReason::Touch, s, width);
            self.proof.undecided.push(undecided);
        }
    }
}

#[cfg(test)]
mod tests;
