//! A series with its numbers: its line and markers.

use std::ops::Range;

use super::layout::Layout;
use super::page::{Page, escape_attribute};
use super::pen::{Point, Style, style};
use super::{Chart, Mark, Series};
use crate::text::number::significant;

/// Markers nearer than this hide each other, in px; of the hidden series, they grow.
const HIDDEN: f64 = 6.5;
const LARGER: f64 = 1.5;
/// Ratio of neighbouring x from which no line joins the errors: nothing was measured there.
const GAP: f64 = 8.0;
/// Columns in which all curves of a chart are thinned: this bounds the size of the document.
const COLUMNS: usize = 3200;
/// A series with more points than this is read off its line: its values would cost too many bytes.
const MOST_POINTS: usize = 200;

pub(super) struct Curve<'a> {
    pub(super) series: &'a Series,
    pub(super) points: Vec<Point>,
    pub(super) used: Range<usize>,
    pub(super) style: Style,
}

impl<'a> Curve<'a> {
    /// All series of a chart.
    pub(super) fn all(chart: &'a Chart) -> Vec<Self> {
        let series = chart.series.iter().enumerate();
        let curves = series.map(|(place, series)| {
            let points = chart.table.pairs(&series.x, &series.y);
            let own = style(series.style.unwrap_or(place));
            let law = series.law.map(|_| Series::SOLID);
            Self {
                series,
                used: series.used.clone().unwrap_or(0..points.len()),
                points,
                style: Style {
                    dashes: series.dashes.or(law).unwrap_or(own.dashes),
                    ..own
                },
            }
        });
        curves.collect()
    }

    /// Where its points stand, if its axes can show them.
    fn places(&self, layout: &Layout) -> Vec<Option<Point>> {
        let places = self.points.iter().map(|at| layout.px(*at));
        let shown = places.map(|at| (at.0 + at.1).is_finite().then_some(at));
        shown.collect()
    }

    /// The parts of its line, between missing points and over the rows that count.
    pub(super) fn line(&self, layout: &Layout, curves: usize) -> Vec<Vec<Point>> {
        let used = self.points.get(self.used.clone()).unwrap_or_default();
        if let Some(law) = self.series.law {
            let steps = used.iter().map(|at| at.0);
            let steps = steps.filter(|step| *step > 0.0 && step.is_finite());
            let first = steps.clone().fold(f64::INFINITY, f64::min);
            let ends = [first, steps.fold(0.0, f64::max)];
            let ends = ends.map(|step| layout.px((step, law.error_at(step))));
            return match ends.iter().all(|at| (at.0 + at.1).is_finite()) {
                true => vec![ends.to_vec()],
                false => vec![],
            };
        }
        let is_one = |(x, _): &Point, (next, _): &Point| {
            let has_gaps = self.series.is_over_steps;
            !(has_gaps && (next / x).max(x / next) >= GAP)
        };
        let width = (layout.plot[2] - layout.plot[0]) * curves as f64 / COLUMNS as f64;
        let mut parts = vec![];
        for part in used.chunk_by(is_one) {
            let places = part.iter().map(|at| layout.px(*at));
            let places: Vec<Point> = places.collect();
            let is_missing = |at: &Point| !(at.0 + at.1).is_finite();
            let joined = places.split(is_missing).filter(|part| !part.is_empty());
            parts.extend(joined.map(|part| thinned(part, width.max(1.0))));
        }
        parts
    }

    /// Where its markers stand, each for itself.
    pub(super) fn markers(&self, layout: &Layout) -> Vec<Vec<Point>> {
        let is_marked = self.series.mark != Mark::None;
        let places = self.places(layout).into_iter().flatten();
        places.filter(|_| is_marked).map(|at| vec![at]).collect()
    }

    /// Whether its markers lie on most of another's.
    pub(super) fn hides(&self, other: &Self, layout: &Layout) -> bool {
        if [self, other]
            .iter()
            .any(|curve| curve.series.mark == Mark::None)
        {
            return false;
        }
        let own = self.places(layout);
        let is_near = |at: &&Point| {
            let mut own = own.iter().flatten();
            own.any(|to| (at.0 - to.0).hypot(at.1 - to.1) < HIDDEN)
        };
        let hidden = other
            .places(layout)
            .iter()
            .flatten()
            .filter(is_near)
            .count();
        2 * hidden > other.points.len()
    }

    /// The marker in the legend: open if those of all points are.
    pub(super) fn sample_mark(&self) -> Mark {
        match self.series.mark {
            Mark::Filled if self.used.is_empty() && !self.points.is_empty() => Mark::Open,
            mark => mark,
        }
    }

    /// The same with larger markers.
    pub(super) fn grow(&mut self) {
        self.style.radius *= LARGER;
    }

    /// Draws line and markers.
    ///
    /// * `curves`: how many the chart has.
    pub(super) fn draw(&self, page: &mut Page, layout: &Layout, curves: usize) {
        let Series { width, mark, .. } = *self.series;
        let lines = self.line(layout, curves).into_iter();
        let (alone, lines): (Vec<_>, Vec<_>) = lines.partition(|line| line.len() == 1);
        page.group(&self.attributes(), |page| {
            page.line(&lines, self.style.colour, width, self.style.dashes);
            if mark == Mark::None {
                // A point alone would be invisible as a line.
                let dot = Style {
                    colour: self.style.colour,
                    radius: 1.5 * width,
                    ..style(0)
                };
                let alone = alone.into_iter().flatten();
                return page.layer(|area| alone.for_each(|at| dot.mark(area, at, Mark::Filled)));
            }
            page.layer(|area| {
                for (k, at) in self.places(layout).into_iter().enumerate() {
                    let mark = if self.used.contains(&k) {
                        mark
                    } else {
                        Mark::Open
                    };
                    at.into_iter()
                        .for_each(|at| self.style.mark(area, at, mark));
                }
            });
        });
    }

    /// Its names and values, for a page that shows them.
    fn attributes(&self) -> String {
        let Series { label, x, y, .. } = self.series;
        let [label, columns] =
            [label.clone(), format!("{x}|{y}")].map(|text| escape_attribute(&text));
        let finite = self
            .points
            .iter()
            .filter(|(x, y)| x.is_finite() && y.is_finite());
        let points: Vec<String> = match finite.clone().count() {
            ..=MOST_POINTS => finite
                .map(|(x, y)| format!("{},{}", rounded(*x), rounded(*y)))
                .collect(),
            _ => vec![],
        };
        let points = points.join(" ");
        format!(" data-series=\"{label}\" data-columns=\"{columns}\" data-points=\"{points}\"")
    }
}

/// To five digits, so that the last bits of a result, which vary between machines, do not show.
fn rounded(value: f64) -> String {
    format!("{:e}", significant(value, 5))
}

/// A line of few points that looks like one of many: of those in a column of this width in px, the
/// first, lowest, highest and last are kept.
fn thinned(part: &[Point], width: f64) -> Vec<Point> {
    let column = |at: &Point| (at.0 / width).floor();
    let mut kept = vec![];
    for near in part.chunk_by(|one, next| column(one) == column(next)) {
        let height = |k: &usize, l: &usize| near[*k].1.total_cmp(&near[*l].1);
        let all = 0..near.len();
        let extremes = [all.clone().min_by(height), all.clone().max_by(height)];
        let mut chosen = [
            0,
            near.len() - 1,
            extremes[0].unwrap_or(0),
            extremes[1].unwrap_or(0),
        ];
        chosen.sort_unstable();
        kept.extend(chosen.map(|k| near[k]));
    }
    kept.dedup();
    kept
}
