//! The rule that judges rates, judged itself: synthetic error sequences of known order.
//!
//! ```toml
//! [calibration]          # families of errors: how often the interval holds the order
//! samples = 20000
//! seed = 2
//! false_pass = 0.01      # allowed share of wrong claims, 0.1 off the true order, that pass
//! false_fail = 0.02      # allowed share of right claims that fail
//! coverage = 0.93        # least share of intervals that hold the true order
//!
//! [laws]                 # 29 error laws on meshes that people use, beside three other rules
//! tables = 6             # for each law and mesh
//! seed = 3
//! true_pass = 0.395      # least share of true claims that pass at a tolerance of 0.1, 4 to 8 levels
//! false_pass = 0.006     # allowed share of wrong claims that pass, at every tolerance, on all meshes
//! hidden = 0.24          # allowed share of tables that pass though a tenth of the finest error is a term of lower order
//! ```

mod laws;

use self::laws::Laws;
use crate::calibration::{Calibration, calibrate};
use crate::case::{Case, CaseFailure, Measured};
use crate::document::{self, InputError, Section};
use crate::outcome::{Check, Outcome, Table};
use crate::study::{FromFile, Study};
use crate::study_file::{StudyHeader, header};
use std::path::Path;

/// Name of the kind.
pub const CALIBRATION: &str = "calibration";

/// Work of a sample in the runner's unit, measured: 10 µs against 25 ns for an element and step.
const SAMPLE_COST: f64 = 400.0;

/// A study of this kind.
pub struct RuleCalibration {
    header: StudyHeader,
    samples: usize,
    seed: u64,
    false_pass: f64,
    false_fail: f64,
    coverage: f64,
    laws: Laws,
}

impl FromFile for RuleCalibration {
    fn parse(text: &str, file: &Path) -> Result<Self, InputError> {
        document::parse_beside(text, file, |root, _| Self::from_document(root))
    }
}

impl RuleCalibration {
    fn from_document(root: &Section<'_>) -> Result<Self, InputError> {
        root.allow(&["study", "calibration", "laws"])?;
        let allowed = "a table with samples, seed, false_pass, false_fail and coverage";
        let section = root.require("calibration", allowed)?.section()?;
        section.allow(&["samples", "seed", "false_pass", "false_fail", "coverage"])?;
        let share = |key: &str| {
            let allowed = "a number between 0 and 1";
            section.require(key, allowed)?.number_where(allowed, |share| share > 0.0 && share < 1.0)
        };
        Ok(Self {
            header: header(root)?,
            samples: section.require("samples", "a number of samples")?.count(1000..=10_000_000)?,
            seed: section.require("seed", "an integer >= 0")?.count(0..=usize::MAX)? as u64,
            false_pass: share("false_pass")?,
            false_fail: share("false_fail")?,
            coverage: share("coverage")?,
            laws: Laws::from_document(root)?,
        })
    }
}

impl Study for RuleCalibration {
    fn header(&self) -> &StudyHeader {
        &self.header
    }

    fn cases(&self) -> Vec<Case> {
        let families = Case { label: format!("{} sequences", self.samples), cost: self.samples as f64 * SAMPLE_COST };
        vec![families, self.laws.case()]
    }

    fn run(&self, index: usize) -> Result<Measured, CaseFailure> {
        if index == 0 { self.families() } else { self.laws.run() }
    }

    fn conclude(&self, results: &[Result<Measured, CaseFailure>]) -> Outcome {
        let (families, laws) = match results {
            [Ok(families), Ok(laws)] => (families, laws),
            [Err(failure), _] | [_, Err(failure)] => {
                let check = Check::that(false, "the calibration runs to its end", &failure.reason);
                return Outcome::new(failure.reason.clone(), vec![], vec![check]);
            }
            _ => return Outcome::new("there is no result", vec![], vec![]),
        };
        let (mut checks, table) = self.judge_families(families);
        checks.extend(self.laws.checks(laws));
        let summary = summary(families);
        let headline = format!("{summary}; {}", Laws::headline(laws));
        let mut outcome = Outcome { headline, ..Outcome::new(summary, vec![], checks) };
        outcome.tables.push(table);
        outcome.tables.extend(Laws::tables(laws));
        outcome.figures = Laws::figures(laws, &self.header.id);
        outcome
    }
}

impl RuleCalibration {
    fn families(&self) -> Result<Measured, CaseFailure> {
        let calibration = calibrate(self.samples, self.seed)?;
        let mut measured = Measured::default();
        // The slices by number of levels mix families: shown, and judged for wrong passes only.
        let whole = calibration.families.iter().chain([&calibration.declared]).map(|tally| (tally, tally.declared));
        let slices = calibration.by_levels.iter().map(|tally| (tally, false));
        for (tally, declared) in slices.chain(whole) {
            let mut push = |what: &str, value: f64| measured.push(format!("{} | {what}", tally.family), value);
            push("samples", (tally.right + tally.wrong) as f64);
            push("false pass", tally.false_pass_rate());
            push("false fail", tally.false_fail_rate());
            push("inconclusive", tally.inconclusive_rate());
            push("coverage", tally.coverage());
            push("declared", f64::from(declared));
        }
        Ok(measured)
    }

    fn judge_families(&self, measured: &Measured) -> (Vec<Check>, Table) {
        let mut checks = vec![];
        let mut rows = vec![];
        let names = measured.values.iter().filter_map(|(key, _)| key.strip_suffix(" | samples"));
        for name in names {
            let of = |what: &str| measured.value(&format!("{name} | {what}"));
            let (pass, fail, coverage) = (of("false pass"), of("false fail"), of("coverage"));
            rows.push(vec![
                name.to_owned(),
                format!("{}", of("samples")),
                percent(pass),
                percent(fail),
                percent(of("inconclusive")),
                percent(coverage),
            ]);
            checks.push(Check::that(
                pass <= self.false_pass,
                format!("{name}: wrong claims pass in at most {}", percent(self.false_pass)),
                percent(pass),
            ));
            // Families that the rule is not made for, and slices by level, are shown; only wrong passes are judged there.
            if of("declared") == 1.0 {
                let evidence = format!("false fail {}, coverage {}", percent(fail), percent(coverage));
                let claim = format!("{name}: right claims rarely fail, intervals hold the truth");
                checks.push(Check::that(fail <= self.false_fail && coverage >= self.coverage, claim, evidence));
            }
        }
        let table = Table {
            title: "The rule on error sequences of known order; a wrong claim is 0.1 off at a tolerance of 0.05"
                .to_owned(),
            head: Calibration::HEAD.map(str::to_owned).to_vec(),
            rows,
        };
        (checks, table)
    }
}

fn summary(measured: &Measured) -> String {
    let of = |what: &str| {
        let key = measured.values.iter().rev().find(|(key, _)| key.ends_with(&format!(" | {what}")));
        key.map_or(f64::NAN, |(_, value)| 100.0 * value)
    };
    format!(
        "{:.2} % false pass, {:.2} % false fail, {:.1} % of the intervals hold the truth",
        of("false pass"),
        of("false fail"),
        of("coverage")
    )
}

/// A share in per cent; NaN is the share of nothing.
fn percent(share: f64) -> String {
    if share.is_nan() { "none".to_owned() } else { format!("{:.2} %", 100.0 * share) }
}
