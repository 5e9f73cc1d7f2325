//! All judged rates of a run in one picture: each with its interval, relative to its claim (a forest plot).

use super::canvas::{Anchor, Canvas, Layer, Pen, Rect};
use super::sheet::elide;
use super::style::{self, GRID, INK, MUTED, NOTE_SIZE, SHADE, TICK_SIZE, TITLE_SIZE, text_width};
use crate::judge::verdict::{RateVerdict, Verdict};
use plotters::style::RGBColor;

/// Half the width of the plot in tolerances: the band of a claim is [-1, 1].
const REACH: f64 = 2.0;

/// Height of one rate, and the least height of one study, in px.
const PITCH: f64 = 5.0;
const ROW: f64 = 19.0;
/// Height of a group's heading, in px.
const HEADING: f64 = 30.0;
/// Room above and below the rows, in px.
const TOP: f64 = 96.0;
const BOTTOM: f64 = 66.0;
/// Between the rates of a study and the numbers next to them, in px.
const CLEAR: f64 = 16.0;
/// Widest label, in px; a longer one is cut.
const LABELS: f64 = 300.0;

/// A study with its rates.
#[derive(Clone, Debug, PartialEq)]
pub struct ForestRow {
    /// The study's id.
    pub label: String,
    /// Its rates.
    pub rates: Vec<RateVerdict>,
    /// Numbers to show next to them, such as those of failing rates; may be empty.
    pub note: String,
}

/// Draws every rate as a point with its interval, in units of its tolerance, studies under the headings of their groups.
///
/// * `groups`: from top to bottom, the property that a group of studies claims, such as `space`, and the studies.
pub fn forest(title: &str, groups: &[(&str, Vec<ForestRow>)]) -> String {
    let rows = groups.iter().flat_map(|(_, rows)| rows);
    let labels = rows
        .clone()
        .map(|row| text_width(&row.label, NOTE_SIZE))
        .fold(80.0, f64::max)
        .min(LABELS);
    let height: f64 = rows.map(row_height).sum::<f64>() + HEADING * groups.len() as f64;
    let plot = Rect {
        left: labels + 28.0,
        top: TOP,
        right: style::WIDTH - 24.0,
        bottom: TOP + height,
    };
    let mut canvas = Canvas::new(style::WIDTH, plot.bottom + BOTTOM);
    canvas.draw(Layer::default(), |pen| {
        pen.text(
            title,
            (0.5 * style::WIDTH, 24.0),
            TITLE_SIZE,
            Anchor::Center,
            INK,
        );
        legend(pen);
        scale(pen, &plot);
        let mut top = plot.top;
        for (label, rows) in groups {
            pen.text(
                label,
                (12.0, top + 0.45 * HEADING),
                TICK_SIZE,
                Anchor::Left,
                INK,
            );
            pen.line(
                &[
                    (12.0, top + HEADING - 5.0),
                    (plot.right, top + HEADING - 5.0),
                ],
                GRID,
                style::THIN,
            );
            top += HEADING;
            for (k, row) in rows.iter().enumerate() {
                if k > 0 {
                    pen.line(&[(12.0, top), (plot.right, top)], GRID, 0.5 * style::THIN);
                }
                draw_row(pen, row, &plot, top);
                top += row_height(row);
            }
        }
    });
    canvas.finish(title, "")
}

fn row_height(row: &ForestRow) -> f64 {
    (PITCH * row.rates.len() as f64 + 6.0).max(ROW)
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
            arrow(pen, (x + 12.0, 56.0), 1.0, colour(verdict));
        } else {
            pen.line(&[(x, 56.0), (x + 24.0, 56.0)], colour(verdict), 2.4);
            pen.disc((x + 12.0, 56.0), 4.0, colour(verdict));
        }
        pen.text(label, (x + 32.0, 56.0), NOTE_SIZE, Anchor::Left, INK);
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
        (-1.0, "order \u{2212} tolerance"),
        (0.0, "order claimed"),
        (1.0, "order + tolerance"),
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
    let axis = "observed rate relative to its claim, in tolerances";
    pen.text(
        axis,
        (plot.centre().0, plot.bottom + 44.0),
        TICK_SIZE,
        Anchor::Center,
        INK,
    );
}

