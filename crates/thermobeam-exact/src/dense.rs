//! Dense matrices of some dozens of rows, by nalgebra: what the solver solves by sweeps, solved
//! without them. Numbers that are none, and iterations without an end, are refused here.

use nalgebra::{DMatrix, DVector, Schur, SymmetricEigen};

/// A solution of `A x = λ B x`.
#[derive(Debug, Clone, PartialEq)]
pub struct Eigenpair {
    /// λ.
    pub value: f64,
    /// x, with `xᵀ B x = 1` and any sign.
    pub vector: DVector<f64>,
}

/// Steps of an iteration for each row of a matrix: two are usual.
const STEPS: usize = 100;
/// Most vectors of a Krylov space.
const VECTORS: usize = 30;
/// Share of a vector's length below which what is left of it is round-off: the Krylov space is then
/// invariant.
const INVARIANT: f64 = 1e-13;

/// X of `A X = right`, by LU factors; `None` for a singular matrix, and where a number is none.
pub fn solve(a: DMatrix<f64>, right: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    a.lu()
        .solve(right)
        .filter(|x| x.iter().all(|entry| entry.is_finite()))
}

/// All solutions of `A x = λ B x` with symmetric matrices, increasing, by those of `L⁻¹ A L⁻ᵀ` for
/// `B = L Lᵀ`; `None` if B is not positive definite, if the iteration does not converge, and where
/// a number is none.
///
/// λ is the Rayleigh quotient of x: its error is the square of that of x.
pub fn eigenpairs(a: &DMatrix<f64>, b: &DMatrix<f64>) -> Option<Vec<Eigenpair>> {
    let lower = b.clone().cholesky()?.unpack();
    let standard = lower.solve_lower_triangular(&lower.solve_lower_triangular(a)?.transpose())?;
    let most = STEPS * standard.nrows();
    let standard = SymmetricEigen::try_new(standard, f64::EPSILON, most)?;
    let vectors = lower.tr_solve_lower_triangular(&standard.eigenvectors)?;
    let mut pairs: Vec<Eigenpair> = vectors
        .column_iter()
        .map(|column| {
            let vector: DVector<f64> = column.into();
            let value = vector.dot(&(a * &vector)) / vector.dot(&(b * &vector));
            Eigenpair { value, vector }
        })
        .collect();
    pairs.sort_by(|one, other| one.value.total_cmp(&other.value));
    let is_finite = pairs.iter().all(|pair| pair.value.is_finite());
    is_finite.then_some(pairs)
}

/// The spectral radius of a linear map by Arnoldi's method: the largest modulus of an eigenvalue of
/// its projection to the space of v, M v, M² v, .... The entries of v are equal. With as many
/// vectors as unknowns, which are at least one, the projection is the map itself.
///
/// NaN where a number is none, and if the iteration for the eigenvalues does not converge.
pub fn krylov_spectral_radius(
    unknowns: usize,
    map: &mut dyn FnMut(&DVector<f64>) -> DVector<f64>,
) -> f64 {
    let most = VECTORS.min(unknowns);
    let length = (unknowns as f64).sqrt();
    let mut basis = vec![DVector::from_element(unknowns, 1.0 / length)];
    let mut projection = DMatrix::zeros(most, most);
    for k in 0..most {
        let mut image = map(&basis[k]);
        let length = image.norm();
        // Twice: one pass leaves round-off of the size of what it removes.
        for _ in 0..2 {
            for (row, vector) in basis.iter().enumerate() {
                let part = vector.dot(&image);
                image.axpy(-part, vector, 1.0);
                projection[(row, k)] += part;
            }
        }
        let rest = image.norm();
        if k + 1 == most || rest <= INVARIANT * length {
            projection = projection.resize(k + 1, k + 1, 0.0);
            break;
        }
        projection[(k + 1, k)] = rest;
        image /= rest;
        basis.push(image);
    }
    spectral_radius(projection)
}

