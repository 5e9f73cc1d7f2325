//! Error bars of values without exact solution, judged themselves: values whose limit is known.
//!
//! ```toml
//! [bars]
//! samples = 150          # of each of 29 laws
//! seed = 4
//! coverage = 0.95        # least share of all bars that contain the true error
//! coverage_each = 0.85   # the same for each law, and for each number of values
//! refused = 0.30         # allowed share of samples without a bar
//! width = 0.30           # allowed median of half-width over true error
//! ```

use std::path::Path;

use convergence_study::input::{InputError, Section};
use convergence_study::judge::calibration::bars::{Bars, ELEMENTS_OF_A_BAR, Tally, calibrate_bars};
use convergence_study::judge::calibration::laws::LAWS;
use convergence_study::study::levels;
use convergence_study::study::{
    Case, CaseFailure, Check, FromFile, Header, Kind, KindRow, Outcome, Ran, Table, reader,
};

use super::{percent, seed, share};

/// The row of the table of kinds.
pub const ROW: KindRow = KindRow {
    name: "bar-calibration",
    read: reader::<BarCalibration>,
    why: "Richardson's estimate with its bar, and the grid convergence index, are applied to thousands of made-up sequences of values whose limit is known: \
          polluted, scattered, on equal and unequal steps.",
    judged: "Counted: how often the bar contains the true error, how often it is refused, how long it is. Each has its limit.",
    failure: "Bars contain the true error less often than is admitted, or are longer: no error bar of any other study can be trusted as far as was said.",
};

/// A study of this kind.
pub struct BarCalibration {
    header: Header,
    samples: usize,
    seed: u64,
    coverage: f64,
    coverage_each: f64,
    refused: f64,
    width: f64,
}

impl FromFile for BarCalibration {
    fn from_document(header: Header, root: &Section<'_>, _: &Path) -> Result<Self, InputError> {
        root.allow(&["study", "bars"])?;
        let allowed = "a table with samples, seed, coverage, coverage_each, refused and width";
        let section = root.require("bars", allowed)?.section()?;
        section.allow(&["samples", "seed", "coverage", "coverage_each", "refused", "width"])?;
        let share = |key: &str| share(&section, key);
        Ok(Self {
            header,
            samples: section.require("samples", "a number of samples of each law")?.count(20..=100_000)?,
            seed: seed(&section)?,
            coverage: share("coverage")?,
            coverage_each: share("coverage_each")?,
            refused: share("refused")?,
            width: share("width")?,
        })
    }
}

impl Kind for BarCalibration {
    type Data = ();
    type Found = Bars;

    fn header(&self) -> &Header {
        &self.header
    }

    fn cases(&self) -> Vec<Case<()>> {
        let cost = (self.samples * LAWS.len() * ELEMENTS_OF_A_BAR) as f64;
        vec![Case { label: format!("{} sequences of each law", self.samples), cost, data: () }]
    }

    fn run(&self, (): &()) -> Result<Bars, CaseFailure> {
        Ok(calibrate_bars(self.samples, self.seed)?)
    }

    fn judge(&self, ran: &[Ran<(), Bars>]) -> Outcome {
        let completion = levels::completion(ran, |_| vec![]);
        let Some(bars) = ran.first().and_then(Ran::ok) else {
            return Outcome::new("the calibration has no result", vec![], vec![completion]);
        };
        let all = &bars.declared;
        let held = |tally: &Tally, least: f64| {
            let claim = format!("{}: at least {} of the bars contain the true error", tally.name, percent(least));
            Check::that(tally.coverage() >= least, claim, percent(tally.coverage()))
        };
        let each = bars.laws.iter().filter(|tally| tally.declared).chain(&bars.by_values);
        let mut checks: Vec<Check> = each.map(|tally| held(tally, self.coverage_each)).collect();
        checks.push(held(all, self.coverage));
        let claim = format!("bars are refused in at most {}", percent(self.refused));
        checks.push(Check::that(all.refused() <= self.refused, claim, percent(all.refused())));
        let claim = format!("the median half-width is at most {} of the true error", self.width);
        checks.push(Check::that(all.width() <= self.width, claim, format!("{:.3}", all.width())));
        checks.push(completion);
        let summary = format!(
            "{:.1} % of the bars contain the true error, {:.1} % of those of the grid convergence index; the median half-width is \
             {:.2} of the true error, that of the index {:.2}",
            100.0 * all.coverage(),
            100.0 * all.index_coverage(),
            all.width(),
            all.index_width(),
        );
        Outcome { tables: vec![table(bars)], ..Outcome::new(summary, vec![], checks) }
    }
}

fn table(bars: &Bars) -> Table {
    let row = |tally: &Tally| {
        vec![
            if tally.declared { tally.name.clone() } else { format!("({})", tally.name) },
            tally.samples.to_string(),
            percent(tally.refused()),
            percent(tally.coverage()),
            percent(tally.index_coverage()),
            format!("{:.3}", tally.width()),
            format!("{:.3}", tally.index_width()),
        ]
    };
    let head = [
        "values",
        "samples",
        "refused",
        "bar contains it",
        "index contains it",
        "half-width of the bar",
        "of the index",
    ];
    Table {
        title: "Error bars and grid convergence index on values of known limit: how often they contain the true error; half-widths are medians, as shares of it".to_owned(),
        head: head.map(str::to_owned).to_vec(),
        rows: bars.laws.iter().chain(&bars.by_values).chain([&bars.declared]).map(row).collect(),
    }
}
