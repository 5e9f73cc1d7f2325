//! Slope triangles in free places near the lines of their order.

use plotters::style::text_anchor::HPos;

use super::Chart;
use super::curve::Curve;
use super::glyphs::text_width;
use super::layout::Layout;
use super::pen::{Area, INK, Point, Rect, TEXT, font, line, write};

/// Horizontal leg and tallest vertical leg, as fractions of the plot.
const LEG: f64 = 0.12;
const TALLEST: f64 = 0.3;
/// Clearance in px, and the room for the text below.
const GAP: f64 = 14.0;
const BELOW: f64 = 24.0;
/// Places tried along each side of the plot.
const PLACES: i32 = 60;

/// A right triangle below its hypotenuse, in px.
#[derive(Clone, Copy)]
pub(super) struct Triangle {
    left: f64,
    base: f64,
    run: f64,
    rise: f64,
    order: f64,
    /// Width of the text of its order.
    text: f64,
}

/// A point on a line, which a triangle must not touch.
struct Taken {
    /// Of the line, if theory gives it one.
    order: Option<f64>,
    at: Point,
}

/// A triangle for each order, where no line runs; `None` if there is no place.
pub(super) fn triangles(
    orders: &[f64],
    chart: &Chart,
    layout: &Layout,
    curves: &[Curve<'_>],
) -> Option<Vec<Triangle>> {
    if orders.is_empty() {
        return Some(vec![]);
    }
    let [left, top, right, bottom] = layout.plot;
    let (width, height) = (right - left, bottom - top);
    let slope = height / (layout.y.high - layout.y.low) * (layout.x.high - layout.x.low) / width;
    let mut taken: Vec<Taken> = vec![];
    for curve in curves {
        let order = curve.series.order;
        let points = curve
            .line(layout, curves.len())
            .into_iter()
            .chain(curve.markers(layout));
        taken.extend(points.flat_map(along).map(|at| Taken { order, at }));
    }
    for guide in &chart.guides {
        let y = layout.px((f64::NAN, guide.value)).1;
        taken.extend(
            along(vec![(left, y), (right, y)])
                .into_iter()
                .map(|at| Taken { order: None, at }),
        );
    }
    let mut placed: Vec<Triangle> = vec![];
    for &order in orders {
        let text = text_width(&order_text(order), TEXT);
        let run = (LEG * width).min(TALLEST * height / (order * slope));
        let places = (0..PLACES * PLACES).map(|k| Triangle {
            left: left + f64::from(k % PLACES) / f64::from(PLACES) * width,
            base: top + f64::from(k / PLACES) / f64::from(PLACES) * height,
            run,
            rise: order * slope * run,
            order,
            text,
        });
        let own = taken.iter().filter(|point| point.order == Some(order));
        let own: Vec<Point> = own.map(|point| point.at).collect();
        let mut least = f64::INFINITY;
        let mut best = None;
        for next in places.filter(|next| next.is_inside(layout.plot)) {
            // A place that is no better need not be free.
            let cost = next.cost(&own);
            if cost < least && !taken.iter().any(|point| next.touches(point.at)) {
                (least, best) = (cost, Some(next));
            }
        }
        let best = best?;
        taken.extend(best.outline().map(|at| Taken { order: None, at }));
        placed.push(best);
    }
    Some(placed)
}

/// Points along a line, every few px.
fn along(line: Vec<Point>) -> Vec<Point> {
    let mut points = line.clone();
    for pair in line.windows(2) {
        let [(x, y), (to_x, to_y)] = [pair[0], pair[1]];
        let count = ((to_x - x).hypot(to_y - y) / 6.0).ceil();
        let parts = (1..count as i32).map(|k| f64::from(k) / count);
        points.extend(parts.map(|part| (x + part * (to_x - x), y + part * (to_y - y))));
    }
    points
}

/// An order as one writes it: 2/3 rather than 0.6666666666666666.
fn order_text(order: f64) -> String {
    let thirds = 3.0 * order;
    if thirds.fract() == 0.0 && order.fract() != 0.0 {
        format!("{thirds}/3")
    } else {
        order.to_string()
    }
}

impl Triangle {
    /// Left, top, right and bottom of triangle and texts.
    fn bounds(&self) -> Rect {
        [
            self.left,
            self.base - self.rise,
            self.left + self.run + 12.0 + self.text,
            self.base + BELOW,
        ]
    }

    fn is_inside(&self, plot: Rect) -> bool {
        let [left, top, right, bottom] = self.bounds();
        left > plot[0] + 4.0
            && top > plot[1] + 4.0
            && right < plot[2] - 4.0
            && bottom < plot[3] - 2.0
    }

    /// Corners of the bounds, and what is between them.
    fn outline(&self) -> impl Iterator<Item = Point> {
        let [left, top, right, bottom] = self.bounds();
        let (x, y) = (0.5 * (left + right), 0.5 * (top + bottom));
        [left, x, right]
            .map(|x| [top, y, bottom].map(|y| (x, y)))
            .into_iter()
            .flatten()
    }

    /// Height of the hypotenuse, continued to both sides.
    fn edge(&self, x: f64) -> f64 {
        self.base - self.rise * ((x - self.left) / self.run).clamp(0.0, 1.0)
    }

    /// Whether a point is on the triangle or its texts, or too near.
    fn touches(&self, (x, y): Point) -> bool {
        let [left, _, right, bottom] = self.bounds();
        x > left - GAP && x < right + GAP && y < bottom + 6.0 && y > self.edge(x + GAP) - GAP
    }

    /// How far above the hypotenuse a line of this order is; less towards the right, where errors
    /// are large.
    ///
    /// * `own`: points on lines of this order.
    fn cost(&self, own: &[Point]) -> f64 {
        let middle = self.left + 0.5 * self.run;
        let edge = self.edge(middle);
        let mut nearest: f64 = 1e12;
        for (x, y) in own {
            if *y < edge {
                let [across, above] = [x - middle, edge - y];
                nearest = nearest.min(across * across + above * above);
            }
        }
        nearest.sqrt() - 0.02 * self.left
    }

    pub(super) fn draw(&self, area: &Area<'_>) {
        let Self {
            left,
            base,
            run,
            rise,
            order,
            ..
        } = *self;
        let right = left + run;
        line(
            area,
            &[
                (left, base),
                (right, base),
                (right, base - rise),
                (left, base),
            ],
            INK,
            1.6,
        );
        write(
            area,
            "1",
            (left + 0.5 * run, base + 13.0),
            font(TEXT),
            HPos::Center,
        );
        write(
            area,
            &order_text(order),
            (right + 7.0, base - 0.5 * rise),
            font(TEXT),
            HPos::Left,
        );
    }
}
