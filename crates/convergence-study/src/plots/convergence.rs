//! Errors against the mesh width or the time step.

use std::ops::Range;

use super::legend::{Entry, Swatch};
use super::look::{Look, look};
use super::marker::Marks;
use super::ruler::on_scale;
use super::slopes::{Trend, triangles};
use super::style::Dash;
use super::xy::{Curve, Xy};
use super::{Axis, Guide, Scale, style};
use crate::judge::power_law::PowerLaw;
use crate::text::number::{RATE_PLACES, WIDEST_INTERVAL, decimals, interval_places};

/// The errors in one norm.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ErrorSeries {
    /// The norm's name.
    pub label: String,
    /// `(h or dt, error)`.
    pub points: Vec<(f64, f64)>,
    /// What theory says, for the legend.
    pub order: Option<f64>,
    /// Line fitted to the points; its rate stands in the legend.
    pub fit: Option<PowerLaw>,
    /// Interval of that rate, which says how many of its digits are known. Of one wider than [`WIDEST_INTERVAL`] neither rate nor
    /// line is drawn. `None`: not known.
    pub interval: Option<[f64; 2]>,
    /// Indices of the points that were fitted, over which the line is drawn; the others get open markers. `None`: all.
    pub used: Option<Range<usize>>,
    /// Which [`look`] it has; `None`: that of its place in the figure.
    pub look: Option<usize>,
}

/// A convergence plot, both axes logarithmic.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Convergence {
    /// Above the plot.
    pub title: Option<String>,
    /// What is refined.
    pub x_label: String,
    /// What is measured.
    pub y_label: String,
    /// One series per norm.
    pub series: Vec<ErrorSeries>,
    /// Orders to draw slope triangles for, beside those of the series.
    pub slopes: Vec<f64>,
    /// A level of note, such as the round-off floor.
    pub floor: Option<Guide>,
    /// Everything right of this step is shaded, with the text above it.
    pub beyond: Option<(f64, String)>,
    /// Lines under the legend, such as what has no result.
    pub notes: Vec<String>,
}

impl ErrorSeries {
    /// The line, where its rate is known.
    pub(crate) fn line(&self) -> Option<PowerLaw> {
        let is_known = |[low, high]: [f64; 2]| high - low <= WIDEST_INTERVAL;
        self.fit.filter(|_| self.interval.is_none_or(is_known))
    }

    /// What the legend says of the rate.
    fn rate(&self) -> Option<String> {
        self.fit?;
        let Some(line) = self.line() else { return Some("no rate".to_owned()) };
        let places = self.interval.map_or(RATE_PLACES - 1, |interval| interval_places(interval, RATE_PLACES));
        line.rate.is_finite().then(|| format!("rate {}", decimals(line.rate, places)))
    }
}

impl Convergence {
    /// Labels for errors over the mesh width.
    pub fn in_space() -> Self {
        Self { x_label: "mesh width h".into(), y_label: "error".into(), ..Self::default() }
    }
}

/// Draws errors over `h` or `dt`, log-log.
pub fn convergence(figure: &Convergence) -> String {
    let mut xy = Xy {
        title: figure.title.clone(),
        x: Axis::log(&*figure.x_label),
        y: Axis::log(&*figure.y_label),
        guides: figure.floor.clone().into_iter().collect(),
        beyond: figure.beyond.clone(),
        notes: figure.notes.clone(),
        ..Xy::default()
    };
    for (k, series) in figure.series.iter().enumerate() {
        xy.curves.extend(curves(series, look_of(k, series)));
        xy.legend.push(entry(series, look_of(k, series)));
    }
    if figure.series.iter().any(has_unused_points) {
        xy.notes.push("open markers: points that the rate does not use".to_owned());
    }
    let mut orders: Vec<f64> = figure.series.iter().filter_map(|series| series.order).collect();
    orders.sort_by(f64::total_cmp);
    orders.dedup();
    orders.extend(&figure.slopes);
    let (outlines, bottom) = triangles(&orders, &trends(&figure.series), &xy.x_ruler(), &xy.y_ruler());
    if !outlines.is_empty() {
        xy.show_y.push(bottom);
    }
    xy.outlines = outlines;
    xy.draw()
}

