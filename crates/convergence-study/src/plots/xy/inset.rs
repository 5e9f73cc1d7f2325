//! A small figure inside a larger one.

use super::Xy;
use crate::plots::canvas::{Anchor, Canvas, Layer, Rect};
use crate::plots::sheet::{Layout, Page, guide_margin};
use crate::plots::style::{self, NOTE_SIZE};

/// A small figure in the plot of a larger one: an enlarged part of its curves, or the same curves
/// on another scale.
///
/// It has no legend: its curves look like those of the same names in the larger figure. Its title
/// is the label of its vertical axis.
#[derive(Clone)]
pub struct Inset {
    /// The small figure.
    pub xy: Box<Xy>,
    /// Where it lies.
    pub place: InsetFrame,
}

/// A part of a plot, with the labels of its axes, in fractions of the plot from its upper left
/// corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InsetFrame {
    /// Left edge.
    pub left: f64,
    /// Upper edge; less than `bottom`.
    pub top: f64,
    /// Right edge.
    pub right: f64,
    /// Lower edge.
    pub bottom: f64,
}

/// Room for the labels of the axes and the title, in px.
const LEFT: f64 = 70.0;
const TOP: f64 = 30.0;
const RIGHT: f64 = 14.0;
const BOTTOM: f64 = 34.0;

impl InsetFrame {
    /// Height of the small plot, in heights of the larger one.
    pub fn height(&self) -> f64 {
        self.bottom - self.top - (TOP + BOTTOM) / style::PLOT_HEIGHT
    }

    fn within(&self, plot: &Rect) -> Rect {
        Rect {
            left: plot.left + self.left * plot.width(),
            top: plot.top + self.top * plot.height(),
            right: plot.left + self.right * plot.width(),
            bottom: plot.top + self.bottom * plot.height(),
        }
    }
}

impl Inset {
    /// Draws it on the page of the larger figure.
    pub(super) fn draw(&self, sheet: &mut Page) {
        let outer = self.place.within(&sheet.plot);
        let plot = Rect {
            left: outer.left + LEFT,
            top: outer.top + TOP,
            right: outer.right - RIGHT.max(guide_margin(&self.xy.guides)),
            bottom: outer.bottom - BOTTOM,
        };
        let layout = Layout {
            x: self.xy.x_ruler(),
            y: self.xy.y_ruler(),
            ..Layout::default()
        };
        let mut inset = layout.placed(plot);
        std::mem::swap(&mut inset.canvas, &mut sheet.canvas);
        inset.canvas.draw(Layer::default(), |pen| {
            pen.rect(outer, style::WHITE);
            pen.frame(outer, style::GRID, style::THIN);
            let at = (plot.left, outer.top + 0.5 * TOP);
            pen.text(&self.xy.y.label, at, NOTE_SIZE, Anchor::Left, style::INK);
        });
        inset.draw_grid();
        inset.draw_guides(&self.xy.guides);
        let mut xy = (*self.xy).clone();
        // A page that reads values off the drawing knows only the axes of the larger figure.
        xy.curves.iter_mut().for_each(|curve| curve.is_data = false);
        xy.draw_curves(&mut inset);
        inset.draw_frame();
        std::mem::swap(&mut inset.canvas, &mut sheet.canvas);
    }
}

impl Layout {
    /// The page of a plot that lies in this rectangle, with a canvas of no size.
    fn placed(self, plot: Rect) -> Page {
        let canvas = Canvas::new(0.0, 0.0);
        self.page(canvas, plot, INSET_TICKS)
    }
}

/// Number of ticks of the vertical axis, at most.
const INSET_TICKS: usize = 4;
