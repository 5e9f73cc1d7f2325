//! The core of all figures with curves: ranges, layers in order, notes on omitted data.

use super::canvas::{self, Anchor, Layer, Point, Rect};
use super::inset::Inset;
use super::look::{Look, Marks, look};
use super::ruler::{Ruler, has_place, on_scale};
use super::sheet::{Entry, Layout, Page, Swatch, guide_margin};
use super::style::TICK_SIZE;
use super::{Axis, Guide, Phases, Scale, Series, style};
use crate::judge::verdict::PowerLaw;
use crate::text::number::counted;

/// Room left around the data, as a fraction of its range.
const MARGIN: f64 = 0.05;
/// Columns of envelopes shared by all curves of a figure; this bounds the size of the document.
const ENVELOPE_COLUMNS: usize = 3200;

/// A curve and how to draw it.
#[derive(Clone, Debug)]
pub struct Curve {
    /// Its entry in the legend; of several curves with the same name the first makes it.
    pub name: String,
    /// Its name in notes, if its entry says more than its name.
    pub noted_as: Option<String>,
    /// `(x, y)` in data coordinates, in drawing order.
    pub points: Vec<(f64, f64)>,
    /// Colour, dashes and marker.
    pub look: Look,
    /// Line width in px; 0 for markers alone.
    pub width: f64,
    /// Drawn from end to end, solid, instead of the line through the points.
    pub fit: Option<PowerLaw>,
    /// How the points are marked.
    pub marks: Marks,
    /// Whether the points are data: only those set the range and are counted when left out.
    pub is_data: bool,
}

impl Curve {
    /// The k-th series as a line, with an entry of its own.
    pub fn line(k: usize, series: &Series) -> Self {
        Self {
            name: series.label.clone(),
            noted_as: None,
            points: series.points.clone(),
            look: look(k),
            width: style::LINE,
            fit: None,
            marks: Marks::None,
            is_data: true,
        }
    }

    /// Its name in notes.
    pub fn noted(&self) -> &str {
        self.noted_as.as_deref().unwrap_or(&self.name)
    }

    /// The parts to draw: a fitted line before the markers, which alone are data.
    fn parts(&self) -> Vec<Self> {
        let Some(fit) = self.fit else {
            return vec![self.clone()];
        };
        let xs = || {
            self.points
                .iter()
                .map(|p| p.0)
                .filter(|x| x.is_finite() && *x > 0.0)
        };
        let ends = [xs().fold(f64::INFINITY, f64::min), xs().fold(0.0, f64::max)];
        let points = ends.map(|x| (x, fit.error_at(x))).to_vec();
        let line = Self {
            points,
            look: self.solid(),
            marks: Marks::None,
            is_data: false,
            fit: None,
            ..self.clone()
        };
        vec![
            line,
            Self {
                width: 0.0,
                fit: None,
                ..self.clone()
            },
        ]
    }

    fn solid(&self) -> Look {
        Look {
            dash: style::SOLID,
            ..self.look
        }
    }
}

/// A closed outline with texts, such as a slope triangle; positions in data coordinates.
#[derive(Clone)]
pub struct Outline {
    /// The last corner is joined to the first.
    pub corners: Vec<(f64, f64)>,
    /// Text, position, px to the right of and below that position, and anchor.
    pub texts: Vec<(String, (f64, f64), Point, Anchor)>,
}

/// A figure with curves.
#[derive(Clone, Default)]
pub struct Xy {
    /// Set above the plot: what the reader should see. `None`: the vertical axis over the horizontal one.
    pub title: Option<String>,
    /// The horizontal axis.
    pub x: Axis,
    /// The vertical axis.
    pub y: Axis,
    /// In drawing order.
    pub curves: Vec<Curve>,
    /// Horizontal lines.
    pub guides: Vec<Guide>,
    /// Shaded intervals of the horizontal axis.
    pub phases: Phases,
    /// Drawn on top of the curves.
    pub outlines: Vec<Outline>,
    /// Everything right of this x is shaded, with this text above it.
    pub beyond: Option<(f64, String)>,
    /// More values that the vertical axis must show.
    pub show_y: Vec<f64>,
    /// More values that the horizontal axis must show.
    pub show_x: Vec<f64>,
    /// Lines under the legend, before those on coinciding curves and on omitted points.
    pub notes: Vec<String>,
    /// A small figure inside the plot.
    pub inset: Option<Inset>,
}

