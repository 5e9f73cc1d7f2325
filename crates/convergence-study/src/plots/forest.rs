//! Judged rates, each with its name and its interval, below each other (a forest plot).

use super::canvas::{Anchor, Canvas, Layer, Pen, Rect};
use super::style::{
    self, GRID, INK, MUTED, NOTE_SIZE, SHADE, TICK_SIZE, TITLE_SIZE, elide, text_width,
};
use crate::interval::Interval;
use crate::judge::verdict::{Band, Verdict};
use plotters::style::RGBColor;

/// Height of a row: a name, and the numbers below it, in px.
const ROW: f64 = 46.0;
/// From the middle of a row to the middle of each of its two lines, in px.
const LINE: f64 = 10.0;
/// Room above and below the rows, in px.
const TOP: f64 = 84.0;
const BOTTOM: f64 = 66.0;
/// Widest label, in px; a longer one is cut.
const LABELS: f64 = 470.0;

/// Room beyond the outermost rates.
const MARGIN: f64 = 0.1;

/// A rate.
#[derive(Clone, Debug, PartialEq)]
pub struct ForestRow {
    /// Its name, with that of its study.
    pub label: String,
    /// Its numbers, below the name.
    pub numbers: String,
    /// Where it is on the axis; `None` or NaN if there is none.
    pub value: Option<f64>,
    /// Its interval on the axis.
    pub interval: Option<Interval>,
    /// Its colour.
    pub verdict: Verdict,
}

/// The horizontal axis.
#[derive(Clone, Debug, PartialEq)]
pub struct ForestAxis {
    /// What it measures.
    pub label: String,
    /// The part that is drawn.
    pub range: Interval,
    /// The values with a line and a number.
    pub ticks: Vec<f64>,
    /// The claimed value, a darker line.
    pub claimed: f64,
    /// The tolerance, shaded.
    pub tolerance: Interval,
    /// What the colours of pass, inconclusive and fail mean.
    pub colours: [&'static str; 3],
}

impl ForestAxis {
    /// Deviations from the claims of several rates, in units of their tolerances.
    pub fn in_tolerances() -> Self {
        Self {
            label: "observed rate \u{2212} order claimed, in tolerances".to_owned(),
            range: Interval::around(0.0, 2.0),
            ticks: vec![-2.0, -1.0, 0.0, 1.0, 2.0],
            claimed: 0.0,
            tolerance: Interval::around(0.0, 1.0),
            colours: ["pass", "inconclusive", "fail"],
        }
    }

