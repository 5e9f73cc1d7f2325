//! Symmetric positive definite tridiagonal systems with one scalar per node.

use crate::error::{StepFailure, StepMatrix};

/// The factorisation `L D Lᵀ` of `mass M + stiffness K` restricted to the nodes 1..=last.
#[derive(Debug, Clone)]
pub struct TridiagonalFactor {
    /// Subdiagonal of L, one entry per node.
    multiplier: Vec<f64>,
    /// Inverse pivots.
    inverse: Vec<f64>,
}

impl TridiagonalFactor {
    /// An uninitialised factorisation for the nodes 1..=last; `last` is n, or n - 1 for a
    /// prescribed value at the tip.
    pub fn new(last: usize) -> Self {
        Self {
            multiplier: vec![0.0; last + 1],
            inverse: vec![0.0; last + 1],
        }
    }

    /// Factorises `mass M + stiffness K`, rows and columns 1..=last.
    ///
    /// * `lengths`: the n element lengths.
    /// * `n_value`: the axial force, for the error only.
    ///
    /// # Errors
    /// [`StepFailure::Indefinite`] at the first pivot that is not positive.
    pub fn factorize(
        &mut self,
        lengths: &[f64],
        mass: f64,
        stiffness: f64,
        n_value: f64,
    ) -> Result<(), StepFailure> {
        let mut previous_inverse = 0.0;
        for i in 1..self.inverse.len() {
            let left = lengths[i - 1];
            let mut pivot = mass * left / 3.0 + stiffness / left;
            if let Some(right) = lengths.get(i) {
                pivot += mass * right / 3.0 + stiffness / right;
            }
            let lower = mass * left / 6.0 - stiffness / left;
            self.multiplier[i] = lower * previous_inverse;
            pivot -= self.multiplier[i] * lower;
            if !(pivot > 0.0) {
                return Err(StepFailure::Indefinite {
                    node: i,
                    pivot,
                    n_value,
                    of: StepMatrix::OneField,
                });
            }
            previous_inverse = 1.0 / pivot;
            self.inverse[i] = previous_inverse;
        }
        Ok(())
    }

    /// Replaces the right-hand side at the nodes 1..=last by the solution.
    pub fn solve_in_place(&self, x: &mut [f64]) {
        let last = self.inverse.len() - 1;
        for i in 2..=last {
            x[i] -= self.multiplier[i] * x[i - 1];
        }
        x[last] *= self.inverse[last];
        for i in (1..last).rev() {
            x[i] = x[i] * self.inverse[i] - self.multiplier[i + 1] * x[i + 1];
        }
    }

    /// The last node.
    pub(crate) fn last(&self) -> usize {
        self.inverse.len() - 1
    }

    /// Entry (last, last) of the inverse matrix, the reciprocal of the last pivot.
    pub fn last_of_inverse(&self) -> f64 {
        self.inverse[self.inverse.len() - 1]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_zero_pivot_is_rejected() {
        let mut factor = TridiagonalFactor::new(1);
        // One element of length 1: mass/3 + stiffness = 0, exact in binary.
        let refused = factor.factorize(&[1.0], 0.75, -0.25, -2.0);
        assert_eq!(
            refused,
            Err(StepFailure::Indefinite {
                node: 1,
                pivot: 0.0,
                n_value: -2.0,
                of: StepMatrix::OneField,
            })
        );
        assert_eq!(factor.factorize(&[1.0], 0.75, -0.125, -2.0), Ok(()));
    }
}
