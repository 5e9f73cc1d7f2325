//! The figure of errors over levels.

use std::ops::Range;

use super::{Axis, Levels, result_at};
use crate::plots::{self, ErrorSeries, xy::Xy};
use crate::study::outcome::{Figure, NamedRate};

/// The explanation of the lines in a caption.
pub(super) const LINES: &str =
    " Lines: the rates observed, each through the finest error that it uses.";

impl Axis {
    /// The step that is refined, in a title.
    fn symbol(self) -> &'static str {
        match self {
            Axis::Space => "h",
            Axis::Time => "dt",
            Axis::Both => "h and dt",
        }
    }
}

impl Levels {
    /// The labels of levels that lack a result for some claimed error.
    fn without_result(&self) -> Vec<&str> {
        let mut labels = vec![];
        for (i, level) in self.refinements.iter().enumerate() {
            let mut claimed = self.columns.iter().filter(|column| column.claim.is_some());
            if claimed.any(|column| result_at(&column.errors, i).is_none()) {
                labels.push(level.label.as_str());
            }
        }
        labels
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
        let claimed = self
            .columns
            .iter()
            .filter_map(|column| column.claim.map(|claim| (column, claim)));
        let series = claimed.map(|(column, claim)| {
            let points = self.points(column);
            let mut judged = rates.iter();
            let rate = judged.find(|rate| rate.name == column.name);
            let rate = rate.map(|rate| &rate.rate);
            ErrorSeries {
                label: column.symbol.clone().unwrap_or(column.name.clone()),
                fit: rate.and_then(|rate| rate.power_law()),
                interval: rate.and_then(|rate| rate.interval),
                points: points
                    .iter()
                    .map(|level| (level.step, level.error))
                    .collect(),
                order: Some(claim.order),
                used: rate.map(|rate| among_results(&rate.used, &self.has_result(column))),
                look: Some(column.look),
            }
        });
        let series: Vec<ErrorSeries> = series.collect();
        let has_line = series.iter().any(|series| series.line().is_some());
        let caption = if has_line { caption + LINES } else { caption };
        let without = self.without_result();
        let notes: Vec<String> = without
            .iter()
            .map(|label| format!("{label}: no result"))
            .collect();
        let missing = if without.is_empty() {
            String::new()
        } else {
            format!(" No result: {}.", without.join("; "))
        };
        let step = self.axis.symbol();
        let title = match subject {
            Some(subject) => format!("{subject}: errors fall with {step} as the triangles do"),
            None => format!("Errors fall with {step} as the triangles do"),
        };
        let has_triangle = series
            .iter()
            .any(|series| series.order.is_some_and(|order| order > 0.0));
        let xy = Xy {
            title: has_triangle.then_some(title),
            notes,
            ..Xy::of_errors(self.axis.label())
        };
        Figure::new(
            what,
            caption + &missing,
            plots::convergence(xy, &series, &[]),
        )
    }
}

/// A range of levels, counted among those with a result.
fn among_results(levels: &Range<usize>, has_result: &[bool]) -> Range<usize> {
    count_results(levels.start, has_result)..count_results(levels.end, has_result)
}

/// The number of levels with a result before a level.
fn count_results(level: usize, has_result: &[bool]) -> usize {
    let before = has_result.iter().take(level);
    before.filter(|has_result| **has_result).count()
}
