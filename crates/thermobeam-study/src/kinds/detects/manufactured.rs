//! Faults in studies of manufactured solutions, by one-step schemes.

use super::{
    ELEMENTS, RELATIVE_KEY, STUDIES,
    matrix::{Detects, Needed},
};
use crate::kinds::prelude::*;
use crate::{
    exact::norm::Norms,
    kinds::orders::{
        Orders,
        manufactured::{Convergence, Prepared},
        planted::{
            fault::{Fault, Planted, RELATIVE, relative},
            plantable::Plantable,
        },
    },
    scene::{Coefficients, tables},
};
use convergence_study::internal::study::Described;

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

const CONTROLS: Keys = &[&[RELATIVE_KEY, STUDIES, ELEMENTS]];

impl FromFile for Detects<Convergence> {
    const KEYS: &'static [Keys] = &[&[&[Key::new(
        "controls",
        Form::Table(&[CONTROLS]),
        "each coefficient and each defect, planted in turn",
    )]]];

    fn from_document(_: &Header, root: &Section<'_>, folder: &Path) -> Result<Self, InputError> {
        let section = root.table("controls", CONTROLS)?;
        Ok(Self {
            relative: relative(&section.require("relative", RELATIVE)?)?,
            studies: named_studies(&section, folder)?,
            faults: Fault::all(),
            needed: Needed::One,
        })
    }
}

/// The studies that a section names, with the section's own levels if it has any.
pub(super) fn named_studies(
    section: &Section<'_>,
    folder: &Path,
) -> Result<Vec<Described<Orders<Convergence>>>, InputError> {
    let file = |item: &Field<'_>| Described::<Orders<Convergence>>::read(item.file(folder)?);
    let allowed = "a list of at least one study file beside this one";
    let mut studies = section.list("studies", allowed, file, |list| !list.is_empty())?;
    if section.get("elements").is_some() {
        let levels = section.list(
            "elements",
            "a list of numbers of elements",
            tables::elements,
            |_| true,
        )?;
        if !levels.is_empty() {
            for spec in &mut studies {
                spec.kind.refine.elements.clone_from(&levels);
                // It is claimed at the finest level of the study's own file.
                spec.kind.constant = None;
            }
        }
    }
    Ok(studies)
}
