//! Errors against the mesh width or the time step, with slope triangles in a free place below a
//! curve, so that they touch no data.

use std::ops::Range;

use super::canvas::Anchor;
use super::look::{Look, Marks, look};
use super::ruler::{Ruler, on_scale};
use super::xy::{Curve, Outline, Xy};
use super::{Axis, Scale, Series, style};
use crate::judge::verdict::PowerLaw;
use crate::text::number::{RATE_PLACES, WIDEST_INTERVAL, decimals, interval_places};

/// Horizontal leg and tallest vertical leg, as fractions of the plot.
const LEG: f64 = 0.12;
const TALLEST: f64 = 0.3;
/// Clearance to the curve above, and room for the text below and on the right, as fractions of the
/// plot.
const GAP: f64 = 0.035;
const TEXT_BELOW: f64 = 0.075;
const TEXT_RIGHT: f64 = 0.055;
/// How far the plot may be extended downwards to make room, in steps, as a fraction of its height.
const EXTENSION: f64 = 0.06;
const MAX_EXTENSIONS: usize = 12;
const SAMPLES: usize = 24;

/// The errors in one norm.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ErrorSeries {
    /// The norm's name.
    pub label: String,
    /// `(h or dt, error)`.
    pub points: Vec<(f64, f64)>,
    /// The order in theory, for the legend.
    pub order: Option<f64>,
    /// Line fitted to the points; its rate is in the legend.
    pub fit: Option<PowerLaw>,
    /// Interval of that rate, which says how many of its digits are known. If it is wider than
    /// [`WIDEST_INTERVAL`], neither rate nor line is drawn. `None`: not known.
    pub interval: Option<[f64; 2]>,
    /// Indices of the fitted points, over which the line is drawn; the others get open markers.
    /// `None`: all.
    pub used: Option<Range<usize>>,
    /// Which [`look`] it has; `None`: that of its place in the figure.
    pub look: Option<usize>,
}

impl ErrorSeries {
    /// The line, if its rate is known.
    pub(crate) fn line(&self) -> Option<PowerLaw> {
        let is_known = |[low, high]: [f64; 2]| high - low <= WIDEST_INTERVAL;
        self.fit.filter(|_| self.interval.is_none_or(is_known))
    }

    /// The rate for the legend.
    fn rate(&self) -> Option<String> {
        self.fit?;
        let Some(line) = self.line() else {
            return Some("no rate".to_owned());
        };
        let places = self.interval.map_or(RATE_PLACES - 1, |interval| {
            interval_places(interval, RATE_PLACES)
        });
        line.rate
            .is_finite()
            .then(|| format!("rate {}", decimals(line.rate, places)))
    }
}

impl Xy {
    /// An empty figure for errors over a step, log-log.
    pub fn of_errors(step: impl Into<String>) -> Self {
        Self {
            x: Axis::log(step),
            y: Axis::log("error"),
            ..Self::default()
        }
    }
}

/// Draws errors over `h` or `dt`.
///
/// * `xy`: the figure without them, such as [`Xy::of_errors`], both axes logarithmic.
/// * `slopes`: orders to draw slope triangles for, in addition to those of the series.
pub fn convergence(mut xy: Xy, series: &[ErrorSeries], slopes: &[f64]) -> String {
    for (k, series) in series.iter().enumerate() {
        xy.curves
            .extend(curves(series, look(series.look.unwrap_or(k))));
    }
    if series.iter().any(has_unused_points) {
        xy.notes
            .push("open markers: points that the rate does not use".to_owned());
    }
    let mut orders: Vec<f64> = series.iter().filter_map(|series| series.order).collect();
    orders.sort_by(f64::total_cmp);
    orders.dedup();
    orders.extend(slopes);
    let (outlines, bottom) = triangles(&orders, &trends(series), &xy.x_ruler(), &xy.y_ruler());
    if !outlines.is_empty() {
        xy.show_y.push(bottom);
    }
    xy.outlines = outlines;
    xy.draw()
}

/// Whether a line is fitted to only some of its points.
fn has_unused_points(series: &ErrorSeries) -> bool {
    let len = series.points.len();
    series.line().is_some() && series.used.as_ref().is_some_and(|used| used.len() < len)
}

