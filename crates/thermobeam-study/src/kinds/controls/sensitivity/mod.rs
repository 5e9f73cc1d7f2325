//! The smallest error in a coefficient that a study still detects, by bisection.
//!
//! ```toml
//! [sensitivity]
//! studies = ["theorem-3.4-space.toml"]    # files beside this one
//! elements = [64, 128, 256, 512]          # optional: levels in place of the studies' own
//! range = [1e-9, 1e-2]                    # relative errors: not detected at the first, detected at the last
//! at_most = 1e-4                          # what some study must detect of every coefficient
//! ```

mod detector;
mod judge;

use std::path::Path;

use convergence_study::input::{Field, InputError, Section};
use convergence_study::study::{Case, CaseFailure, FromFile, Header, Kind, Outcome, Ran};

use super::fault::{Fault, coefficients, named_studies};
use crate::kinds::convergence::Convergence;
use detector::BISECTIONS;

pub(super) use detector::Detector;

/// A study of the smallest errors that are detected.
pub struct Sensitivity {
    header: Header,
    studies: Vec<Convergence>,
    range: [f64; 2],
    at_most: f64,
}

/// A coefficient of a study.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coefficient {
    /// The study, by its place in the list.
    pub study: usize,
    /// The coefficient.
    pub key: &'static str,
}

impl FromFile for Sensitivity {
    fn from_document(header: Header, root: &Section<'_>, folder: &Path) -> Result<Self, InputError> {
        root.allow(&["study", "sensitivity"])?;
        let section = root.require("sensitivity", "a table with studies, range and at_most")?.section()?;
        section.allow(&["studies", "elements", "range", "at_most"])?;
        let below_one = "a number between 0 and 1";
        let number = |field: &Field<'_>| field.number_where(below_one, |r| r > 0.0 && r < 1.0);
        let ascending = "a list of two ascending numbers between 0 and 1";
        let field = section.require("range", ascending)?;
        let ends = field.items(ascending)?.iter().map(number).collect::<Result<Vec<_>, _>>()?;
        let &[low, high] = ends.as_slice() else { return Err(field.refuse_as_written(ascending)) };
        if low >= high {
            return Err(field.refuse_as_written(ascending));
        }
        let studies = named_studies(&section, folder)?;
        let at_most = number(&section.require("at_most", below_one)?)?;
        Ok(Self { header, studies, range: [low, high], at_most })
    }
}

impl Kind for Sensitivity {
    /// Coefficients that a study lacks, or has zero, are left out.
    type Data = Coefficient;
    /// The smallest relative error detected; `None` where the range does not bracket it.
    type Found = Option<f64>;

    fn header(&self) -> &Header {
        &self.header
    }

    fn cases(&self) -> Vec<Case<Coefficient>> {
        let cost = |spec: &Convergence| -> f64 {
            let runs = BISECTIONS as f64 + 2.0;
            spec.refine.cases().iter().map(|&(n, steps)| n as f64 * (steps as f64 * runs * 4.0 + 50.0)).sum()
        };
        let of_study = |(study, spec): (usize, &Convergence)| {
            let can_be_planted = |key: &&'static str| Fault::Coefficient(key).plant(spec, self.at_most).is_some();
            let case = |key| Case {
                label: format!("{key} in {}", spec.header.id),
                cost: cost(spec),
                data: Coefficient { study, key },
            };
            coefficients().filter(can_be_planted).map(case).collect::<Vec<_>>()
        };
        self.studies.iter().enumerate().flat_map(of_study).collect()
    }

    fn run(&self, coefficient: &Coefficient) -> Result<Option<f64>, CaseFailure> {
        let mut detector = Detector::new(&self.studies[coefficient.study])?;
        Ok(detector.smallest(coefficient.key, self.range))
    }

    fn judge(&self, ran: &[Ran<Coefficient, Option<f64>>]) -> Outcome {
        judge::judge(self, ran)
    }
}
