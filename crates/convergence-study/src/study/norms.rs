//! Norms of errors at points or in cells, as errors of one study.

use super::outcome::LevelErrors;
use crate::column::{INSIDE, MAX};
use crate::text::number::max_or_nan;

/// The norms L1, L2, `max` and `max inside` of errors: four errors of one study, which says whether
/// the boundary has lost the order.
///
/// An error at few points is invisible in L1 and plain in the maximum; and a maximum that leaves
/// the ends out hides what happens there. NaN is kept.
///
/// * `errors`: at points or in cells, of any sign; `weights`: the size of the cell of each, or its
///   weight in a quadrature; `boundary`: whether each is at the boundary.
///
/// # Panics
/// The lists differ in length, a weight is negative or not finite, or all points are at the
/// boundary.
///
/// ```
/// // Second order inside, first order at the ends.
/// let solve = |n: usize| {
///     let h = 1.0 / n as f64;
///     let at_end = |i: usize| i == 0 || i == n;
///     let error = |i: usize| if at_end(i) { 0.1 * h } else { h * h * (i as f64 * h).exp() };
///     let errors: Vec<f64> = (0..=n).map(error).collect();
///     let boundary: Vec<bool> = (0..=n).map(at_end).collect();
///     convergence_study::norms(&errors, &vec![h; n + 1], &boundary)
/// };
/// let study = convergence_study::levels([16, 32, 64, 128, 256], solve);
/// let found = study.claim("max inside", 2.0).run();
/// assert!(!found.outcome.verdict.is_pass());
/// assert!(found.explained().contains("the boundary loses the order"));
/// ```
#[track_caller]
pub fn norms(errors: &[f64], weights: &[f64], boundary: &[bool]) -> [(&'static str, f64); 4] {
    let of_all = all_norms(errors, weights);
    let [l1, l2, max] = of_all.unwrap_or_else(|message| panic!("{message}"));
    let inside = largest_inside(errors, boundary).unwrap_or_else(|message| panic!("{message}"));
    [l1, l2, max, (INSIDE, inside)]
}

impl LevelErrors {
    /// As [`norms`], for callers that refuse lists; without `boundary` the maximum inside is left
    /// out.
    ///
    /// # Errors
    /// The list that does not fit, and why.
    pub fn norms(
        errors: &[f64],
        weights: &[f64],
        boundary: Option<&[bool]>,
    ) -> Result<Vec<(&'static str, f64)>, String> {
        let mut found = all_norms(errors, weights)?.to_vec();
        if let Some(boundary) = boundary {
            found.push((INSIDE, largest_inside(errors, boundary)?));
        }
        Ok(found)
    }
}

/// L1, L2 and the maximum.
///
/// # Errors
/// The lists differ in length, or a weight is negative or not finite.
fn all_norms(errors: &[f64], weights: &[f64]) -> Result<[(&'static str, f64); 3], String> {
    same_length("weights", errors, weights.len())?;
    if errors.is_empty() {
        return Err("errors: expected at least one, found none".to_owned());
    }
    let is_weight = |weight: f64| weight.is_finite() && weight >= 0.0;
    if let Some(k) = weights.iter().position(|weight| !is_weight(*weight)) {
        let found = weights[k];
        return Err(format!(
            "weights[{k}]: expected a finite number >= 0, found {found}"
        ));
    }
    let [l1, l2] = [1, 2].map(|power| {
        let terms = errors.iter().zip(weights);
        let terms = terms.map(|(error, weight)| weight * error.abs().powi(power));
        terms.sum::<f64>()
    });
    let max = errors.iter().map(|error| error.abs()).fold(0.0, max_or_nan);
    Ok([("L1", l1), ("L2", l2.sqrt()), (MAX, max)])
}

/// The maximum of the points that are not at the boundary.
///
/// # Errors
/// The lists differ in length, or all points are at the boundary.
fn largest_inside(errors: &[f64], boundary: &[bool]) -> Result<f64, String> {
    same_length("boundary", errors, boundary.len())?;
    let inside = errors
        .iter()
        .zip(boundary)
        .filter(|(_, at_boundary)| !**at_boundary);
    let inside = inside.map(|(error, _)| error.abs());
    let largest = inside.reduce(max_or_nan);
    largest.ok_or_else(|| "boundary: expected a point that is not at it, found none".to_owned())
}

fn same_length(name: &str, errors: &[f64], found: usize) -> Result<(), String> {
    let expected = errors.len();
    if found == expected {
        return Ok(());
    }
    Err(format!(
        "{name}: expected {expected}, one for each error, found {found}"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn norms_are_those_of_the_definitions_and_keep_nan() {
        let found = norms(&[3.0, -4.0, 1.0], &[0.5, 0.5, 1.0], &[false, true, false]);
        let l2 = (0.5 * 9.0 + 0.5 * 16.0 + 1.0_f64).sqrt();
        assert_eq!(
            found,
            [("L1", 4.5), ("L2", l2), ("max", 4.0), ("max inside", 3.0)]
        );
        let broken = norms(&[3.0, f64::NAN], &[1.0; 2], &[true, false]);
        assert!(broken.iter().all(|(_, norm)| norm.is_nan()), "{broken:?}");
        let infinite = norms(&[3.0, f64::INFINITY], &[1.0; 2], &[false, true]);
        assert_eq!((infinite[2].1, infinite[3].1), (f64::INFINITY, 3.0));
    }

    #[test]
    fn what_does_not_fit_is_named() {
        for (errors, weights, words) in [
            (
                &[1.0, 2.0][..],
                &[1.0][..],
                "weights: expected 2, one for each error, found 1",
            ),
            (
                &[1.0],
                &[-1.0],
                "weights[0]: expected a finite number >= 0, found -1",
            ),
            (
                &[1.0],
                &[f64::NAN],
                "weights[0]: expected a finite number >= 0, found NaN",
            ),
            (&[], &[], "errors: expected at least one, found none"),
        ] {
            assert_eq!(all_norms(errors, weights).unwrap_err(), words);
        }
        let words = "boundary: expected a point that is not at it, found none";
        assert_eq!(largest_inside(&[1.0], &[true]).unwrap_err(), words);
        assert!(largest_inside(&[1.0], &[]).is_err());
    }
}
