//! Studies into which faults can be planted, and the runs of such a study with a fault.

use super::fault::{Fault, Planted};
use crate::kinds::prelude::*;

/// A study of orders whose solver or sources can be wrong on purpose.
pub trait Plantable: Kind<Found: Clone> {
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

    /// What the study says of the results of its cases.
    fn verdict(&self, ran: &[Ran<Self::Data, Self::Found>]) -> Verdict {
        self.judge(ran).verdict
    }
}

/// A case of a study, and what its runs share.
struct Prepared<'a, K: Plantable + 'a> {
    case: Case<K::Data>,
    shared: K::Shared<'a>,
}

/// All cases of a study, prepared once for runs with many faults.
pub(super) struct Detector<'a, K: Plantable> {
    study: &'a K,
    cases: Vec<Prepared<'a, K>>,
}

impl<'a, K: Plantable> Detector<'a, K> {
    /// # Errors
    /// [`CaseFailure`]: a case cannot be set up.
    pub(super) fn new(study: &'a K) -> Result<Self, CaseFailure> {
        let prepare = |case: Case<K::Data>| {
            let shared = study.share(&case.data)?;
            Ok(Prepared { case, shared })
        };
        let cases = study.cases().into_iter().map(prepare);
        Ok(Self {
            study,
            cases: cases.collect::<Result<_, CaseFailure>>()?,
        })
    }

    /// The results of all cases without a fault.
    pub(super) fn without_a_fault(&mut self) -> Vec<Ran<K::Data, K::Found>> {
        self.run(Planted {
            solver: self.study.theory(),
            defect: None,
        })
    }

    /// The results of all cases with a fault.
    fn run(&mut self, planted: Planted) -> Vec<Ran<K::Data, K::Found>> {
        let run = |Prepared { case, shared }: &mut Prepared<'_, K>| Ran {
            case: case.clone(),
            found: K::run_planted(shared, &case.data, planted),
        };
        self.cases.iter_mut().map(run).collect()
    }

    /// Whether the study fails with a relative error in a coefficient; a run that breaks down is a
    /// failure. `None` if the study lacks the coefficient, or it is zero.
    pub(super) fn detects(&mut self, key: &'static str, relative: f64) -> Option<bool> {
        let planted = Fault::Coefficient(key).plant(self.study.theory(), relative)?;
        let ran = self.run(planted);
        Some(self.study.verdict(&ran) == Verdict::Fail)
    }
}
