//! Blocks of a step's linear system, three fields times q + 1 coefficients in time, and dense
//! matrices between them.

use crate::lanes::fma;

/// Coefficients in time of (v, w, θ~) at one block of the space.
pub(super) type Block<const S: usize> = [[f64; S]; 3];

/// A matrix that maps blocks to blocks, column by column: `matrix[field][stage]` is a column.
pub(super) type Matrix<const S: usize> = [[Block<S>; S]; 3];

/// The zero matrix.
pub(super) const fn zero<const S: usize>() -> Matrix<S> {
    [[[[0.0; S]; 3]; S]; 3]
}

/// `y -= A x`.
///
/// In place, as in [`multiply`]: the copy of a returned block would wait for its stores.
pub(super) fn subtract_product<const S: usize>(y: &mut Block<S>, matrix: &Matrix<S>, x: &Block<S>) {
    let mut sum = *y;
    for (columns, x) in matrix.iter().zip(x) {
        for (column, x) in columns.iter().zip(x) {
            add_multiple(&mut sum, column, -x);
        }
    }
    *y = sum;
}

/// `Σ_j x_j column_j` added to y.
#[inline(always)]
pub(super) fn add_columns<const S: usize>(y: &mut [f64; S], columns: &[[f64; S]; S], x: &[f64; S]) {
    for (column, x) in columns.iter().zip(x) {
        for (y, entry) in y.iter_mut().zip(column) {
            *y = fma(*entry, *x, *y);
        }
    }
}

/// Replaces x by `A x`.
pub(super) fn multiply<const S: usize>(matrix: &Matrix<S>, x: &mut Block<S>) {
    let mut sum = [[0.0; S]; 3];
    for (columns, x) in matrix.iter().zip(&*x) {
        for (column, x) in columns.iter().zip(x) {
            add_multiple(&mut sum, column, *x);
        }
    }
    *x = sum;
}

/// `A B`.
pub(super) fn matrix_product<const S: usize>(a: &Matrix<S>, b: &Matrix<S>) -> Matrix<S> {
    let mut c = *b;
    c.as_flattened_mut()
        .iter_mut()
        .for_each(|column| multiply(a, column));
    c
}

/// `C -= A B`.
pub(super) fn subtract_matrix_product<const S: usize>(
    c: &mut Matrix<S>,
    a: &Matrix<S>,
    b: &Matrix<S>,
) {
    for (c, b) in c.as_flattened_mut().iter_mut().zip(b.as_flattened()) {
        subtract_product(c, a, b);
    }
}

/// `A += B`.
pub(super) fn add<const S: usize>(a: &mut Matrix<S>, b: &Matrix<S>) {
    for (a, b) in a.as_flattened_mut().iter_mut().zip(b.as_flattened()) {
        add_multiple(a, b, 1.0);
    }
}

/// `y += factor x`.
#[inline(always)]
fn add_multiple<const S: usize>(y: &mut Block<S>, x: &Block<S>, factor: f64) {
    for (y, x) in y.as_flattened_mut().iter_mut().zip(x.as_flattened()) {
        *y = fma(factor, *x, *y);
    }
}

/// Replaces a matrix by its inverse, by Gauss-Jordan elimination without pivoting.
///
/// While the elastic energy at fixed axial force is positive, the symmetric part of the matrices
/// here has no negative eigenvalue, and no pivot is negative.
///
/// # Errors
/// The first pivot that is not positive.
pub(super) fn invert<const S: usize>(matrix: &mut Matrix<S>) -> Result<(), f64> {
    let columns = matrix.as_flattened_mut();
    for k in 0..3 * S {
        let (field, stage) = (k / S, k % S);
        let pivot_column = columns[k];
        let pivot = pivot_column[field][stage];
        if !(pivot > 0.0 && pivot.is_finite()) {
            return Err(pivot);
        }
        let inverse = 1.0 / pivot;
        for (j, column) in columns.iter_mut().enumerate() {
            if j == k {
                column
                    .as_flattened_mut()
                    .iter_mut()
                    .for_each(|entry| *entry *= -inverse);
                column[field][stage] = inverse;
            } else {
                let factor = column[field][stage] * inverse;
                add_multiple(column, &pivot_column, -factor);
                column[field][stage] = factor;
            }
        }
    }
    Ok(())
}

/// Gives a coefficient that does not exist, or is prescribed, the equation `x = 0`.
pub(super) fn isolate<const S: usize>(matrix: &mut Matrix<S>, field: usize) {
    clear_column(matrix, field);
    clear_row(matrix, field);
    for stage in 0..S {
        matrix[field][stage][field][stage] = 1.0;
    }
}

/// Sets the columns of a field to zero.
pub(super) fn clear_column<const S: usize>(matrix: &mut Matrix<S>, field: usize) {
    matrix[field] = [[[0.0; S]; 3]; S];
}

/// Sets the rows of a field to zero.
pub(super) fn clear_row<const S: usize>(matrix: &mut Matrix<S>, field: usize) {
    for column in matrix.as_flattened_mut() {
        column[field] = [0.0; S];
    }
}
