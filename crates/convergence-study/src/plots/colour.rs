//! From values to colours, and the bar that explains them.

use super::Scale;
use super::canvas::{Anchor, Layer, Rect};
use super::ruler::{Ruler, Ticks, on_scale, power_of_ten};
use super::sheet::Page;
use super::style::{self, LABEL_SIZE, TICK_SIZE, elide, text_width};
use plotters::style::RGBColor;
use plotters::style::colors::colormaps::{ColorMap, DerivedColorMap, ViridisRGB};

/// Colours of a scale: few enough to merge equal neighbours, too many to see steps; odd, so that
/// zero has its own.
const LEVELS: usize = 65;
const BAR_GAP: f64 = 22.0;
const BAR_WIDTH: f64 = 20.0;

/// Blue, white, red: Brewer's RdBu, readable with all common kinds of colour vision.
const DIVERGING: [RGBColor; 9] = [
    RGBColor(33, 102, 172),
    RGBColor(67, 147, 195),
    RGBColor(146, 197, 222),
    RGBColor(209, 229, 240),
    RGBColor(247, 247, 247),
    RGBColor(253, 219, 199),
    RGBColor(244, 165, 130),
    RGBColor(214, 96, 77),
    RGBColor(178, 24, 43),
];

/// A range of values with a colour for each.
#[derive(Clone, Debug)]
pub(super) struct ColourScale {
    pub(super) ruler: Ruler,
    label: String,
    colours: Vec<RGBColor>,
}

impl ColourScale {
    /// Dark for low, bright for high values (viridis).
    pub(super) fn sequential(
        label: &str,
        scale: Scale,
        values: impl IntoIterator<Item = f64>,
    ) -> Self {
        let colours = (0..LEVELS)
            .map(|k| ViridisRGB::get_color(k as f64 / (LEVELS - 1) as f64))
            .collect();
        Self {
            ruler: Ruler::around(scale, values, 0.0),
            label: label.to_owned(),
            colours,
        }
    }

    /// White at zero, blue below, red above; symmetric.
    pub(super) fn diverging(label: &str, values: impl IntoIterator<Item = f64>) -> Self {
        let sizes = values
            .into_iter()
            .filter(|&v| on_scale(Scale::Linear, v).is_some())
            .map(f64::abs);
        let largest = sizes.fold(0.0, f64::max);
        // The smallest normal range keeps a picture of zeros drawable.
        let largest = if largest > f64::MIN_POSITIVE {
            largest
        } else {
            1.0
        };
        let map = DerivedColorMap::new(&DIVERGING);
        let colours = (0..LEVELS)
            .map(|k| map.get_color(k as f32 / (LEVELS - 1) as f32))
            .collect();
        Self {
            ruler: Ruler::between(Scale::Linear, -largest, largest),
            label: label.to_owned(),
            colours,
        }
    }

    /// The colour of a value, if it can be drawn.
    pub(super) fn colour(&self, value: f64) -> Option<RGBColor> {
        let fraction = self.ruler.fraction(on_scale(self.ruler.scale, value)?);
        let level = (fraction * LEVELS as f64) as usize;
        Some(self.colours[level.min(LEVELS - 1)])
    }

    pub(super) fn ticks(&self) -> Ticks {
        self.ruler.ticks(8)
    }

    /// Width of the bar, to the right of the plot.
    pub(super) fn margin(&self) -> f64 {
        BAR_GAP + BAR_WIDTH + self.widest_label() + 28.0 + LABEL_SIZE
    }

    fn widest_label(&self) -> f64 {
        self.ticks()
            .major
            .iter()
            .map(|t| text_width(&t.label, TICK_SIZE))
            .fold(0.0, f64::max)
    }

    /// Draws the bar in the sheet's right margin.
    pub(super) fn draw_bar(&self, sheet: &mut Page) {
        let plot = sheet.plot;
        let left = plot.right + BAR_GAP;
        let bar = Rect {
            left,
            right: left + BAR_WIDTH,
            ..plot
        };
        let ruler = self.ruler.laid_out(bar.bottom, bar.top);
        let ticks = self.ticks();
        sheet.canvas.draw(Layer::default(), |pen| {
            let step = bar.height() / LEVELS as f64;
            for (k, &colour) in self.colours.iter().enumerate() {
                let bottom = bar.bottom - k as f64 * step;
                // Each overlaps the next, so that no seam shows between them.
                let top = (bottom - 2.0 * step).max(bar.top);
                pen.rect(Rect { top, bottom, ..bar }, colour);
            }
            pen.frame(bar, style::INK, style::THIN);
            for t in &ticks.major {
                let y = ruler.px_of(t.position);
                pen.tick((bar.right, y), (bar.right + 5.0, y));
                pen.text(
                    &t.label,
                    (bar.right + 9.0, y),
                    TICK_SIZE,
                    Anchor::Left,
                    style::INK,
                );
            }
            let end = bar.right + 9.0 + self.widest_label() + 9.0 + 0.5 * LABEL_SIZE;
            pen.text_upwards(&self.bar_label(&ticks), (end, plot.centre().1), LABEL_SIZE);
        });
    }

    fn bar_label(&self, ticks: &Ticks) -> String {
        let label = match ticks.exponent {
            0 => self.label.clone(),
            e => format!("{} / {}", self.label, power_of_ten(e)),
        };
        elide(&label, LABEL_SIZE, style::PLOT_HEIGHT)
    }
}
