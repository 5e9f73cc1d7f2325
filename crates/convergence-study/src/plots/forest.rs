//! Judged rates, each with its name and its interval, relative to its claim (a forest plot).

use super::canvas::{Anchor, Canvas, Layer, Pen, Rect};
use super::style::{
    self, GRID, INK, MUTED, NOTE_SIZE, SHADE, TICK_SIZE, TITLE_SIZE, elide, text_width,
};
use crate::interval::Interval;
use crate::judge::verdict::{RateVerdict, Verdict};
use plotters::style::RGBColor;

/// Half the width of the plot in tolerances: the band of a claim is [-1, 1].
const REACH: f64 = 2.0;

/// Height of a row: a name, and the numbers below it, in px.
const ROW: f64 = 46.0;
/// From the middle of a row to the middle of each of its two lines, in px.
const LINE: f64 = 10.0;
/// Room above and below the rows, in px.
const TOP: f64 = 84.0;
const BOTTOM: f64 = 66.0;
/// Widest label, in px; a longer one is cut.
const LABELS: f64 = 470.0;

/// A rate.
#[derive(Clone, Debug, PartialEq)]
pub struct ForestRow {
    /// Its name, with that of its study.
    pub label: String,
    /// Its numbers, below the name.
    pub numbers: String,
    /// What was judged.
    pub rate: RateVerdict,
}

/// Draws rates as points with their intervals, in units of their tolerances, from top to bottom.
pub fn forest(title: &str, rows: &[ForestRow]) -> String {
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
        legend(pen);
        scale(pen, &plot);
        for (k, row) in rows.iter().enumerate() {
            draw_row(pen, row, &plot, plot.top + ROW * k as f64);
        }
    });
    canvas.finish(title, "")
}

/// The px of a value in tolerances; values beyond the plot go to its edge.
fn px(plot: &Rect, value: f64) -> f64 {
    let fraction = (value.clamp(-REACH, REACH) + REACH) / (2.0 * REACH);
    plot.left + fraction * plot.width()
}

fn legend(pen: &Pen<'_>) {
    let mut x = 12.0;
    for (verdict, label) in [
        (Verdict::Pass, "pass"),
        (Verdict::Inconclusive, "inconclusive"),
        (Verdict::Fail, "fail"),
        (Verdict::Fail, "beyond the plot"),
    ] {
        if label.starts_with("beyond") {
            arrow(pen, (x + 12.0, 54.0), 1.0, colour(verdict));
        } else {
            pen.line(&[(x, 54.0), (x + 24.0, 54.0)], colour(verdict), 2.4);
            pen.disc((x + 12.0, 54.0), 5.0, colour(verdict));
        }
        pen.text(label, (x + 32.0, 54.0), NOTE_SIZE, Anchor::Left, INK);
        x += 32.0 + text_width(label, NOTE_SIZE) + 18.0;
    }
}

fn scale(pen: &Pen<'_>, plot: &Rect) {
    pen.rect(
        Rect {
            left: px(plot, -1.0),
            right: px(plot, 1.0),
            ..*plot
        },
        SHADE,
    );
    for (value, label) in [
        (-2.0, "\u{2212}2"),
        (-1.0, "\u{2212}1"),
        (0.0, "0"),
        (1.0, "+1"),
        (2.0, "+2"),
    ] {
        let x = px(plot, value);
        pen.line(
            &[(x, plot.top), (x, plot.bottom)],
            if value == 0.0 { MUTED } else { GRID },
            style::THIN,
        );
        pen.text(
            label,
            (x, plot.bottom + 16.0),
            NOTE_SIZE,
            Anchor::Center,
            INK,
        );
    }
    let axis = "observed rate \u{2212} order claimed, in tolerances";
    pen.text(
        axis,
        (plot.centre().0, plot.bottom + 44.0),
        TICK_SIZE,
        Anchor::Center,
        INK,
    );
}