    /// Rates against one claim.
    ///
    /// * `rates`: those to be seen; what is more than 3 below the claim, or more than 2 above, is
    ///   beyond the plot.
    pub fn of_rates(
        claim: Band,
        rates: impl IntoIterator<Item = f64>,
        colours: [&'static str; 3],
    ) -> Self {
        let Band {
            order, tolerance, ..
        } = claim;
        let mut low = order - 1.0;
        let mut high = order + 0.5;
        for rate in rates.into_iter().filter(|rate| rate.is_finite()) {
            low = low.min(rate.max(order - 3.0) - MARGIN);
            high = high.max(rate.min(order + 2.0) + MARGIN);
        }
        // Whole halves.
        let first = (2.0 * low).floor() as i64;
        let last = (2.0 * high).ceil() as i64;
        Self {
            label: format!("rate; the line is the order claimed, {order}, the band its tolerance"),
            range: Interval {
                low: 0.5 * first as f64,
                high: 0.5 * last as f64,
            },
            ticks: (first..=last).map(|half| 0.5 * half as f64).collect(),
            claimed: order,
            tolerance: Interval::around(order, tolerance),
            colours,
        }
    }

    /// The px of a value; values beyond the plot go to its edge.
    fn px(&self, plot: &Rect, value: f64) -> f64 {
        let Interval { low, high } = self.range;
        plot.left + (value.clamp(low, high) - low) / (high - low) * plot.width()
    }

    /// Ticks relative to the claim have a sign.
    fn tick(&self, value: f64) -> String {
        let sign = match value {
            value if value < 0.0 => "\u{2212}",
            value if value > 0.0 && self.claimed == 0.0 => "+",
            _ => "",
        };
        format!("{sign}{}", value.abs())
    }
}

/// Draws rates as points with their intervals from top to bottom.
pub fn forest(title: &str, axis: &ForestAxis, rows: &[ForestRow]) -> String {
    let texts = rows.iter().flat_map(|row| [&row.label, &row.numbers]);
    let widths = texts.map(|text| text_width(text, NOTE_SIZE));
    let plot = Rect {
        left: widths.fold(80.0, f64::max).min(LABELS) + 28.0,
        top: TOP,
        right: style::WIDTH - 24.0,
        bottom: TOP + ROW * rows.len() as f64,
    };
    let mut canvas = Canvas::new(style::WIDTH, plot.bottom + BOTTOM);
    canvas.draw(Layer::default(), |pen| {
        let middle = 0.5 * style::WIDTH;
        pen.text(title, (middle, 24.0), TITLE_SIZE, Anchor::Center, INK);
        legend(pen, axis);
        scale(pen, axis, &plot);
        for (k, row) in rows.iter().enumerate() {
            draw_row(pen, axis, row, &plot, plot.top + ROW * k as f64);
        }
    });
    canvas.finish(title, "")
}

fn legend(pen: &Pen<'_>, axis: &ForestAxis) {
    let mut x = 12.0;
    let verdicts = [Verdict::Pass, Verdict::Inconclusive, Verdict::Fail];
    for (verdict, label) in verdicts.into_iter().zip(axis.colours) {
        pen.line(&[(x, 54.0), (x + 24.0, 54.0)], colour(verdict), 2.4);
        pen.disc((x + 12.0, 54.0), 5.0, colour(verdict));
        x = legend_label(pen, label, x);
    }
    arrow(pen, (x + 12.0, 54.0), 1.0, colour(Verdict::Fail));
    legend_label(pen, "beyond the plot", x);
}

/// Writes the label of an entry that begins at x; returns where the next one begins.
fn legend_label(pen: &Pen<'_>, label: &str, x: f64) -> f64 {
    pen.text(label, (x + 32.0, 54.0), NOTE_SIZE, Anchor::Left, INK);
    x + 32.0 + text_width(label, NOTE_SIZE) + 18.0
}

fn scale(pen: &Pen<'_>, axis: &ForestAxis, plot: &Rect) {
    let Interval { low, high } = axis.tolerance;
    pen.rect(
        Rect {
            left: axis.px(plot, low),
            right: axis.px(plot, high),
            ..*plot
        },
        SHADE,
    );
    for value in &axis.ticks {
        let is_claimed = *value == axis.claimed;
        vertical(
            pen,
            axis,
            plot,
            *value,
            if is_claimed { MUTED } else { GRID },
        );
        let place = (axis.px(plot, *value), plot.bottom + 16.0);
        pen.text(&axis.tick(*value), place, NOTE_SIZE, Anchor::Center, INK);
    }
    if !axis.ticks.contains(&axis.claimed) {
        vertical(pen, axis, plot, axis.claimed, MUTED);
    }
    let place = (plot.centre().0, plot.bottom + 44.0);
    pen.text(&axis.label, place, TICK_SIZE, Anchor::Center, INK);
}

fn vertical(pen: &Pen<'_>, axis: &ForestAxis, plot: &Rect, value: f64, colour: RGBColor) {
    let x = axis.px(plot, value);
    pen.line(&[(x, plot.top), (x, plot.bottom)], colour, style::THIN);
}

fn draw_row(pen: &Pen<'_>, axis: &ForestAxis, row: &ForestRow, plot: &Rect, top: f64) {
    let y = top + 0.5 * ROW;
    let ink = if row.verdict == Verdict::Pass {
        INK
    } else {
        colour(row.verdict)
    };
    let right = plot.left - 12.0;
    let label = elide(&row.label, NOTE_SIZE, LABELS);
    pen.text(&label, (right, y - LINE), NOTE_SIZE, Anchor::Right, ink);
    let numbers = elide(&row.numbers, NOTE_SIZE, LABELS);
    pen.text(&numbers, (right, y + LINE), NOTE_SIZE, Anchor::Right, MUTED);
    pen.line(&[(12.0, top), (plot.right, top)], GRID, 0.5 * style::THIN);
    draw_rate(pen, axis, row, plot, y);
}

fn draw_rate(pen: &Pen<'_>, axis: &ForestAxis, row: &ForestRow, plot: &Rect, y: f64) {
    let colour = colour(row.verdict);
    let range = axis.range;
    if let Some(ends) = row.interval
        && ends.is_finite()
    {
        let Interval { low, high } = ends;
        let line = [(axis.px(plot, low), y), (axis.px(plot, high), y)];
        pen.line(&line, colour, 2.4);
        // An interval that extends beyond the frame; if the rate does too, it has its own arrow.
        let is_within = row.value.is_some_and(|value| range.holds(value));
        for end in [low, high]
            .into_iter()
            .filter(|end| is_within && !range.holds(*end))
        {
            tick(pen, (axis.px(plot, end), y), side(range, end), colour);
        }
    }
    let Some(value) = row.value.filter(|value| value.is_finite()) else {
        return;
    };
    if range.holds(value) {
        pen.disc((axis.px(plot, value), y), 5.0, colour);
    } else {
        let direction = side(range, value);
        let place = (axis.px(plot, value) - 8.0 * direction, y);
        arrow(pen, place, direction, colour);
    }
}

/// On which side of a range a value beyond it is: -1 or 1.
fn side(range: Interval, value: f64) -> f64 {
    if value < range.low { -1.0 } else { 1.0 }
}

/// A small triangle whose point is on the frame.
fn tick(pen: &Pen<'_>, (x, y): (f64, f64), direction: f64, colour: RGBColor) {
    let back = x - 5.0 * direction;
    pen.polygon(&[(x, y), (back, y - 2.5), (back, y + 2.5)], colour);
}

/// A triangle that points beyond the plot.
fn arrow(pen: &Pen<'_>, (x, y): (f64, f64), direction: f64, colour: RGBColor) {
    pen.polygon(
        &[
            (x + 7.0 * direction, y),
            (x - 3.0 * direction, y - 4.0),
            (x - 3.0 * direction, y + 4.0),
        ],
        colour,
    );
}

fn colour(verdict: Verdict) -> RGBColor {
    // Colours of Okabe and Ito.
    match verdict {
        Verdict::Pass => RGBColor(0, 114, 178),
        Verdict::Inconclusive => RGBColor(230, 159, 0),
        Verdict::Fail => RGBColor(213, 94, 0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    fn row(label: &str, rate: f64, half: f64, verdict: Verdict) -> ForestRow {
        ForestRow {
            label: label.into(),
            numbers: format!("numbers of {label}"),
            value: Some(rate),
            interval: Some(Interval::around(rate, half)),
            verdict,
        }
    }

    fn drawn(title: &str, rows: &[ForestRow]) -> String {
        forest(title, &ForestAxis::in_tolerances(), rows)
    }

    #[test]
    fn every_rate_is_named_and_one_beyond_the_plot_is_an_arrow() {
        let rows = [
            row("sound", 0.1, 0.2, Verdict::Pass),
            row("lost-order", -20.0, 0.1, Verdict::Fail),
            ForestRow {
                label: "none".into(),
                numbers: "no rate".into(),
                value: None,
                interval: None,
                verdict: Verdict::Inconclusive,
            },
        ];
        let svg = drawn("All rates", &rows);
        for text in [
            "sound",
            "numbers of sound",
            "lost-order",
            "no rate",
            "All rates",
        ] {
            assert!(svg.contains(text), "{text}");
        }
        // A sound rate and three entries of the legend; the lost order is not a disc.
        assert_eq!(svg.matches("<circle").count(), 4, "{svg}");
        assert_eq!(svg.matches("<polygon").count(), 2);
        assert!(svg.contains("\u{2212}2") && !svg.contains("\n-2\n"));
    }

    #[test]
    fn an_interval_that_the_frame_cuts_has_a_small_arrow() {
        let count = |half: f64| {
            let rows = [row("a", 0.5, half, Verdict::Inconclusive)];
            drawn("", &rows).matches("<polygon").count()
        };
        // One belongs to the legend.
        assert_eq!([count(1.0), count(2.0), count(5.0)], [1, 2, 3]);
    }

    #[test]
    fn a_long_label_is_cut_and_nan_draws_nothing() {
        let rows = [row(&"x".repeat(200), f64::NAN, f64::NAN, Verdict::Fail)];
        let svg = drawn("", &rows);
        assert!(svg.contains('…') && !svg.contains("NaN"));
    }

    #[test]
    fn rates_against_one_claim_have_their_own_values_at_the_ticks() {
        let band = Band {
            order: 2.0,
            tolerance: 0.25,
        };
        let words = ["back", "undecided", "lost"];
        let axis = ForestAxis::of_rates(band, [2.01, 1.02, f64::NAN], words);
        assert_eq!(
            axis.range,
            Interval {
                low: 0.5,
                high: 2.5
            }
        );
        assert_eq!(axis.ticks, [0.5, 1.0, 1.5, 2.0, 2.5]);
        let svg = forest("", &axis, &[row("a", 1.02, 0.1, Verdict::Fail)]);
        for text in ["undecided", "the order claimed, 2", "\n1.5\n", "\n2.5\n"] {
            assert!(svg.contains(text), "{text}: {svg}");
        }
        assert!(!svg.contains("+2"));
        // Far rates are arrows, not the range.
        let axis = ForestAxis::of_rates(band, [-30.0, 40.0], words);
        assert_eq!(
            axis.range,
            Interval {
                low: -1.5,
                high: 4.5
            }
        );
    }
}
