//! What a convergence study is no test of: coefficients whose error it would not see, and norms in which there is no error.
//!
//! The study is run again with each coefficient of the solver off by a little, and judged as ever. One that still passes says
//! nothing about that coefficient, whatever its claim.

use convergence_study::judge::verdict::Verdict;
use convergence_study::study::Untested;
use thermobeam::parameters::Obstacles;

use super::sensitivity::Detector;
use super::{Fault, coefficients, verdicts};
use crate::kinds::convergence::Convergence;
use crate::kinds::prelude::*;

/// Relative error of a coefficient that a test of it has to see.
const OFF: f64 = 1e-4;

/// Errors that are round-off on every level.
const ROUND_OFF: f64 = 1e-12;

/// Of a study that passes; nothing where it does not, where it is wrong on purpose, and over a grid of meshes and steps.
pub(in crate::kinds) fn untested(study: &Convergence) -> Vec<Untested> {
    if study.control.is_some() || study.refine.grid {
        return vec![];
    }
    let Ok(mut detector) = Detector::new(study) else { return vec![] };
    let Some(levels) = detector.levels(Fault::None, 0.0) else { return vec![] };
    if verdicts(study, &levels).any(|verdict| verdict != Verdict::Pass) {
        return vec![];
    }
    let mut found = vec![];
    for key in coefficients() {
        let why = match Fault::Coefficient(key).plant(study, OFF) {
            None => Some(absent(study, key)),
            Some(_) if detector.detects(key, OFF) => None,
            Some(_) => {
                Some(contact(study, key).unwrap_or_else(|| format!("an error of {OFF:e} of its value is not rejected")))
            }
        };
        found.extend(why.map(|why| Untested { what: key.to_owned(), why }));
    }
    let is_exact = |norm: &Norm| levels.iter().all(|(_, errors)| errors[*norm] <= ROUND_OFF);
    found.extend(Norm::ALL.into_iter().filter(is_exact).map(|norm| Untested {
        what: norm.name().to_owned(),
        why: "its error is round-off on every level: the solution lies in the space of the scheme".to_owned(),
    }));
    found
}

/// Why a coefficient cannot be off.
fn absent(study: &Convergence, key: &str) -> String {
    let of_obstacles = tables::OBSTACLE_KEYS.contains(&key);
    if of_obstacles && study.obstacles.is_none() { "there are no obstacles" } else { "it is zero" }.to_owned()
}

/// Why an obstacle does nothing; `None` for other coefficients, and where the free end touches it.
fn contact(study: &Convergence, key: &str) -> Option<String> {
    let Obstacles { g1, g2, .. } = study.obstacles?;
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
    let tip = |n: usize| {
        let t = n as f64 * study.refine.dt(steps);
        study.exact.u.iter().map(|product| product.x.eval(1.0) * product.t.eval(t)).sum::<f64>()
    };
    let ends = |[low, high]: [f64; 2], u: f64| [low.min(u), high.max(u)];
    (0..=steps).map(tip).fold([f64::INFINITY, f64::NEG_INFINITY], ends)
}
