//! Frequencies of the beam with elements of any degree on any mesh.

use std::convert::Infallible;

use thermobeam::bracket::bisect;
use thermobeam::dg::MAX_DEGREE;
use thermobeam::dg::element;
use thermobeam::mesh::Mesh;
use thiserror::Error;

/// The reason why these frequencies cannot be computed.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum SpectrumError {
    /// More frequencies requested than the mesh has.
    #[error(
        "frequencies of a mesh: expected at most {available}, found {count}: take fewer frequencies or more elements"
    )]
    Count {
        /// Number of frequencies requested.
        count: usize,
        /// Number of frequencies of the mesh, twice the degree times the number of elements.
        available: usize,
    },
    /// Invalid degree of the elements.
    #[error("degree of the elements: expected 1 to {MAX_DEGREE}, found {0}")]
    Degree(usize),
}

/// The `count` lowest ω of the semi-discrete beam, `(K - ω² M) x = 0`, in increasing order.
///
/// K and M are the matrices of `‖u_x - φ‖² + ‖φ_x‖²` and `‖u‖² + ‖φ‖²` on elements of degree p,
/// with exact integration and with u and φ clamped at node 0; for p = 1 as in (3.7) with a = β =
/// ρ = ζ = 0. As Rayleigh-Ritz values they lie above the exact ones, by O(h^2p); on a uniform mesh
/// of linear elements `ω_h - ω ≈ ω³h²/24` for high modes.
///
/// Method: the block LDLᵀ pivots of K - λM have as many negative eigenvalues as the pencil has
/// eigenvalues below λ (Sylvester). In each element the degrees from p down to 2 are eliminated
/// first, then the nodes from left to right. Bisection on that count separates eigenvalues at any
/// distance. The error of a frequency is at most round-off times the condition number, about
/// `ε n²/ω²` for linear elements, and usually far smaller.
///
/// # Errors
/// [`SpectrumError`] if `count` is more than 2np, or the degree is not one from 1 to
/// [`MAX_DEGREE`].
pub fn discrete_frequencies(
    mesh: &Mesh,
    degree: usize,
    count: usize,
) -> Result<Vec<f64>, SpectrumError> {
    let whole = discrete_frequencies_until(mesh, degree, count, |_| Ok::<(), Infallible>(()))?;
    Ok(whole.unwrap_or_else(|never| match never {}))
}

/// As [`discrete_frequencies`], but calls `may_go_on` before each count of the bisection, which
/// takes O(n p³) operations.
///
/// * `may_go_on(i)`: i frequencies are known; its error ends the computation.
/// * Returns the frequencies, or the error of `may_go_on`.
///
/// # Errors
/// As [`discrete_frequencies`].
pub fn discrete_frequencies_until<E>(
    mesh: &Mesh,
    degree: usize,
    count: usize,
    mut may_go_on: impl FnMut(usize) -> Result<(), E>,
) -> Result<Result<Vec<f64>, E>, SpectrumError> {
    if !(1..=MAX_DEGREE).contains(&degree) {
        return Err(SpectrumError::Degree(degree));
    }
    let lengths: Vec<f64> = mesh.lengths().collect();
    let available = 2 * lengths.len() * degree;
    if count > available {
        return Err(SpectrumError::Count { count, available });
    }
    let highest = spectral_bound(&lengths, degree);
    let mut stopped = None;
    let frequencies = (0..count).map(|index| {
        // Positive if more than `index` frequencies lie below omega.
        let excess = |omega: f64| {
            if stopped.is_none() {
                stopped = may_go_on(index).err();
            }
            // After that, bisection ends without further counts, in negligible time.
            if stopped.is_none() && count_below(&lengths, degree, omega * omega) > index {
                1.0
            } else {
                -1.0
            }
        };
        let omega = bisect(excess, 0.0, highest);
        stopped.take().map_or(Ok(omega), Err)
    });
    Ok(frequencies.collect())
}

/// An upper bound of all ω: `‖u' - φ‖² <= 2‖u'‖² + 2‖φ‖²`, and on each element
/// `‖w'‖² <= p (p + 1)² (p + 2)/h² ‖w‖²`, the sum of the squares of the slopes of orthonormal
/// Legendre polynomials.
fn spectral_bound(lengths: &[f64], degree: usize) -> f64 {
    let shortest = lengths.iter().copied().fold(f64::INFINITY, f64::min);
    let inverse = (degree * (degree + 1).pow(2) * (degree + 2)) as f64;
    (2.0 * inverse / (shortest * shortest) + 2.0).sqrt()
}

/// Number of eigenvalues ω² below `lambda`.
fn count_below(lengths: &[f64], degree: usize, lambda: f64) -> usize {
    let mut negative = 0;
    // The Schur complement of the current node's block after eliminating the elements to the left.
    let mut node = [[0.0; 2]; 2];
    for (i, &h) in lengths.iter().enumerate() {
        let mut element = ElementPencil::new(h, degree, lambda);
        negative += element.eliminate_inner();
        // Node 0 is clamped.
        if i > 0 {
            for (sum, entry) in element.entries[0]
                .as_flattened_mut()
                .iter_mut()
                .zip(node.as_flattened())
            {
                *sum += entry;
            }
            negative += element.eliminate(0, 1);
        }
        node = element.block(1);
    }
    negative + invert(node).0
}

/// K - λM of one element, in 2 x 2 blocks of (u, φ), one for each function of the basis: the hats,
/// then degrees 2 to p.
struct ElementPencil {
    blocks: usize,
    entries: Vec<[[f64; 2]; 2]>,
}

