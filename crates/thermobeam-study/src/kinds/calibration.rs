//! The rule that judges rates, judged itself: thousands of synthetic error sequences of known order.
//!
//! ```toml
//! [calibration]
//! samples = 20000
//! seed = 2
//! false_pass = 0.01      # allowed share of wrong claims, 0.1 off the true order, that pass
//! false_fail = 0.02      # allowed share of right claims that fail
//! coverage = 0.93        # least share of intervals that hold the true order
//! ```

use convergence_study::input::{InputError, Section};
use convergence_study::judge::calibration::{Calibration, Tally, calibrate};
use convergence_study::study::{
    Case, CaseFailure, Check, FromFile, Header, Kind, KindRow, Outcome, Ran, Table, reader,
};
use std::path::Path;

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

/// Work of a sample in the runner's unit, measured: 4 µs against 25 ns for an element and step.
const SAMPLE_COST: f64 = 160.0;

/// A study of this kind.
pub struct RuleCalibration {
    header: Header,
    samples: usize,
    seed: u64,
    false_pass: f64,
    false_fail: f64,
    coverage: f64,
}

impl FromFile for RuleCalibration {
    fn from_document(header: Header, root: &Section<'_>, _: &Path) -> Result<Self, InputError> {
        root.allow(&["study", "calibration"])?;
        let allowed = "a table with samples, seed, false_pass, false_fail and coverage";
        let section = root.require("calibration", allowed)?.section()?;
        section.allow(&["samples", "seed", "false_pass", "false_fail", "coverage"])?;
        let share = |key: &str| {
            let allowed = "a number between 0 and 1";
            section.require(key, allowed)?.number_where(allowed, |share| share > 0.0 && share < 1.0)
        };
        Ok(Self {
            header,
            samples: section.require("samples", "a number of samples")?.count(1000..=10_000_000)?,
            seed: section.require("seed", "an integer >= 0")?.count(0..=usize::MAX)? as u64,
            false_pass: share("false_pass")?,
            false_fail: share("false_fail")?,
            coverage: share("coverage")?,
        })
    }
}

impl Kind for RuleCalibration {
    type Data = ();
    type Found = Calibration;

    fn header(&self) -> &Header {
        &self.header
    }

    fn cases(&self) -> Vec<Case<()>> {
        let label = format!("{} sequences", self.samples);
        vec![Case { label, cost: self.samples as f64 * SAMPLE_COST, data: () }]
    }

    fn run(&self, (): &()) -> Result<Calibration, CaseFailure> {
        Ok(calibrate(self.samples, self.seed)?)
    }

    fn judge(&self, ran: &[Ran<(), Calibration>]) -> Outcome {
        let calibration = match ran {
            [Ran { found: Ok(calibration), .. }] => calibration,
            [Ran { found: Err(failure), .. }] => {
                let check = Check::that(false, "the calibration runs to its end", &failure.reason);
                return Outcome::new(failure.reason.clone(), vec![], vec![check]);
            }
            _ => return Outcome::new("there is no result", vec![], vec![]),
        };
        let (checks, table) = self.judge_families(calibration);
        let summary = summary(&calibration.declared);
        let headline = summary.clone();
        Outcome { headline, tables: vec![table], ..Outcome::new(summary, vec![], checks) }
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
