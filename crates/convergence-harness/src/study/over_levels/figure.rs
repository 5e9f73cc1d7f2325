//! The figure of errors over levels.

use std::ops::Range;

use super::{Axis, Levels, Rates, at};
use crate::plots::{self, ErrorSeries, xy::Xy};
use crate::study::outcome::Figure;

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
        let lacks = |i: usize| {
            self.columns
                .iter()
                .any(|column| column.claim.is_some() && at(&column.errors, i).is_none())
        };
        self.refinements
            .iter()
            .enumerate()
            .filter(|(i, _)| lacks(*i))
            .map(|(_, level)| level.label.as_str())
            .collect()
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
        rates: &Rates,
    ) -> Figure {
        let claimed = self
            .columns
            .iter()
            .filter_map(|column| column.claim.map(|claim| (column, claim)));
        let series = claimed.map(|(column, claim)| {
            let points = self.points(column);
            let rate = rates.iter().find(|(name, _)| *name == column.name);
            ErrorSeries {
                label: column.symbol.clone().unwrap_or(column.name.clone()),
                fit: rate.and_then(|(_, rate)| rate.power_law()),
                interval: rate.and_then(|(_, rate)| rate.interval),
                points: points
                    .iter()
                    .map(|level| (level.step, level.error))
                    .collect(),
                order: Some(claim.order),
                used: rate.map(|(_, rate)| drawn(&rate.used, &self.has_result(column))),
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
        let seen = match subject {
            Some(subject) => format!("{subject}: errors fall with {step} as the triangles do"),
            None => format!("Errors fall with {step} as the triangles do"),
        };
        let has_triangle = series
            .iter()
            .any(|series| series.order.is_some_and(|order| order > 0.0));
        let xy = Xy {
            title: has_triangle.then_some(seen),
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
fn drawn(used: &Range<usize>, has: &[bool]) -> Range<usize> {
    let before = |end: usize| has[..end.min(has.len())].iter().filter(|has| **has).count();
    before(used.start)..before(used.end)
}