fn draw_row(pen: &Pen<'_>, row: &ForestRow, plot: &Rect, top: f64) {
    let y = top + 0.5 * ROW;
    let ink = if row.rate.verdict == Verdict::Pass {
        INK
    } else {
        colour(row.rate.verdict)
    };
    let right = plot.left - 12.0;
    let label = elide(&row.label, NOTE_SIZE, LABELS);
    pen.text(&label, (right, y - LINE), NOTE_SIZE, Anchor::Right, ink);
    let numbers = elide(&row.numbers, NOTE_SIZE, LABELS);
    pen.text(&numbers, (right, y + LINE), NOTE_SIZE, Anchor::Right, MUTED);
    pen.line(&[(12.0, top), (plot.right, top)], GRID, 0.5 * style::THIN);
    draw_rate(pen, &row.rate, plot, y);
}

/// A value in units of its claim's tolerance; NaN without a claim, which no picture shows.
fn relative(rate: &RateVerdict, value: f64) -> f64 {
    rate.claimed.map_or(f64::NAN, |band| band.distance(value))
}

fn draw_rate(pen: &Pen<'_>, rate: &RateVerdict, plot: &Rect, y: f64) {
    let colour = colour(rate.verdict);
    let value = rate.fitted.map(|value| relative(rate, value));
    let interval = rate
        .interval
        .map(|ends| ends.map(|end| relative(rate, end)));
    if let Some(ends) = interval
        && ends.is_finite()
    {
        let Interval { low, high } = ends;
        pen.line(&[(px(plot, low), y), (px(plot, high), y)], colour, 2.4);
        // An interval that extends beyond the frame; if the rate does too, it has its own arrow.
        let is_within = value.is_some_and(|value| value.abs() <= REACH);
        for end in [low, high]
            .into_iter()
            .filter(|end| is_within && end.abs() > REACH)
        {
            tick(pen, (px(plot, end), y), end.signum(), colour);
        }
    }
    let Some(value) = value.filter(|value| value.is_finite()) else {
        return;
    };
    if value.abs() <= REACH {
        pen.disc((px(plot, value), y), 5.0, colour);
    } else {
        let direction = value.signum();
        let place = (px(plot, value) - 8.0 * direction, y);
        arrow(pen, place, direction, colour);
    }
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
    use crate::judge::verdict::judge_pairs;

    /// Claimed are an order of 0 and a tolerance of 1.
    fn missing(verdict: Verdict) -> RateVerdict {
        let mut rate = judge_pairs([], 0.0, 1.0);
        rate.verdict = verdict;
        rate
    }

    fn row(label: &str, rate: f64, half: f64, verdict: Verdict) -> ForestRow {
        let mut judged = missing(verdict);
        judged.fitted = Some(rate);
        judged.interval = Some(Interval::around(rate, half));
        ForestRow {
            label: label.into(),
            numbers: format!("numbers of {label}"),
            rate: judged,
        }
    }

    #[test]
    fn every_rate_is_named_and_one_beyond_the_plot_is_an_arrow() {
        let rows = [
            row("sound", 0.1, 0.2, Verdict::Pass),
            row("lost-order", -20.0, 0.1, Verdict::Fail),
            ForestRow {
                label: "none".into(),
                numbers: "no rate".into(),
                rate: missing(Verdict::Inconclusive),
            },
        ];
        let svg = forest("All rates", &rows);
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
            forest("", &rows).matches("<polygon").count()
        };
        // One belongs to the legend.
        assert_eq!([count(1.0), count(2.0), count(5.0)], [1, 2, 3]);
    }

    #[test]
    fn a_long_label_is_cut_and_nan_draws_nothing() {
        let rows = [row(&"x".repeat(200), f64::NAN, f64::NAN, Verdict::Fail)];
        let svg = forest("", &rows);
        assert!(svg.contains('…') && !svg.contains("NaN"));
    }
}