impl ElementPencil {
    fn new(h: f64, degree: usize, lambda: f64) -> Self {
        let blocks = degree + 1;
        let mut entries = Vec::with_capacity(blocks * blocks);
        for i in 0..blocks {
            for j in 0..blocks {
                let mass = 0.5 * h * element::mass(i, j);
                let stiffness = 2.0 / h * element::stiffness(i, j);
                // ‖u_x - φ‖²: u of the row with φ of the column, -(N_j, N_i').
                let shear = [element::coupling(i, j), element::coupling(j, i)];
                entries.push([
                    [stiffness - lambda * mass, -shear[0]],
                    [-shear[1], stiffness + mass - lambda * mass],
                ]);
            }
        }
        Self { blocks, entries }
    }

    /// Eliminates degrees p to 2. Returns how many of the pivots' eigenvalues are negative.
    fn eliminate_inner(&mut self) -> usize {
        (2..self.blocks)
            .rev()
            .map(|block| self.eliminate(block, block - 1))
            .sum()
    }

    /// Updates the blocks up to `last` after the elimination of `pivot`; counts its negative
    /// eigenvalues.
    fn eliminate(&mut self, pivot: usize, last: usize) -> usize {
        let (negative, inverse) = invert(self.block(pivot));
        let [[a, b], [_, d]] = inverse;
        for row in (0..=last).filter(|&row| row != pivot) {
            let of = self.entries[row * self.blocks + pivot];
            let product = of.map(|[u, phi]| [u * a + phi * b, u * b + phi * d]);
            for column in (0..=last).filter(|&column| column != pivot) {
                let from = self.entries[column * self.blocks + pivot];
                let entry = &mut self.entries[row * self.blocks + column];
                for (i, row) in entry.iter_mut().enumerate() {
                    for (j, value) in row.iter_mut().enumerate() {
                        *value -= product[i][0] * from[j][0] + product[i][1] * from[j][1];
                    }
                }
            }
        }
        negative
    }

    /// A block of the diagonal.
    fn block(&self, i: usize) -> [[f64; 2]; 2] {
        self.entries[i * self.blocks + i]
    }
}

/// Number of negative eigenvalues of a symmetric block, whose entry below the diagonal is not read,
/// and its inverse.
fn invert([[a, b], [_, d]]: [[f64; 2]; 2]) -> (usize, [[f64; 2]; 2]) {
    let mut determinant = a * d - b * b;
    if determinant == 0.0 {
        // λ is an eigenvalue of a leading part. A relative shift by round-off decides, as rounding
        // errors do for other λ.
        determinant =
            (f64::EPSILON * f64::EPSILON * (a * a + d * d + b * b)).max(f64::MIN_POSITIVE);
    }
    let negative = if determinant < 0.0 {
        1
    } else if a + d < 0.0 {
        2
    } else {
        0
    };
    (
        negative,
        [[d, -b], [-b, a]].map(|row| row.map(|entry| entry / determinant)),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_singular_block_is_shifted_by_round_off_to_the_positive_side() {
        let square = f64::EPSILON * f64::EPSILON;
        let scaled = |block| {
            let (negative, [[a, b], [_, d]]) = invert(block);
            (negative, [a * square, b * square, d * square])
        };
        assert_eq!(
            scaled([[1.0, 3.0], [3.0, 9.0]]),
            (0, [9.0 / 91.0, -3.0 / 91.0, 1.0 / 91.0])
        );
        let (negative, [[a, _], [_, d]]) = invert([[-4.0, 0.0], [0.0, 0.0]]);
        assert_eq!((negative, a, d * square), (2, 0.0, -0.25));
        assert_eq!(invert([[0.0; 2]; 2]), (0, [[0.0; 2]; 2]));
    }

    #[test]
    fn the_bisection_ends_when_it_is_told_to_and_changes_nothing_else() {
        let mesh = Mesh::uniform(8).unwrap();
        let whole = discrete_frequencies(&mesh, 1, 3).unwrap();
        let mut counts = vec![];
        let counted = discrete_frequencies_until(&mesh, 1, 3, |known| -> Result<(), ()> {
            counts.push(known);
            Ok(())
        });
        assert_eq!(counted, Ok(Ok(whole)));
        assert!(
            counts.is_sorted() && counts.len() > 3 * 50 && counts.last() == Some(&2),
            "{counts:?}"
        );
        for most in [0, 1, counts.len() / 2, counts.len() - 1] {
            let mut calls = 0;
            let stopped = discrete_frequencies_until(&mesh, 1, 3, |known| {
                calls += 1;
                if calls > most { Err(known) } else { Ok(()) }
            });
            assert_eq!(stopped, Ok(Err(counts[most])), "{most}");
            assert_eq!(calls, most + 1, "it is not asked again");
        }
    }

    #[test]
    fn all_frequencies_lie_below_the_spectral_bound() {
        let lengths = [0.5, 0.25, 0.25];
        assert_eq!(spectral_bound(&lengths, 1), (24.0 * 16.0 + 2.0_f64).sqrt());
        for degree in 1..=7 {
            let bound = spectral_bound(&lengths, degree);
            assert_eq!(
                count_below(&lengths, degree, bound * bound),
                6 * degree,
                "p = {degree}"
            );
            assert_eq!(
                count_below(&lengths, degree, 0.0),
                0,
                "K is positive definite"
            );
        }
    }
}