/// The data points of a figure: their numbers, and the ranges of those that both axes can show.
struct Extent {
    x: [f64; 2],
    y: [f64; 2],
    points: usize,
    finite: usize,
    drawable: usize,
}

/// The range of no values.
const NOWHERE: [f64; 2] = [f64::INFINITY, f64::NEG_INFINITY];

impl Xy {
    /// The horizontal range.
    pub fn x_ruler(&self) -> Ruler {
        self.x_ruler_of(&self.extent())
    }

    /// The vertical range.
    pub fn y_ruler(&self) -> Ruler {
        self.y_ruler_of(&self.extent())
    }

    /// The width of a curve's line, measured on the vertical axis; in decades if that is logarithmic.
    pub fn line_width(&self) -> f64 {
        let ruler = self.y_ruler();
        (ruler.hi - ruler.lo) * style::LINE / style::PLOT_HEIGHT
    }

    fn x_ruler_of(&self, extent: &Extent) -> Ruler {
        let values = extent.x.into_iter().chain(self.show_x.iter().copied());
        let phases = self.phases.intervals.iter().flat_map(|&(a, b)| [a, b]);
        // Time runs from edge to edge; chosen parameters need room around them.
        let margin = if self.x.scale == Scale::Log {
            MARGIN
        } else {
            0.0
        };
        let ruler = Ruler::around(self.x.scale, values.chain(phases), margin);
        // If the first step is short, the axis starts at zero.
        let starts_at_zero =
            self.x.scale == Scale::Linear && ruler.lo > 0.0 && ruler.lo < 0.02 * ruler.hi;
        if starts_at_zero {
            Ruler::between(self.x.scale, 0.0, ruler.hi)
        } else {
            ruler
        }
    }

    fn y_ruler_of(&self, extent: &Extent) -> Ruler {
        let guides = self.guides.iter().map(|g| g.value);
        let values = extent
            .y
            .into_iter()
            .chain(guides)
            .chain(self.show_y.iter().copied());
        Ruler::around(self.y.scale, values, MARGIN)
    }

    /// One pass over the points, of which a history has many thousands.
    fn extent(&self) -> Extent {
        let mut extent = Extent {
            x: NOWHERE,
            y: NOWHERE,
            points: 0,
            finite: 0,
            drawable: 0,
        };
        for curve in self.curves.iter().filter(|curve| curve.is_data) {
            extent.points += curve.points.len();
            for &(x, y) in &curve.points {
                extent.finite +=
                    usize::from(has_place(Scale::Linear, x) && has_place(Scale::Linear, y));
                if has_place(self.x.scale, x) && has_place(self.y.scale, y) {
                    extent.drawable += 1;
                    extent.x = [extent.x[0].min(x), extent.x[1].max(x)];
                    extent.y = [extent.y[0].min(y), extent.y[1].max(y)];
                }
            }
        }
        extent
    }

    /// Draws the figure.
    pub fn draw(&self) -> String {
        self.drawn().finish()
    }

    /// The page with everything but what is around the plot.
    pub(super) fn drawn(&self) -> Page {
        let mut sheet = self.plan().lay_out();
        self.draw_ground(&mut sheet);
        sheet.draw_grid();
        sheet.draw_guides(&self.guides);
        self.draw_curves(&mut sheet);
        self.draw_outlines(&mut sheet);
        if let Some(inset) = &self.inset {
            inset.draw(&mut sheet);
        }
        sheet
    }

    fn plan(&self) -> Layout {
        let extent = self.extent();
        let (x, y) = (self.x_ruler_of(&extent), self.y_ruler_of(&extent));
        let above = self.beyond.as_ref().and_then(|(from, text)| {
            let from = on_scale(self.x.scale, *from)?.max(x.lo);
            (from < x.hi).then(|| (0.5 * (from + x.hi), text.clone()))
        });
        Layout {
            title: self.title.clone(),
            x,
            y,
            x_label: self.x.label.clone(),
            y_label: self.y.label.clone(),
            right: guide_margin(&self.guides),
            above,
            legend: self.entries(),
            notes: self.notes(&extent, &x, &y),
        }
    }

