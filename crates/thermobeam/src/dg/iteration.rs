//! The iterations of one step: what each of them did, and when they end.

use crate::error::StepFailure;

/// A factorisation is replaced if the iteration contracts more slowly than this and a better one is
/// possible.
const SLOW: f64 = 0.2;

/// Iterations that need not contract; a later one that does not is a divergence.
const FIRST_ITERATIONS: usize = 4;

/// Increments below this many rounding errors of the solution cannot shrink further.
const FLOOR: f64 = 16.0 * f64::EPSILON;

/// An iteration that has just been done.
pub(super) struct Iteration {
    /// From 1.
    pub(super) number: usize,
    /// The factorisation that it used; `None` before the first.
    pub(super) slot: Option<usize>,
    /// The mean axial force that it started from.
    pub(super) n_value: f64,
    /// The norm of the correction.
    pub(super) increment: f64,
    /// Of the solution, in the norm of the increments.
    pub(super) size: f64,
    /// The ratio of this increment to the one before: 0 at the first, NaN before it.
    pub(super) contraction: f64,
}

impl Iteration {
    /// Before the first.
    pub(super) const START: Self = Self {
        number: 0,
        slot: None,
        n_value: f64::NAN,
        increment: f64::INFINITY,
        size: f64::NAN,
        contraction: f64::NAN,
    };

    /// Whether the solution is within the tolerance, or as accurate as rounding errors allow.
    pub(super) fn has_converged(&self, tolerance: f64) -> bool {
        let Self {
            number,
            increment,
            size,
            contraction,
            ..
        } = *self;
        // Once their ratio is known, the sum of the remaining increments is at most this.
        let rest = if contraction < 0.5 {
            increment * contraction / (1.0 - contraction)
        } else {
            increment
        };
        let is_known = number > 1 && rest <= tolerance;
        // Round-off: further iterations change only the last digits.
        let is_stagnant =
            increment <= FLOOR * size || (contraction > 0.5 && increment <= 64.0 * FLOOR * size);
        increment <= tolerance || is_known || is_stagnant
    }

    /// Whether it contracts so slowly that another factorisation may pay.
    pub(super) fn is_slow(&self) -> bool {
        self.contraction > SLOW && self.number > 1
    }

    /// The failure of a step whose iteration does not contract.
    pub(super) fn divergence(&self) -> Option<StepFailure> {
        let is_diverging = self.contraction >= 1.0 && self.number > FIRST_ITERATIONS;
        is_diverging.then_some(StepFailure::Diverged {
            iterations: self.number,
            increment: self.increment,
            contraction: self.contraction,
            of: None,
        })
    }
}
