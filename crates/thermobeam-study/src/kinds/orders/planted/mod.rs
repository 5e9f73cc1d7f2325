//! A study repeated with a planted fault: would it be noticed?

pub(crate) mod fault;

use super::{
    ErrorSource, Runs, Series,
    any_order::{AnyOrder, AnyOrderRun, JudgedErrors},
    manufactured::{Convergence, Prepared},
};
use crate::exact::norm::Norms;
use crate::kinds::prelude::*;
use crate::scene::Coefficients;
use fault::Planted;

/// The results of a case, one for each fault.
pub(crate) type OfFaults<F> = Vec<Result<F, CaseFailure>>;

/// A study of orders whose solver or sources can be wrong on purpose.
pub trait Plantable: ErrorSource<Found: Clone> {
    /// Coefficients from which the sources are derived.
    fn theory(&self) -> Coefficients;

    /// Runs a case with each of these faults; what its runs share is computed once.
    ///
    /// # Errors
    /// [`CaseFailure`]: the case cannot be set up, whatever is planted.
    fn run_planted(
        &self,
        data: &Self::Data,
        planted: &[Planted],
    ) -> Result<OfFaults<Self::Found>, CaseFailure>;

    /// The errors of a run, each with its name.
    fn errors(found: &Self::Found) -> Vec<(&'static str, f64)>;
}

impl Plantable for AnyOrder {
    fn theory(&self) -> Coefficients {
        self.theory
    }

    fn run_planted(
        &self,
        resolution: &AnyOrderRun,
        planted: &[Planted],
    ) -> Result<OfFaults<JudgedErrors>, CaseFailure> {
        let mut study = self.clone();
        let results = planted.iter().map(|planted| {
            study.solver = planted.solver;
            study.defect = planted.defect;
            study.run(resolution)
        });
        Ok(results.collect())
    }

    fn errors(errors: &JudgedErrors) -> Vec<(&'static str, f64)> {
        errors.named.clone()
    }
}

impl Plantable for Convergence {
    fn theory(&self) -> Coefficients {
        self.theory
    }

    fn run_planted(
        &self,
        &(elements, steps): &(usize, usize),
        planted: &[Planted],
    ) -> Result<OfFaults<Norms>, CaseFailure> {
        let mut prepared = Prepared::new(self, elements)?;
        let planted = planted.iter();
        let results = planted.map(|planted| prepared.run(steps, planted.solver, planted.defect));
        Ok(results.collect())
    }

    fn errors(errors: &Norms) -> Vec<(&'static str, f64)> {
        errors
            .iter()
            .map(|(norm, error)| (norm.name(), error))
            .collect()
    }
}

/// The verdict of a study on the results of its cases.
pub(crate) fn verdict<S: ErrorSource>(source: &S, runs: &Runs<S>) -> Verdict {
    let measured = source.measured(runs);
    let is_complete = runs.iter().all(|run| run.found.is_ok());
    if !is_complete || !measured.broken().measured.is_empty() {
        return Verdict::Fail;
    }
    let numbers = measured.sheets.iter().flat_map(|sheet| &sheet.measured);
    let numbers = numbers
        .filter_map(Measured::holds)
        .map(|holds| match holds {
            true => Verdict::Pass,
            false => Verdict::Fail,
        });
    let claimed = measured.series.iter().filter(|series| series.is_claimed);
    Verdict::worst(numbers.chain(claimed.map(Series::verdict)))
}
