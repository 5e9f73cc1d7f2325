//! Frequencies of the beam with P1 elements on any mesh.

use std::convert::Infallible;

use crate::bracket::bisect;
use crate::mesh::Mesh;
use thiserror::Error;

/// More frequencies requested than the mesh has.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("frequencies of a mesh: expected at most {available}, found {count}: take fewer frequencies or more elements")]
pub struct SpectrumError {
    /// Number of frequencies requested.
    pub count: usize,
    /// Number of frequencies of the mesh, twice the number of elements.
    pub available: usize,
}

/// A symmetric 2 x 2 block `[[a, b], [b, d]]`.
#[derive(Debug, Clone, Copy)]
struct Symmetric {
    a: f64,
    b: f64,
    d: f64,
}

/// The `count` lowest ω of the semi-discrete beam, `(K - ω² M) x = 0`, in increasing order.
///
/// K and M are the P1 matrices of `‖u_x - φ‖² + ‖φ_x‖²` and `‖u‖² + ‖φ‖²` with exact integration and with u and φ
/// clamped at node 0, as in (3.7) with a = β = ρ = ζ = 0. On a uniform mesh ω_h - ω ≈ ω³h²/24 for high modes.
///
/// Method: the block LDLᵀ pivots of K - λM, block tridiagonal with 2 x 2 blocks, have as many negative eigenvalues as
/// the pencil has eigenvalues below λ (Sylvester). Bisection on that count separates eigenvalues however close they
/// are. The error of a frequency is at most round-off times the condition number, about `ε n²/ω²`, and mostly far
/// smaller.
///
/// # Errors
/// [`SpectrumError`] if `count` is more than 2n.
pub fn discrete_frequencies(mesh: &Mesh, count: usize) -> Result<Vec<f64>, SpectrumError> {
    let whole = discrete_frequencies_until(mesh, count, |_| Ok::<(), Infallible>(()))?;
    Ok(whole.unwrap_or_else(|never| match never {}))
}

/// As [`discrete_frequencies`], and `may_go_on` is asked before each count of the bisection, which takes O(n) operations.
///
/// * `may_go_on(i)`: i frequencies are known; its error ends the computation.
/// * Returns the frequencies, or the error of `may_go_on`.
///
/// # Errors
/// [`SpectrumError`] if `count` is more than 2n.
pub fn discrete_frequencies_until<E>(
    mesh: &Mesh,
    count: usize,
    mut may_go_on: impl FnMut(usize) -> Result<(), E>,
) -> Result<Result<Vec<f64>, E>, SpectrumError> {
    let lengths: Vec<f64> = mesh.lengths().collect();
    let available = 2 * lengths.len();
    if count > available {
        return Err(SpectrumError { count, available });
    }
    let highest = spectral_bound(&lengths);
    let mut stopped = None;
    let mut below = |index: usize| {
        // Positive if more than `index` frequencies lie below omega.
        let excess = |omega: f64| {
            if stopped.is_none() {
                stopped = may_go_on(index).err();
            }
            // After the end, bisection runs out without a count, which takes no time.
            if stopped.is_none() && count_below(&lengths, omega * omega) > index { 1.0 } else { -1.0 }
        };
        let found = bisect(excess, 0.0, highest);
        stopped.take().map_or(Ok(found), Err)
    };
    Ok((0..count).map(&mut below).collect())
}

/// An upper bound of all ω: on each element `‖w'‖² <= 12/h² ‖w‖²` and `‖u' - φ‖² <= 2‖u'‖² + 2‖φ‖²`.
fn spectral_bound(lengths: &[f64]) -> f64 {
    let shortest = lengths.iter().copied().fold(f64::INFINITY, f64::min);
    (24.0 / (shortest * shortest) + 2.0).sqrt()
}

/// Number of eigenvalues ω² below `lambda`.
fn count_below(lengths: &[f64], lambda: f64) -> usize {
    let mut negative = 0;
    let mut previous: Option<Symmetric> = None;
    for (i, &left) in lengths.iter().enumerate() {
        let mut pivot = diagonal(left, lengths.get(i + 1).copied(), lambda);
        if let Some(inverse) = previous {
            subtract_congruence(&mut pivot, inverse, left, lambda);
        }
        let (count, inverse) = invert(pivot);
        negative += count;
        previous = Some(inverse);
    }
    negative
}

/// The diagonal block of a node between elements of lengths `left` and `right` (`None` at the tip).
fn diagonal(left: f64, right: Option<f64>, lambda: f64) -> Symmetric {
    let lengths = left + right.unwrap_or(0.0);
    let stiffness = 1.0 / left + right.map_or(0.0, f64::recip);
    let mass = lengths / 3.0;
    // (N_i, N_i'): 1/2 from the left element, -1/2 from the right.
    let coupling = if right.is_some() { 0.0 } else { 0.5 };
    Symmetric { a: stiffness - lambda * mass, b: -coupling, d: stiffness + mass - lambda * mass }
}

