//! The sources into which faults can be planted.

use super::{fault::Planted, plantable::Plantable};
use crate::exact::norm::Norms;
use crate::kinds::orders::{
    ErrorSource,
    any_order::{AnyOrder, AnyOrderRun, JudgedErrors},
    manufactured::{Convergence, Prepared},
};
use crate::kinds::prelude::*;
use crate::scene::Coefficients;

impl Plantable for AnyOrder {
    type Shared<'a> = &'a AnyOrder;

    fn theory(&self) -> Coefficients {
        self.theory
    }

    fn share(&self, _: &AnyOrderRun) -> Result<&AnyOrder, CaseFailure> {
        Ok(self)
    }

    fn run_planted(
        study: &mut &AnyOrder,
        resolution: &AnyOrderRun,
        Planted { solver, defect }: Planted,
    ) -> Result<JudgedErrors, CaseFailure> {
        let mut study = study.clone();
        study.solver = solver;
        study.defect = defect;
        study.run(resolution)
    }

    fn errors(errors: &JudgedErrors) -> Vec<(&'static str, f64)> {
        errors.named.clone()
    }
}

impl Plantable for Convergence {
    /// The space vectors of a mesh.
    type Shared<'a> = Prepared<'a>;

    fn theory(&self) -> Coefficients {
        self.theory
    }

    fn share(&self, &(elements, _): &(usize, usize)) -> Result<Prepared<'_>, CaseFailure> {
        Ok(Prepared::new(self, elements)?)
    }

    fn run_planted(
        shared: &mut Prepared<'_>,
        &(_, steps): &(usize, usize),
        planted: Planted,
    ) -> Result<Norms, CaseFailure> {
        shared.run(steps, planted.solver, planted.defect)
    }

    fn errors(errors: &Norms) -> Vec<(&'static str, f64)> {
        errors
            .iter()
            .map(|(norm, error)| (norm.name(), error))
            .collect()
    }
}