/// The markers, joined by a line unless one is fitted: then that line, and open markers for points
/// that it does not use. If the rate is not known, only the markers.
fn curves(series: &ErrorSeries, look: Look) -> Vec<Curve> {
    let line = Curve::line(0, &Series::new(label(series), series.points.clone()));
    let is_fitted = series.fit.is_some();
    let marked = Curve {
        width: if is_fitted { 0.0 } else { line.width },
        look,
        marks: Marks::Filled,
        ..line
    };
    let Some(fit) = series.line() else {
        return vec![marked];
    };
    let used = series.used.clone().unwrap_or(0..series.points.len());
    let points = |of_used: bool| {
        let points = series
            .points
            .iter()
            .enumerate()
            .filter(|(k, _)| used.contains(k) == of_used);
        points.map(|(_, point)| *point).collect::<Vec<_>>()
    };
    let unused = Curve {
        points: points(false),
        marks: Marks::Open,
        ..marked.clone()
    };
    // A fitted line is thin and solid; a line that only joins the points is not.
    let fitted = Curve {
        points: points(true),
        width: style::THIN,
        fit: Some(fit),
        ..marked
    };
    let unused = Some(unused).filter(|unused| !unused.points.is_empty());
    [fitted].into_iter().chain(unused).collect()
}

fn label(series: &ErrorSeries) -> String {
    let order = series.order.map(|order| format!("order {order}"));
    let texts = [Some(series.label.clone()), order, series.rate()];
    texts.into_iter().flatten().collect::<Vec<_>>().join(", ")
}

fn trends(series: &[ErrorSeries]) -> Vec<LogCurve> {
    let log = |&(x, y): &(f64, f64)| Some((on_scale(Scale::Log, x)?, on_scale(Scale::Log, y)?));
    let trend = |s: &ErrorSeries| {
        let mut points: Vec<(f64, f64)> = s.points.iter().filter_map(log).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        LogCurve {
            points,
            order: s.order,
        }
    };
    series.iter().map(trend).collect()
}

/// A curve in the logarithms of its coordinates, and the order that theory gives it.
#[derive(Clone, Debug)]
struct LogCurve {
    /// Ascending in x.
    points: Vec<(f64, f64)>,
    order: Option<f64>,
}

/// A right triangle below its hypotenuse, in logarithms.
#[derive(Clone, Copy, Debug)]
struct Triangle {
    left: f64,
    right: f64,
    base: f64,
    order: f64,
}

/// Triangles for the given orders, and the value the vertical axis must reach down to.
fn triangles(orders: &[f64], trends: &[LogCurve], x: &Ruler, y: &Ruler) -> (Vec<Outline>, f64) {
    let drawable: Vec<f64> = orders
        .iter()
        .copied()
        .filter(|p| p.is_finite() && *p > 0.0)
        .collect();
    let mut y = *y;
    for _ in 0..MAX_EXTENSIONS {
        if let Some(found) = place_all(&drawable, trends, x, &y) {
            return (
                found.iter().map(Triangle::outline).collect(),
                10f64.powf(y.lo),
            );
        }
        y.lo -= EXTENSION * (y.hi - y.lo);
    }
    (Vec::new(), 10f64.powf(y.lo))
}

fn place_all(orders: &[f64], trends: &[LogCurve], x: &Ruler, y: &Ruler) -> Option<Vec<Triangle>> {
    let mut placed: Vec<Triangle> = Vec::new();
    for &order in orders {
        let next = candidates(order, trends, x, y).find(|t| t.is_free(trends, &placed, x, y))?;
        placed.push(next);
    }
    Some(placed)
}

/// Places right below a curve: first curves of exactly this order, then from right to left.
fn candidates(
    order: f64,
    trends: &[LogCurve],
    x: &Ruler,
    y: &Ruler,
) -> impl Iterator<Item = Triangle> {
    let width = x.hi - x.lo;
    let height = y.hi - y.lo;
    let leg = (LEG * width).min(TALLEST * height / order);
    let has_order = move |t: &&LogCurve| t.order.is_some_and(|p| (p - order).abs() < 1e-9);
    let (own, other): (Vec<&LogCurve>, Vec<&LogCurve>) = trends.iter().partition(has_order);
    let x = *x;
    let y = *y;
    let places = own
        .into_iter()
        .chain(other)
        .flat_map(|t| (4..19).rev().map(move |k| (t, f64::from(k) / 20.0)));
    places.filter_map(move |(trend, at)| {
        let right = x.lo + at * width;
        let left = right - leg;
        let clearance =
            samples(left, right).filter_map(|s| Some(trend.at(s)? - order * (s - left)));
        let base = clearance.fold(f64::INFINITY, f64::min) - GAP * (y.hi - y.lo);
        base.is_finite().then_some(Triangle {
            left,
            right,
            base,
            order,
        })
    })
}

