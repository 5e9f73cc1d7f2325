//! The page: the one place that emits SVG.
//!
//! Plotters' SVG backend places everything on whole pixels and has neither dashes nor clipping. So
//! the page is drawn on a grid of tenths of a pixel, in layers: each layer is a fragment drawn by
//! plotters, nested in a group that gives it the dash pattern, the clip rectangle or the halo,
//! which its children inherit in SVG.

use super::attributes::{escape, printable};
pub use super::geometry::{Point, Rect, grid};
use super::geometry::{keep_inside, on_grid};
use super::style::{self, Dash};
use plotters::backend::SVGBackend;
use plotters::coord::Shift;
use plotters::drawing::{DrawingArea, IntoDrawingArea};
use plotters::element::{Circle, Drawable, PathElement, PointCollection, Polygon, Rectangle, Text};
pub use plotters::style::text_anchor::HPos as Anchor;
use plotters::style::text_anchor::{Pos, VPos};
use plotters::style::{Color, FontTransform, IntoTextStyle, RGBColor};
use std::collections::BTreeMap;
use std::fmt::Write;

/// Plotters divides font sizes by this before it writes them.
const PLOTTERS_FONT_FACTOR: f64 = 1.24;

/// The common properties of everything in one layer: clip rectangle, dash pattern, halo.
#[derive(Clone, Copy, Debug, Default)]
pub struct Layer {
    /// Nothing outside this rectangle is shown.
    pub clip: Option<Rect>,
    /// Of lines.
    pub dash: Dash,
    /// Texts have a white rim, readable on any colour.
    pub halo: bool,
}

impl Layer {
    /// Nothing outside this rectangle is shown.
    pub fn clipped(clip: Rect) -> Self {
        Self {
            clip: Some(clip),
            ..Self::default()
        }
    }

    /// The same layer with its lines dashed.
    pub fn dashed(self, dash: Dash) -> Self {
        Self { dash, ..self }
    }

    fn open(&self) -> String {
        let mut tags = String::new();
        // A nested viewport clips without an id, so that several figures can live in one HTML page.
        if let Some(r) = self.clip {
            let view = [r.left, r.top, r.width(), r.height()].map(grid);
            let [x, y, w, h] = view;
            let _ = write!(
                tags,
                "<svg x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\" viewBox=\"{x} {y} {w} {h}\" overflow=\"hidden\">"
            );
        }
        tags.push_str("<g stroke-linejoin=\"round\"");
        if !self.dash.is_empty() {
            let lengths: Vec<String> = self.dash.iter().map(|&d| grid(d).to_string()).collect();
            let _ = write!(tags, " stroke-dasharray=\"{}\"", lengths.join(" "));
        }
        if self.halo {
            let _ = write!(
                tags,
                " stroke=\"#ffffff\" stroke-width=\"{}\" paint-order=\"stroke\"",
                grid(3.5)
            );
        }
        tags + ">\n"
    }

    fn close(&self) -> &'static str {
        if self.clip.is_some() {
            "</g></svg>\n"
        } else {
            "</g>\n"
        }
    }
}

/// A page being drawn, layer upon layer.
pub struct Canvas {
    width: f64,
    height: f64,
    body: String,
}

impl Canvas {
    /// An empty page; width and height in px.
    pub fn new(width: f64, height: f64) -> Self {
        Self {
            width,
            height,
            body: String::new(),
        }
    }

    /// Height in px of the document.
    pub fn height(&self) -> f64 {
        self.height.round()
    }

    /// Draws a layer on top of the others.
    pub fn draw(&mut self, layer: Layer, draw: impl FnOnce(&Pen<'_>)) {
        let mut fragment = String::new();
        let size = (grid(self.width) as u32, grid(self.height) as u32);
        {
            let page = Rect {
                left: 0.0,
                top: 0.0,
                right: self.width,
                bottom: self.height,
            };
            let pen = Pen {
                page,
                area: SVGBackend::with_string(&mut fragment, size).into_drawing_area(),
            };
            draw(&pen);
            let closed = pen.area.present();
            debug_assert!(closed.is_ok(), "drawing into memory cannot fail");
        }
        self.body.push_str(&layer.open());
        self.body.push_str(&without_ballast(&fragment));
        self.body.push_str(layer.close());
    }

    /// Puts everything that `draw` adds into an SVG group with these attributes.
    ///
    /// * `attributes`: as in the opening tag, each with a blank in front; values escaped by
    ///   [`escape_attribute`].
    pub fn group(&mut self, attributes: &str, draw: impl FnOnce(&mut Self)) {
        let _ = writeln!(self.body, "<g{attributes}>");
        draw(self);
        self.body.push_str("</g>\n");
    }

    /// Adds SVG elements for what plotters cannot draw; positions are on the page's [`grid`].
    pub fn raw(&mut self, elements: &str) {
        self.body.push_str(elements);
    }

    /// The document. `description` is what screen readers say, and browsers show on hovering.
    /// `attributes` are those of the whole picture.
    pub fn finish(self, description: &str, attributes: &str) -> String {
        let w = self.width.round();
        let h = self.height.round();
        let gw = grid(w);
        let gh = grid(h);
        let description = escape(description);
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w}\" height=\"{h}\" viewBox=\"0 0 {gw} {gh}\" \
             role=\"img\"{attributes}>\n<title>{description}</title>\n<rect width=\"{gw}\" height=\"{gh}\" fill=\"#ffffff\"/>\n\
             {}</svg>\n",
            self.body
        )
    }
}

