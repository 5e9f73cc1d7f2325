//! The smallest error in a coefficient that a study still detects, by bisection.
//!
//! ```toml
//! [sensitivity]
//! studies = ["theorem-3.4-space.toml"]    # files beside this one
//! elements = [64, 128, 256, 512]          # optional: levels in place of the studies' own
//! range = [1e-9, 1e-2]                    # relative errors: unseen at the first, seen at the last
//! at_most = 1e-4                          # what some study must see of every coefficient
//! ```

use crate::error::design::{Disagreement, Prepared};
use crate::kinds::controls::perturbed;
use crate::kinds::convergence::Convergence;
use crate::kinds::tables::Norms;
use crate::kinds::untyped::{Case, Measured};
use crate::kinds::{FromFile, Study};
use crate::scene::tables;
use convergence_study::input::{self, InputError, Section};
use convergence_study::judge::verdict::{Level, Verdict, judge};
use convergence_study::study::CaseFailure;
use convergence_study::study::Header;
use convergence_study::study::outcome::{Check, Outcome, Quantity, Table};
use std::path::Path;

/// Name of the kind.
pub const SENSITIVITY: &str = "sensitivity";

/// Bisections of the logarithm: seven decades to within 4 percent.
const BISECTIONS: usize = 9;

/// A study of this kind.
pub struct Sensitivity {
    header: Header,
    studies: Vec<Convergence>,
    range: [f64; 2],
    at_most: f64,
}

impl FromFile for Sensitivity {
    fn parse(text: &str, file: &Path) -> Result<Self, InputError> {
        input::parse_beside(text, file, Self::from_document)
    }
}

impl Sensitivity {
    fn from_document(root: &Section<'_>, folder: &Path) -> Result<Self, InputError> {
        root.allow(&["study", SENSITIVITY])?;
        let section = root.require(SENSITIVITY, "a table with studies, range and at_most")?.section()?;
        section.allow(&["studies", "elements", "range", "at_most"])?;
        let below_one = "a number between 0 and 1";
        let number = |field: &input::Field<'_>| field.number_where(below_one, |r| r > 0.0 && r < 1.0);
        let field = section.require("range", "a list of two rising numbers between 0 and 1")?;
        let ends = field.items("a list of two numbers")?.iter().map(number).collect::<Result<Vec<_>, _>>()?;
        let &[low, high] = ends.as_slice() else { return Err(field.refuse_as_written("a list of two numbers")) };
        if low >= high {
            return Err(field.refuse_as_written("two rising numbers"));
        }
        let studies = super::controls::named_studies(&section, folder)?;
        let at_most = number(&section.require("at_most", below_one)?)?;
        Ok(Self { header: Header::from_document(root)?, studies, range: [low, high], at_most })
    }

    /// Study and coefficient of each case; coefficients that a study lacks, or has zero, are left out.
    fn pairs(&self) -> Vec<(&Convergence, &'static str)> {
        let keys = tables::BEAM_KEYS.iter().chain(&tables::OBSTACLE_KEYS);
        let of_study = |spec| keys.clone().map(move |key| (spec, *key));
        let pairs = self.studies.iter().flat_map(of_study);
        pairs.filter(|(spec, key)| perturbed(spec.beam, spec.obstacles, key, self.at_most).is_some()).collect()
    }
}

/// The runs of one study, prepared once for all bisections.
struct Detector<'a> {
    spec: &'a Convergence,
    prepared: Vec<(Prepared<'a>, usize, usize)>,
}

impl<'a> Detector<'a> {
    fn new(spec: &'a Convergence) -> Result<Self, CaseFailure> {
        let prepare = |(n, steps)| Ok((Prepared::new(spec, n)?, n, steps));
        Ok(Self { spec, prepared: spec.refine.cases().into_iter().map(prepare).collect::<Result<_, CaseFailure>>()? })
    }

