//! The planted faults, and what each changes.

use crate::{exact::defect::Defect, scene::Coefficients};

/// The fault of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Fault {
    /// Nothing.
    None,
    /// A coefficient of the solver.
    Coefficient(&'static str),
    /// The sources.
    Defect(Defect),
}

/// What a run is given in place of the study's own.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Planted {
    /// The solver's coefficients.
    pub solver: Coefficients,
    /// The mistake in the sources.
    pub defect: Option<Defect>,
}

impl Fault {
    /// No fault at all, then each coefficient and each defect.
    pub(crate) fn all() -> Vec<Self> {
        let defects = Defect::ALL.map(|(defect, _)| Fault::Defect(defect));
        [Fault::None]
            .into_iter()
            .chain(Coefficients::names().map(Fault::Coefficient))
            .chain(defects)
            .collect()
    }

    /// In words.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Fault::None => "none",
            Fault::Coefficient(key) => key,
            Fault::Defect(defect) => defect.name(),
        }
    }

    /// What the fault changes; `None` if the study lacks what is wrong, or it is zero.
    ///
    /// * `theory`: coefficients from which the sources are derived.
    /// * `relative`: relative error of a coefficient.
    pub(crate) fn plant(self, theory: Coefficients, relative: f64) -> Option<Planted> {
        let solver = match self {
            Fault::Coefficient(key) => theory.off(key, relative)?,
            Fault::None | Fault::Defect(_) => theory,
        };
        let defect = match self {
            Fault::Defect(defect) if defect.applies(&theory.beam, theory.obstacles.as_ref()) => {
                Some(defect)
            }
            Fault::Defect(_) => return None,
            Fault::None | Fault::Coefficient(_) => None,
        };
        Some(Planted { solver, defect })
    }
}
