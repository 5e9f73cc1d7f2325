//! Dense matrices against nalgebra, whose methods are others.

use nalgebra::DMatrix;
use thermobeam_exact::dense::{Dense, eigenpairs, spectral_radius};

/// Entries between -1 and 1 without a pattern.
fn scattered(i: usize, j: usize) -> f64 {
    (((i * 31 + j) as f64 + 0.5) * 12.9898).sin()
}

#[test]
fn spectral_radii_and_eigenvalues_are_those_of_another_library() {
    for n in [2, 5, 30] {
        let radius = spectral_radius(&Dense::from_fn(n, n, scattered));
        let values = DMatrix::from_fn(n, n, scattered).complex_eigenvalues();
        let largest = values.iter().map(|value| value.re.hypot(value.im));
        let largest = largest.fold(0.0, f64::max);
        assert!(
            (radius - largest).abs() < 1e-12 * largest,
            "{n}: {radius} {largest}"
        );

        let symmetric = |i: usize, j: usize| scattered(i, j) + scattered(j, i);
        let identity = Dense::from_fn(n, n, |i, j| f64::from(u8::from(i == j)));
        let pairs = eigenpairs(&Dense::from_fn(n, n, symmetric), &identity).unwrap();
        let mut values = DMatrix::from_fn(n, n, symmetric).symmetric_eigenvalues();
        values.as_mut_slice().sort_by(f64::total_cmp);
        for (pair, value) in pairs.iter().zip(&values) {
            assert!(
                (pair.value - value).abs() < 1e-12 * n as f64,
                "{n}: {value}"
            );
        }
        assert_eq!(pairs.len(), n);
    }
}
