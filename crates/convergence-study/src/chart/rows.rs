//! Judged rates with their intervals, below each other (a forest plot).

use plotters::style::Color;
use plotters::style::text_anchor::HPos;

use super::layout::{EDGE, Layout};
use super::pen::{Area, GRID, INK, MUTED, Style, TEXT, elide, font, line, polygon, style, write};
use super::{Axis, Chart, Columns, Mark, Series, Shade};
use crate::interval::Interval;
use crate::text::number::{RATE_PLACES, interval_text, rate_text};
use convergence_judge::verdict::{self, RateVerdict, Verdict, against_claim};

/// Height of a row, and from its middle to the middle of each of its two lines, in px.
pub(super) const ROW: f64 = 46.0;
const LINE: f64 = 10.5;
/// Room beyond the outermost rates.
const MARGIN: f64 = 0.1;
/// Verdicts and the styles of their rates.
const STYLES: [(Verdict, usize); 3] = [
    (Verdict::Pass, 0),
    (Verdict::Inconclusive, 4),
    (Verdict::Fail, 1),
];
/// What verdicts are called.
pub(crate) const VERDICTS: [&str; 3] = ["pass", "inconclusive", "fail"];

/// A rate.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Row {
    /// Its name, with that of its study.
    pub(crate) name: String,
    /// Its numbers, below the name.
    pub(crate) numbers: String,
    /// Where it is on the axis; `None` or NaN if there is none.
    pub(crate) value: Option<f64>,
    /// Its interval on the axis.
    pub(crate) interval: Option<Interval>,
    /// Its colour.
    pub(crate) verdict: Verdict,
}

impl Row {
    /// A rate with its claim.
    pub(crate) fn new(name: String, rate: &RateVerdict) -> Self {
        let numbers = match (rate.interval, rate.fitted) {
            (Some(interval), _) => interval_text(interval, RATE_PLACES),
            (None, Some(_)) => rate_text(rate.fitted),
            (None, None) => "no rate".to_owned(),
        };
        Self {
            name,
            numbers: against_claim(&numbers, &rate.claim()).replace('-', "\u{2212}"),
            value: rate.fitted.or(rate.finest_rate()),
            interval: rate.interval,
            verdict: rate.verdict,
        }
    }
}

/// Rates relative to their claims, in units of their tolerances.
pub(crate) fn deviations(rows: Vec<Row>) -> Chart {
    let axis = Axis {
        range: Some([-2.0, 2.0]),
        ..Axis::linear("observed rate \u{2212} order claimed, in tolerances")
    };
    forest(axis, 0.0, Interval::around(0.0, 1.0), VERDICTS, rows)
}

/// Rates against one claim.
///
/// * `words`: what the colours of pass, inconclusive and fail mean.
/// * `rows`: rates more than 3 below the claim, or more than 2 above, are beyond the plot.
pub(crate) fn rates_of(claim: verdict::Band, words: [&str; 3], rows: Vec<Row>) -> Chart {
    let verdict::Band {
        order, tolerance, ..
    } = claim;
    let [mut low, mut high] = [order - 1.0, order + 0.5];
    for rate in rows
        .iter()
        .filter_map(|row| row.value)
        .filter(|rate| rate.is_finite())
    {
        low = low.min(rate.max(order - 3.0) - MARGIN);
        high = high.max(rate.min(order + 2.0) + MARGIN);
    }
    let axis = Axis {
        // Whole halves.
        range: Some([0.5 * (2.0 * low).floor(), 0.5 * (2.0 * high).ceil()]),
        ..Axis::linear(format!(
            "rate; the line is the order claimed, {order}, the band its tolerance"
        ))
    };
    forest(axis, order, Interval::around(order, tolerance), words, rows)
}

/// * `claimed`: a vertical line.
fn forest(x: Axis, claimed: f64, tolerance: Interval, words: [&str; 3], rows: Vec<Row>) -> Chart {
    let table = Columns::new([
        ("order claimed", vec![claimed; 2]),
        ("ends", vec![-(rows.len() as f64), 0.0]),
        ("", vec![]),
    ]);
    let claimed = Series::new("order claimed", "order claimed", "ends").styled(5);
    let mut series = vec![Series {
        width: 1.2,
        dashes: Some(""),
        ..claimed
    }];
    // The rows draw themselves: these say what their colours mean.
    for ((_, style), word) in STYLES.into_iter().zip(words) {
        series.push(Series::new(word, "", "").scattered().styled(style));
    }
    let [low, high] = x.range.unwrap_or_default();
    let is_beyond = |row: &Row| row.value.is_some_and(|value| value < low || value > high);
    let notes = match rows.iter().any(is_beyond) {
        true => vec!["triangles at the rim: beyond the plot".to_owned()],
        false => vec![],
    };
    let bands = vec![Shade {
        label: "tolerance".to_owned(),
        intervals: vec![(tolerance.low, tolerance.high)],
    }];
    let y = Axis {
        range: Some([-(rows.len().max(1) as f64), 0.0]),
        rows,
        ..Axis::default()
    };
    Chart {
        series,
        notes,
        bands,
        ..Chart::new(table, x, y)
    }
}

/// Names and numbers, with a line above each row, and where the rates are.
pub(super) fn draw(area: &Area<'_>, chart: &Chart, layout: &Layout) {
    let [left, top, right, _] = layout.plot;
    for (k, row) in chart.y.rows.iter().enumerate() {
        let above = top + ROW * k as f64;
        line(area, &[(EDGE, above), (right, above)], GRID, 1.0);
        let own = STYLES
            .into_iter()
            .find(|(verdict, _)| *verdict == row.verdict);
        let own = own.map_or(style(0), |(_, k)| style(k));
        let middle = above + 0.5 * ROW;
        let colour = match row.verdict {
            Verdict::Pass => INK,
            _ => own.colour,
        };
        for (text, y, colour) in [
            (&row.name, middle - LINE, colour),
            (&row.numbers, middle + LINE, MUTED),
        ] {
            let text = elide(text, TEXT, left - 28.0);
            write(
                area,
                &text,
                (left - 12.0, y),
                font(TEXT).color(&colour.to_rgba()),
                HPos::Right,
            );
        }
        row.draw(area, layout, own, middle);
    }
}

impl Row {
    /// Its rate and its interval; triangles at the rim point to what is beyond.
    fn draw(&self, area: &Area<'_>, layout: &Layout, style: Style, y: f64) {
        let place = |x: f64| (layout.px((x, f64::NAN)).0, y);
        let arrow = |x: f64, size: f64| {
            let (end, y) = place(x);
            let [back, half] = [end - size * layout.x.beyond(x), 0.5 * size];
            let corners = [(end, y), (back, y - half), (back, y + half)];
            polygon(area, corners.into_iter(), style.colour);
        };
        let ends = self.interval.map(|ends| [ends.low, ends.high]);
        if let Some(ends) = ends.filter(|ends| ends.iter().all(|end| end.is_finite())) {
            line(area, &ends.map(place), style.colour, 2.4);
            let beyond = ends.into_iter().filter(|end| layout.x.beyond(*end) != 0.0);
            beyond.for_each(|end| arrow(end, 6.0));
        }
        match self.value.filter(|value| value.is_finite()) {
            Some(value) if layout.x.beyond(value) == 0.0 => {
                style.mark(area, place(value), Mark::Filled);
            }
            Some(value) => arrow(value, 9.0),
            None => {}
        }
    }
}
