//! The spectral radius of the paper's iteration, linearised at a state.

use nalgebra::{DMatrix, DVector};
use thermobeam::linearized::LinearizedIteration;

use crate::exact::dense;

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
    let mut basis = vec![DVector::from_element(
        unknowns,
        1.0 / (unknowns as f64).sqrt(),
    )];
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
            projection = projection.resize(k + 1, k + 1, 0.0);
            break;
        }
        projection[(k + 1, k)] = rest;
        image /= rest;
        basis.push(image);
    }
    dense::spectral_radius(projection)
}

/// The image of (δV, δW) at the free nodes.
fn apply(map: &mut LinearizedIteration, errors: &DVector<f64>) -> DVector<f64> {
    let (of_v, of_w) = errors.as_slice().split_at(map.elements());
    let [mut v, mut w] = [of_v, of_w].map(|free| [&[0.0], free].concat());
    map.apply(&mut v, &mut w);
    DVector::from([&v[1..], &w[1..]].concat())
}
