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
//! true_pass = 0.385      # least share of true claims that pass at a tolerance of 0.1, 4 to 8 levels
//! false_pass = 0.006     # allowed share of wrong claims that pass, at every tolerance, on all meshes
//! hidden = 0.24          # allowed share of tables that pass though a tenth of the finest error is a term of lower order
//! ```

pub mod bars;
mod laws;

use convergence_study::input::{InputError, Section};
use convergence_study::judge::calibration::comparison::Comparison;
use convergence_study::judge::calibration::{Calibration, Tally, calibrate};
use convergence_study::study::levels;
use convergence_study::study::{
    Case, CaseFailure, Check, FromFile, Header, Kind, KindRow, Outcome, Ran, Table, reader,
};
use std::path::Path;

use self::laws::Laws;

/// The row of the table of kinds.
pub const ROW: KindRow = KindRow {
    name: "calibration",
    read: reader::<RuleCalibration>,
    why: "The rule that turns errors into verdicts is applied to thousands of made-up sequences of errors whose order is known: \
          pure powers, polluted by higher powers, scattered, ending in a round-off floor.",
    judged: "Counted: how often a wrong claim passes, how often a right one fails, how often the interval holds the true order. \
             Each share has its limit.",
    failure: "The rule errs more often than is admitted: no verdict of any other study can be trusted as far as was said.",
};

/// Work of a sample in the runner's unit, measured: 10 µs against 25 ns for an element and step.
const SAMPLE_COST: f64 = 400.0;

/// What a case computes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Part {
    /// Families of errors: how often the interval holds the order.
    Families,
    /// 29 error laws, beside three other rules.
    Laws,
}

/// What a case finds.
#[derive(Debug, Clone)]
pub enum Counted {
    /// Of [`Part::Families`].
    Families(Calibration),
    /// Of [`Part::Laws`].
    Laws(Box<Comparison>),
}

/// A study of this kind.
pub struct RuleCalibration {
    header: Header,
    samples: usize,
    seed: u64,
    false_pass: f64,
    false_fail: f64,
    coverage: f64,
    laws: Laws,
}

/// A bound of the calibrations: a share of their samples.
fn share(section: &Section<'_>, key: &str) -> Result<f64, InputError> {
    let allowed = "a number between 0 and 1";
    section.require(key, allowed)?.number_where(allowed, |share| share > 0.0 && share < 1.0)
}

fn seed(section: &Section<'_>) -> Result<u64, InputError> {
    Ok(section.require("seed", "an integer >= 0")?.count(0..=usize::MAX)? as u64)
}

impl FromFile for RuleCalibration {
    fn from_document(header: Header, root: &Section<'_>, _: &Path) -> Result<Self, InputError> {
        root.allow(&["study", "calibration", "laws"])?;
        let allowed = "a table with samples, seed, false_pass, false_fail and coverage";
        let section = root.require("calibration", allowed)?.section()?;
        section.allow(&["samples", "seed", "false_pass", "false_fail", "coverage"])?;
        let share = |key: &str| share(&section, key);
        Ok(Self {
            header,
            samples: section.require("samples", "a number of samples")?.count(1000..=10_000_000)?,
            seed: seed(&section)?,
            false_pass: share("false_pass")?,
            false_fail: share("false_fail")?,
            coverage: share("coverage")?,
            laws: Laws::from_document(root)?,
        })
    }
}

impl Kind for RuleCalibration {
    type Data = Part;
    type Found = Counted;

    fn header(&self) -> &Header {
        &self.header
    }

    fn cases(&self) -> Vec<Case<Part>> {
        let label = format!("{} sequences", self.samples);
        let families = Case { label, cost: self.samples as f64 * SAMPLE_COST, data: Part::Families };
        vec![families, self.laws.case()]
    }

    fn run(&self, part: &Part) -> Result<Counted, CaseFailure> {
        Ok(match part {
            Part::Families => Counted::Families(calibrate(self.samples, self.seed)?),
            Part::Laws => Counted::Laws(Box::new(self.laws.run()?)),
        })
    }

    fn judge(&self, ran: &[Ran<Part, Counted>]) -> Outcome {
        let completion = levels::completion(ran, |_| vec![]);
        let found = |of: fn(&Counted) -> bool| ran.iter().filter_map(Ran::ok).find(|found| of(found));
        let families = found(|found| matches!(found, Counted::Families(_)));
        let laws = found(|found| matches!(found, Counted::Laws(_)));
        let (Some(Counted::Families(families)), Some(Counted::Laws(laws))) = (families, laws) else {
            return Outcome::new("a part of the calibration has no result", vec![], vec![completion]);
        };
        let (mut checks, table) = self.judge_families(families);
        checks.push(completion);
        checks.extend(self.laws.checks(laws));
        let summary = summary(&families.declared);
        let headline = format!("{summary}; {}", Laws::headline(laws));
        let mut tables = vec![table];
        tables.extend(Laws::tables(laws));
        let figures = Laws::figures(laws, &self.header.id);
        Outcome { headline, tables, figures, ..Outcome::new(summary, vec![], checks) }
    }
}

impl RuleCalibration {
    fn judge_families(&self, calibration: &Calibration) -> (Vec<Check>, Table) {
        let (mut checks, mut rows) = (vec![], vec![]);
        // The slices by number of levels mix families: shown, and judged for wrong passes only.
        let whole = calibration.families.iter().chain([&calibration.declared]).map(|tally| (tally, tally.declared));
        let slices = calibration.by_levels.iter().map(|tally| (tally, false));
        for (tally, declared) in slices.chain(whole) {
            let name = tally.family;
            let (pass, fail, coverage) = (tally.false_pass_rate(), tally.false_fail_rate(), tally.coverage());
            rows.push(vec![
                name.to_owned(),
                (tally.right + tally.wrong).to_string(),
                percent(pass),
                percent(fail),
                percent(tally.inconclusive_rate()),
                percent(coverage),
            ]);
            checks.push(Check::that(
                pass <= self.false_pass,
                format!("{name}: wrong claims pass in at most {}", percent(self.false_pass)),
                percent(pass),
            ));
            // Families that the rule is not made for, and slices by level, are shown; only wrong passes are judged there.
            if declared {
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

fn percent(share: f64) -> String {
    if share.is_nan() { "none".to_owned() } else { format!("{:.2} %", 100.0 * share) }
}

fn summary(declared: &Tally) -> String {
    format!(
        "{:.2} % false pass, {:.2} % false fail, {:.1} % of the intervals hold the truth",
        100.0 * declared.false_pass_rate(),
        100.0 * declared.false_fail_rate(),
        100.0 * declared.coverage(),
    )
}
