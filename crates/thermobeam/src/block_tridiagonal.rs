//! Symmetric block tridiagonal factorisation without pivoting, one block per node.
//!
//! `S_1 = D_1`, `S_i = D_i - O_i S_{i-1}⁻¹ O_iᵀ`; a solve is `y_i = r_i - G_i y_{i-1}` forward with
//! `G_i = O_i S_{i-1}⁻¹`, then `x_i = S_i⁻¹ y_i - G_{i+1}ᵀ x_{i+1}` backward. No pivoting is needed
//! because the matrix is quasi-definite: its displacement part is positive definite, its
//! temperature part negative definite. A pivot of the wrong sign therefore shows that the matrix is
//! not: the beam is beyond its buckling force.

use crate::error::{StepFailure, StepMatrix};
use crate::lanes::{Lane, MultiplyAdd};

/// A block, row by row.
pub(crate) type Block<T, const B: usize> = [[T; B]; B];

/// The factors at one node.
#[derive(Debug, Clone, Copy)]
pub(crate) struct NodeFactors<T, const B: usize> {
    /// `G_i = O_i S_{i-1}⁻¹`, zero at the first node.
    pub(crate) multiplier: Block<T, B>,
    /// `S_i⁻¹`, symmetric.
    pub(crate) inverse: Block<T, B>,
}

// The loops below write arrays in place, which the compiler keeps in registers, unlike those of
// `std::array::from_fn`.

/// `matrix * vector`.
#[inline(always)]
pub(crate) fn times<A: MultiplyAdd, T: Lane, const B: usize>(
    matrix: &Block<T, B>,
    vector: [T; B],
) -> [T; B] {
    let mut product = vector;
    for row in 0..B {
        let mut sum = matrix[row][0] * vector[0];
        for column in 1..B {
            sum = matrix[row][column].mul_add::<A>(vector[column], sum);
        }
        product[row] = sum;
    }
    product
}

/// `start - matrix * vector`.
#[inline(always)]
pub(crate) fn minus_times<A: MultiplyAdd, T: Lane, const B: usize>(
    start: [T; B],
    matrix: &Block<T, B>,
    vector: [T; B],
) -> [T; B] {
    let mut result = start;
    for row in 0..B {
        for column in 0..B {
            result[row] = (-matrix[row][column]).mul_add::<A>(vector[column], result[row]);
        }
    }
    result
}

/// `start - matrixᵀ * vector`.
#[inline(always)]
pub(crate) fn minus_transpose_times<A: MultiplyAdd, T: Lane, const B: usize>(
    start: [T; B],
    matrix: &Block<T, B>,
    vector: [T; B],
) -> [T; B] {
    let mut result = start;
    for row in 0..B {
        for column in 0..B {
            result[row] = (-matrix[column][row]).mul_add::<A>(vector[column], result[row]);
        }
    }
    result
}

/// Inverse of a symmetric block by Gauss-Jordan elimination with diagonal pivots.
///
/// Pivot k must have the sign of `signs[k]`; the first that does not (NaN included) is returned as
/// an error.
#[inline(always)] // Unrolled for the constant signs of its caller; not inlined, a factorisation takes half as long again.
fn invert<const B: usize>(mut block: Block<f64, B>, signs: [f64; B]) -> Result<Block<f64, B>, f64> {
    for k in 0..B {
        let pivot = block[k][k];
        // Also true for NaN.
        if !(pivot * signs[k] > 0.0) {
            return Err(pivot);
        }
        let scale = 1.0 / pivot;
        block[k][k] = 1.0;
        for column in 0..B {
            block[k][column] *= scale;
        }
        for row in (0..B).filter(|&row| row != k) {
            let factor = block[row][k];
            block[row][k] = 0.0;
            for column in 0..B {
                block[row][column] -= factor * block[k][column];
            }
        }
    }
    Ok(block)
}

/// The signs of the pivots of displacement, rotation and temperature.
fn signs<const B: usize>() -> [f64; B] {
    std::array::from_fn(|k| if k == 2 { -1.0 } else { 1.0 })
}

/// An uninitialised factorisation for n elements: a [`NodeFactors`] for each unknown node 1..n;
/// entry 0 is unused.
pub(crate) fn uninitialised<T: Lane, const B: usize>(elements: usize) -> Vec<NodeFactors<T, B>> {
    let zero = [[T::splat(0.0); B]; B];
    vec![
        NodeFactors {
            multiplier: zero,
            inverse: zero
        };
        elements + 1
    ]
}

/// Factorises the matrix of case `lane`; `blocks(i)` gives `(O_i, D_i)` for node i = 1..n.
///
/// # Errors
/// [`StepFailure::Indefinite`] at the first pivot of the wrong sign; the factorisation is then
/// unusable.
pub(crate) fn factorize<T: Lane, const B: usize>(
    nodes: &mut [NodeFactors<T, B>],
    lane: usize,
    n_value: f64,
    mut blocks: impl FnMut(usize) -> (Block<f64, B>, Block<f64, B>),
) -> Result<(), StepFailure> {
    let mut inverse = [[0.0; B]; B];
    for (node, stored) in nodes.iter_mut().enumerate().skip(1) {
        let (lower, mut pivot_block) = blocks(node);
        // `inverse` is zero at the first node, whose left neighbour is clamped.
        let mut multiplier = [[0.0; B]; B];
        for row in 0..B {
            for column in 0..B {
                multiplier[row][column] = (0..B).map(|k| lower[row][k] * inverse[k][column]).sum();
            }
        }
        for row in 0..B {
            for column in 0..B {
                let update: f64 = (0..B).map(|k| multiplier[row][k] * lower[column][k]).sum();
                pivot_block[row][column] -= update;
            }
        }
        inverse = invert(pivot_block, signs()).map_err(|pivot| StepFailure::Indefinite {
            node,
            pivot,
            n_value,
            of: StepMatrix::Coupled,
        })?;
        for row in 0..B {
            for column in 0..B {
                stored.multiplier[row][column].set_lane(lane, multiplier[row][column]);
                stored.inverse[row][column].set_lane(lane, inverse[row][column]);
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pivot_that_is_zero_or_nan_or_of_the_wrong_sign_is_rejected() {
        for pivot in [0.0, -1.0, f64::NAN] {
            let refused = invert([[1.0, 0.0], [0.0, pivot]], [1.0, 1.0]).unwrap_err();
            assert_eq!(refused.to_bits(), pivot.to_bits());
        }
        assert_eq!(
            invert([[1.0, 0.0], [0.0, -4.0]], [1.0, -1.0]),
            Ok([[1.0, 0.0], [0.0, -0.25]])
        );
    }

    #[test]
    fn a_pivot_of_the_wrong_sign_is_reported_with_its_node() {
        let mut nodes = uninitialised::<f64, 2>(3);
        let failure = factorize(&mut nodes, 0, -0.9, |node| {
            let d = if node == 3 { -1.0 } else { 1.0 };
            ([[0.0; 2]; 2], [[d, 0.0], [0.0, 1.0]])
        });
        assert_eq!(
            failure,
            Err(StepFailure::Indefinite {
                node: 3,
                pivot: -1.0,
                n_value: -0.9,
                of: StepMatrix::Coupled,
            })
        );
    }
}
