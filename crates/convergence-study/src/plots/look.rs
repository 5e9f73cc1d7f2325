//! What distinguishes one series of a figure from the others: colour, dashes and shape of the
//! markers.

use super::canvas::{Pen, Point};
use super::style::{self, Dash, WHITE};
use plotters::style::RGBColor;

/// The shape of a marker, y downwards; shapes stay distinct when small and without colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Marker {
    /// A disc.
    Circle,
    /// A filled polygon with these corners, in radii of the circle.
    Polygon(&'static [Point]),
    /// Strokes through the centre, each by one of its ends: no inside to leave white.
    Strokes(&'static [Point]),
}

/// How a series' points are marked.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Marks {
    /// No markers.
    #[default]
    None,
    /// In the colour of the series.
    Filled,
    /// Outline on white.
    Open,
}

/// Half the height of a circle, in px.
const RADIUS: f64 = 5.5;

impl Look {
    /// Draws the marker centred at `at`. Strokes have no inside to leave white: open, they stand in
    /// a circle.
    pub fn mark(self, pen: &Pen<'_>, at: Point, marks: Marks) {
        let Self { colour, marker, .. } = self;
        let radius = self.size * RADIUS;
        match marks {
            Marks::None => {}
            Marks::Filled => marker.fill(pen, at, radius, colour),
            Marks::Open if matches!(marker, Marker::Strokes(_)) => {
                pen.disc(at, radius + 2.2, colour);
                pen.disc(at, radius + 0.8, WHITE);
                marker.fill(pen, at, 0.8 * radius, colour);
            }
            Marks::Open => {
                marker.fill(pen, at, radius + 1.0, colour);
                marker.fill(pen, at, radius - 1.4, WHITE);
            }
        }
    }
}

impl Marker {
    fn fill(self, pen: &Pen<'_>, (x, y): Point, r: f64, colour: RGBColor) {
        match self {
            Marker::Circle => pen.disc((x, y), r, colour),
            Marker::Polygon(corners) => {
                let path: Vec<Point> = corners
                    .iter()
                    .map(|&(dx, dy)| (x + r * dx, y + r * dy))
                    .collect();
                pen.polygon(&path, colour);
            }
            Marker::Strokes(ends) => ends.iter().for_each(|&(dx, dy)| {
                let dx = r * dx;
                let dy = r * dy;
                pen.line(&[(x - dx, y - dy), (x + dx, y + dy)], colour, 2.4);
            }),
        }
    }
}

/// Okabe and Ito's palette, distinct for all common kinds of colour vision; for its yellow, too
/// pale on white, Tol's olive.
const COLOURS: [RGBColor; 8] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(170, 68, 153),
    RGBColor(230, 159, 0),
    RGBColor(34, 34, 34),
    RGBColor(86, 180, 233),
    RGBColor(128, 128, 38),
];

/// Circle, square, triangle, diamond, inverted triangle, cross, plus and star, sized to look
/// equally heavy.
const MARKERS: [Marker; 8] = [
    Marker::Circle,
    Marker::Polygon(&[(-0.9, -0.9), (0.9, -0.9), (0.9, 0.9), (-0.9, 0.9)]),
    Marker::Polygon(&[(0.0, -1.25), (1.15, 0.8), (-1.15, 0.8)]),
    Marker::Polygon(&[(0.0, -1.3), (1.2, 0.0), (0.0, 1.3), (-1.2, 0.0)]),
    Marker::Polygon(&[(0.0, 1.25), (1.15, -0.8), (-1.15, -0.8)]),
    Marker::Strokes(&[(0.9, 0.9), (0.9, -0.9)]),
    Marker::Strokes(&[(1.2, 0.0), (0.0, 1.2)]),
    Marker::Strokes(&[(1.2, 0.0), (0.6, 1.04), (0.6, -1.04)]),
];

const DASHES: [Dash; 5] = [
    style::SOLID,
    style::LONG,
    style::DOTTED,
    style::MIXED,
    style::SHORT,
];

/// What distinguishes one series: each of the three is enough by itself for a handful of series.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    /// Colour of lines and markers.
    pub colour: RGBColor,
    /// Marker of its points.
    pub marker: Marker,
    /// Dashes of its line.
    pub dash: Dash,
    /// Size of the marker, 1 unless another series hides it.
    pub size: f64,
}

/// Markers from that of a series to that of the next one with its colour: it is of another kind,
/// strokes for a polygon. With an odd number all pairs of colour and marker occur.
const MARKERS_ON: usize = 5;

/// Look of the k-th series. The first 64 differ: from the 9th on, colours repeat with other
/// markers.
pub fn look(k: usize) -> Look {
    let marker = (k + MARKERS_ON * (k / COLOURS.len())) % MARKERS.len();
    Look {
        colour: COLOURS[k % COLOURS.len()],
        marker: MARKERS[marker],
        dash: DASHES[k % DASHES.len()],
        size: 1.0,
    }
}