fn samples(left: f64, right: f64) -> impl Iterator<Item = f64> {
    (0..=SAMPLES).map(move |k| left + (right - left) * k as f64 / SAMPLES as f64)
}

impl LogCurve {
    /// The curve's height at `x`, between its points.
    fn at(&self, x: f64) -> Option<f64> {
        let pair = self
            .points
            .windows(2)
            .find(|w| w[0].0 <= x && x <= w[1].0)?;
        let ((x0, y0), (x1, y1)) = (pair[0], pair[1]);
        Some(if x1 > x0 {
            y0 + (y1 - y0) * (x - x0) / (x1 - x0)
        } else {
            y0.min(y1)
        })
    }
}

impl Triangle {
    fn top(&self) -> f64 {
        self.base + self.order * (self.right - self.left)
    }

    /// Whether triangle and texts keep clear of all curves, the other triangles and the frame.
    fn is_free(&self, trends: &[LogCurve], placed: &[Triangle], x: &Ruler, y: &Ruler) -> bool {
        let width = x.hi - x.lo;
        let height = y.hi - y.lo;
        let bottom = self.base - TEXT_BELOW * height;
        let right = self.right + TEXT_RIGHT * width;
        let clear_of = |t: &LogCurve| {
            samples(self.left, right).all(|s| match t.at(s) {
                None => true,
                Some(v) if v < bottom => true,
                // Beyond the vertical leg there is only text, half way up.
                Some(v) => {
                    v > (self.base + self.order * (s - self.left)).min(self.top())
                        + 0.9 * GAP * height
                }
            })
        };
        let overlaps = |t: &Triangle| {
            let apart = t.right + TEXT_RIGHT * width < self.left || right < t.left;
            !apart && t.base - TEXT_BELOW * height < self.top() && bottom < t.top()
        };
        bottom > y.lo
            && self.left > x.lo
            && trends.iter().all(clear_of)
            && !placed.iter().any(overlaps)
    }

    fn outline(&self) -> Outline {
        let value = |v: (f64, f64)| (10f64.powf(v.0), 10f64.powf(v.1));
        let foot = (0.5 * (self.left + self.right), self.base);
        let side = (self.right, 0.5 * (self.base + self.top()));
        Outline {
            corners: [
                (self.left, self.base),
                (self.right, self.base),
                (self.right, self.top()),
            ]
            .map(value)
            .to_vec(),
            texts: vec![
                ("1".to_owned(), value(foot), (0.0, 13.0), Anchor::Center),
                (written(self.order), value(side), (7.0, 0.0), Anchor::Left),
            ],
        }
    }
}

/// An order in a picture: 2/3 rather than 0.6666666666666666.
fn written(order: f64) -> String {
    let thirds = 3.0 * order;
    let is_fraction = thirds.fract() == 0.0 && order.fract() != 0.0;
    if is_fraction {
        format!("{thirds}/3")
    } else {
        order.to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_triangle_lies_below_its_curve_and_above_the_bottom() {
        let points: Vec<(f64, f64)> = (0..5)
            .map(|k| (-f64::from(4 - k), -2.0 * f64::from(4 - k)))
            .collect();
        let trends = [LogCurve {
            points,
            order: Some(2.0),
        }];
        let x = Ruler::between(Scale::Log, -4.2, 0.2);
        let y = Ruler::between(Scale::Log, -8.4, 0.4);
        let (outlines, bottom) = triangles(&[1.0, 2.0], &trends, &x, &y);
        assert_eq!(outlines.len(), 2);
        for (cx, cy) in outlines.iter().flat_map(|o| &o.corners) {
            assert!(*cy < cx * cx && *cy > bottom, "({cx}, {cy})");
        }
    }

    #[test]
    fn an_order_is_written_as_one_reads_it() {
        assert_eq!(
            [1.0, 2.0, 0.5, 2.0 / 3.0, 4.0 / 3.0].map(written),
            ["1", "2", "0.5", "2/3", "4/3"]
        );
    }

    #[test]
    fn no_curve_no_triangle() {
        let ruler = Ruler::between(Scale::Log, -1.0, 0.0);
        assert!(triangles(&[1.0], &[], &ruler, &ruler).0.is_empty());
        assert!(
            triangles(&[f64::NAN, -1.0], &[], &ruler, &ruler)
                .0
                .is_empty()
        );
    }
}
