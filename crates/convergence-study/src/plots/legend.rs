//! Entries of a legend, in aligned columns.

use super::canvas::{Anchor, Canvas, Layer, Pen, Point, Rect};
use super::look::{Look, Marks};
use super::style::{self, EDGE, TICK_SIZE, elide, text_width};
use plotters::style::RGBColor;

const SWATCH_WIDTH: f64 = 46.0;
const SWATCH_GAP: f64 = 9.0;
/// Between columns, in px.
pub(super) const COLUMN_GAP: f64 = 26.0;

/// The sample before the text of an entry.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Swatch {
    /// A line with markers.
    Line {
        /// Colour, dashes and marker.
        look: Look,
        /// Width of the line in px; 0 for markers alone.
        width: f64,
        /// How the marker is drawn.
        marks: Marks,
    },
    /// A patch of colour.
    Fill(RGBColor),
    /// A patch with diagonal strokes.
    Hatch(RGBColor),
}

/// A line of the legend.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Entry {
    /// The sample before the text.
    pub(super) swatch: Swatch,
    /// The text; cut if too long.
    pub(super) label: String,
}

/// As many equal columns as fit on the page, rows filled evenly: their number, and their width in
/// px.
pub(super) fn arranged(entries: &[Entry]) -> (usize, f64) {
    let width = style::WIDTH - 2.0 * EDGE;
    let widest = entries
        .iter()
        .map(|e| text_width(&e.label, TICK_SIZE))
        .fold(0.0, f64::max);
    let column_width = (SWATCH_WIDTH + SWATCH_GAP + widest + COLUMN_GAP).min(width);
    let most = ((width + COLUMN_GAP) / column_width).floor().max(1.0) as usize;
    let rows = entries.len().div_ceil(most).max(1);
    (entries.len().div_ceil(rows).max(1), column_width)
}

/// Draws an entry at `x`, its row centred on `y`, in a column of this width.
pub(super) fn draw_entry(canvas: &mut Canvas, entry: &Entry, (x, y): Point, width: f64) {
    let text_place = (x + SWATCH_WIDTH + SWATCH_GAP, y);
    let room = width - SWATCH_WIDTH - SWATCH_GAP;
    let label = elide(&entry.label, TICK_SIZE, room);
    let write = |pen: &Pen<'_>| pen.text(&label, text_place, TICK_SIZE, Anchor::Left, style::INK);
    let patch = Rect {
        left: x + 6.0,
        top: y - 8.0,
        right: x + SWATCH_WIDTH - 2.0,
        bottom: y + 8.0,
    };
    match entry.swatch {
        Swatch::Line { look, width, marks } => {
            if width > 0.0 {
                let ends = [(x, y), (x + SWATCH_WIDTH, y)];
                canvas.draw(Layer::default().dashed(look.dash), |pen| {
                    pen.line(&ends, look.colour, width);
                });
            }
            canvas.draw(Layer::default(), |pen| {
                look.mark(pen, (x + 0.5 * SWATCH_WIDTH, y), marks);
                write(pen);
            });
        }
        Swatch::Fill(colour) => canvas.draw(Layer::default(), |pen| {
            pen.rect(patch, colour);
            pen.frame(patch, style::GRID, 1.0);
            write(pen);
        }),
        Swatch::Hatch(colour) => canvas.draw(Layer::default(), |pen| {
            pen.rect(patch, colour);
            pen.hatch(&[patch]);
            write(pen);
        }),
    }
}
