//! The spectral radius of the paper's iteration, linearised at a state.

use nalgebra::{DMatrix, DVector};
use thermobeam::linearized::LinearizedIteration;

use crate::kinds::prelude::max_or_nan;

/// Vectors of the Krylov space: on 100 elements its largest eigenvalue agrees with that of the
/// dense matrix to 1e-6 at every point of the study.
const VECTORS: usize = 30;
/// Share of a vector's length below which what is left of it is round-off: the Krylov space is then
/// invariant.
const INVARIANT: f64 = 1e-13;

/// The spectral radius of the map of (δV, δW), by Arnoldi's method: the largest modulus of an
/// eigenvalue of the map's projection to the space of v, M v, M² v, ....
///
/// The first vector is 1 at every free node of both fields; it contains the layer at the free end
/// and all long waves. With as many vectors as unknowns the projection is the map itself.
pub(super) fn spectral_radius(map: &mut LinearizedIteration) -> f64 {
    let unknowns = 2 * map.elements();
    let most = VECTORS.min(unknowns);
    let mut basis = vec![DVector::from_element(unknowns, 1.0).normalize()];
    let mut projection = DMatrix::zeros(most, most);
    for k in 0..most {
        let mut image = apply(map, &basis[k]);
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
            projection = projection.view((0, 0), (k + 1, k + 1)).into_owned();
            break;
        }
        projection[(k + 1, k)] = rest;
        basis.push(image / rest);
    }
    projection
        .complex_eigenvalues()
        .iter()
        .map(|value| value.re.hypot(value.im))
        .fold(0.0, max_or_nan)
}

/// The image of (δV, δW) at the free nodes.
fn apply(map: &mut LinearizedIteration, errors: &DVector<f64>) -> DVector<f64> {
    let n = map.elements();
    let clamped = std::iter::once(&0.0);
    let mut v: Vec<f64> = clamped
        .clone()
        .chain(errors.rows(0, n).iter())
        .copied()
        .collect();
    let mut w: Vec<f64> = clamped.chain(errors.rows(n, n).iter()).copied().collect();
    map.apply(&mut v, &mut w);
    DVector::from_iterator(2 * n, v[1..].iter().chain(&w[1..]).copied())
}
