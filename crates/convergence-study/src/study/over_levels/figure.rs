//! The figure of errors over levels, drawn from the rows that the report lists.

use super::{Levels, RefinedIn, result_at};
use crate::chart::{self, Chart, Columns, Series};
use crate::study::outcome::{Figure, LevelErrors, NamedRate};
use crate::text::prose::capitalized;
use convergence_judge::verdict::Verdict;

/// The explanation of the lines in a caption.
pub(super) const LINES: &str =
    " Lines: the rates observed, each through the finest error that it uses.";

impl RefinedIn {
    /// The step that is refined, in a title.
    fn symbol(self) -> &'static str {
        match self {
            RefinedIn::Space => "h",
            RefinedIn::Time => "dt",
            RefinedIn::Both => "h and dt",
        }
    }
}

impl Levels {
    /// For each level, how many claimed errors lack a result.
    fn lacking(&self) -> Vec<usize> {
        let lacking = (0..self.refinements.len()).map(|level| {
            let claimed = self.columns.iter().filter(|column| column.claim.is_some());
            claimed
                .filter(|column| result_at(&column.errors, level).is_none())
                .count()
        });
        lacking.collect()
    }

    /// The judged errors, each with the line of its rate if that is known, and triangles for the
    /// orders claimed.
    ///
    /// * `subject`: what has these errors, for the title, which says what one should see.
    /// * `caption`: the content, as a sentence; an explanation of the lines is appended if there
    ///   are any.
    pub fn figure(
        &self,
        what: &str,
        subject: Option<String>,
        caption: String,
        rates: &[NamedRate],
    ) -> Figure {
        let lacking = self.lacking();
        let levels = self.refinements.iter().zip(&lacking);
        let without: Vec<&str> = levels
            .filter(|(_, errors)| **errors > 0)
            .map(|(level, _)| level.label.as_str())
            .collect();
        let chart = Chart {
            notes: without
                .iter()
                .map(|label| format!("{label}: no result"))
                .collect(),
            missing: lacking.iter().sum(),
            ..self.chart(subject, rates)
        };
        let has_line = chart.series.iter().any(|series| series.law.is_some());
        let lines = if has_line { LINES } else { "" };
        let missing = if without.is_empty() {
            String::new()
        } else {
            format!(" No result: {}.", without.join("; "))
        };
        Figure::of(what, caption + lines + &missing, chart)
    }

    /// The rows that a report lists, with a column for each claimed error: NaN if no level has it.
    pub(crate) fn rows(&self) -> Columns {
        let mut table = Columns::from(&self.errors()[..]);
        for column in self.columns.iter().filter(|column| column.claim.is_some()) {
            if !table.has(&column.name) {
                let lacking = self.refinements.iter().map(|_| f64::NAN);
                table.push(&column.name, lacking);
            }
        }
        table
    }

    /// A series for each error with a claim.
    fn chart(&self, subject: Option<String>, rates: &[NamedRate]) -> Chart {
        let mut series = vec![];
        let mut verdicts = vec![];
        for column in &self.columns {
            let Some(claim) = column.claim else { continue };
            let mut label = column.symbol.as_ref().unwrap_or(&column.name).clone();
            if column.is_only_drawn {
                label += " (not claimed)";
            }
            let errors = Series::errors(label, STEP, &column.name).claiming(claim.order);
            let errors = errors.styled(column.style);
            let rate = rates.iter().find(|rate| rate.name == column.name);
            if !column.is_only_drawn {
                verdicts.extend(rate.map(|rate| rate.rate.verdict));
            }
            series.push(match rate {
                Some(rate) => errors.judged(&rate.rate),
                None => errors,
            });
        }
        let has_triangle = series.iter().any(|series| series.order > Some(0.0));
        let title = match subject {
            _ if !has_triangle => String::new(),
            Some(subject) => format!("{subject}: {}", self.seen(&verdicts)),
            None => capitalized(&self.seen(&verdicts)),
        };
        Chart {
            title,
            series,
            ..Chart::new(
                self.rows(),
                chart::Axis::log(self.axis.label()),
                chart::Axis::log(self.measured),
            )
        }
    }

    /// What one sees, which the verdicts decide.
    fn seen(&self, verdicts: &[Verdict]) -> String {
        let step = self.axis.symbol();
        let count = |verdict| verdicts.iter().filter(|own| **own == verdict).count();
        let measured = self.measured;
        let of = |part: usize| match verdicts.len() {
            1 => format!("the {measured}"),
            all => format!("{part} of {all} {measured}s"),
        };
        match [Verdict::Fail, Verdict::Inconclusive].map(count) {
            _ if verdicts.is_empty() => format!("{measured}s over {step}"),
            [0, 0] if self.columns.iter().any(|column| column.is_only_drawn) => {
                "those claimed fall as the triangles do".to_owned()
            }
            [0, 0] => format!("{measured}s fall with {step} as the triangles do"),
            [0, undecided] => format!("the order in {step} is undecided for {}", of(undecided)),
            [failing, _] => format!("the order in {step} fails for {}", of(failing)),
        }
    }
}

/// The column of the steps.
const STEP: &str = "step";

/// The rows that a report lists: a column for the steps, and one for each error.
impl From<&[LevelErrors]> for Columns {
    fn from(levels: &[LevelErrors]) -> Self {
        let steps = levels.iter().map(|level| level.step.unwrap_or(f64::NAN));
        let mut table = Self::new([(STEP, steps.collect())]);
        // A level without a result lacks the errors of the others.
        for error in levels.iter().flat_map(|level| &level.errors) {
            if !table.has(&error.name) {
                let values = levels.iter().map(|level| level.error(&error.name));
                table.push(&error.name, values);
            }
        }
        table
    }
}