    /// Whether the study fails when the solver's coefficient is off by that much.
    fn detects(&mut self, key: &'static str, relative: f64) -> bool {
        let Some((beam, obstacles)) = perturbed(self.spec.beam, self.spec.obstacles, key, relative) else {
            return false;
        };
        let disagreement = Disagreement { beam, obstacles, defect: None };
        let spec = self.spec;
        let errors: Vec<(f64, Norms)> = self
            .prepared
            .iter_mut()
            // A wrong run that breaks down has been noticed.
            .map(|(prepared, n, steps)| {
                (spec.step(*n, *steps), prepared.run(*steps, disagreement).unwrap_or(Norms::NAN))
            })
            .collect();
        spec.expect.iter().any(|expectation| {
            let levels: Vec<Level> =
                errors.iter().map(|&(step, errors)| Level { step, error: errors[expectation.norm] }).collect();
            judge(&levels, expectation.order, expectation.tolerance).verdict == Verdict::Fail
        })
    }
}

impl Study for Sensitivity {
    fn header(&self) -> &Header {
        &self.header
    }

    fn cases(&self) -> Vec<Case> {
        let cost = |spec: &Convergence| -> f64 {
            let runs = BISECTIONS as f64 + 2.0;
            spec.refine.cases().iter().map(|&(n, steps)| n as f64 * (steps as f64 * runs * 4.0 + 50.0)).sum()
        };
        let case = |(spec, key): (&Convergence, &str)| Case {
            label: format!("{key} in {}", spec.header.id),
            cost: cost(spec),
        };
        self.pairs().into_iter().map(case).collect()
    }

    fn run(&self, index: usize) -> Result<Measured, CaseFailure> {
        let (spec, key) = self.pairs()[index];
        let mut detector = Detector::new(spec)?;
        let [mut unseen, mut seen] = self.range.map(f64::log10);
        let mut measured = Measured::default();
        let bracketed = !detector.detects(key, self.range[0]) && detector.detects(key, self.range[1]);
        if bracketed {
            for _ in 0..BISECTIONS {
                let middle = 0.5 * (unseen + seen);
                if detector.detects(key, 10f64.powf(middle)) { seen = middle } else { unseen = middle }
            }
        }
        measured.push("smallest", if bracketed { 10f64.powf(seen) } else { f64::INFINITY });
        Ok(measured)
    }

    fn conclude(&self, results: &[Result<Measured, CaseFailure>]) -> Outcome {
        let pairs = self.pairs();
        let smallest = |spec: &Convergence, key: &str| {
            let index = pairs.iter().position(|(of, name)| of.header.id == spec.header.id && *name == key)?;
            Some(results.get(index)?.as_ref().map_or(f64::NAN, |measured| measured.value("smallest")))
        };
        let (mut checks, mut rows, mut quantities) = (vec![], vec![], vec![]);
        for key in tables::BEAM_KEYS.iter().chain(&tables::OBSTACLE_KEYS) {
            let found: Vec<Option<f64>> = self.studies.iter().map(|spec| smallest(spec, key)).collect();
            // NaN, the mark of a failed case, wins over every number and is no detection.
            let best = found.iter().flatten().copied().reduce(|a, b| if a.is_nan() || a < b { a } else { b });
            let best = best.unwrap_or(f64::NAN);
            let claim = format!("{key} off by {:e} is seen", self.at_most);
            checks.push(Check::that(best <= self.at_most, claim, format!("seen from {best:.1e} on")));
            quantities.push(Quantity { name: format!("smallest {key} seen"), value: best, tolerance: 0.2 });
            let cell = |found: &Option<f64>| match found {
                Some(found) if found.is_finite() => format!("{found:.1e}"),
                Some(_) => "not in the range".to_owned(),
                None => "not there".to_owned(),
            };
            rows.push([vec![(*key).to_owned()], found.iter().map(cell).collect()].concat());
        }
        let summary = format!("every coefficient is seen from {:e} on, most from far less", self.at_most);
        let failed = checks.iter().any(|check| check.verdict != Verdict::Pass);
        let summary = if failed { "some coefficient is not seen".to_owned() } else { summary };
        let headline = summary.clone();
        let mut outcome = Outcome { headline, ..Outcome::new(summary, vec![], checks) };
        let mut head = vec!["coefficient".to_owned()];
        head.extend(self.studies.iter().map(|spec| spec.header.id.clone()));
        outcome.tables.push(Table {
            title: "Smallest relative error that makes the study fail".to_owned(),
            head,
            rows,
        });
        outcome.quantities = quantities;
        outcome
    }
}
