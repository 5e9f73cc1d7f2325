//! Slope triangles: found a free place below a curve, so that they touch no data.

use super::canvas::Anchor;
use super::ruler::Ruler;
use super::xy::Outline;

/// Horizontal leg and tallest vertical leg, as fractions of the plot.
const LEG: f64 = 0.12;
const TALLEST: f64 = 0.3;
/// Clearance to the curve above, and room for the text below and on the right, as fractions of the plot.
const GAP: f64 = 0.035;
const TEXT_BELOW: f64 = 0.075;
const TEXT_RIGHT: f64 = 0.055;
/// How far the plot may be extended downwards to make room, in steps, as a fraction of its height.
const EXTENSION: f64 = 0.06;
const MAX_EXTENSIONS: usize = 12;
const SAMPLES: usize = 24;

/// A curve in the logarithms of its coordinates, and the order that theory gives it.
#[derive(Clone, Debug)]
pub(super) struct Trend {
    /// Ascending in x.
    pub(super) points: Vec<(f64, f64)>,
    pub(super) order: Option<f64>,
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
pub(super) fn triangles(orders: &[f64], trends: &[Trend], x: &Ruler, y: &Ruler) -> (Vec<Outline>, f64) {
    let drawable: Vec<f64> = orders.iter().copied().filter(|p| p.is_finite() && *p > 0.0).collect();
    let mut y = *y;
    for _ in 0..MAX_EXTENSIONS {
        if let Some(found) = place_all(&drawable, trends, x, &y) {
            return (found.iter().map(Triangle::outline).collect(), 10f64.powf(y.lo));
        }
        y.lo -= EXTENSION * (y.hi - y.lo);
    }
    (Vec::new(), 10f64.powf(y.lo))
}

fn place_all(orders: &[f64], trends: &[Trend], x: &Ruler, y: &Ruler) -> Option<Vec<Triangle>> {
    let mut placed: Vec<Triangle> = Vec::new();
    for &order in orders {
        let next = candidates(order, trends, x, y).find(|t| t.is_free(trends, &placed, x, y))?;
        placed.push(next);
    }
    Some(placed)
}

/// Places right below a curve: curves of the very order first, then from right to left.
fn candidates(order: f64, trends: &[Trend], x: &Ruler, y: &Ruler) -> impl Iterator<Item = Triangle> {
    let (width, height) = (x.hi - x.lo, y.hi - y.lo);
    let leg = (LEG * width).min(TALLEST * height / order);
    let has_order = move |t: &&Trend| t.order.is_some_and(|p| (p - order).abs() < 1e-9);
    let (own, other): (Vec<&Trend>, Vec<&Trend>) = trends.iter().partition(has_order);
    let (x, y) = (*x, *y);
    let places = own.into_iter().chain(other).flat_map(|t| (4..19).rev().map(move |k| (t, f64::from(k) / 20.0)));
    places.filter_map(move |(trend, at)| {
        let right = x.lo + at * width;
        let left = right - leg;
        let clearance = samples(left, right).filter_map(|s| Some(trend.at(s)? - order * (s - left)));
        let base = clearance.fold(f64::INFINITY, f64::min) - GAP * (y.hi - y.lo);
        base.is_finite().then_some(Triangle { left, right, base, order })
    })
}

fn samples(left: f64, right: f64) -> impl Iterator<Item = f64> {
    (0..=SAMPLES).map(move |k| left + (right - left) * k as f64 / SAMPLES as f64)
}

impl Trend {
    /// The curve's height at `x`, between its points.
    fn at(&self, x: f64) -> Option<f64> {
        let pair = self.points.windows(2).find(|w| w[0].0 <= x && x <= w[1].0)?;
        let ((x0, y0), (x1, y1)) = (pair[0], pair[1]);
        Some(if x1 > x0 { y0 + (y1 - y0) * (x - x0) / (x1 - x0) } else { y0.min(y1) })
    }
}

impl Triangle {
    fn top(&self) -> f64 {
        self.base + self.order * (self.right - self.left)
    }

    /// Whether triangle and texts keep clear of all curves, the other triangles and the frame.
    fn is_free(&self, trends: &[Trend], placed: &[Triangle], x: &Ruler, y: &Ruler) -> bool {
        let (width, height) = (x.hi - x.lo, y.hi - y.lo);
        let bottom = self.base - TEXT_BELOW * height;
        let right = self.right + TEXT_RIGHT * width;
        let clear_of = |t: &Trend| {
            samples(self.left, right).all(|s| match t.at(s) {
                None => true,
                Some(v) if v < bottom => true,
                // Beyond the vertical leg there is only a text, half way up.
                Some(v) => v > (self.base + self.order * (s - self.left)).min(self.top()) + 0.9 * GAP * height,
            })
        };
        let overlaps = |t: &Triangle| {
            let apart = t.right + TEXT_RIGHT * width < self.left || right < t.left;
            !apart && t.base - TEXT_BELOW * height < self.top() && bottom < t.top()
        };
        bottom > y.lo && self.left > x.lo && trends.iter().all(clear_of) && !placed.iter().any(overlaps)
    }

    fn outline(&self) -> Outline {
        let value = |v: (f64, f64)| (10f64.powf(v.0), 10f64.powf(v.1));
        let foot = (0.5 * (self.left + self.right), self.base);
        let side = (self.right, 0.5 * (self.base + self.top()));
        Outline {
            corners: [(self.left, self.base), (self.right, self.base), (self.right, self.top())].map(value).to_vec(),
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
    if is_fraction { format!("{thirds}/3") } else { order.to_string() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plots::Scale;

    #[test]
    fn a_triangle_lies_below_its_curve_and_above_the_bottom() {
        let points: Vec<(f64, f64)> = (0..5).map(|k| (-f64::from(4 - k), -2.0 * f64::from(4 - k))).collect();
        let trends = [Trend { points, order: Some(2.0) }];
        let (x, y) = (Ruler::between(Scale::Log, -4.2, 0.2), Ruler::between(Scale::Log, -8.4, 0.4));
        let (outlines, bottom) = triangles(&[1.0, 2.0], &trends, &x, &y);
        assert_eq!(outlines.len(), 2);
        for (cx, cy) in outlines.iter().flat_map(|o| &o.corners) {
            assert!(*cy < cx * cx && *cy > bottom, "({cx}, {cy})");
        }
    }

    #[test]
    fn an_order_is_written_as_one_reads_it() {
        assert_eq!([1.0, 2.0, 0.5, 2.0 / 3.0, 4.0 / 3.0].map(written), ["1", "2", "0.5", "2/3", "4/3"]);
    }

    #[test]
    fn no_curve_no_triangle() {
        let ruler = Ruler::between(Scale::Log, -1.0, 0.0);
        assert!(triangles(&[1.0], &[], &ruler, &ruler).0.is_empty());
        assert!(triangles(&[f64::NAN, -1.0], &[], &ruler, &ruler).0.is_empty());
    }
}
