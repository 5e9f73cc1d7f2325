//! Dense matrices of some dozens of rows: what the solver solves by sweeps, solved without them.

use std::ops::{Index, IndexMut};

/// A matrix, row by row.
#[derive(Debug, Clone, PartialEq)]
pub struct Dense {
    rows: usize,
    columns: usize,
    entries: Vec<f64>,
}

/// A solution of `A x = λ B x`.
#[derive(Debug, Clone, PartialEq)]
pub struct Eigenpair {
    /// λ.
    pub value: f64,
    /// x, with `xᵀ B x = 1` and any sign.
    pub vector: Vec<f64>,
}

impl Index<[usize; 2]> for Dense {
    type Output = f64;

    fn index(&self, [row, column]: [usize; 2]) -> &f64 {
        &self.entries[row * self.columns + column]
    }
}

impl IndexMut<[usize; 2]> for Dense {
    fn index_mut(&mut self, [row, column]: [usize; 2]) -> &mut f64 {
        &mut self.entries[row * self.columns + column]
    }
}

impl Dense {
    /// A matrix of zeros.
    pub fn zeros(rows: usize, columns: usize) -> Self {
        Self {
            rows,
            columns,
            entries: vec![0.0; rows * columns],
        }
    }

    /// The matrix with these entries, by row and column.
    pub fn from_fn(rows: usize, columns: usize, entry: impl Fn(usize, usize) -> f64) -> Self {
        let mut matrix = Self::zeros(rows, columns);
        for row in 0..rows {
            for column in 0..columns {
                matrix[[row, column]] = entry(row, column);
            }
        }
        matrix
    }

    /// A part, from this row and column on.
    pub fn part(&self, [row, column]: [usize; 2], rows: usize, columns: usize) -> Self {
        Self::from_fn(rows, columns, |i, j| self[[row + i, column + j]])
    }