    fn entries(&self) -> Vec<Entry> {
        let mut entries: Vec<Entry> = vec![];
        for curve in &self.curves {
            if entries.iter().all(|entry| entry.label != curve.name) {
                let look = if curve.fit.is_some() {
                    curve.solid()
                } else {
                    curve.look
                };
                let swatch = Swatch::Line {
                    look,
                    width: curve.width,
                    marks: curve.marks,
                };
                entries.push(Entry {
                    swatch,
                    label: curve.name.clone(),
                });
            }
        }
        if !self.phases.intervals.is_empty() {
            entries.push(Entry {
                swatch: Swatch::Fill(style::SHADE),
                label: self.phases.label.clone(),
            });
        }
        entries
    }

    fn notes(&self, extent: &Extent, x: &Ruler, y: &Ruler) -> Vec<String> {
        let mut notes = self.notes.clone();
        notes.extend(coinciding(&self.curves, x, y));
        notes.extend(left_out(
            extent.points - extent.finite,
            extent.finite - extent.drawable,
        ));
        notes
    }

    fn draw_ground(&self, sheet: &mut Page) {
        let plot = sheet.plot;
        let ends = self.phases.intervals.iter().filter_map(|&(a, b)| {
            let (a, b) = (sheet.x.px(a)?, sheet.x.px(b)?);
            Some((a.min(b), a.max(b)))
        });
        let mut spans = merge_intervals(ends.collect());
        if let Some(from) = self.beyond.as_ref().and_then(|b| sheet.x.px(b.0)) {
            spans.push((from.max(plot.left), plot.right));
        }
        sheet.canvas.draw(Layer::clipped(plot), |pen| {
            for &(left, right) in &spans {
                // An interval shorter than a pixel still leaves a trace.
                pen.rect(
                    Rect {
                        left,
                        right: right.max(left + 0.7),
                        ..plot
                    },
                    style::SHADE,
                );
            }
        });
    }

    pub(super) fn draw_curves(&self, sheet: &mut Page) {
        let parts: Vec<Curve> = self.curves.iter().flat_map(Curve::parts).collect();
        let share = ENVELOPE_COLUMNS / parts.len().max(1);
        let columns = (sheet.plot.width() as usize).min(share).max(1);
        for curve in &parts {
            let positions: Vec<Option<Point>> = curve.points.iter().map(|&p| sheet.px(p)).collect();
            let (alone, lines): (Vec<_>, Vec<_>) = match curve.width {
                0.0 => Default::default(),
                _ => lines(&positions, columns)
                    .into_iter()
                    .partition(|line| line.len() == 1),
            };
            let attributes = canvas::series(&curve.name, curve.is_data.then_some(&curve.points));
            let line_layer = Layer::clipped(sheet.plot).dashed(curve.look.dash);
            sheet.canvas.group(&attributes, |canvas| {
                canvas.draw(line_layer, |pen| {
                    lines
                        .iter()
                        .for_each(|line| pen.line(line, curve.look.colour, curve.width));
                });
                // Not clipped: a marker on the frame stays whole.
                canvas.draw(Layer::default(), |pen| {
                    alone
                        .iter()
                        .flatten()
                        .for_each(|&at| pen.disc(at, 1.5 * curve.width, curve.look.colour));
                    for &at in positions.iter().flatten() {
                        curve
                            .look
                            .marker
                            .draw(pen, at, curve.look.colour, curve.marks);
                    }
                });
            });
        }
    }

    fn draw_outlines(&self, sheet: &mut Page) {
        for outline in &self.outlines {
            let mut path: Vec<Point> = outline
                .corners
                .iter()
                .filter_map(|&p| sheet.px(p))
                .collect();
            path.extend(path.first().copied());
            let texts: Vec<_> = outline
                .texts
                .iter()
                .filter_map(|t| Some((t, sheet.px(t.1)?)))
                .collect();
            sheet.canvas.draw(Layer::default(), |pen| {
                pen.line(&path, style::INK, 1.6);
                for ((text, _, shift, anchor), at) in texts {
                    pen.text(
                        text,
                        (at.0 + shift.0, at.1 + shift.1),
                        TICK_SIZE,
                        *anchor,
                        style::INK,
                    );
                }
            });
        }
    }
}