/// The output of plotters, without a document around every layer and without attributes at their
/// default values: a third of the bytes.
fn without_ballast(fragment: &str) -> String {
    let mut output = String::with_capacity(fragment.len());
    for line in fragment.lines() {
        if line.starts_with("<svg ") || line == "</svg>" {
            continue;
        }
        if line.starts_with('<') {
            output += &line.replace(" opacity=\"1\"", "").replace(" \"/>", "\"/>");
        } else {
            // Texts stand on lines of their own, and do not start with a tag.
            output += line;
        }
        output.push('\n');
    }
    output
}

/// Intervals without those that touch the one before: these become one.
fn joined(mut intervals: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    intervals.sort_by(|one, next| one.0.total_cmp(&next.0));
    let mut joined: Vec<(f64, f64)> = vec![];
    for (from, to) in intervals {
        match joined.last_mut() {
            // A gap below the page's grid is round-off.
            Some(last) if from < last.1 + 0.1 => last.1 = last.1.max(to),
            _ => joined.push((from, to)),
        }
    }
    joined
}

/// Draws shapes and text, in px.
pub struct Pen<'a> {
    page: Rect,
    area: DrawingArea<SVGBackend<'a>, Shift>,
}

impl Pen<'_> {
    fn put<E>(&self, element: &E)
    where
        for<'b> &'b E: PointCollection<'b, (i32, i32)>,
        for<'b> E: Drawable<SVGBackend<'b>>,
    {
        let drawn = self.area.draw(element);
        debug_assert!(drawn.is_ok(), "drawing into memory cannot fail");
    }

    /// An open line through points, of this width in px.
    pub fn line(&self, points: &[Point], colour: RGBColor, width: f64) {
        // Plotters moves points off the page to its edge, which would bend the line.
        for piece in keep_inside(points, &self.page) {
            let mut path = on_grid(&piece);
            path.dedup();
            if let [only] = path[..] {
                path.push(only);
            }
            self.put(&PathElement::new(
                path,
                colour.stroke_width(grid(width).max(1) as u32),
            ));
        }
    }

    /// A filled polygon; the last corner is joined to the first.
    pub fn polygon(&self, points: &[Point], colour: RGBColor) {
        self.put(&Polygon::new(on_grid(points), colour.filled()));
    }

    /// A filled rectangle.
    pub fn rect(&self, r: Rect, colour: RGBColor) {
        let corners = [(grid(r.left), grid(r.top)), (grid(r.right), grid(r.bottom))];
        self.put(&Rectangle::new(corners, colour.filled()));
    }

    /// The edges of a rectangle, of this width in px.
    pub fn frame(&self, r: Rect, colour: RGBColor, width: f64) {
        // Plotters' rectangles have no line width.
        let a = (r.left, r.top);
        let c = (r.right, r.bottom);
        self.line(
            &[a, (c.0, a.1), c, (a.0, c.1), a, (c.0, a.1)],
            colour,
            width,
        );
    }

    /// A filled circle with this radius in px.
    pub fn disc(&self, centre: Point, radius: f64, colour: RGBColor) {
        self.put(&Circle::new(
            (grid(centre.0), grid(centre.1)),
            grid(radius),
            colour.filled(),
        ));
    }

    /// Horizontal text of this size in px, vertically centred on `at`.
    pub fn text(&self, text: &str, at: Point, size: f64, anchor: Anchor, colour: RGBColor) {
        self.write(text, at, size, anchor, FontTransform::None, colour);
    }

    /// Text that reads upwards, its middle at `at`.
    pub fn text_upwards(&self, text: &str, at: Point, size: f64) {
        self.write(
            text,
            at,
            size,
            Anchor::Center,
            FontTransform::Rotate270,
            style::INK,
        );
    }

    /// A thin line from the top of a rectangle to its bottom.
    pub fn vertical(&self, x: f64, within: &Rect, colour: RGBColor) {
        self.line(&[(x, within.top), (x, within.bottom)], colour, 1.0);
    }

    /// A thin line from the left of a rectangle to its right.
    pub fn horizontal(&self, y: f64, within: &Rect, colour: RGBColor) {
        self.line(&[(within.left, y), (within.right, y)], colour, 1.0);
    }

    /// A tick of an axis: a thin stroke.
    pub fn tick(&self, from: Point, to: Point) {
        self.line(&[from, to], style::INK, style::THIN);
    }

    /// Diagonal strokes over rectangles; where two of these touch, a stroke goes on.
    pub fn hatch(&self, rectangles: &[Rect]) {
        const SPACING: f64 = 9.0;
        // Strokes lie where x + y is a multiple of the spacing: of each, the intervals of x.
        let mut strokes: BTreeMap<i32, Vec<(f64, f64)>> = BTreeMap::new();
        for r in rectangles {
            let first = ((r.left + r.top) / SPACING).ceil() as i32;
            let last = ((r.right + r.bottom) / SPACING).floor() as i32;
            for k in first..=last {
                let sum = f64::from(k) * SPACING;
                let x0 = (sum - r.bottom).max(r.left);
                let x1 = (sum - r.top).min(r.right);
                if x1 > x0 {
                    strokes.entry(k).or_default().push((x0, x1));
                }
            }
        }
        for (k, intervals) in strokes {
            let sum = f64::from(k) * SPACING;
            for (x0, x1) in joined(intervals) {
                self.line(&[(x0, sum - x0), (x1, sum - x1)], style::MUTED, 1.1);
            }
        }
    }

    fn write(
        &self,
        text: &str,
        at: Point,
        size: f64,
        anchor: Anchor,
        turn: FontTransform,
        colour: RGBColor,
    ) {
        let font = (style::FONT, f64::from(grid(size)) * PLOTTERS_FONT_FACTOR)
            .into_text_style(&self.area)
            .transform(turn)
            .color(&colour)
            .pos(Pos::new(anchor, VPos::Center));
        self.put(&Text::new(printable(text), (grid(at.0), grid(at.1)), font));
    }
}
