//! What a study that passes does not test.

use super::{Convergence, design::range_of_the_tip};
use crate::exact::norm::{Norm, Norms};
use crate::kinds::orders::{
    ErrorSource as _,
    planted::{
        Plantable as _,
        fault::{Fault, Planted},
        verdict,
    },
};
use crate::kinds::prelude::*;
use crate::scene::Coefficients;
use convergence_study::Untested;
use thermobeam::{motion::TipRange, parameters::Obstacles};

/// Relative errors of a coefficient that a study testing it must notice, each of them: beside an
/// error of its own a study may notice one sign alone.
const OFF: [f64; 2] = [1e-4, -1e-4];

/// Errors that are round-off on every level.
const ROUND_OFF: f64 = 1e-12;

/// What a study that passes does not test: coefficients whose error it would miss, and quantities
/// without any error. The study is repeated with a small error in each coefficient of the solver;
/// if it still passes, it does not test that coefficient.
///
/// * Returns nothing if the study fails.
pub(super) fn untested(study: &Convergence) -> Vec<Untested> {
    let theory = study.theory;
    let honest = Planted {
        solver: theory,
        defect: None,
    };
    let mut faults = vec![(("", 0.0), honest)];
    for key in Coefficients::names() {
        for off in OFF {
            let planted = Fault::Coefficient(key).plant(theory, off);
            faults.extend(planted.map(|planted| ((key, off), planted)));
        }
    }
    let (keys, planted): (Vec<(&str, f64)>, Vec<Planted>) = faults.into_iter().unzip();
    let Ok(results) = under_faults(study, &planted) else {
        return vec![];
    };
    let honest = &results[0];
    if !verdict(study, honest).is_pass() {
        return vec![];
    }
    let mut untested = vec![];
    for key in Coefficients::names() {
        let own = keys.iter().zip(&results).filter(|((of, _), _)| *of == key);
        let mut missed = own
            .clone()
            .filter(|(_, found)| verdict(study, found) != Verdict::Fail);
        let why = match missed.next() {
            Some(((_, off), _)) => contact(theory.obstacles, key, range_of_the_tip(study))
                .unwrap_or_else(|| format!("an error of {off:e} of its value is not rejected")),
            None if own.count() > 0 => continue,
            None if Coefficients::OF_OBSTACLES.contains(&key) && theory.obstacles.is_none() => {
                "there are no obstacles".to_owned()
            }
            None => "it is zero".to_owned(),
        };
        untested.push(Untested {
            what: key.to_owned(),
            why,
        });
    }
    untested.extend(without_error(honest));
    untested
}

/// The results of all cases of a study, one after the other for each of these faults; a run that
/// breaks down is a failure.
///
/// # Errors
/// [`CaseFailure`]: a case cannot be set up.
fn under_faults(
    study: &Convergence,
    planted: &[Planted],
) -> Result<Vec<Vec<ErrorRun>>, CaseFailure> {
    let mut results: Vec<Vec<ErrorRun>> = planted.iter().map(|_| vec![]).collect();
    for case in study.cases() {
        let found = study.run_planted(&case.data, planted)?;
        for (runs, found) in results.iter_mut().zip(found) {
            let case = case.clone();
            runs.push(Ran { case, found });
        }
    }
    Ok(results)
}

/// A case with its result.
type ErrorRun = Ran<(usize, usize), Norms>;

/// Quantities whose error is round-off in every run.
fn without_error(ran: &[ErrorRun]) -> Vec<Untested> {
    let mut untested = vec![];
    for norm in Norm::ALL {
        let errors = ran.iter().filter_map(Ran::ok).map(|errors| errors[norm]);
        if largest_of(errors).is_some_and(|largest| largest <= ROUND_OFF) {
            untested.push(Untested {
                what: norm.name().to_owned(),
                why: "its error is round-off on every level: the solution lies in the space of the scheme"
                    .to_owned(),
            });
        }
    }
    untested
}

/// Why an obstacle has no effect; `None` for other coefficients, and if the free end touches it.
fn contact(obstacles: Option<Obstacles>, key: &str, tip: TipRange) -> Option<String> {
    let TipRange { low, high } = tip;
    let Obstacles { g1, g2, .. } = obstacles?;
    match key {
        "g1" if low >= g1 => Some(format!("the free end stays above it: u(1) >= {low:.4}")),
        "g2" if high <= g2 => Some(format!("the free end stays below it: u(1) <= {high:.4}")),
        "epsilon" if low >= g1 && high <= g2 => Some(format!(
            "the free end touches nothing: {low:.4} <= u(1) <= {high:.4}"
        )),
        _ => None,
    }
}