/// The note on data that a figure cannot show.
pub(super) fn left_out(non_finite: usize, not_positive: usize) -> Vec<String> {
    let points = |n: usize, what: &str, why: &str| {
        (n > 0).then(|| format!("{} not drawn{why}", counted(n, &format!("{what} point"))))
    };
    let non_finite = points(non_finite, "non-finite", "");
    let not_positive = points(not_positive, "non-positive", " (logarithmic axis)");
    non_finite.into_iter().chain(not_positive).collect()
}

/// Curves closer than this everywhere look like one, in px.
const CLOSE: f64 = 3.0;

/// A note for each set of coinciding data curves: compared by points if they have equally many, else as lines.
fn coinciding(curves: &[Curve], x: &Ruler, y: &Ruler) -> Vec<String> {
    let is_shown = |curve: &&Curve| curve.is_data && curve.points.len() > 1;
    let data: Vec<&Curve> = curves.iter().filter(is_shown).collect();
    let mut sets: Vec<Vec<&Curve>> = vec![];
    for curve in data {
        let set = sets.iter_mut().find(|set| coincide(set[0], curve, x, y));
        match set {
            Some(set) if set.iter().all(|known| known.noted() != curve.noted()) => set.push(curve),
            Some(_) => {}
            None => sets.push(vec![curve]),
        }
    }
    let mut notes: Vec<String> = vec![];
    for set in sets.iter().filter(|set| set.len() > 1) {
        let names: Vec<&str> = set.iter().map(|curve| curve.noted()).collect();
        let note = format!("{} coincide", names.join(" and "));
        if !notes.contains(&note) {
            notes.push(note);
        }
    }
    notes
}

fn coincide(a: &Curve, b: &Curve, x: &Ruler, y: &Ruler) -> bool {
    // The plot is somewhat narrower than the page.
    let (x, y) = (
        x.laid_out(0.0, style::WIDTH),
        y.laid_out(0.0, style::PLOT_HEIGHT),
    );
    let near = |ruler: &Ruler, a: f64, b: f64| match (ruler.px(a), ruler.px(b)) {
        (Some(a), Some(b)) => (a - b).abs() < CLOSE,
        (None, None) => true,
        _ => false,
    };
    let mut pairs = a.points.iter().zip(&b.points);
    if a.points.len() == b.points.len() {
        return pairs.all(|(p, q)| near(&x, p.0, q.0) && near(&y, p.1, q.1));
    }
    let line = |curve: &Curve| {
        let points = curve
            .points
            .iter()
            .map(|point| Some((x.px(point.0)?, y.px(point.1)?)));
        let points: Vec<Point> = points
            .collect::<Option<_>>()
            .filter(|_| curve.width > 0.0 && curve.fit.is_none())?;
        points.is_sorted_by(|p, q| p.0 <= q.0).then_some(points)
    };
    let (Some(a), Some(b)) = (line(a), line(b)) else {
        return false;
    };
    let ends = [(a.first(), b.first()), (a.last(), b.last())];
    let begin_and_end = ends
        .iter()
        .all(|ends| matches!(ends, (Some(p), Some(q)) if (p.0 - q.0).abs() < CLOSE));
    begin_and_end && follows(&a, &b) && follows(&b, &a)
}

/// Whether every point lies on the line, which is straight from point to point and level beyond its ends; x ascending.
fn follows(points: &[Point], line: &[Point]) -> bool {
    let height = |x: f64| {
        let next = line.partition_point(|p| p.0 < x).min(line.len() - 1);
        let (p, q) = (line[next.saturating_sub(1)], line[next]);
        let share = if q.0 > p.0 {
            ((x - p.0) / (q.0 - p.0)).clamp(0.0, 1.0)
        } else {
            1.0
        };
        p.1 + share * (q.1 - p.1)
    };
    points
        .iter()
        .all(|point| (point.1 - height(point.0)).abs() < CLOSE)
}

