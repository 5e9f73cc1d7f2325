//! The legend: below the plot, in aligned columns, never on the data.

use super::canvas::{Anchor, Canvas, Layer, Pen};
use super::heat::hatch;
use super::look::Look;
use super::marker::Marks;
use super::readable;
use super::rect::Rect;
use super::style::{self, TICK_SIZE, text_width};
use plotters::style::RGBColor;

const ROW_HEIGHT: f64 = 27.0;
const SWATCH_WIDTH: f64 = 46.0;
const SWATCH_GAP: f64 = 9.0;
const COLUMN_GAP: f64 = 26.0;

/// The sample before the text of an entry.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Swatch {
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
pub struct Entry {
    /// The sample before the text.
    pub swatch: Swatch,
    /// The text; one that is too long is cut.
    pub label: String,
}

/// Entries arranged for a page of given width.
#[derive(Clone, Debug)]
pub(super) struct Legend {
    entries: Vec<Entry>,
    columns: usize,
    column_width: f64,
}

impl Legend {
    /// As many equal columns as fit, rows filled evenly.
    pub(super) fn arrange(entries: Vec<Entry>, width: f64) -> Self {
        let widest = entries.iter().map(|e| text_width(&e.label, TICK_SIZE)).fold(0.0, f64::max);
        let column_width = (SWATCH_WIDTH + SWATCH_GAP + widest + COLUMN_GAP).min(width);
        let most = ((width + COLUMN_GAP) / column_width).floor().max(1.0) as usize;
        let rows = entries.len().div_ceil(most).max(1);
        Self { columns: entries.len().div_ceil(rows).max(1), column_width, entries }
    }

    /// Height of all rows in px.
    pub(super) fn height(&self) -> f64 {
        self.entries.len().div_ceil(self.columns) as f64 * ROW_HEIGHT
    }

    /// Draws the legend centred on `centre`, its first row below `top`.
    pub(super) fn draw(&self, canvas: &mut Canvas, centre: f64, top: f64) {
        let width = self.columns as f64 * self.column_width - COLUMN_GAP;
        // Centred on the plot, but on the page in any case.
        let left = (centre - 0.5 * width).min(style::WIDTH - width - 8.0).max(8.0);
        for (k, entry) in self.entries.iter().enumerate() {
            let x = left + (k % self.columns) as f64 * self.column_width;
            let y = top + ((k / self.columns) as f64 + 0.5) * ROW_HEIGHT;
            canvas.group(&readable::entry(&entry.label), |canvas| self.draw_entry(canvas, entry, x, y));
        }
    }

    fn draw_entry(&self, canvas: &mut Canvas, entry: &Entry, x: f64, y: f64) {
        let text_at = (x + SWATCH_WIDTH + SWATCH_GAP, y);
        let room = self.column_width - SWATCH_WIDTH - SWATCH_GAP;
        let label = elide(&entry.label, TICK_SIZE, room);
        let write = |pen: &Pen<'_>| pen.text(&label, text_at, TICK_SIZE, Anchor::Left, style::INK);
        let patch = Rect { left: x + 6.0, top: y - 8.0, right: x + SWATCH_WIDTH - 2.0, bottom: y + 8.0 };
        match entry.swatch {
            Swatch::Line { look, width, marks } => {
                if width > 0.0 {
                    let ends = [(x, y), (x + SWATCH_WIDTH, y)];
                    canvas.draw(Layer::default().dashed(look.dash), |pen| pen.line(&ends, look.colour, width));
                }
                canvas.draw(Layer::default(), |pen| {
                    look.marker.draw(pen, (x + 0.5 * SWATCH_WIDTH, y), look.colour, marks);
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
                hatch(pen, patch);
                write(pen);
            }),
        }
    }
}

/// A text of this size cut to fit a width, both in px, with an ellipsis where it was cut.
pub fn elide(text: &str, size: f64, width: f64) -> String {
    if text_width(text, size) <= width {
        return text.to_owned();
    }
    let mut kept = String::new();
    for c in text.chars() {
        if text_width(&kept, size) + text_width("m…", size) > width {
            break;
        }
        kept.push(c);
    }
    kept + "…"
}
