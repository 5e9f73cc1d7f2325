//! Errors against the mesh width or the time step, with slope triangles in a free place below a
//! curve, so that they touch no data.

use std::ops::Range;

use super::canvas::Anchor;
use super::look::{Look, Marks, look};
use super::ruler::{Ruler, on_scale};
use super::xy::{Curve, Outline, OutlineText, Xy};
use super::{Axis, Scale, Series, style};
use crate::interval::Interval;
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
/// Ratio of neighbouring steps from which no line joins their errors.
const GAP_RATIO: f64 = 8.0;
/// Markers so near, as a fraction of the range of all errors, hide each other.
const HIDDEN: f64 = 0.015;
/// Growth of a marker for each series that hides it.
const LARGER: f64 = 0.5;

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
    pub interval: Option<Interval>,
    /// Indices of the fitted points, over which the line is drawn; the others get open markers.
    /// `None`: all.
    pub used: Option<Range<usize>>,
    /// Which [`look`] it has; `None`: that of its place in the figure.
    pub look: Option<usize>,
}

impl ErrorSeries {
    /// The line, if its rate is known.
    pub(crate) fn line(&self) -> Option<PowerLaw> {
        match self.interval {
            Some(interval) if !(interval.width() <= WIDEST_INTERVAL) => None,
            _ => self.fit,
        }
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
    for (k, one) in series.iter().enumerate() {
        let look = Look {
            size: size(one, &series[k + 1..], series),
            ..look(one.look.unwrap_or(k))
        };
        xy.curves.extend(curves(one, look));
    }
    if series.iter().any(has_unused_points) {
        xy.notes
            .push("open markers: points that the rate does not use".to_owned());
    }
    let mut orders: Vec<f64> = series.iter().filter_map(|series| series.order).collect();
    orders.sort_by(f64::total_cmp);
    orders.dedup();
    orders.extend(slopes);
    let triangles = triangles(&orders, &trends(series), &xy.x_ruler(), &xy.y_ruler());
    if !triangles.outlines.is_empty() {
        xy.show_y.push(triangles.bottom);
    }
    xy.outlines = triangles.outlines;
    xy.draw()
}

/// How large the markers of a fitted series are: those that a later one hides show around it.
fn size(series: &ErrorSeries, later: &[ErrorSeries], all: &[ErrorSeries]) -> f64 {
    if series.fit.is_none() {
        return 1.0;
    }
    let own = LogCurve::new(series).points;
    let mut range = [f64::INFINITY, f64::NEG_INFINITY];
    for (_, y) in trends(all).iter().flat_map(|trend| &trend.points) {
        range = [range[0].min(*y), range[1].max(*y)];
    }
    let near = HIDDEN * (range[1] - range[0]);
    let hides = |other: &&ErrorSeries| {
        let points = LogCurve::new(other).points;
        let hidden = own
            .iter()
            .filter(|(x, y)| points.iter().any(|(u, v)| u == x && (v - y).abs() <= near));
        2 * hidden.count() > own.len()
    };
    1.0 + LARGER * later.iter().filter(hides).count().min(2) as f64
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
    let markers = Curve {
        width: if is_fitted { 0.0 } else { line.width },
        look,
        marks: Marks::Filled,
        ..line
    };
    let Some(fit) = series.line() else {
        return without_gaps(markers);
    };
    let range = series.used.clone().unwrap_or(0..series.points.len());
    let mut used = vec![];
    let mut unused = vec![];
    for (k, point) in series.points.iter().enumerate() {
        if range.contains(&k) {
            used.push(*point);
        } else {
            unused.push(*point);
        }
    }
    // A fitted line is thin and solid; a line that only joins the points is not.
    let mut curves = vec![Curve {
        points: used,
        width: style::THIN,
        fit: Some(fit),
        ..markers.clone()
    }];
    if !unused.is_empty() {
        curves.push(Curve {
            points: unused,
            marks: Marks::Open,
            ..markers
        });
    }
    curves
}

/// No line crosses nearly a decade without points, where nothing was measured.
fn without_gaps(curve: Curve) -> Vec<Curve> {
    curve
        .points
        .chunk_by(|(x, _), (next, _)| (next / x).max(x / next) < GAP_RATIO)
        .map(|points| Curve {
            points: points.to_vec(),
            ..curve.clone()
        })
        .collect()
}

fn label(series: &ErrorSeries) -> String {
    let order = series.order.map(|order| format!("order {order}"));
    let texts = [Some(series.label.clone()), order, series.rate()];
    texts.into_iter().flatten().collect::<Vec<_>>().join(", ")
}

fn trends(series: &[ErrorSeries]) -> Vec<LogCurve> {
    series.iter().map(LogCurve::new).collect()
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

/// Slope triangles.
struct Triangles {
    outlines: Vec<Outline>,
    /// The value that the vertical axis must reach down to.
    bottom: f64,
}

/// Triangles for the given orders.
fn triangles(orders: &[f64], trends: &[LogCurve], x: &Ruler, y: &Ruler) -> Triangles {
    let drawable: Vec<f64> = orders
        .iter()
        .copied()
        .filter(|p| p.is_finite() && *p > 0.0)
        .collect();
    let mut y = *y;
    for _ in 0..MAX_EXTENSIONS {
        if let Some(triangles) = place_all(&drawable, trends, x, &y) {
            return Triangles {
                outlines: triangles.iter().map(Triangle::outline).collect(),
                bottom: 10f64.powf(y.lo),
            };
        }
        y.lo -= EXTENSION * (y.hi - y.lo);
    }
    Triangles {
        outlines: vec![],
        bottom: 10f64.powf(y.lo),
    }
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
    let (same_order, others): (Vec<&LogCurve>, Vec<&LogCurve>) = trends
        .iter()
        .partition(|trend| trend.order.is_some_and(|p| (p - order).abs() < 1e-9));
    let x = *x;
    let y = *y;
    let places = same_order
        .into_iter()
        .chain(others)
        .flat_map(|trend| (4..19).rev().map(move |k| (trend, f64::from(k) / 20.0)));
    places.filter_map(move |(trend, fraction)| {
        let right = x.lo + fraction * width;
        let left = right - leg;
        let clearance =
            samples(left, right).filter_map(|s| Some(trend.height(s)? - order * (s - left)));
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
    /// The errors that a logarithm can show.
    fn new(series: &ErrorSeries) -> Self {
        let mut points: Vec<(f64, f64)> = series
            .points
            .iter()
            .filter_map(|&(x, y)| Some((on_scale(Scale::Log, x)?, on_scale(Scale::Log, y)?)))
            .collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        Self {
            points,
            order: series.order,
        }
    }

    /// The curve's height at `x`, between its points.
    fn height(&self, x: f64) -> Option<f64> {
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
        if bottom <= y.lo || self.left <= x.lo {
            return false;
        }
        let touches_curve = trends.iter().any(|trend| {
            samples(self.left, right).any(|s| {
                // Beyond the vertical leg there is only text, half way up.
                let top = (self.base + self.order * (s - self.left)).min(self.top());
                let curve = trend.height(s);
                curve.is_some_and(|v| v >= bottom && v <= top + 0.9 * GAP * height)
            })
        });
        let overlaps_triangle = placed.iter().any(|t| {
            let is_beside = t.right + TEXT_RIGHT * width < self.left || right < t.left;
            !is_beside && t.base - TEXT_BELOW * height < self.top() && bottom < t.top()
        });
        !touches_curve && !overlaps_triangle
    }

    fn outline(&self) -> Outline {
        let foot = (0.5 * (self.left + self.right), self.base);
        let side = (self.right, 0.5 * (self.base + self.top()));
        Outline {
            corners: [
                (self.left, self.base),
                (self.right, self.base),
                (self.right, self.top()),
            ]
            .map(from_logs)
            .to_vec(),
            texts: vec![
                OutlineText {
                    text: "1".to_owned(),
                    position: from_logs(foot),
                    offset: (0.0, 13.0),
                    anchor: Anchor::Center,
                },
                OutlineText {
                    text: order_text(self.order),
                    position: from_logs(side),
                    offset: (7.0, 0.0),
                    anchor: Anchor::Left,
                },
            ],
        }
    }
}

/// The point with these logarithms.
fn from_logs((x, y): (f64, f64)) -> (f64, f64) {
    (10f64.powf(x), 10f64.powf(y))
}

/// An order in a picture: 2/3 rather than 0.6666666666666666.
fn order_text(order: f64) -> String {
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
        let Triangles { outlines, bottom } = triangles(&[1.0, 2.0], &trends, &x, &y);
        assert_eq!(outlines.len(), 2);
        for (cx, cy) in outlines.iter().flat_map(|o| &o.corners) {
            assert!(*cy < cx * cx && *cy > bottom, "({cx}, {cy})");
        }
    }

    #[test]
    fn an_order_is_written_as_one_reads_it() {
        assert_eq!(
            [1.0, 2.0, 0.5, 2.0 / 3.0, 4.0 / 3.0].map(order_text),
            ["1", "2", "0.5", "2/3", "4/3"]
        );
    }

    #[test]
    fn no_curve_no_triangle() {
        let ruler = Ruler::between(Scale::Log, -1.0, 0.0);
        for orders in [&[1.0][..], &[f64::NAN, -1.0]] {
            let triangles = triangles(orders, &[], &ruler, &ruler);
            assert!(triangles.outlines.is_empty());
        }
    }
}
