//! The spectral radius of the paper's iteration, linearised at a state.

use nalgebra::DVector;
use thermobeam::linearized::LinearizedIteration;

use crate::exact::dense::krylov_spectral_radius;

/// The spectral radius of the map of (δV, δW).
///
/// The first vector is 1 at every free node of both fields; it contains the layer at the free end
/// and all long waves. On 100 elements the result agrees with that of the dense matrix to 1e-6 at
/// every point of the study.
pub(super) fn spectral_radius(map: &mut LinearizedIteration) -> f64 {
    krylov_spectral_radius(2 * map.elements(), &mut |errors| apply(map, errors))
}

/// The image of (δV, δW) at the free nodes.
fn apply(map: &mut LinearizedIteration, errors: &DVector<f64>) -> DVector<f64> {
    let (of_v, of_w) = errors.as_slice().split_at(map.elements());
    let [mut v, mut w] = [of_v, of_w].map(|free| [&[0.0], free].concat());
    map.apply(&mut v, &mut w);
    DVector::from([&v[1..], &w[1..]].concat())
}