    /// Puts another matrix in the place of a part, from this row and column on.
    pub fn put(&mut self, [row, column]: [usize; 2], part: &Dense) {
        for i in 0..part.rows {
            for j in 0..part.columns {
                self[[row + i, column + j]] = part[[i, j]];
            }
        }
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// A row.
    fn row(&self, row: usize) -> &[f64] {
        &self.entries[row * self.columns..(row + 1) * self.columns]
    }

    /// The transposed matrix.
    pub fn transpose(&self) -> Self {
        Self::from_fn(self.columns, self.rows, |row, column| self[[column, row]])
    }

    /// `self + factor * other`.
    pub fn plus(&self, factor: f64, other: &Dense) -> Self {
        let pairs = self.entries.iter().zip(&other.entries);
        Self {
            entries: pairs.map(|(own, other)| own + factor * other).collect(),
            ..*self
        }
    }

    /// The product with another matrix.
    pub fn times(&self, other: &Dense) -> Self {
        let mut product = Self::zeros(self.rows, other.columns);
        for row in 0..self.rows {
            for (k, factor) in self.row(row).iter().enumerate() {
                let target = &mut product.entries[row * other.columns..(row + 1) * other.columns];
                add(target, *factor, other.row(k));
            }
        }
        product
    }

    /// The product with a vector.
    pub fn multiply(&self, vector: &[f64]) -> Vec<f64> {
        (0..self.rows)
            .map(|row| dot(self.row(row), vector))
            .collect()
    }

    /// X of `self X = right`, by Gauss's elimination with the largest pivot of each column; `None`
    /// for a singular matrix, and where a number is none.
    pub fn solve(&self, right: &Dense) -> Option<Self> {
        let n = self.rows;
        let (mut matrix, mut right) = (self.clone(), right.clone());
        for k in 0..n {
            let size = |row: &usize| matrix[[*row, k]].abs();
            let pivot = (k..n).max_by(|i, j| size(i).total_cmp(&size(j)))?;
            if !(size(&pivot) > 0.0 && size(&pivot) < f64::INFINITY) {
                return None;
            }
            matrix.swap(k, pivot);
            right.swap(k, pivot);
            for row in k + 1..n {
                let factor = matrix[[row, k]] / matrix[[k, k]];
                matrix.subtract(row, factor, k);
                right.subtract(row, factor, k);
            }
        }
        for k in (0..n).rev() {
            for row in k + 1..n {
                right.subtract(k, matrix[[k, row]], row);
            }
            for column in 0..right.columns {
                right[[k, column]] /= matrix[[k, k]];
            }
        }
        Some(right)
    }

    /// The one vector x of `self x = right`; `None` as for [`solve`](Self::solve).
    pub fn solve_one(&self, right: &[f64]) -> Option<Vec<f64>> {
        let right = Self::from_fn(right.len(), 1, |row, _| right[row]);
        Some(self.solve(&right)?.entries)
    }

    /// Exchanges two rows.
    fn swap(&mut self, one: usize, other: usize) {
        for column in 0..self.columns {
            self.entries
                .swap(one * self.columns + column, other * self.columns + column);
        }
    }

    /// Subtracts a multiple of another row from a row.
    fn subtract(&mut self, row: usize, factor: f64, other: usize) {
        for column in 0..self.columns {
            self[[row, column]] -= factor * self[[other, column]];
        }
    }

    /// L, lower triangular, of `self = L Lᵀ`, for a symmetric matrix; `None` unless it is positive
    /// definite.
    fn cholesky(&self) -> Option<Self> {
        let n = self.rows;
        let mut lower = Self::zeros(n, n);
        for i in 0..n {
            for j in 0..=i {
                let rest = self[[i, j]] - dot(&lower.row(i)[..j], &lower.row(j)[..j]);
                lower[[i, j]] = if j < i {
                    rest / lower[[j, j]]
                } else if rest > 0.0 {
                    rest.sqrt()
                } else {
                    return None;
                };
            }
        }
        Some(lower)
    }

    /// X of `self X = right` for a lower triangular matrix.
    fn solve_lower(&self, right: &Dense) -> Self {
        let mut right = right.clone();
        for row in 0..self.rows {
            for k in 0..row {
                right.subtract(row, self[[row, k]], k);
            }
            for column in 0..right.columns {
                right[[row, column]] /= self[[row, row]];
            }
        }
        right
    }
}

/// The sum of the products of entries.
pub fn dot(one: &[f64], other: &[f64]) -> f64 {
    one.iter().zip(other).map(|(a, b)| a * b).sum()
}

/// Adds a multiple of a vector.
pub fn add(target: &mut [f64], factor: f64, other: &[f64]) {
    for (entry, other) in target.iter_mut().zip(other) {
        *entry += factor * other;
    }
}

/// Sweeps of Jacobi's method: it converges quadratically, for these sizes within ten.
const SWEEPS: usize = 30;

/// All solutions of `A x = λ B x` with symmetric matrices, increasing, by Jacobi's rotations of
/// `L⁻¹ A L⁻ᵀ` for `B = L Lᵀ`; `None` if B is not positive definite, or if
/// the rotations do not converge.
///
/// λ is the Rayleigh quotient of x: its error is the square of that of x.
pub fn eigenpairs(a: &Dense, b: &Dense) -> Option<Vec<Eigenpair>> {
    let n = a.rows;
    let lower = b.cholesky()?;
    let half = lower.solve_lower(a);
    let whole = lower.solve_lower(&half.transpose());
    // Symmetric but for rounding.
    let mut standard = Dense::from_fn(n, n, |i, j| 0.5 * (whole[[i, j]] + whole[[j, i]]));
    // Row k is the vector of entry k on the diagonal.
    let mut vectors = Dense::from_fn(n, n, |i, j| f64::from(u8::from(i == j)));
    let mut is_diagonal = false;
    for _ in 0..SWEEPS {
        is_diagonal = true;
        for i in 0..n {
            for j in i + 1..n {
                let small = f64::EPSILON * (standard[[i, i]] * standard[[j, j]]).abs().sqrt();
                if standard[[i, j]].abs() > 0.01 * small {
                    is_diagonal = false;
                    rotate(&mut standard, &mut vectors, [i, j]);
                }
            }
        }
        if is_diagonal {
            break;
        }
    }
    if !is_diagonal {
        return None;
    }
    // x of Lᵀ x = y.
    let upper = lower.transpose();
    let mut pairs = vec![];
    for k in 0..n {
        let vector = upper.solve_one(vectors.row(k))?;
        let value = dot(&vector, &a.multiply(&vector)) / dot(&vector, &b.multiply(&vector));
        pairs.push(Eigenpair { value, vector });
    }
    pairs.sort_by(|one, other| one.value.total_cmp(&other.value));
    Some(pairs)
}

/// Rotates rows and columns i and j of a symmetric matrix such that entry (i, j) vanishes:
/// `tan 2φ = 2 a_ij/(a_jj - a_ii)`, with the smaller of both angles.
fn rotate(matrix: &mut Dense, vectors: &mut Dense, [i, j]: [usize; 2]) {
    let cotangent = (matrix[[j, j]] - matrix[[i, i]]) / (2.0 * matrix[[i, j]]);
    let tangent = cotangent.signum() / (cotangent.abs() + cotangent.hypot(1.0));
    let cosine = 1.0 / tangent.hypot(1.0);
    let sine = tangent * cosine;
    for column in 0..matrix.columns {
        let [of_i, of_j] = [matrix[[i, column]], matrix[[j, column]]];
        matrix[[i, column]] = cosine * of_i - sine * of_j;
        matrix[[j, column]] = sine * of_i + cosine * of_j;
        let [of_i, of_j] = [vectors[[i, column]], vectors[[j, column]]];
        vectors[[i, column]] = cosine * of_i - sine * of_j;
        vectors[[j, column]] = sine * of_i + cosine * of_j;
    }
    for row in 0..matrix.rows {
        let [of_i, of_j] = [matrix[[row, i]], matrix[[row, j]]];
        matrix[[row, i]] = cosine * of_i - sine * of_j;
        matrix[[row, j]] = sine * of_i + cosine * of_j;
    }
    // Zero but for rounding.
    (matrix[[i, j]], matrix[[j, i]]) = (0.0, 0.0);
}

/// Squarings in the spectral radius: what the norm adds to it is divided by 2 to this power.
const SQUARINGS: i32 = 60;

/// The largest modulus of an eigenvalue, by Gelfand's formula `ρ(A) = lim ‖A^k‖^(1/k)` for
/// k = 1, 2, 4, ...: each power is the square of the one before, scaled to norm 1.
///
/// Rounding errors of a power are divided by k; powers of a defective matrix grow by a power of k,
/// which is nothing for the last k. NaN for a matrix with NaN.
pub fn spectral_radius(matrix: &Dense) -> f64 {
    let mut power = matrix.clone();
    let mut logarithm = 0.0;
    for squaring in 0..=SQUARINGS {
        let norm = dot(&power.entries, &power.entries).sqrt();
        if norm == 0.0 {
            return 0.0;
        }
        logarithm += norm.ln() * 0.5_f64.powi(squaring);
        power.entries.iter_mut().for_each(|entry| *entry /= norm);
        power = power.times(&power);
    }
    logarithm.exp()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Entries between -1 and 1 without a pattern.
    fn scattered(rows: usize, columns: usize, seed: u64) -> Dense {
        Dense::from_fn(rows, columns, |i, j| {
            let mixed = (seed + (i * 131 + j + 1) as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15);
            (mixed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        })
    }

    fn largest(matrix: &Dense) -> f64 {
        matrix
            .entries
            .iter()
            .fold(0.0, |most, entry| f64::max(most, entry.abs()))
    }

    #[test]
    fn a_solution_satisfies_its_equations_and_a_singular_matrix_has_none() {
        for n in [1, 2, 7, 40] {
            let mut matrix = scattered(n, n, 3);
            if n > 1 {
                // No pivot without an exchange of rows.
                matrix[[0, 0]] = 0.0;
            }
            let right = scattered(n, 3, 5);
            let solution = matrix.solve(&right).unwrap();
            let rest = largest(&matrix.times(&solution).plus(-1.0, &right));
            assert!(rest < 1e-13 * largest(&solution) * n as f64, "{n}: {rest}");
        }
        let rank_one = Dense::from_fn(3, 3, |i, j| ((i + 1) * (j + 1)) as f64);
        assert_eq!(rank_one.solve(&scattered(3, 1, 1)), None);
        let none = Dense::from_fn(2, 2, |_, _| f64::NAN);
        assert_eq!(none.solve_one(&[1.0, 1.0]), None);
    }

    /// A x = λ B x, xᵀ B y = δ, and all values: their sum is the trace of B⁻¹ A.
    #[test]
    fn eigenpairs_satisfy_their_equations_and_are_all() {
        for n in [1, 2, 9, 32] {
            let [a, b] = [7, 11].map(|seed| scattered(n, n, seed));
            let a = a.plus(1.0, &a.transpose());
            let b = Dense::from_fn(n, n, |i, j| f64::from(u8::from(i == j)))
                .plus(0.5, &b.times(&b.transpose()));
            let pairs = eigenpairs(&a, &b).unwrap();
            for (k, Eigenpair { value, vector }) in pairs.iter().enumerate() {
                let [left, right] = [a.multiply(vector), b.multiply(vector)];
                let rest = left.iter().zip(&right).map(|(l, r)| (l - value * r).abs());
                assert!(rest.fold(0.0, f64::max) < 1e-12, "{n}: {k}");
                for (l, other) in pairs.iter().enumerate() {
                    let expected = f64::from(u8::from(k == l));
                    assert!((dot(&other.vector, &right) - expected).abs() < 1e-12);
                }
            }
            let of_both = b.solve(&a).unwrap();
            let trace: f64 = (0..n).map(|k| of_both[[k, k]]).sum();
            let sum: f64 = pairs.iter().map(|pair| pair.value).sum();
            assert!((trace - sum).abs() < 1e-12 * n as f64, "{trace} {sum}");
            assert!(pairs.is_sorted_by(|one, other| one.value <= other.value));
        }
        let indefinite = Dense::from_fn(2, 2, |i, j| if i == j { 0.5 } else { 1.0 });
        assert_eq!(eigenpairs(&indefinite, &indefinite), None);
    }

    /// Second differences: λ_k = 4 sin²(kπ/(2(n + 1))), one twice as a block of both.
    #[test]
    fn equal_and_close_eigenvalues_are_found() {
        let n = 12;
        let single = |i: usize, j: usize| match i.abs_diff(j) {
            0 => 2.0,
            1 => -1.0,
            _ => 0.0,
        };
        let twice = Dense::from_fn(2 * n, 2 * n, |i, j| {
            if i / n == j / n {
                single(i % n, j % n)
            } else {
                0.0
            }
        });
        let identity = Dense::from_fn(2 * n, 2 * n, |i, j| f64::from(u8::from(i == j)));
        for (k, pair) in eigenpairs(&twice, &identity).unwrap().iter().enumerate() {
            let angle = (k / 2 + 1) as f64 * std::f64::consts::PI / (2.0 * (n + 1) as f64);
            let expected = 4.0 * angle.sin().powi(2);
            assert!((pair.value - expected).abs() < 1e-14, "{k}");
        }
    }

    /// Rounding beside eigenvalues that are zero does not keep the rotations going.
    #[test]
    fn eigenvalues_of_a_matrix_without_rank_are_found() {
        let n = 30;
        let vector: Vec<f64> = (0..n).map(|k| 1.0 + 0.37 * f64::from(k).sin()).collect();
        let rank_one = Dense::from_fn(vector.len(), vector.len(), |i, j| vector[i] * vector[j]);
        let identity = Dense::from_fn(vector.len(), vector.len(), |i, j| {
            f64::from(u8::from(i == j))
        });
        let pairs = eigenpairs(&rank_one, &identity).expect("rotations that converge");
        let (last, others) = pairs.split_last().expect("values");
        let length = dot(&vector, &vector);
        assert!((last.value - length).abs() < 1e-14 * length);
        assert!(others.iter().all(|pair| pair.value.abs() < 1e-14 * length));
    }

    #[test]
    fn the_spectral_radius_is_that_of_known_matrices() {
        let cases: [(&[f64], f64); 6] = [
            (&[3.0, 0.0, 0.0, -5.0], 5.0),
            // A complex pair, 0.6 ± 0.8 i, and one whose modulus is large.
            (&[0.6, -0.8, 0.8, 0.6], 1.0),
            (&[1.0, -1e3, 1e3, 1.0], 1e3_f64.hypot(1.0)),
            // Defective, nilpotent, far from normal.
            (&[0.7, 1.0, 0.0, 0.7], 0.7),
            (&[0.0, 1.0, 0.0, 0.0], 0.0),
            (&[0.5, 1e6, 0.0, 0.25], 0.5),
        ];
        for (entries, expected) in cases {
            let matrix = Dense::from_fn(2, 2, |i, j| entries[2 * i + j]);
            let found = spectral_radius(&matrix);
            assert!(
                (found - expected).abs() <= 1e-13 * expected,
                "{entries:?}: {found}"
            );
        }
        let none = Dense::from_fn(2, 2, |_, _| f64::NAN);
        assert!(spectral_radius(&none).is_nan());
    }
}
