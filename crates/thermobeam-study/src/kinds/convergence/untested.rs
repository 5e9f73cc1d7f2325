//! What a convergence study does not test: coefficients whose error it would miss, and norms without any error.
//!
//! The study is repeated with a small error in each coefficient of the solver, and judged as usual. If it still passes, it
//! does not test that coefficient, whatever it claims.

use convergence_study::study::Untested;

use super::Convergence;
use super::design::{Detector, verdicts};
use crate::kinds::prelude::*;
use crate::scene::Coefficients;

/// Relative error of a coefficient that a study testing it must notice.
const OFF: f64 = 1e-4;

/// Errors that are round-off on every level.
const ROUND_OFF: f64 = 1e-12;

/// For a study that passes; empty if it fails, if it is wrong on purpose, or if it has a grid of meshes and steps.
pub(super) fn untested(study: &Convergence) -> Vec<Untested> {
    let mut found = vec![];
    let is_looked_at = study.solver == study.theory && !study.refine.grid;
    let Some(mut detector) = is_looked_at.then(|| Detector::new(study).ok()).flatten() else { return found };
    let levels = detector.measure(study.theory);
    if verdicts(study, &levels).any(|verdict| verdict != Verdict::Pass) {
        return found;
    }
    for key in Coefficients::names() {
        let why = match study.theory.off(key, OFF) {
            None if tables::OBSTACLE_KEYS.contains(&key) && study.theory.obstacles.is_none() => {
                "there are no obstacles".to_owned()
            }
            None => "it is zero".to_owned(),
            Some(off) if detector.detects(off) => continue,
            Some(_) => {
                contact(study, key).unwrap_or_else(|| format!("an error of {OFF:e} of its value is not rejected"))
            }
        };
        found.push(Untested { what: key.to_owned(), why });
    }
    let is_exact = |norm: &Norm| levels.iter().all(|(_, errors)| errors[*norm] <= ROUND_OFF);
    found.extend(Norm::ALL.into_iter().filter(is_exact).map(|norm| Untested {
        what: norm.name().to_owned(),
        why: "its error is round-off on every level: the solution lies in the space of the scheme".to_owned(),
    }));
    found
}

/// Why an obstacle has no effect; `None` for other coefficients, and if the free end touches it.
fn contact(study: &Convergence, key: &str) -> Option<String> {
    let Obstacles { g1, g2, .. } = study.theory.obstacles?;
    let [low, high] = range_of_the_tip(study);
    match key {
        "g1" if low >= g1 => Some(format!("the free end stays above it: u(1) >= {low:.4}")),
        "g2" if high <= g2 => Some(format!("the free end stays below it: u(1) <= {high:.4}")),
        "epsilon" if low >= g1 && high <= g2 => {
            Some(format!("the free end touches nothing: {low:.4} <= u(1) <= {high:.4}"))
        }
        _ => None,
    }
}

/// Smallest and largest u(1, t) of the exact solution over the time levels of the finest run.
fn range_of_the_tip(study: &Convergence) -> [f64; 2] {
    let steps = study.refine.steps.iter().copied().max().unwrap_or(1);
    let tip = |n: usize| study.exact.tip(n as f64 * study.refine.dt(steps));
    let ends = |[low, high]: [f64; 2], u: f64| [low.min(u), high.max(u)];
    (0..=steps).map(tip).fold([f64::INFINITY, f64::NEG_INFINITY], ends)
}