/// The largest modulus of an eigenvalue; NaN for a matrix with a number that is none, and if the
/// iteration does not converge.
fn spectral_radius(matrix: DMatrix<f64>) -> f64 {
    if !matrix.iter().all(|entry| entry.is_finite()) {
        return f64::NAN;
    }
    let most = STEPS * matrix.nrows();
    let Some(schur) = Schur::try_new(matrix, f64::EPSILON, most) else {
        return f64::NAN;
    };
    let values = schur.complex_eigenvalues();
    let moduli = values.iter().map(|value| value.re.hypot(value.im));
    moduli.fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Entries between -1 and 1 without a pattern.
    fn scattered(rows: usize, columns: usize, seed: usize) -> DMatrix<f64> {
        DMatrix::from_fn(rows, columns, |i, j| {
            (((i * 31 + j + 1009 * seed) as f64 + 0.5) * 12.9898).sin()
        })
    }

    /// A X = B for `solve`; A x = λ B x, xᵀ B y = δ, and all values: their
    /// sum is the trace of B⁻¹ A.
    #[test]
    fn solutions_satisfy_their_equations_and_a_singular_matrix_has_none() {
        let n = 9;
        let [a, b] = [7, 11].map(|seed| scattered(n, n, seed));
        let one = DMatrix::identity(n, n);
        let (a, b) = (&a + a.transpose(), &one + &b * b.transpose() * 0.5);
        let quotient = solve(b.clone(), &a).unwrap();
        let pairs = eigenpairs(&a, &b).unwrap();
        let values = DVector::from_iterator(n, pairs.iter().map(|pair| pair.value));
        let vectors: Vec<_> = pairs.into_iter().map(|pair| pair.vector).collect();
        let vectors = DMatrix::from_columns(&vectors);
        for rest in [
            &b * &quotient - &a,
            &a * &vectors - &b * &vectors * DMatrix::from_diagonal(&values),
            vectors.transpose() * &b * &vectors - &one,
        ] {
            assert!(rest.amax() < 1e-12, "{rest}");
        }
        assert!((quotient.trace() - values.sum()).abs() < 1e-11);
        assert!(values.as_slice().is_sorted());
        let none = DMatrix::from_element(2, 2, f64::NAN);
        let rank_one = DMatrix::from_fn(2, 2, |i, j| ((i + 1) * (j + 1)) as f64);
        let indefinite = DMatrix::from_row_slice(2, 2, &[0.5, 1.0, 1.0, 0.5]);
        assert_eq!(
            [&rank_one, &none].map(|a| solve(a.clone(), &indefinite)),
            [None, None]
        );
        assert_eq!(eigenpairs(&indefinite, &indefinite), None);
        assert_eq!(eigenpairs(&none, &DMatrix::identity(2, 2)), None);
    }

    #[test]
    fn the_spectral_radius_is_that_of_known_matrices() {
        let cases: [([f64; 4], f64); 6] = [
            ([3.0, 0.0, 0.0, -5.0], 5.0),
            // A complex pair, 0.6 ± 0.8 i, and one whose modulus is large.
            ([0.6, -0.8, 0.8, 0.6], 1.0),
            ([1.0, -1e3, 1e3, 1.0], 1e3_f64.hypot(1.0)),
            // Defective, nilpotent, far from normal.
            ([0.7, 1.0, 0.0, 0.7], 0.7),
            ([0.0, 1.0, 0.0, 0.0], 0.0),
            ([0.5, 1e6, 0.0, 0.25], 0.5),
        ];
        for (entries, expected) in cases {
            let found = spectral_radius(DMatrix::from_row_slice(2, 2, &entries));
            assert!(
                (found - expected).abs() <= 1e-13 * expected,
                "{entries:?}: {found}"
            );
        }
        assert!(spectral_radius(DMatrix::from_element(2, 2, f64::NAN)).is_nan());
    }

    /// A matrix of more rows than a Krylov space has vectors, whose largest eigenvalue stands
    /// apart.
    #[test]
    fn the_spectral_radius_of_a_map_is_that_of_its_matrix() {
        for rows in [1, 2, 20, 80] {
            let mut matrix = scattered(rows, rows, 13) / rows as f64;
            matrix[(0, 0)] -= 3.0;
            let found = krylov_spectral_radius(rows, &mut |vector| &matrix * vector);
            let expected = spectral_radius(matrix.clone());
            assert!(
                (found / expected - 1.0).abs() < 1e-9,
                "{rows}: {found}, {expected}"
            );
        }
        let none = krylov_spectral_radius(2, &mut |_| DVector::from_element(2, f64::NAN));
        assert!(none.is_nan());
    }
}
