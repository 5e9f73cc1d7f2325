//! Review: what differs from the baseline, change by change, and the baseline with those that were accepted.

use std::fmt::Write;

use thiserror::Error;

use crate::run::{self, Finished, Progress};
use crate::store::baseline::{Baseline, BaselineError, Change, Movement, Refusal};
use crate::store::writing;
use crate::study::Study;
use crate::text::number::interval_text;
use crate::text::visible::visible;
use crate::verify::{Request, VerificationError};

/// What a run has found and what of it is not what it was.
#[derive(Debug)]
pub struct Pending {
    /// The studies, in the order in which they were given.
    pub finished: Vec<Finished>,
    /// What differs from the baseline.
    pub changes: Vec<Change>,
}

/// Why changes were not accepted; the baseline is as it was.
#[derive(Debug, Error)]
pub enum ReviewError {
    /// The baseline or its lock cannot be used.
    #[error(transparent)]
    Verification(#[from] VerificationError),
    /// The baseline cannot be read or written.
    #[error(transparent)]
    Baseline(#[from] BaselineError),
    /// A change that no baseline can take.
    #[error("{change}: {refusal}")]
    Refused {
        /// Which one.
        change: String,
        /// Why.
        refusal: Refusal,
    },
    /// Somebody else has changed the baseline in the meantime.
    #[error("{0}: the baseline has changed during the review; expected what was shown; nothing is accepted")]
    Outdated(String),
}

/// Runs the studies and compares them with the baseline; writes nothing.
///
/// # Errors
/// [`VerificationError`].
pub fn pending(
    studies: &[Box<dyn Study>],
    request: &Request,
    progress: &(dyn Fn(Progress) + Sync),
) -> Result<Pending, VerificationError> {
    let baseline = Baseline::read(&request.baseline())?;
    let finished = run::run(studies, request.effort, progress)?;
    let changes = baseline.compare(&finished, request.scope.known());
    Ok(Pending { finished, changes })
}

/// Takes these changes for the baseline, each with its reason: all of them or none.
///
/// * Returns what still differs.
///
/// # Errors
/// [`ReviewError`].
pub fn accept(pending: &Pending, request: &Request, accepted: &[(usize, String)]) -> Result<Vec<Change>, ReviewError> {
    let _lock = request.lock_baseline()?;
    let _writing = writing::begin();
    let mut baseline = Baseline::read(&request.baseline())?;
    let known = request.scope.known();
    let now = baseline.compare(&pending.finished, known);
    for (index, reason) in accepted {
        let change = &pending.changes[*index];
        if !now.contains(change) {
            return Err(ReviewError::Outdated(id(change)));
        }
        let taken = baseline.accept(&pending.finished, change, reason);
        taken.map_err(|refusal| ReviewError::Refused { change: id(change), refusal })?;
    }
    if !accepted.is_empty() {
        baseline.write(&request.baseline())?;
    }
    Ok(baseline.compare(&pending.finished, known))
}

/// The name of a change: study, colon, number or `claim PATH`.
pub fn id(change: &Change) -> String {
    format!("{}:{}", change.study, change.subject())
}

/// Old, new and tolerance; the interval and the claim of a rate; what the study claims, and its verdict.
pub fn describe(pending: &Pending, change: &Change) -> String {
    let mut text = format!("{}: {}\n", visible(&id(change)), visible(&change.movement.to_string()));
    let Some(Finished { header, outcome, .. }) =
        pending.finished.iter().find(|finished| finished.header.id == change.study)
    else {
        return text;
    };
    let rate = change.name.strip_prefix("rate ").filter(|_| !matches!(change.movement, Movement::Vanished { .. }));
    if let Some((_, rate)) = outcome.rates.iter().find(|(name, _)| rate == Some(name)) {
        if let Some(interval) = rate.interval {
            let _ = writeln!(text, "  interval {}, pairwise {}", interval_text(interval, 4), pairwise(&rate.pairwise));
        }
        let _ = writeln!(text, "  order {} ± {}: {}", rate.order, rate.tolerance, visible(&rate.reason));
    }
    let _ = writeln!(text, "  claim: {}: {}", visible(&header.claim), outcome.verdict);
    text
}

fn pairwise(rates: &[f64]) -> String {
    rates.iter().map(|rate| format!("{rate:.3}")).collect::<Vec<_>>().join(" ")
}
