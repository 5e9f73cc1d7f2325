//! The boundary of the fixed point's convergence at one value of the second parameter, by bisection in dt.

use convergence_study::study::CaseFailure;
use thermobeam::simulation::Problem;

use super::super::step::{FixedPointStep, factors};
use super::row::TOLERANCE;
use super::{Map, axial_force};

/// Halvings of the logarithm of dt: to a ten-thousandth of a range of seven decades.
pub(super) const HALVINGS: usize = 20;
/// Iterations after which the ratio of two increments is the factor of the slowest mode.
pub(super) const ITERATIONS: usize = 400;
/// The α up to which the boundary is looked for. Far beyond it the iterates grow so large that the Kirchhoff term stiffens
/// the beam: the increments may shrink for many iterations without convergence. That it fails there the map shows.
const FAR: f64 = 4.0;
/// Consecutive ratios that must be below 1: past the boundary the iteration may run in a cycle, in which some are.
const CONSECUTIVE: usize = 8;

/// Predicted and measured boundary on a line of constant second parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Boundary {
    /// The dt at which α = 1; `None` where α does not cross 1 within the map.
    pub predicted: Option<f64>,
    /// The dt from which on the fixed point fails; `None` where it behaves alike at both ends of the map.
    pub found: Option<Crossing>,
}

/// A boundary found, and the predicted factors there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crossing {
    /// The time step.
    pub dt: f64,
    /// Factor of the contact.
    pub alpha: f64,
    /// Factor of the coupling.
    pub gamma: f64,
}

impl Boundary {
    pub(in super::super) fn not_finite(&self) -> Vec<&'static str> {
        let predicted = self.predicted.map(|dt| ("predicted boundary", dt));
        let found = self.found.map(|at| [("boundary", at.dt), ("alpha", at.alpha), ("gamma", at.gamma)]);
        let all = predicted.into_iter().chain(found.into_iter().flatten());
        all.filter(|(_, value)| !value.is_finite()).map(|(name, _)| name).collect()
    }
}

impl Map {
    pub(in super::super) fn boundary(&self, value: f64) -> Result<Boundary, CaseFailure> {
        let (problem, [low, high]) = (self.problem(value)?, self.dt);
        let n_value = axial_force(&problem);
        let alpha_is_below = |limit: f64| {
            bisect(low, high, |dt| {
                let [alpha, _] = factors(&problem, dt, n_value);
                Ok(alpha < limit)
            })
        };
        let predicted = alpha_is_below(1.0)?;
        let far = alpha_is_below(FAR)?.unwrap_or(high);
        let found = bisect(low, far, |dt| contracts(&problem, dt))?.map(|dt| {
            let [alpha, gamma] = factors(&problem, dt, n_value);
            Crossing { dt, alpha, gamma }
        });
        Ok(Boundary { predicted, found })
    }
}

/// Whether the increments shrink, however slowly.
fn contracts(problem: &Problem, dt: f64) -> Result<bool, CaseFailure> {
    for iterations in ITERATIONS - CONSECUTIVE..ITERATIONS {
        let step = FixedPointStep::run(problem, dt, TOLERANCE, iterations)?;
        if step.converged || !step.contraction.is_some_and(|ratio| ratio < 1.0) {
            return Ok(step.converged);
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
