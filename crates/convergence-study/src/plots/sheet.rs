//! A laid-out page: plot area, axes, grid, notes, and the legend below the plot, in aligned
//! columns, never on the data.

use super::Guide;
use super::attributes;
use super::canvas::{Anchor, Canvas, Layer, Pen, Point, Rect};
use super::legend::{COLUMN_GAP, Entry, arranged, draw_entry};
use super::ruler::{Ruler, Ticks, power_of_ten};
use super::style::{self, EDGE, LABEL_SIZE, NOTE_SIZE, TICK_SIZE, TITLE_SIZE, elide, text_width};

/// Height of the row of the title.
const TITLE_ROW: f64 = 32.0;
const NOTE_HEIGHT: f64 = 24.0;
/// From the frame down to the middle of the tick labels, and on to the middle of the axis label.
const TICK_LABEL_DROP: f64 = 19.0;
const AXIS_LABEL_DROP: f64 = 48.0;
/// Guide labels closer than this would overlap.
const GUIDE_SPACING: f64 = 21.0;
/// Number of ticks of the vertical axis, at most.
const Y_TICKS: usize = 8;
/// Height of a row of the legend.
const ROW_HEIGHT: f64 = 27.0;

/// The content of a page.
#[derive(Clone, Debug, Default)]
pub(super) struct Layout {
    /// `None`: the vertical axis over the horizontal one.
    pub(super) title: Option<String>,
    pub(super) x: Ruler,
    pub(super) y: Ruler,
    pub(super) x_label: String,
    pub(super) y_label: String,
    /// Room needed to the right of the plot, in px.
    pub(super) right: f64,
    /// Text above the plot, at positions on the x scale.
    pub(super) above: Option<(f64, String)>,
    pub(super) legend: Vec<Entry>,
    pub(super) notes: Vec<String>,
}

/// A page with everything in its place.
pub(super) struct Page {
    pub(super) canvas: Canvas,
    pub(super) plot: Rect,
    pub(super) x: Ruler,
    pub(super) y: Ruler,
    x_ticks: Ticks,
    y_ticks: Ticks,
    plan: Layout,
}

impl Layout {
    fn title(&self) -> String {
        self.title.clone().unwrap_or_else(|| {
            [&self.y_label, &self.x_label]
                .map(|label| without_unit(label))
                .join(" over ")
        })
    }

    /// Measures all texts and places the plot area between them.
    pub(super) fn lay_out(self) -> Page {
        let y_ticks = self.y.ticks(Y_TICKS);
        let left = EDGE + LABEL_SIZE + 10.0 + widest(&y_ticks) + 12.0;
        let right = style::WIDTH - self.right.max(2.0 * EDGE);
        let headline = self.above.is_some() || y_ticks.exponent != 0;
        let top = EDGE + TITLE_ROW + if headline { 24.0 } else { 0.0 };
        let plot = Rect {
            left,
            top,
            right,
            bottom: top + style::PLOT_HEIGHT,
        };
        let height = notes_top(&plot, &self.legend) + NOTE_HEIGHT * self.notes.len() as f64 + 8.0;
        self.page(Canvas::new(style::WIDTH, height.round()), plot, Y_TICKS)
    }

    /// The page with its plot in this place.
    ///
    /// * `y_ticks`: number of ticks of the vertical axis, at most.
    pub(super) fn page(self, canvas: Canvas, plot: Rect, y_ticks: usize) -> Page {
        Page {
            canvas,
            x: self.x.laid_out(plot.left, plot.right),
            y: self.y.laid_out(plot.bottom, plot.top),
            plot,
            x_ticks: ticks_that_fit(&self.x, plot.width()),
            y_ticks: self.y.ticks(y_ticks),
            plan: self,
        }
    }
}

/// A label up to its unit, such as `displacement u` of `displacement u (dimensionless)`.
fn without_unit(label: &str) -> &str {
    label.split(" (").next().unwrap_or(label)
}

fn legend_top(plot: &Rect) -> f64 {
    plot.bottom + AXIS_LABEL_DROP + 18.0
}

fn notes_top(plot: &Rect, legend: &[Entry]) -> f64 {
    legend_top(plot) + legend.len().div_ceil(arranged(legend).0) as f64 * ROW_HEIGHT
}

fn widest(ticks: &Ticks) -> f64 {
    ticks
        .major
        .iter()
        .map(|t| text_width(&t.label, TICK_SIZE))
        .fold(0.0, f64::max)
}