fn draw_row(pen: &Pen<'_>, row: &ForestRow, plot: &Rect, top: f64) {
    let height = row_height(row);
    let worst = row
        .rates
        .iter()
        .map(|rate| rate.verdict)
        .max()
        .unwrap_or(Verdict::Pass);
    let ink = if worst == Verdict::Pass {
        INK
    } else {
        colour(worst)
    };
    pen.text(
        &elide(&row.label, NOTE_SIZE, LABELS),
        (plot.left - 12.0, top + 0.5 * height),
        NOTE_SIZE,
        Anchor::Right,
        ink,
    );
    let first = top + 0.5 * (height - PITCH * (row.rates.len() as f64 - 1.0));
    for (k, rate) in row.rates.iter().enumerate() {
        draw_rate(pen, rate, plot, first + PITCH * k as f64);
    }
    draw_note(pen, row, plot, (top + 0.5 * height, ink));
}

/// Draws the note next to the rates of a study, on the side with more room.
fn draw_note(pen: &Pen<'_>, row: &ForestRow, plot: &Rect, (y, ink): (f64, RGBColor)) {
    let note = note(row);
    if note.is_empty() {
        return;
    }
    let drawn = row.rates.iter().flat_map(|rate| {
        let values = rate
            .fitted
            .into_iter()
            .chain(rate.interval.into_iter().flatten());
        values.map(|value| relative(rate, value))
    });
    let ends = drawn
        .filter(|value| value.is_finite())
        .map(|value| px(plot, value));
    let (left, right) = ends.fold((plot.right, plot.left), |(left, right), x| {
        (x.min(left), x.max(right))
    });
    let width = text_width(&note, NOTE_SIZE);
    let (start, anchor) = match right + CLEAR + width < plot.right {
        true => (right + CLEAR, Anchor::Left),
        false => (left - CLEAR, Anchor::Right),
    };
    pen.text(&note, (start, y), NOTE_SIZE, anchor, ink);
}

/// The note of the row, and how many of its rates are missing.
fn note(row: &ForestRow) -> String {
    let is_missing = |rate: &&RateVerdict| {
        rate.fitted
            .is_none_or(|value| !relative(rate, value).is_finite())
    };
    let missing = row.rates.iter().filter(is_missing).count();
    let without = match missing {
        0 => String::new(),
        all if all == row.rates.len() => "no rate".to_owned(),
        some => format!("{some} without a rate"),
    };
    let parts = [row.note.clone(), without];
    parts
        .iter()
        .filter(|part| !part.is_empty())
        .cloned()
        .collect::<Vec<_>>()
        .join("; ")
}

/// A value in units of its claim's tolerance.
fn relative(rate: &RateVerdict, value: f64) -> f64 {
    (value - rate.order) / rate.tolerance
}

