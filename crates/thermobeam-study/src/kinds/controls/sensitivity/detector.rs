//! Whether a study detects an error in a coefficient, and the smallest that it detects.

use convergence_study::judge::verdict::Verdict;
use convergence_study::study::CaseFailure;

use super::super::fault::{BROKEN, Errors, Fault, verdicts};
use crate::error::design::Prepared;
use crate::kinds::convergence::Convergence;

/// Bisections of the logarithm: seven decades to within 4 percent.
pub(super) const BISECTIONS: usize = 9;

/// Elements and steps of a level, and its errors.
type LevelErrors = ((usize, usize), Errors);

/// The levels of one study, prepared once for all runs.
pub(in crate::kinds::controls) struct Detector<'a> {
    spec: &'a Convergence,
    prepared: Vec<(Prepared<'a>, usize, usize)>,
}

impl<'a> Detector<'a> {
    pub(in crate::kinds::controls) fn new(spec: &'a Convergence) -> Result<Self, CaseFailure> {
        let prepare = |(n, steps)| Ok((Prepared::new(spec, n)?, n, steps));
        Ok(Self { spec, prepared: spec.refine.cases().into_iter().map(prepare).collect::<Result<_, CaseFailure>>()? })
    }

    /// Whether the study fails when the solver's coefficient is off by that much.
    pub(in crate::kinds::controls) fn detects(&mut self, key: &'static str, relative: f64) -> bool {
        let spec = self.spec;
        let levels = self.levels(Fault::Coefficient(key), relative);
        levels.is_some_and(|levels| verdicts(spec, &levels).any(|verdict| verdict == Verdict::Fail))
    }

    /// Elements, steps and errors of every level with a fault; `None` where it cannot be planted.
    pub(in crate::kinds::controls) fn levels(&mut self, fault: Fault, relative: f64) -> Option<Vec<LevelErrors>> {
        let disagreement = fault.plant(self.spec, relative)?;
        // A fault that breaks a run down is detected.
        let level = |(prepared, n, steps): &mut (Prepared<'_>, usize, usize)| {
            ((*n, *steps), prepared.run(*steps, disagreement).unwrap_or(BROKEN))
        };
        Some(self.prepared.iter_mut().map(level).collect())
    }

    /// The smallest relative error detected, by bisection of its logarithm; `None` where the range does not bracket it.
    pub(super) fn smallest(&mut self, key: &'static str, range: [f64; 2]) -> Option<f64> {
        if self.detects(key, range[0]) || !self.detects(key, range[1]) {
            return None;
        }
        let [mut missed, mut detected] = range.map(f64::log10);
        for _ in 0..BISECTIONS {
            let middle = 0.5 * (missed + detected);
            if self.detects(key, 10f64.powf(middle)) { detected = middle } else { missed = middle }
        }
        Some(10f64.powf(detected))
    }
}