/// Whether a line is fitted to some of its points only.
fn has_unused_points(series: &ErrorSeries) -> bool {
    let len = series.points.len();
    series.line().is_some() && series.used.as_ref().is_some_and(|used| used.len() < len)
}

/// Its own look, or that of its place in the figure.
fn look_of(k: usize, series: &ErrorSeries) -> Look {
    look(series.look.unwrap_or(k))
}

/// The legend's entry for line and markers. A fitted line is thin and solid, one that only joins the points is not.
fn entry(series: &ErrorSeries, look: Look) -> Entry {
    let (dash, width) = match (series.fit, series.line()) {
        (_, Some(_)) => (Dash::Solid, style::THIN),
        (Some(_), None) => (look.dash, 0.0),
        (None, None) => (look.dash, style::LINE),
    };
    let swatch = Swatch::Line { look: Look { dash, ..look }, width, marks: Marks::Filled };
    Entry { swatch, label: label(series) }
}

/// The markers, joined by a line unless one is fitted: then that line, and open markers for points that it does not use. Where
/// the rate is not known, the markers alone.
fn curves(series: &ErrorSeries, look: Look) -> Vec<Curve> {
    let marked = Curve {
        name: label(series),
        noted_as: Some(series.label.clone()),
        is_listed: false,
        points: series.points.clone(),
        look,
        width: style::LINE,
        marks: Marks::Filled,
        is_data: true,
    };
    let Some(fit) = series.line() else {
        return vec![if series.fit.is_some() { Curve { width: 0.0, ..marked } } else { marked }];
    };
    let used = series.used.clone().unwrap_or(0..series.points.len());
    let (fitted, others): (Vec<_>, Vec<_>) =
        series.points.iter().copied().enumerate().partition(|(k, _)| used.contains(k));
    let [fitted, others] =
        [fitted, others].map(|points| points.into_iter().map(|(_, point)| point).collect::<Vec<_>>());
    let line = Curve {
        points: fitted_line(&fitted, fit),
        look: Look { dash: Dash::Solid, ..look },
        width: style::THIN,
        marks: Marks::None,
        is_data: false,
        ..marked.clone()
    };
    let unused =
        (!others.is_empty()).then(|| Curve { points: others, width: 0.0, marks: Marks::Open, ..marked.clone() });
    [line, Curve { points: fitted, width: 0.0, ..marked }].into_iter().chain(unused).collect()
}

fn label(series: &ErrorSeries) -> String {
    let order = series.order.map(|order| format!("order {order}"));
    let texts = [Some(series.label.clone()), order, series.rate()];
    texts.into_iter().flatten().collect::<Vec<_>>().join(", ")
}

/// The fitted power law between the outermost points.
fn fitted_line(points: &[(f64, f64)], fit: PowerLaw) -> Vec<(f64, f64)> {
    let xs = || points.iter().map(|p| p.0).filter(|x| x.is_finite() && *x > 0.0);
    let ends = [xs().fold(f64::INFINITY, f64::min), xs().fold(0.0, f64::max)];
    ends.map(|x| (x, fit.error_at(x))).to_vec()
}

fn trends(series: &[ErrorSeries]) -> Vec<Trend> {
    let log = |&(x, y): &(f64, f64)| Some((on_scale(Scale::Log, x)?, on_scale(Scale::Log, y)?));
    let trend = |s: &ErrorSeries| {
        let mut points: Vec<(f64, f64)> = s.points.iter().filter_map(log).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        Trend { points, order: s.order }
    };
    series.iter().map(trend).collect()
}
