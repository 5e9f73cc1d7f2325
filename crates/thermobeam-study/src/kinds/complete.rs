//! Cases without a result, and results that are no numbers, in every study alike.

use crate::kinds::untyped::{Case, Measured};
use convergence_study::study::CaseFailure;
use convergence_study::study::outcome::Check;

/// Fails unless every case has a result in which every number is finite.
///
/// A number that does not exist, such as the time of a contact that never came, is not measured; it is never NaN.
pub(super) fn all_ran(cases: &[Case], results: &[Result<Measured, CaseFailure>]) -> Check {
    let mut complaints: Vec<String> = Vec::new();
    for (k, result) in results.iter().enumerate() {
        let label = cases.get(k).map_or("a case too many", |case| &case.label);
        match result {
            Err(failure) => complaints.push(format!("{label}: {}", failure.reason)),
            Ok(measured) => {
                complaints.extend(no_numbers(measured).map(|name| format!("{label}: {name} is not finite")));
            }
        }
    }
    if results.len() != cases.len() {
        complaints.push(format!("{} results for {} cases", results.len(), cases.len()));
    }
    let holds = complaints.is_empty();
    let evidence = if holds { format!("{} of {}", cases.len(), cases.len()) } else { complaints.join("; ") };
    Check::that(holds, "every computation came to its end, with finite numbers", evidence)
}

/// Names of what is not finite.
fn no_numbers(measured: &Measured) -> impl Iterator<Item = &str> {
    let values = measured.values.iter().filter(|(_, value)| !value.is_finite()).map(|(name, _)| name.as_str());
    let broken = |points: &[(f64, f64)]| points.iter().any(|(x, y)| !(x.is_finite() && y.is_finite()));
    let curves = measured.series.iter().filter(move |(_, points)| broken(points)).map(|(name, _)| name.as_str());
    values.chain(curves)
}

/// The results, nothing in place of those that are missing: what is read from it is NaN, which passes no check.
pub(super) fn or_nothing(cases: usize, results: &[Result<Measured, CaseFailure>]) -> Vec<Measured> {
    (0..cases).map(|k| results.get(k).and_then(|result| result.clone().ok()).unwrap_or_default()).collect()
}
