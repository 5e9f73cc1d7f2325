//! The boundary of the fixed point on a line of constant second parameter, by bisection in dt.

use super::measure::{axial_force, factors, fixed_point};
use crate::kinds::untyped::Measured;
use convergence_study::run::time_limit::Patience;
use convergence_study::study::CaseFailure;
use thermobeam::simulation::Problem;

/// Halvings of the logarithm of dt: to a ten-thousandth of a range of seven decades.
pub(super) const HALVINGS: usize = 20;
/// Iterations after which the ratio of two increments is the factor of the slowest mode.
pub(super) const ITERATIONS: usize = 400;
/// The α up to which the boundary is looked for. Far beyond it the iteration throws the beam about, which the Kirchhoff term
/// then stiffens: its increments may shrink for a long while without an end. That it fails there the map shows.
const FAR: f64 = 4.0;
/// Consecutive ratios that must be below 1: past the boundary the iteration may run in a cycle, in which some are.
const CONSECUTIVE: usize = 8;

/// The dt at which the fixed point ceases to converge, and that at which α = 1; without them where the line does not cross
/// the boundary within the map.
pub(super) fn find(problem: &Problem, [low, high]: [f64; 2]) -> Result<Measured, CaseFailure> {
    let m = axial_force(&problem.beam, problem);
    let mut measured = Measured::default();
    let predicted = bisect(low, high, |dt| Ok(factors(problem, dt, m).0 < 1.0))?;
    let far = bisect(low, high, |dt| Ok(factors(problem, dt, m).0 < FAR))?.unwrap_or(high);
    let found = bisect(low, far, |dt| contracts(problem, dt))?;
    if let Some(dt) = predicted {
        measured.push("predicted", dt);
    }
    if let Some(dt) = found {
        let (alpha, gamma) = factors(problem, dt, m);
        measured.push("found", dt);
        measured.push("alpha", alpha);
        measured.push("gamma", gamma);
    }
    measured.push("crosses", f64::from(found.is_some()));
    measured.push("should cross", f64::from(predicted.is_some()));
    Ok(measured)
}

/// Whether the increments shrink, however slowly.
fn contracts(problem: &Problem, dt: f64) -> Result<bool, CaseFailure> {
    let mut patience = Patience::of_long_rounds();
    for iterations in ITERATIONS - CONSECUTIVE..ITERATIONS {
        patience.check(iterations, || dt)?;
        let ended = fixed_point(problem, dt, iterations)?;
        if ended.converged || !(ended.contraction < 1.0) {
            return Ok(ended.converged);
        }
    }
    Ok(true)
}

/// The value between a `low` that holds and a `high` that does not; `None` unless they are so.
fn bisect(
    mut low: f64,
    mut high: f64,
    holds: impl Fn(f64) -> Result<bool, CaseFailure>,
) -> Result<Option<f64>, CaseFailure> {
    if !holds(low)? || holds(high)? {
        return Ok(None);
    }
    for _ in 0..HALVINGS {
        let middle = (low * high).sqrt();
        if holds(middle)? {
            low = middle;
        } else {
            high = middle;
        }
    }
    Ok(Some((low * high).sqrt()))
}

#[cfg(test)]
mod tests {
    use super::bisect;

    #[test]
    fn a_threshold_is_found_to_a_part_in_ten_thousand() {
        let found = bisect(1e-6, 10.0, |dt| Ok(dt < 4.6e-3)).unwrap().unwrap();
        assert!((found / 4.6e-3 - 1.0).abs() < 1e-4);
        assert_eq!(bisect(1.0, 2.0, |_| Ok(true)).unwrap(), None);
        assert_eq!(bisect(1.0, 2.0, |_| Ok(false)).unwrap(), None);
    }
}
