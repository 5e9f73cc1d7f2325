//! The smallest error in a coefficient that a study still detects, by bisection.
//!
//! ```toml
//! [sensitivity]
//! studies = ["theorem-3.4-space.toml"]    # files beside this one
//! elements = [64, 128, 256, 512]          # optional: levels in place of the studies' own
//! range = [1e-9, 1e-2]                    # relative errors: not detected at the first, detected at the last
//! at_most = 1e-4                          # what some study must detect of every coefficient
//! ```

use super::fault::{RELATIVE, relative};
use super::manufactured::named_studies;
use super::plantable::Detector;
use super::{ELEMENTS, STUDIES};
use crate::kinds::orders::Orders;
use crate::kinds::orders::manufactured::Convergence;
use crate::kinds::prelude::*;

/// Bisections of the logarithm: seven decades to within 4 percent.
const BISECTIONS: usize = 9;

/// A study of the smallest detected errors.
pub struct Sensitivity {
    studies: Vec<Described<Orders<Convergence>>>,
    range: [f64; 2],
    at_most: f64,
}

const SENSITIVITY: Keys = &[&[
    STUDIES,
    ELEMENTS,
    Key::new(
        "range",
        Form::List(&Form::Positive),
        "the relative errors between which it is searched, below 1",
    ),
    Key::new(
        "at_most",
        Form::Positive,
        "a relative error that some study must detect, below 1",
    ),
]];

impl FromFile for Sensitivity {
    const KEYS: &'static [Keys] = &[&[&[Key::new(
        "sensitivity",
        Form::Table(&[SENSITIVITY]),
        "the smallest error of each coefficient that a study detects",
    )]]];

    fn from_document(_: &Header, root: &Section<'_>, folder: &Path) -> Result<Self, InputError> {
        let section = root.table("sensitivity", SENSITIVITY)?;
        let ascending = "a list of two ascending numbers between 0 and 1";
        let range = section.list("range", ascending, relative, |ends| {
            ends.len() == 2 && increases(ends)
        })?;
        let studies = named_studies(&section, folder)?;
        let at_most = relative(&section.require("at_most", RELATIVE)?)?;
        Ok(Self {
            studies,
            range: [range[0], range[1]],
            at_most,
        })
    }
}

impl Kind for Sensitivity {
    /// Index of a study, and a coefficient; coefficients that a study lacks or has zero are left
    /// out.
    type Data = (usize, &'static str);
    /// The smallest relative error detected; `None` if the range does not bracket it.
    type Found = Option<f64>;

    fn cases(&self) -> Vec<Case<Self::Data>> {
        let cost = |spec: &Described<Orders<Convergence>>| -> f64 {
            let runs = BISECTIONS as f64 + 2.0;
            let cases = spec.kind.cases();
            cases.iter().map(|case| runs * case.cost).sum()
        };
        let of_study = |(study, spec): (usize, &Described<Orders<Convergence>>)| {
            let can_be_planted =
                |key: &&'static str| spec.kind.theory.off(key, self.at_most).is_some();
            let case = |key| {
                Case::new(
                    format!("{key} in {}", spec.header.id),
                    cost(spec),
                    (study, key),
                )
            };
            Coefficients::names()
                .filter(can_be_planted)
                .map(case)
                .collect::<Vec<_>>()
        };
        self.studies.iter().enumerate().flat_map(of_study).collect()
    }

    fn run(&self, &(study, key): &Self::Data) -> Result<Option<f64>, CaseFailure> {
        let mut detector = Detector::new(&self.studies[study].kind.0)?;
        let mut detects = |relative| detector.detects(key, relative) == Some(true);
        let [least, most] = self.range;
        if detects(least) || !detects(most) {
            return Ok(None);
        }
        let [mut missed, mut detected] = self.range.map(f64::log10);
        for _ in 0..BISECTIONS {
            let middle = 0.5 * (missed + detected);
            if detects(10f64.powf(middle)) {
                detected = middle;
            } else {
                missed = middle;
            }
        }
        Ok(Some(10f64.powf(detected)))
    }

    fn judge(&self, ran: &[Ran<(usize, &'static str), Option<f64>>]) -> Outcome {
        let mut checks = vec![completion(ran, |smallest| {
            not_finite([("the smallest error", *smallest)])
        })];
        let (mut rows, mut quantities) = (vec![], vec![]);
        let mut left_out = vec![];
        for key in Coefficients::names() {
            let cells: Vec<(f64, String)> = (0..self.studies.len())
                .map(|study| cell(study, key, ran))
                .collect();
            left_out.extend((0..self.studies.len()).map(|study| not_judged(study, key, ran)));
            let best = cells
                .iter()
                .map(|(smallest, _)| *smallest)
                .fold(f64::INFINITY, min_or_nan);
            let claim = format!("{key} off by {:e} is detected", self.at_most);
            let evidence = format!("detected from {best:.1e} on");
            let check = Check::that(best <= self.at_most, claim, evidence);
            checks.push(check.about(Subject::of(key)));
            let smallest = Quantity::new(format!("smallest {key} seen"), best, 0.2);
            quantities.push(smallest.about(Subject::of(key)));
            rows.push(
                std::iter::once(key.to_owned())
                    .chain(cells.into_iter().map(|(_, text)| text))
                    .collect(),
            );
        }
        let holds = checks.iter().all(|check| check.verdict == Verdict::Pass);
        let [which, is] = if holds {
            ["every", "detected, most from far less"]
        } else {
            ["some", "not detected"]
        };
        let summary = format!("{which} coefficient off by {:e} is {is}", self.at_most);
        let head = ["coefficient"]
            .into_iter()
            .chain(self.studies.iter().map(|spec| spec.header.id.as_str()));
        let title =
            "Smallest relative error that makes the study fail; n/a: coefficient absent or zero";
        let tables = vec![Table::new(title, head, rows)];
        Outcome {
            headline: summary.clone(),
            coverage: vec![Coverage::of("pairs of a study and a coefficient", left_out)],
            tables,
            quantities,
            ..Outcome::new(summary, vec![], checks)
        }
    }
}

/// Why the smallest error that a study detects is not known; `None` if it is.
fn not_judged(
    study: usize,
    key: &str,
    ran: &[Ran<(usize, &'static str), Option<f64>>],
) -> Option<&'static str> {
    let case = ran.iter().find(|ran| ran.case.data == (study, key));
    match case.map(|case| &case.found) {
        None => Some("the coefficient is absent or zero"),
        Some(Err(_)) => Some(NO_RESULT),
        Some(Ok(None)) => Some("not in the range"),
        Some(Ok(Some(_))) => None,
    }
}

/// The smallest error that a study detects, and its table cell: NaN if the case failed, infinite if
/// the study lacks the coefficient or the range does not bracket it.
fn cell(study: usize, key: &str, ran: &[Ran<(usize, &'static str), Option<f64>>]) -> (f64, String) {
    let case = ran.iter().find(|ran| ran.case.data == (study, key));
    match case.map(|case| &case.found) {
        None => (f64::INFINITY, "n/a".to_owned()),
        Some(Err(_)) => (f64::NAN, "failed".to_owned()),
        Some(Ok(None)) => (f64::INFINITY, "not in the range".to_owned()),
        Some(Ok(Some(smallest))) => (*smallest, format!("{smallest:.1e}")),
    }
}