/// The finest ticks whose labels do not touch.
fn ticks_that_fit(ruler: &Ruler, width: f64) -> Ticks {
    for count in (2..=8).rev() {
        let ticks = ruler.ticks(count);
        if (widest(&ticks) + 0.8 * TICK_SIZE) * ticks.major.len() as f64 <= width {
            return ticks;
        }
    }
    ruler.ticks(1)
}

impl Page {
    /// Position of a data point, if its axes can show it.
    pub(super) fn px(&self, (x, y): (f64, f64)) -> Option<Point> {
        Some((self.x.px(x)?, self.y.px(y)?))
    }

    /// Draws the grid: call this before drawing the data.
    pub(super) fn draw_grid(&mut self) {
        let Page {
            plot,
            x,
            y,
            x_ticks,
            y_ticks,
            canvas,
            ..
        } = self;
        canvas.draw(Layer::clipped(*plot), |pen| {
            for &v in &x_ticks.minor {
                pen.vertical(x.px_of(v), plot, style::MINOR_GRID);
            }
            for &v in &y_ticks.minor {
                pen.horizontal(y.px_of(v), plot, style::MINOR_GRID);
            }
            for tick in &x_ticks.major {
                pen.vertical(x.px_of(tick.position), plot, style::GRID);
            }
            for tick in &y_ticks.major {
                pen.horizontal(y.px_of(tick.position), plot, style::GRID);
            }
        });
    }

    /// Draws a thin line at each guide, and its label in the right margin.
    pub(super) fn draw_guides(&mut self, guides: &[Guide]) {
        let mut places: Vec<(f64, &str)> = guides
            .iter()
            .filter_map(|g| Some((self.y.px(g.value)?, g.label.as_str())))
            .collect();
        places.sort_by(|a, b| a.0.total_cmp(&b.0));
        let plot = self.plot;
        self.canvas
            .draw(Layer::clipped(plot).dashed(style::SHORT), |pen| {
                for &(y, _) in &places {
                    pen.line(&[(plot.left, y), (plot.right, y)], style::MUTED, 1.4);
                }
            });
        let spread = spread_out(&places.iter().map(|p| p.0).collect::<Vec<_>>(), plot);
        self.canvas.draw(Layer::default(), |pen| {
            for (&(line_y, label), &label_y) in places.iter().zip(&spread) {
                pen.line(
                    &[(plot.right + 1.0, line_y), (plot.right + 9.0, label_y)],
                    style::MUTED,
                    style::THIN,
                );
                pen.text(
                    label,
                    (plot.right + 13.0, label_y),
                    TICK_SIZE,
                    Anchor::Left,
                    style::INK,
                );
            }
        });
    }

    /// Draws the frame, and the ticks and labels of the axes.
    pub(super) fn draw_frame(&mut self) {
        let Page {
            canvas,
            plot,
            x_ticks,
            y_ticks,
            plan,
            x,
            y,
        } = self;
        canvas.draw(Layer::default(), |pen| {
            pen.frame(*plot, style::INK, style::THIN);
            draw_x_axis(pen, plot, x, x_ticks, &plan.x_label);
            draw_y_axis(pen, plot, y, y_ticks, &plan.y_label);
        });
    }

    /// Draws everything around the data, and closes the document.
    pub(super) fn finish(mut self) -> String {
        self.draw_frame();
        let Page {
            canvas,
            plot,
            plan,
            x,
            ..
        } = &mut self;
        canvas.draw(Layer::default(), |pen| draw_headlines(pen, plot, plan, x));
        self.draw_foot();
        let plan = self.plan;
        let axes = [(&*plan.x_label, &self.x), (&*plan.y_label, &self.y)];
        let attributes = attributes::axes(&self.plot, axes);
        self.canvas.finish(&plan.title(), &attributes)
    }

    /// Draws the legend centred on the plot but always within the page, its first row below `top`.
    fn draw_legend(&mut self, top: f64) {
        let Self { plan, canvas, .. } = self;
        let (columns, column_width) = arranged(&plan.legend);
        let width = columns as f64 * column_width - COLUMN_GAP;
        let left = (self.plot.centre().0 - 0.5 * width)
            .min(style::WIDTH - width - 8.0)
            .max(8.0);
        for (k, entry) in plan.legend.iter().enumerate() {
            let x = left + (k % columns) as f64 * column_width;
            let y = top + ((k / columns) as f64 + 0.5) * ROW_HEIGHT;
            canvas.group(&attributes::entry(&entry.label), |canvas| {
                draw_entry(canvas, entry, (x, y), column_width);
            });
        }
    }

