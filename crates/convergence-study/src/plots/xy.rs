//! The core of all figures with curves: ranges, layers in order, notes on omitted data.

pub(crate) mod inset;

use super::attributes;
use super::canvas::{Anchor, Layer, Point, Rect};
pub use super::curve::Curve;
use super::envelope::lines;
use super::legend::{Entry, Swatch};
use super::ruler::{Ruler, has_place, on_scale};
use super::sheet::{Layout, Page, guide_margin};
use super::style::TICK_SIZE;
use super::{Axis, Guide, Phases, Scale, style};
use crate::text::number::counted;
use inset::Inset;

/// Room left around the data, as a fraction of its range.
const MARGIN: f64 = 0.05;
/// Columns of envelopes shared by all curves of a figure; this bounds the size of the document.
const ENVELOPE_COLUMNS: usize = 3200;

/// A closed outline with texts, such as a slope triangle; positions in data coordinates.
#[derive(Clone)]
pub struct Outline {
    /// The last corner is joined to the first.
    pub corners: Vec<(f64, f64)>,
    /// Its texts.
    pub texts: Vec<OutlineText>,
}

/// A text at an outline.
#[derive(Clone)]
pub struct OutlineText {
    /// What it says.
    pub text: String,
    /// Where it stands, in data coordinates.
    pub position: (f64, f64),
    /// Px to the right of that position, and below it.
    pub offset: Point,
    /// Which point of the text stands there.
    pub anchor: Anchor,
}

/// A figure with curves.
#[derive(Clone, Default)]
pub struct Xy {
    /// Set above the plot: what the reader should see. `None`: the vertical axis over the
    /// horizontal one.
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
    /// Lines under the legend, before that on omitted points.
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

    /// The width of a curve's line, measured on the vertical axis; in decades if that is
    /// logarithmic.
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
        let x = self.x_ruler_of(&extent);
        let y = self.y_ruler_of(&extent);
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
            notes: self.notes(&extent),
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

    fn notes(&self, extent: &Extent) -> Vec<String> {
        let mut notes = self.notes.clone();
        notes.extend(notes_on_missing_points(
            extent.points - extent.finite,
            extent.finite - extent.drawable,
        ));
        notes
    }

    fn draw_ground(&self, sheet: &mut Page) {
        let plot = sheet.plot;
        let ends = self.phases.intervals.iter().filter_map(|&(a, b)| {
            let a = sheet.x.px(a)?;
            let b = sheet.x.px(b)?;
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
            let attributes =
                attributes::series(&curve.name, curve.is_data.then_some(&curve.points));
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
                        curve.look.mark(pen, at, curve.marks);
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
                .filter_map(|text| Some((text, sheet.px(text.position)?)))
                .collect();
            sheet.canvas.draw(Layer::default(), |pen| {
                pen.line(&path, style::INK, 1.6);
                for (text, (x, y)) in texts {
                    let place = (x + text.offset.0, y + text.offset.1);
                    pen.text(&text.text, place, TICK_SIZE, text.anchor, style::INK);
                }
            });
        }
    }
}

/// The notes on points that a figure cannot show.
pub(super) fn notes_on_missing_points(non_finite: usize, not_positive: usize) -> Vec<String> {
    let mut notes = vec![];
    if non_finite > 0 {
        notes.push(format!(
            "{} not drawn",
            counted(non_finite, "non-finite point")
        ));
    }
    if not_positive > 0 {
        let points = counted(not_positive, "non-positive point");
        notes.push(format!("{points} not drawn (logarithmic axis)"));
    }
    notes
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