fn draw_rate(pen: &Pen<'_>, rate: &RateVerdict, plot: &Rect, y: f64) {
    let colour = colour(rate.verdict);
    let value = rate.fitted.map(|value| relative(rate, value));
    let interval = rate
        .interval
        .map(|ends| ends.map(|end| relative(rate, end)));
    let finite = |value: &f64| value.is_finite();
    if let Some([low, high]) = interval.filter(|ends| ends.iter().all(finite)) {
        pen.line(&[(px(plot, low), y), (px(plot, high), y)], colour, 1.8);
        // An interval that extends beyond the frame; if the rate does too, it has its own arrow.
        let is_within = value.is_some_and(|value| value.abs() <= REACH);
        for end in [low, high]
            .into_iter()
            .filter(|end| is_within && end.abs() > REACH)
        {
            tick(pen, (px(plot, end), y), end.signum(), colour);
        }
    }
    match value.filter(finite) {
        Some(value) if value.abs() <= REACH => pen.disc((px(plot, value), y), 2.4, colour),
        Some(value) => arrow(
            pen,
            (px(plot, value) - 8.0 * value.signum(), y),
            value.signum(),
            colour,
        ),
        None => {}
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
        RateVerdict {
            verdict,
            ..judge_pairs([], 0.0, 1.0)
        }
    }

    fn row(label: &str, rates: &[(f64, f64, Verdict)]) -> ForestRow {
        let rate = |&(rate, half, verdict): &(f64, f64, Verdict)| RateVerdict {
            fitted: Some(rate),
            interval: Some([rate - half, rate + half]),
            ..missing(verdict)
        };
        ForestRow {
            label: label.into(),
            rates: rates.iter().map(rate).collect(),
            note: String::new(),
        }
    }

    #[test]
    fn every_study_is_named_and_a_rate_beyond_the_plot_is_an_arrow() {
        let none = missing(Verdict::Inconclusive);
        let rows = vec![
            row(
                "sound",
                &[(0.1, 0.2, Verdict::Pass), (0.0, 0.1, Verdict::Pass)],
            ),
            row("lost-order", &[(-20.0, 0.1, Verdict::Fail)]),
            ForestRow {
                label: "none".into(),
                rates: vec![none; 3],
                note: String::new(),
            },
        ];
        let svg = forest("All rates", &[("space", rows)]);
        for text in [
            "sound",
            "lost-order",
            "none",
            "no rate",
            "space",
            "All rates",
        ] {
            assert!(svg.contains(text), "{text}");
        }
        // Two sound rates and three entries of the legend; the lost order is not a disc.
        assert_eq!(svg.matches("<circle").count(), 5, "{svg}");
        assert_eq!(svg.matches("<polygon").count(), 2);
        // Stated once for a study, not once for each rate.
        assert_eq!(svg.matches("no rate").count(), 1);
        assert!(svg.contains("\u{2212}2") && !svg.contains("\n-2\n"));
    }

    #[test]
    fn numbers_stand_beside_the_rates_where_there_is_room() {
        let x_of = |svg: &str, text: &str| -> f64 {
            let before = &svg[..svg.find(text).unwrap_or_else(|| panic!("{text} in {svg}"))];
            let tag = &before[before.rfind("<text").unwrap()..];
            tag.split("x=\"")
                .nth(1)
                .unwrap()
                .split('"')
                .next()
                .unwrap()
                .parse()
                .unwrap()
        };
        let mut low = row(
            "low",
            &[(-20.0, 0.1, Verdict::Fail), (0.0, 0.1, Verdict::Pass)],
        );
        low.rates.push(missing(Verdict::Fail));
        low.note = "1.000, claimed 2".into();
        let high = ForestRow {
            note: "3.000, claimed 2".into(),
            ..row("high", &[(20.0, 0.1, Verdict::Fail)])
        };
        let svg = forest("", &[("g", vec![low, high])]);
        // In tenths of px: the arrow at the right rim begins at 8650.
        let (beside, before) = (
            x_of(&svg, "1.000, claimed 2; 1 without a rate"),
            x_of(&svg, "3.000, claimed 2"),
        );
        let middle = x_of(&svg, "order claimed");
        assert!(
            beside > middle && before < 8650.0,
            "{beside} {before} {middle}"
        );
    }

    #[test]
    fn an_interval_that_the_frame_cuts_has_a_small_arrow() {
        let count = |half: f64| {
            let rows = vec![row("a", &[(0.5, half, Verdict::Inconclusive)])];
            forest("", &[("g", rows)]).matches("<polygon").count()
        };
        // One belongs to the legend.
        assert_eq!([count(1.0), count(2.0), count(5.0)], [1, 2, 3]);
    }

    #[test]
    fn studies_are_parted_by_a_line() {
        let lines = |count: usize| {
            let rows = vec![row("a", &[(0.0, 0.1, Verdict::Pass)]); count];
            forest("", &[("g", rows)]).matches("<polyline").count()
        };
        // The interval, and a line between this study and the one before.
        assert_eq!(lines(4) - lines(3), 2);
    }

    #[test]
    fn a_long_label_is_cut_and_nan_draws_nothing() {
        let rows = vec![row(
            &"x".repeat(200),
            &[(f64::NAN, f64::NAN, Verdict::Fail)],
        )];
        let svg = forest("", &[("g", rows)]);
        assert!(svg.contains('…') && svg.contains("no rate") && !svg.contains("NaN"));
    }
}