/// Lines through positions, broken where a position is missing.
///
/// A series longer than four positions per column is reduced to first, lowest, highest and last of each column of
/// pixels, in their order; no eye can see the difference. Positions must then run along x.
fn lines(positions: &[Option<Point>], columns: usize) -> Vec<Vec<Point>> {
    if positions.len() <= 4 * columns {
        let runs = positions
            .split(Option::is_none)
            .filter(|run| !run.is_empty());
        return runs
            .map(|run| run.iter().flatten().copied().collect())
            .collect();
    }
    envelope(positions, columns)
}

fn envelope(positions: &[Option<Point>], columns: usize) -> Vec<Vec<Point>> {
    let xs = || positions.iter().flatten().map(|p| p.0);
    let left = xs().fold(f64::INFINITY, f64::min);
    let width = xs().fold(f64::NEG_INFINITY, f64::max) - left;
    let column = |x: f64| ((x - left) / width * columns as f64).min(columns as f64 - 1.0) as usize;
    let mut lines = vec![Vec::new()];
    let mut group: Vec<Point> = Vec::new();
    let mut missing = 0_usize;
    for position in positions {
        let Some(p) = *position else {
            missing += 1;
            continue;
        };
        if group
            .last()
            .is_some_and(|last| column(last.0) != column(p.0))
        {
            extend_with_extremes(&mut lines, &group);
            group.clear();
            // A gap is drawn only if it is as wide as a column: narrower ones would cost more bytes than they show.
            if missing > positions.len() / columns {
                lines.push(Vec::new());
            }
        }
        missing = 0;
        group.push(p);
    }
    extend_with_extremes(&mut lines, &group);
    lines.retain(|line| !line.is_empty());
    lines
}

fn extend_with_extremes(lines: &mut [Vec<Point>], group: &[Point]) {
    let Some(line) = lines.last_mut() else { return };
    let by_height = |a: &usize, b: &usize| group[*a].1.total_cmp(&group[*b].1);
    let lowest = (0..group.len()).min_by(by_height);
    let highest = (0..group.len()).max_by(by_height);
    let mut kept = [Some(0), lowest, highest, group.len().checked_sub(1)];
    kept.sort_unstable();
    let mut previous = None;
    for k in kept.into_iter().flatten().filter(|&k| k < group.len()) {
        if previous != Some(k) {
            line.push(group[k]);
        }
        previous = Some(k);
    }
}

/// Union of intervals on the page; those closer than a pixel are drawn as one.
fn merge_intervals(mut intervals: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    intervals.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut merged: Vec<(f64, f64)> = Vec::new();
    for (from, to) in intervals {
        match merged.last_mut() {
            Some(last) if from <= last.1 + 1.0 => last.1 = last.1.max(to),
            _ => merged.push((from, to)),
        }
    }
    merged
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_single_spike_survives() {
        let mut positions: Vec<_> = (0..100_000)
            .map(|k| Some((f64::from(k) * 7e-3, 100.0)))
            .collect();
        positions[54_321] = Some((54_321.0 * 7e-3, 3.0));
        let lines = lines(&positions, 700);
        assert_eq!(lines.len(), 1);
        assert!(lines[0].len() <= 2800);
        assert!(lines[0].iter().any(|p| p.1 == 3.0));
    }

    #[test]
    fn a_missing_position_breaks_a_short_line() {
        let p = |x: f64| Some((x, 0.0));
        assert_eq!(
            lines(&[p(0.0), p(1.0), None, None, p(2.0)], 100),
            [vec![(0.0, 0.0), (1.0, 0.0)], vec![(2.0, 0.0)]]
        );
    }

    #[test]
    fn a_wide_gap_breaks_a_long_line() {
        let positions: Vec<_> = (0..10_000)
            .map(|k| (!(4000..6000).contains(&k)).then_some((f64::from(k), 0.0)))
            .collect();
        assert_eq!(lines(&positions, 100).len(), 2);
        assert!(lines(&[None; 1000], 10).is_empty());
    }

    #[test]
    fn intervals_that_touch_become_one() {
        assert_eq!(
            merge_intervals(vec![(5.0, 9.0), (0.0, 2.0), (2.5, 4.5)]),
            [(0.0, 9.0)]
        );
        assert_eq!(
            merge_intervals(vec![(0.0, 2.0), (4.0, 5.0)]),
            [(0.0, 2.0), (4.0, 5.0)]
        );
    }
}