    fn draw_foot(&mut self) {
        self.draw_legend(legend_top(&self.plot));
        let first = notes_top(&self.plot, &self.plan.legend) + 0.5 * NOTE_HEIGHT;
        let left = self.plot.left;
        let notes = &self.plan.notes;
        self.canvas.draw(Layer::default(), |pen| {
            for (k, note) in notes.iter().enumerate() {
                let place = (left, first + k as f64 * NOTE_HEIGHT);
                let note = elide(note, NOTE_SIZE, style::WIDTH - left - EDGE);
                pen.text(&note, place, NOTE_SIZE, Anchor::Left, style::MUTED);
            }
        });
    }
}

fn draw_x_axis(pen: &Pen<'_>, plot: &Rect, ruler: &Ruler, ticks: &Ticks, label: &str) {
    for t in &ticks.major {
        let x = ruler.px_of(t.position);
        pen.tick((x, plot.bottom), (x, plot.bottom - 6.0));
        pen.text(
            &t.label,
            (x, plot.bottom + TICK_LABEL_DROP),
            TICK_SIZE,
            Anchor::Center,
            style::INK,
        );
    }
    let row = plot.bottom + AXIS_LABEL_DROP;
    if ticks.exponent != 0 {
        let power = format!("×{}", power_of_ten(ticks.exponent));
        pen.text(
            &power,
            (plot.right, row),
            TICK_SIZE,
            Anchor::Right,
            style::INK,
        );
    }
    let label = elide(label, LABEL_SIZE, plot.width());
    pen.text(
        &label,
        (plot.centre().0, row),
        LABEL_SIZE,
        Anchor::Center,
        style::INK,
    );
}

fn draw_y_axis(pen: &Pen<'_>, plot: &Rect, ruler: &Ruler, ticks: &Ticks, label: &str) {
    for t in &ticks.major {
        let y = ruler.px_of(t.position);
        pen.tick((plot.left, y), (plot.left + 6.0, y));
        pen.text(
            &t.label,
            (plot.left - 9.0, y),
            TICK_SIZE,
            Anchor::Right,
            style::INK,
        );
    }
    if ticks.exponent != 0 {
        let power = format!("×{}", power_of_ten(ticks.exponent));
        pen.text(
            &power,
            (plot.left, plot.top - 13.0),
            TICK_SIZE,
            Anchor::Left,
            style::INK,
        );
    }
    let label = elide(label, LABEL_SIZE, plot.height() + EDGE);
    pen.text_upwards(
        &label,
        (EDGE + 0.5 * LABEL_SIZE, plot.centre().1),
        LABEL_SIZE,
    );
}

fn draw_headlines(pen: &Pen<'_>, plot: &Rect, plan: &Layout, x: &Ruler) {
    let title = elide(&plan.title(), TITLE_SIZE, style::WIDTH - 2.0 * EDGE);
    pen.text(
        &title,
        (0.5 * style::WIDTH, EDGE + 10.0),
        TITLE_SIZE,
        Anchor::Center,
        style::INK,
    );
    if let Some((position, text)) = &plan.above {
        pen.text(
            text,
            (x.px_of(*position), plot.top - 13.0),
            TICK_SIZE,
            Anchor::Center,
            style::INK,
        );
    }
}

/// Width of guide labels, to the right of the plot.
pub(super) fn guide_margin(guides: &[Guide]) -> f64 {
    guides
        .iter()
        .map(|g| text_width(&g.label, TICK_SIZE) + 22.0)
        .fold(0.0, f64::max)
}

/// Moves sorted heights apart so that labels do not overlap, within the plot if possible.
fn spread_out(heights: &[f64], plot: Rect) -> Vec<f64> {
    let mut spread = heights.to_vec();
    for k in 1..spread.len() {
        spread[k] = spread[k].max(spread[k - 1] + GUIDE_SPACING);
    }
    let mut lowest = plot
        .bottom
        .max(spread.first().copied().unwrap_or(plot.bottom));
    for y in spread.iter_mut().rev() {
        *y = y.min(lowest);
        lowest = *y - GUIDE_SPACING;
    }
    spread
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn close_guide_labels_are_moved_apart() {
        let plot = Rect {
            left: 0.0,
            top: 0.0,
            right: 100.0,
            bottom: 430.0,
        };
        let spread = spread_out(&[10.0, 12.0, 425.0, 429.0], plot);
        assert!(
            spread
                .windows(2)
                .all(|w| w[1] - w[0] >= GUIDE_SPACING - 1e-9),
            "{spread:?}"
        );
        assert!(spread[3] <= plot.bottom);
    }
}
