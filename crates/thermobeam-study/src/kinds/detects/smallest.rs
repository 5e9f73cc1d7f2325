//! The smallest error in a coefficient that a study still detects, by bisection.
//!
//! ```toml
//! [sensitivity]
//! studies = ["theorem-3.4-space.toml"]    # files beside this one
//! elements = [64, 128, 256, 512]          # optional: levels in place of the studies' own
//! range = [1e-9, 1e-2]                    # relative errors: not detected at the first, detected at the last
//! at_most = 1e-4                          # what some study must detect of every coefficient
//! ```

use super::{ELEMENTS, STUDIES, manufactured::named_studies};
use crate::kinds::prelude::*;
use crate::{
    kinds::orders::{
        Orders,
        manufactured::Convergence,
        planted::{
            fault::{RELATIVE, relative},
            plantable::Detector,
        },
    },
    scene::Coefficients,
};
use convergence_judge::text::number::min_or_nan;
use convergence_study::{
    Coverage,
    internal::study::{Described, coverage::NO_RESULT, header::SettingWords},
};

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

    fn settings(&self, header: &Header, subject: &Subject) -> Vec<SettingWords> {
        super::exercise(&self.studies, subject).settings(header, subject)
    }

    fn cases(&self) -> Vec<Case<Self::Data>> {
        let runs = BISECTIONS as f64 + 2.0;
        let mut pairs = vec![];
        for (study, described) in self.studies.iter().enumerate() {
            let cases = described.kind.cases();
            let cost: f64 = cases.iter().map(|case| runs * case.cost).sum();
            for key in Coefficients::names() {
                if described.kind.theory.off(key, self.at_most).is_some() {
                    let label = format!("{key} in {}", described.header.id);
                    pairs.push(Case::new(label, cost, (study, key)));
                }
            }
        }
        pairs
    }

    fn run(&self, &(study, key): &Self::Data) -> Result<Option<f64>, CaseFailure> {
        let mut detector = Detector::new(&self.studies[study].kind.0)?;
        let [least, most] = self.range;
        if detector.detects(key, least) == Some(true) || detector.detects(key, most) != Some(true) {
            return Ok(None);
        }
        let [mut missed, mut detected] = self.range.map(f64::log10);
        for _ in 0..BISECTIONS {
            let middle = 0.5 * (missed + detected);
            if detector.detects(key, 10f64.powf(middle)) == Some(true) {
                detected = middle;
            } else {
                missed = middle;
            }
        }
        Ok(Some(10f64.powf(detected)))
    }

    fn judge(&self, ran: &[Ran<(usize, &'static str), Option<f64>>]) -> Outcome {
        let mut checks = vec![completion_check(ran, |smallest| {
            not_finite([("the smallest error", *smallest)])
        })];
        let mut rows = vec![];
        let mut quantities = vec![];
        let mut left_out = vec![];
        for key in Coefficients::names() {
            let mut best = f64::INFINITY;
            let mut row = vec![key.to_owned()];
            for study in 0..self.studies.len() {
                let result = PairResult::new(study, key, ran);
                best = min_or_nan(best, result.smallest());
                row.push(result.cell());
                left_out.push(result.omission());
            }
            let claim = format!("{key} off by {:e} is detected", self.at_most);
            let evidence = format!("detected from {best:.1e} on");
            let check = Check::that(best <= self.at_most, claim, evidence);
            checks.push(check.about(Subject::of(key)));
            let smallest = Quantity::new(format!("smallest {key} seen"), best, 0.2);
            quantities.push(smallest.about(Subject::of(key)));
            rows.push(row);
        }
        let holds = checks.iter().all(|check| check.verdict == Verdict::Pass);
        let off = format!("coefficient off by {:e}", self.at_most);
        let summary = if holds {
            format!("every {off} is detected, most from far less")
        } else {
            format!("some {off} is not detected")
        };
        let head = ["coefficient"]
            .into_iter()
            .chain(self.studies.iter().map(|spec| spec.header.id.as_str()));
        let title =
            "Smallest relative error that makes the study fail; n/a: coefficient absent or zero";
        let tables = vec![Table::new(title, head, rows)];
        Outcome {
            headline: summary.clone().into(),
            coverage: vec![Coverage::of("pairs of a study and a coefficient", left_out)],
            tables,
            quantities,
            ..Outcome::new(summary, vec![], checks)
        }
    }
}

/// The smallest error in a coefficient that a study detects.
enum PairResult {
    /// The coefficient is absent or zero.
    Absent,
    /// The case failed.
    Failed,
    /// The range does not bracket it.
    NotInRange,
    /// A relative error.
    Smallest(f64),
}

impl PairResult {
    fn new(study: usize, key: &str, ran: &[Ran<(usize, &'static str), Option<f64>>]) -> Self {
        let case = ran.iter().find(|ran| ran.case.data == (study, key));
        match case.map(|case| &case.found) {
            None => Self::Absent,
            Some(Err(_)) => Self::Failed,
            Some(Ok(None)) => Self::NotInRange,
            Some(Ok(Some(smallest))) => Self::Smallest(*smallest),
        }
    }

    /// The error; NaN if the case failed, infinite if the study detects none in the range.
    fn smallest(&self) -> f64 {
        match self {
            Self::Absent | Self::NotInRange => f64::INFINITY,
            Self::Failed => f64::NAN,
            Self::Smallest(error) => *error,
        }
    }

    fn cell(&self) -> String {
        match self {
            Self::Absent => "n/a".to_owned(),
            Self::Failed => "failed".to_owned(),
            Self::NotInRange => "not in the range".to_owned(),
            Self::Smallest(error) => format!("{error:.1e}"),
        }
    }

    /// Why the error is not known; `None` if it is.
    fn omission(&self) -> Option<&'static str> {
        match self {
            Self::Absent => Some("the coefficient is absent or zero"),
            Self::Failed => Some(NO_RESULT),
            Self::NotInRange => Some("not in the range"),
            Self::Smallest(_) => None,
        }
    }
}
