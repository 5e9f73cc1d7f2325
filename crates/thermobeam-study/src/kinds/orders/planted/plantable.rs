//! Studies into which faults can be planted, and the runs of such a study with a fault.

use super::fault::{Fault, Planted};
use crate::kinds::prelude::*;
use crate::{
    kinds::orders::{ErrorSource, Runs, Series},
    scene::Coefficients,
};

/// A study of orders whose solver or sources can be wrong on purpose.
pub trait Plantable: ErrorSource<Found: Clone> {
    /// What the runs of a case share, whatever is planted.
    type Shared<'a>
    where
        Self: 'a;

    /// Coefficients from which the sources are derived.
    fn theory(&self) -> Coefficients;

    /// Computes what the runs of a case share.
    ///
    /// # Errors
    /// [`CaseFailure`]: the case cannot be set up, whatever is planted.
    fn share<'a>(&'a self, data: &Self::Data) -> Result<Self::Shared<'a>, CaseFailure>;

    /// Runs a case with a fault.
    ///
    /// # Errors
    /// [`CaseFailure`] with the solver's message.
    fn run_planted(
        shared: &mut Self::Shared<'_>,
        data: &Self::Data,
        planted: Planted,
    ) -> Result<Self::Found, CaseFailure>;

    /// The errors of a run, each with its name.
    fn errors(found: &Self::Found) -> Vec<(&'static str, f64)>;
}

/// The verdict of a study on the results of its cases.
pub(crate) fn verdict<S: ErrorSource>(source: &S, runs: &Runs<S>) -> Verdict {
    for run in runs {
        match run.ok() {
            Some(found) if source.not_finite(found).is_empty() => (),
            _ => return Verdict::Fail,
        }
    }
    let measured = source.measured(runs);
    let checks = measured.checks.iter().map(|check| check.verdict);
    let claimed = measured.series.iter().filter(|series| series.is_claimed);
    Verdict::worst(checks.chain(claimed.map(Series::verdict)))
}

/// A case of a study, and what its runs share.
struct Prepared<'a, S: Plantable + 'a> {
    case: Case<S::Data>,
    shared: S::Shared<'a>,
}

/// All cases of a study, prepared once for runs with many faults.
pub(in crate::kinds) struct Detector<'a, S: Plantable> {
    study: &'a S,
    cases: Vec<Prepared<'a, S>>,
}

impl<'a, S: Plantable> Detector<'a, S> {
    /// # Errors
    /// [`CaseFailure`]: a case cannot be set up.
    pub(in crate::kinds) fn new(study: &'a S) -> Result<Self, CaseFailure> {
        let mut cases = vec![];
        for case in study.cases() {
            let shared = study.share(&case.data)?;
            cases.push(Prepared { case, shared });
        }
        Ok(Self { study, cases })
    }

    /// The results of all cases without a fault.
    pub(in crate::kinds) fn without_a_fault(&mut self) -> Vec<Ran<S::Data, S::Found>> {
        self.run(Planted {
            solver: self.study.theory(),
            defect: None,
        })
    }

    /// The results of all cases with a fault.
    fn run(&mut self, planted: Planted) -> Vec<Ran<S::Data, S::Found>> {
        let mut results = vec![];
        for Prepared { case, shared } in &mut self.cases {
            results.push(Ran {
                case: case.clone(),
                found: S::run_planted(shared, &case.data, planted),
            });
        }
        results
    }

    /// Whether the study fails with a relative error in a coefficient; a run that breaks down is a
    /// failure. `None` if the study lacks the coefficient, or it is zero.
    pub(in crate::kinds) fn detects(&mut self, key: &'static str, relative: f64) -> Option<bool> {
        let planted = Fault::Coefficient(key).plant(self.study.theory(), relative)?;
        let ran = self.run(planted);
        Some(verdict(self.study, &ran) == Verdict::Fail)
    }
}
