//! Lines, markers and texts in px, and what distinguishes one series from the others.

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::glyphs::{glyph_width, text_width};
use super::page::printable;
use super::{Mark, Series};

/// A drawing area in tenths of a pixel.
pub(super) type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
/// In px, y downwards.
pub(super) type Point = (f64, f64);
/// Left, top, right and bottom in px.
pub(super) type Rect = [f64; 4];

/// Sizes of titles, of the labels of axes, and of all other texts, in px: 18 of the 900 px of a
/// page are 9 points where it is printed 160 mm wide.
pub(super) const TITLE: f64 = 22.0;
pub(super) const LABEL: f64 = 20.0;
pub(super) const TEXT: f64 = 18.0;
/// Helvetica and its metric twins first: the estimates of [`text_width`] use the widest, DejaVu
/// Sans.
pub(super) const FONT: &str = "Helvetica, Arial, DejaVu Sans, sans-serif";

pub(super) const INK: RGBColor = RGBColor(34, 34, 34);
pub(super) const MUTED: RGBColor = RGBColor(96, 96, 96);
pub(super) const GRID: RGBColor = RGBColor(214, 214, 214);
pub(super) const MINOR_GRID: RGBColor = RGBColor(238, 238, 238);
/// Light enough for the lines of the grid to stay visible on it.
pub(super) const SHADE: RGBColor = RGBColor(228, 233, 240);
pub(super) const THIN: f64 = 1.2;
/// Of open markers.
const OUTLINE: f64 = 2.2;

/// Dashes and gaps in turn, in tenths of px; none: solid.
pub(super) type Dashes = &'static str;
/// Distinct in black and white.
const DASHES: [Dashes; 5] = [
    Series::SOLID,
    "120 50",
    Series::DOTTED,
    "110 40 25 40",
    Series::SHORT,
];

/// Okabe and Ito's palette, distinct for all common kinds of colour vision; for its yellow, too
/// pale on white, Tol's olive.
const COLOURS: [RGBColor; 8] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(170, 68, 153),
    RGBColor(230, 159, 0),
    INK,
    RGBColor(86, 180, 233),
    RGBColor(128, 128, 38),
];

/// A marker: a star of this many points, or a disc if it has none.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Star {
    points: u8,
    /// Radii of the corners, in radii of the disc.
    outer: f64,
    inner: f64,
    /// How far it is turned, in circles.
    turn: f64,
}

const fn star(points: u8, outer: f64, inner: f64, turn: f64) -> Star {
    Star {
        points,
        outer,
        inner,
        turn,
    }
}

/// Disc, square, triangle, diamond, inverted triangle, cross, plus and star, sized to look equally
/// heavy.
const STARS: [Star; 8] = [
    star(0, 1.0, 1.0, 0.0),
    star(4, 1.27, 0.9, 0.125),
    star(3, 1.35, 0.675, 0.0),
    star(4, 1.3, 0.92, 0.0),
    star(3, 1.35, 0.675, 0.5),
    star(4, 1.6, 0.55, 0.125),
    star(4, 1.6, 0.55, 0.0),
    star(6, 1.5, 0.65, 0.0),
];

/// What distinguishes one series.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Style {
    pub(super) colour: RGBColor,
    pub(super) dashes: Dashes,
    pub(super) star: Star,
    /// Of the markers in px.
    pub(super) radius: f64,
}

/// From the marker of a series to that of the next one with its colour: with an odd number all
/// pairs of colour and marker occur.
const MARKERS_ON: usize = 5;

/// The style of the k-th series. The first 64 differ: from the ninth on, colours repeat with other
/// markers.
pub(crate) fn style(k: usize) -> Style {
    Style {
        colour: COLOURS[k % COLOURS.len()],
        dashes: DASHES[k % DASHES.len()],
        star: STARS[(k + MARKERS_ON * (k / COLOURS.len())) % STARS.len()],
        radius: 5.5,
    }
}

