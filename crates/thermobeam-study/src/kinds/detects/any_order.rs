//! Faults in studies of the solver of any order: each study named must fail for every perturbed
//! coefficient and for every defect.
//!
//! ```toml
//! [any-order]
//! relative = 1e-4
//! studies = ["any-order-coefficients.toml"]    # of kind orders/any-order, beside this file
//! coefficients = ["zeta", "a"]                 # names of [beam] and [obstacles]; none may be zero in a study
//! defects = ["half of rho in N"]               # optional: mistakes in the loads, in the words of the report
//! ```

use super::{
    RELATIVE_KEY, STUDIES,
    matrix::{Detects, Needed},
};
use crate::kinds::prelude::*;
use crate::{
    exact::defect::Defect,
    kinds::orders::{
        ErrorSource, Orders,
        any_order::{AnyOrder, AnyOrderRun, JudgedErrors},
        planted::{
            fault::{Fault, Planted, RELATIVE, relative},
            plantable::Plantable,
        },
    },
    scene::Coefficients,
};
use convergence_study::internal::study::Described;

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

const PLANTED: Keys = &[&[
    RELATIVE_KEY,
    STUDIES,
    Key::new(
        "coefficients",
        Form::List(&Form::Choice(|| Coefficients::names().collect())),
        "coefficients of the solver that are put off in turn",
    ),
    Key::new(
        "defects",
        Form::List(&Form::Choice(defect_names)),
        "defects of the loads",
    )
    .or("none"),
]];

fn defect_names() -> Vec<&'static str> {
    let of_the_problem = Defect::ALL
        .iter()
        .filter(|(defect, _)| defect.is_of_the_problem());
    of_the_problem.map(|(_, name)| *name).collect()
}

impl FromFile for Detects<AnyOrder> {
    const KEYS: &'static [Keys] = &[&[&[Key::new(
        "any-order",
        Form::Table(&[PLANTED]),
        "what is planted in studies of kind orders/any-order",
    )]]];

    fn from_document(_: &Header, root: &Section<'_>, folder: &Path) -> Result<Self, InputError> {
        let section = root.table("any-order", PLANTED)?;
        let relative = relative(&section.require("relative", RELATIVE)?)?;
        let allowed = "a list of at least one study file of kind orders/any-order beside this one";
        let read = |file: &Field<'_>| Described::<Orders<AnyOrder>>::read(file.file(folder)?);
        let studies = section.list("studies", allowed, read, |list| !list.is_empty())?;
        let names: Vec<(&str, &'static str)> =
            Coefficients::names().map(|name| (name, name)).collect();
        let allowed = "a list of at least one coefficient";
        let listed = section.list(
            "coefficients",
            allowed,
            |item| item.choice(&names),
            |list| !list.is_empty(),
        )?;
        let mut faults = vec![Fault::None];
        faults.extend(listed.into_iter().map(Fault::Coefficient));
        faults.extend(defects(&section)?.into_iter().map(Fault::Defect));
        for study in &studies {
            let absent = faults
                .iter()
                .find(|fault| fault.plant(study.kind.theory, relative).is_none());
            if let Some(absent) = absent {
                let key = if matches!(absent, Fault::Defect(_)) {
                    "defects"
                } else {
                    "coefficients"
                };
                let found = format!(
                    "{}, which {} does not have or has zero",
                    absent.name(),
                    study.header.id
                );
                return Err(section.refuse(key, found, format!("{key} that every study has")));
            }
        }
        Ok(Self {
            relative,
            studies,
            faults,
            needed: Needed::Every,
        })
    }
}

/// The defects that a section names; none without the key.
fn defects(section: &Section<'_>) -> Result<Vec<Defect>, InputError> {
    if section.get("defects").is_none() {
        return Ok(vec![]);
    }
    let of_the_problem = Defect::ALL
        .iter()
        .filter(|(defect, _)| defect.is_of_the_problem());
    let names: Vec<(&str, Defect)> = of_the_problem
        .map(|&(defect, name)| (name, defect))
        .collect();
    section.list(
        "defects",
        "a list of at least one defect",
        |item| item.choice(&names),
        |list| !list.is_empty(),
    )
}