/// `pivot -= F P Fᵀ`, with P the inverse of the previous pivot and F the subdiagonal block, across an element of length
/// h.
fn subtract_congruence(pivot: &mut Symmetric, inverse: Symmetric, h: f64, lambda: f64) {
    let mass = h / 6.0;
    let (u, phi) = (-1.0 / h - lambda * mass, -1.0 / h + mass - lambda * mass);
    // Rows (u, φ) of the right node, columns of the left: -(φ_left, N_right') = -1/2, -(u_left', N_right) = +1/2.
    let f = [[u, -0.5], [0.5, phi]];
    let product = |row: [f64; 2]| [row[0] * inverse.a + row[1] * inverse.b, row[0] * inverse.b + row[1] * inverse.d];
    let (first, second) = (product(f[0]), product(f[1]));
    pivot.a -= first[0] * f[0][0] + first[1] * f[0][1];
    pivot.b -= first[0] * f[1][0] + first[1] * f[1][1];
    pivot.d -= second[0] * f[1][0] + second[1] * f[1][1];
}

/// Number of negative eigenvalues of the block, and its inverse.
fn invert(block: Symmetric) -> (usize, Symmetric) {
    let Symmetric { a, b, d } = block;
    let mut determinant = a * d - b * b;
    if determinant == 0.0 {
        // λ is an eigenvalue of a leading part. A relative shift by round-off decides, as rounding errors do for other
        // λ.
        determinant = (f64::EPSILON * f64::EPSILON * (a * a + d * d + b * b)).max(f64::MIN_POSITIVE);
    }
    let negative = if determinant < 0.0 {
        1
    } else if a + d < 0.0 {
        2
    } else {
        0
    };
    (negative, Symmetric { a: d / determinant, b: -b / determinant, d: a / determinant })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_singular_block_is_shifted_by_round_off_to_the_positive_side() {
        let square = f64::EPSILON * f64::EPSILON;
        let (negative, inverse) = invert(Symmetric { a: 1.0, b: 3.0, d: 9.0 });
        assert_eq!((negative, inverse.a * square), (0, 9.0 / 91.0));
        assert_eq!((inverse.b * square, inverse.d * square), (-3.0 / 91.0, 1.0 / 91.0));
        let (negative, inverse) = invert(Symmetric { a: -4.0, b: 0.0, d: 0.0 });
        assert_eq!((negative, inverse.a, inverse.d * square), (2, 0.0, -0.25));
        let (negative, inverse) = invert(Symmetric { a: 0.0, b: 0.0, d: 0.0 });
        assert_eq!((negative, inverse.a, inverse.d), (0, 0.0, 0.0));
    }

    #[test]
    fn the_bisection_ends_when_it_is_told_to_and_changes_nothing_else() {
        let mesh = Mesh::uniform(8).unwrap();
        let whole = discrete_frequencies(&mesh, 3).unwrap();
        let mut asked = vec![];
        let counted = discrete_frequencies_until(&mesh, 3, |known| -> Result<(), ()> {
            asked.push(known);
            Ok(())
        });
        assert_eq!(counted, Ok(Ok(whole)));
        assert!(asked.is_sorted() && asked.len() > 3 * 50 && asked.last() == Some(&2), "{asked:?}");
        for most in [0, 1, asked.len() / 2, asked.len() - 1] {
            let mut calls = 0;
            let stopped = discrete_frequencies_until(&mesh, 3, |known| {
                calls += 1;
                if calls > most { Err(known) } else { Ok(()) }
            });
            assert_eq!(stopped, Ok(Err(asked[most])), "{most}");
            assert_eq!(calls, most + 1, "it is not asked again");
        }
    }

    #[test]
    fn negative_eigenvalues_of_a_block_are_counted() {
        for (a, b, d, negative) in [(2.0, 1.0, 3.0, 0), (2.0, 3.0, 3.0, 1), (-1.0, 0.5, 4.0, 1), (-2.0, 1.0, -3.0, 2)] {
            let (found, inverse) = invert(Symmetric { a, b, d });
            assert_eq!(found, negative, "{a} {b} {d}");
            let identity =
                [a * inverse.a + b * inverse.b, a * inverse.b + b * inverse.d, b * inverse.b + d * inverse.d];
            assert!(
                identity.iter().zip([1.0, 0.0, 1.0]).all(|(found, one)| (found - one).abs() < 1e-15),
                "{identity:?}"
            );
        }
    }

    #[test]
    fn all_frequencies_lie_below_the_spectral_bound() {
        let bound = spectral_bound(&[0.5, 0.25, 0.25]);
        assert_eq!(bound, (24.0 * 16.0 + 2.0_f64).sqrt());
        assert_eq!(count_below(&[0.5, 0.25, 0.25], bound * bound), 6);
    }
}