impl Style {
    /// Draws a marker.
    pub(super) fn mark(&self, area: &Area<'_>, at: Point, mark: Mark) {
        match mark {
            Mark::None => {}
            Mark::Filled => self.star.fill(area, at, self.radius, self.colour),
            Mark::Open => {
                self.star.fill(area, at, self.radius, WHITE);
                self.star.outline(area, at, self.radius, self.colour);
            }
        }
    }
}

impl Star {
    fn fill(self, area: &Area<'_>, at: Point, radius: f64, colour: RGBColor) {
        if self.points == 0 {
            let disc = Circle::new(on_page(at), tenths(radius), colour.filled());
            return certain(area.draw(&disc));
        }
        polygon(area, self.corners(at, radius), colour);
    }

    fn outline(self, area: &Area<'_>, at: Point, radius: f64, colour: RGBColor) {
        if self.points == 0 {
            let style = colour.stroke_width(tenths(OUTLINE) as u32);
            return certain(area.draw(&Circle::new(on_page(at), tenths(radius), style)));
        }
        // Round the first corner, so that its joint is like the others.
        let corners = self.corners(at, radius);
        let corners: Vec<Point> = corners.clone().chain(corners.take(2)).collect();
        line(area, &corners, colour, OUTLINE);
    }

    fn corners(self, (x, y): Point, radius: f64) -> impl Iterator<Item = Point> + Clone {
        (0..2 * self.points).map(move |k| {
            let size = radius * if k % 2 == 0 { self.outer } else { self.inner };
            let turn = self.turn + 0.5 * f64::from(k) / f64::from(self.points);
            let (sin, cos) = (std::f64::consts::TAU * turn).sin_cos();
            (x + size * sin, y - size * cos)
        })
    }
}

/// A filled polygon.
pub(super) fn polygon(area: &Area<'_>, corners: impl Iterator<Item = Point>, colour: RGBColor) {
    let corners: Vec<_> = corners.map(on_page).collect();
    certain(area.draw(&Polygon::new(corners, colour.filled())));
}

/// A line of this width.
pub(super) fn line(area: &Area<'_>, points: &[Point], colour: RGBColor, width: f64) {
    let points: Vec<_> = points.iter().map(|at| on_page(*at)).collect();
    let style = colour.stroke_width(tenths(width) as u32);
    certain(area.draw(&PathElement::new(points, style)));
}

/// The edges of a rectangle.
pub(super) fn frame(area: &Area<'_>, [left, top, right, bottom]: Rect) {
    let corners = [(left, top), (right, top), (right, bottom), (left, bottom)];
    line(area, &[&corners[..], &corners[..2]].concat(), INK, THIN);
}

/// Writes a text, its middle at this height.
pub(super) fn write(area: &Area<'_>, text: &str, at: Point, style: TextStyle<'_>, anchor: HPos) {
    if !text.is_empty() {
        let style = style.pos(Pos::new(anchor, VPos::Center));
        certain(area.draw_text(&printable(text), &style, on_page(at)));
    }
}

pub(super) fn font(size: f64) -> TextStyle<'static> {
    // Plotters divides sizes by 1.24 before it writes them.
    (FONT, 12.4 * size).into_font().color(&INK)
}

/// Drawing into memory cannot fail.
pub(super) fn certain<E>(drawn: Result<(), E>) {
    debug_assert!(drawn.is_ok(), "drawing into memory failed");
}

/// Px in the unit of the page.
pub(super) fn tenths(px: f64) -> i32 {
    (10.0 * px).round() as i32
}

fn on_page((x, y): Point) -> (i32, i32) {
    (tenths(x), tenths(y))
}

/// The width in px of the widest text.
pub(super) fn widest<'t>(texts: impl Iterator<Item = &'t str>) -> f64 {
    texts.map(|text| text_width(text, TEXT)).fold(0.0, f64::max)
}

/// The text cut to a width in px, ending with an ellipsis if it was cut.
pub(super) fn elide(text: &str, size: f64, width: f64) -> String {
    if text_width(text, size) <= width {
        return text.to_owned();
    }
    let mut room = width - text_width("…", size);
    let fits = |c: &char| {
        room -= size * glyph_width(*c);
        room >= 0.0
    };
    text.chars().take_while(fits).chain(['…']).collect()
}
