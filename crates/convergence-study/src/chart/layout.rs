//! Where everything stands: texts are measured, and the plot is placed between them.

use super::curve::Curve;
use super::legend::entries;
use super::pen::{LABEL, Point, Rect, TEXT, widest};
use super::rows::ROW;
use super::ruler::Ruler;
use super::{Chart, cells};
use crate::text::number::counted;

/// Of the page in px.
pub(super) const WIDTH: f64 = 900.0;
/// Room between the edge of the page and everything on it.
pub(super) const EDGE: f64 = 16.0;
/// Heights of rows.
pub(super) const TITLE_ROW: f64 = 32.0;
pub(super) const LEGEND_ROW: f64 = 27.0;
pub(super) const NOTE_ROW: f64 = 24.0;
/// Height of a plot.
const HEIGHT: f64 = 430.0;
/// From the plot down to the legend.
pub(super) const FOOT: f64 = 66.0;
/// Of an entry of the legend: the sample, from there to the text, and from there to the next
/// column.
pub(super) const SAMPLE: f64 = 46.0;
pub(super) const SAMPLE_GAP: f64 = 9.0;
pub(super) const COLUMN_GAP: f64 = 26.0;
/// Widest names of rows; longer ones are cut.
const NAMES: f64 = 476.0;
/// Room around the data, as a fraction of their range.
const MARGIN: f64 = 0.05;
/// A first time below this fraction of the last is that of a first step: the axis starts at 0.
const FIRST_STEP: f64 = 0.02;

/// Everything in px.
pub(super) struct Layout {
    pub(super) x: Ruler,
    pub(super) y: Ruler,
    /// The scale of the colours.
    pub(super) z: Ruler,
    pub(super) plot: Rect,
    /// Of the legend.
    pub(super) columns: usize,
    pub(super) column_width: f64,
    pub(super) notes: Vec<String>,
    pub(super) notes_top: f64,
    pub(super) height: f64,
}

impl Layout {
    /// * `left`: the plot begins here, or further right if its labels need the room.
    /// * `extension`: how far the vertical axis goes further down, in lengths of its range.
    pub(super) fn new(chart: &Chart, curves: &[Curve<'_>], left: f64, extension: f64) -> Self {
        let [x, mut y, z] = rulers(chart, curves);
        y.low -= extension * (y.high - y.low);
        let rows = chart.y.rows.len();
        if rows == 0 {
            y = y.with_ticks(8);
        }
        let names = chart
            .y
            .rows
            .iter()
            .flat_map(|row| [&*row.name, &*row.numbers]);
        let names = widest(names).min(NAMES) + 28.0;
        let left = (2.5 * EDGE + LABEL + y.widest()).max(names).max(left);
        let guides = widest(chart.guides.iter().map(|guide| &*guide.label)) + 22.0;
        let right = WIDTH
            - match &chart.cells {
                Some(_) => cells::GAP + cells::WIDTH + z.widest() + 28.0 + LABEL,
                None => guides.max(2.0 * EDGE),
            };
        let fits = |x: &Ruler| (x.widest() + 0.8 * TEXT) * x.major.len() as f64 <= right - left;
        let mut counts = (1..=8).rev().map(|count| x.with_ticks(count));
        let x = counts.find(fits).unwrap_or(x);
        let top = EDGE + TITLE_ROW;
        let bottom = top
            + match rows {
                0 => HEIGHT,
                _ => ROW * rows as f64,
            };
        let entries = entries(chart, curves);
        let texts = widest(entries.iter().map(|entry| entry.label));
        let page = WIDTH - 2.0 * EDGE;
        let column_width = (SAMPLE + SAMPLE_GAP + texts + COLUMN_GAP).min(page);
        let most = ((page + COLUMN_GAP) / column_width).floor().max(1.0) as usize;
        let lines = entries.len().div_ceil(most);
        let notes = notes(chart, curves);
        let notes_top = bottom + FOOT + LEGEND_ROW * lines as f64;
        Self {
            x,
            y,
            z,
            plot: [left, top, right, bottom],
            columns: entries.len().div_ceil(lines.max(1)).max(1),
            column_width,
            notes_top,
            height: (notes_top + NOTE_ROW * notes.len() as f64 + 8.0).round(),
            notes,
        }
    }

    /// Where a point stands; NaN where an axis cannot show it.
    pub(super) fn px(&self, (x, y): Point) -> Point {
        let [left, top, right, bottom] = self.plot;
        let [x, y] = [self.x.fraction(x), self.y.fraction(y)].map(|at| at.unwrap_or(f64::NAN));
        (left + x * (right - left), bottom - y * (bottom - top))
    }
}

/// The scales of both axes and of the colours.
fn rulers(chart: &Chart, curves: &[Curve<'_>]) -> [Ruler; 3] {
    if let Some(cells) = &chart.cells {
        return cells.rulers(chart);
    }
    let [on_x, on_y] = [&chart.x, &chart.y].map(Ruler::of_scale);
    let points = curves.iter().flat_map(|curve| &curve.points);
    let drawable = points.filter(|at| on_x.place(at.0).is_some() && on_y.place(at.1).is_some());
    let bands = chart.bands.iter().flat_map(|band| &band.intervals);
    let bands = bands.flat_map(|(from, to)| [*from, *to]);
    let x = drawable.clone().map(|at| at.0).chain(bands);
    // Time runs from edge to edge; chosen parameters need room around them.
    let mut x = Ruler::new(&chart.x, x, if chart.x.is_log { MARGIN } else { 0.0 });
    if !x.is_log && x.low > 0.0 && x.low < FIRST_STEP * x.high {
        x.low = 0.0;
    }
    let guides = chart.guides.iter().map(|guide| guide.value);
    let y = Ruler::new(&chart.y, drawable.map(|at| at.1).chain(guides), MARGIN);
    [x, y, Ruler::default()]
}

/// Those of the chart, and how many points it cannot show.
fn notes(chart: &Chart, curves: &[Curve<'_>]) -> Vec<String> {
    let mut notes = chart.notes.clone();
    let has_unused =
        |curve: &Curve<'_>| curve.series.law.is_some() && curve.used.len() < curve.points.len();
    if curves.iter().any(has_unused) {
        notes.push("open markers: points that the rate does not use".to_owned());
    }
    let [x, y] = [&chart.x, &chart.y].map(Ruler::of_scale);
    let points = curves.iter().flat_map(|curve| &curve.points);
    let points = points.filter(|at| x.place(at.0).and(y.place(at.1)).is_none());
    let cells = chart
        .cells
        .iter()
        .map(|cells| cells.without_colour(&chart.table));
    let missing = (points.count() + cells.sum::<usize>()).saturating_sub(chart.missing);
    if missing > 0 {
        let points = counted(missing, "point");
        notes.push(match chart.x.is_log || chart.y.is_log {
            true => format!("{points} not drawn: not finite, or not positive (logarithmic axis)"),
            false => format!("{points} not drawn: not finite"),
        });
    }
    notes
}
