//! Values over two parameters as coloured cells: with iso lines, or with marks and boundary curves on top.

use super::canvas::{Anchor, Layer};
use super::colour::ColourScale;
use super::heat::{edges, hatch, in_order, paint};
use super::legend::{Entry, Swatch};
use super::look::{Look, look};
use super::marker::Marks;
use super::rect::{Point, Rect, keep_outside};
use super::ruler::{Ruler, Ticks, on_scale};
use super::sheet::{Plan, Sheet};
use super::style::{Dash, TICK_SIZE, WHITE, text_width};
use super::xy::left_out;
use super::{Axis, Scale, Series, readable, style};

/// Half the width of the only cell of an axis with one value, in decades (or units, on a linear axis).
const ALONE: f64 = 0.25;

/// An error over two parameters.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Surface {
    /// Above the plot.
    pub title: Option<String>,
    /// Horizontal axis, `dt` say.
    pub x: Axis,
    /// Vertical axis, `h` say.
    pub y: Axis,
    /// What the colours show; logarithmic as a rule.
    pub z: Axis,
    /// Values along the horizontal axis, in any order.
    pub x_values: Vec<f64>,
    /// Values along the vertical axis, in any order.
    pub y_values: Vec<f64>,
    /// `values[k][j]` belongs to `y_values[k]` and `x_values[j]`.
    pub values: Vec<Vec<f64>>,
}

/// Draws an error over two parameters as coloured cells with iso lines.
pub fn surface(figure: &Surface) -> String {
    let lattice = Lattice::new(figure);
    let colours = ColourScale::sequential(&figure.z.label, figure.z.scale, lattice.values.iter().flatten().copied());
    let mut sheet = lattice.plan(figure, &colours).lay_out();
    lattice.paint(&mut sheet, &colours);
    let vertices = lattice.vertices(&sheet, figure.z.scale);
    draw_contours(&mut sheet, &vertices, &colours.ticks());
    colours.draw_bar(&mut sheet);
    sheet.finish()
}

/// Values on a grid, both axes ascending.
struct Lattice {
    /// Positions on the scale.
    x: Vec<f64>,
    y: Vec<f64>,
    /// Row by row; NaN where there is none.
    values: Vec<Vec<f64>>,
    /// Where each column and row was in the input.
    columns: Vec<usize>,
    rows: Vec<usize>,
}

impl Lattice {
    fn new(figure: &Surface) -> Self {
        let (x, columns): (Vec<f64>, Vec<usize>) = in_order(figure.x.scale, &figure.x_values).into_iter().unzip();
        let (y, rows): (Vec<f64>, Vec<usize>) = in_order(figure.y.scale, &figure.y_values).into_iter().unzip();
        let value = |k: usize, j: usize| figure.values.get(k).and_then(|row| row.get(j)).copied().unwrap_or(f64::NAN);
        let values = rows.iter().map(|&k| columns.iter().map(|&j| value(k, j)).collect()).collect();
        Self { x, y, values, columns, rows }
    }

    fn plan(&self, figure: &Surface, colours: &ColourScale) -> Plan {
        Plan {
            title: figure.title.clone(),
            x: span(figure.x.scale, &edges(&self.x, ALONE)),
            y: span(figure.y.scale, &edges(&self.y, ALONE)),
            x_label: figure.x.label.clone(),
            y_label: figure.y.label.clone(),
            right: colours.margin(),
            above: None,
            legend: Vec::new(),
            notes: self.notes(figure.z.scale, |_, _| false),
        }
    }

    /// Counts cells without a colour, but for the excused ones.
    fn notes(&self, z: Scale, excused: impl Fn(usize, usize) -> bool) -> Vec<String> {
        let (mut non_finite, mut not_positive) = (0, 0);
        for (k, row) in self.values.iter().enumerate() {
            for (j, &value) in row.iter().enumerate() {
                match (on_scale(Scale::Linear, value), on_scale(z, value)) {
                    _ if excused(k, j) => {}
                    (None, _) => non_finite += 1,
                    (Some(_), None) => not_positive += 1,
                    _ => {}
                }
            }
        }
        left_out(non_finite, not_positive)
    }

    /// Edges of the cells in px.
    fn edges_on(&self, sheet: &Sheet) -> (Vec<f64>, Vec<f64>) {
        let x = edges(&self.x, ALONE).iter().map(|&v| sheet.x.px_of(v)).collect();
        let y = edges(&self.y, ALONE).iter().map(|&v| sheet.y.px_of(v)).collect();
        (x, y)
    }

    fn paint(&self, sheet: &mut Sheet, colours: &ColourScale) {
        let (x, y) = self.edges_on(sheet);
        let colour = |row: &Vec<f64>| row.iter().map(|&v| colours.colour(v)).collect();
        let rows: Vec<_> = self.values.iter().map(colour).collect();
        paint(&mut sheet.canvas, &x, &y, &rows);
    }

    fn vertices(&self, sheet: &Sheet, z: Scale) -> Vec<Vec<Vertex>> {
        let row = |(&y, values): (&f64, &Vec<f64>)| {
            let cells = self.x.iter().zip(values);
            let vertex =
                |(&x, &v): (&f64, &f64)| Vertex { at: (sheet.x.px_of(x), sheet.y.px_of(y)), value: on_scale(z, v) };
            cells.map(vertex).collect()
        };
        self.y.iter().zip(&self.values).map(row).collect()
    }
}

/// The range from the first to the last edge, or any range if there is none.
fn span(scale: Scale, edges: &[f64]) -> Ruler {
    match (edges.first(), edges.last()) {
        (Some(&lo), Some(&hi)) if lo < hi => Ruler::between(scale, lo, hi),
        _ => Ruler::around(scale, [], 0.0),
    }
}

/// A grid point in px with its value on the colour scale.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Vertex {
    at: Point,
    value: Option<f64>,
}

/// Iso lines at the colour bar's ticks, labelled like them.
fn draw_contours(sheet: &mut Sheet, rows: &[Vec<Vertex>], levels: &Ticks) {
    let mut labels: Vec<(Point, &str)> = Vec::new();
    let plot = sheet.plot;
    let lines: Vec<_> = levels.major.iter().map(|level| iso_segments(rows, level.at)).collect();
    for (level, segments) in levels.major.iter().zip(&lines) {
        // As far as can be from the frame and from the other labels.
        let room = |p: &Point| {
            let frame = [p.0 - plot.left, plot.right - p.0, 2.0 * (p.1 - plot.top), 2.0 * (plot.bottom - p.1)];
            let others = labels.iter().map(|(q, _)| (p.0 - q.0).hypot(2.0 * (p.1 - q.1)));
            frame.into_iter().chain(others).fold(f64::INFINITY, f64::min)
        };
        let middles = segments.iter().map(|[a, b]| (0.5 * (a.0 + b.0), 0.5 * (a.1 + b.1)));
        let best = middles.map(|p| (room(&p), p)).max_by(|a, b| a.0.total_cmp(&b.0));
        labels.extend(best.filter(|(room, _)| *room > 45.0).map(|(_, at)| (at, &*level.label)));
    }
    // Every label interrupts every line.
    for mut pieces in lines {
        for (at, label) in &labels {
            pieces = pieces.into_iter().flat_map(|s| keep_outside(s, &around(*at, label))).collect();
        }
        sheet.canvas.draw(Layer::clipped(plot), |pen| {
            pieces.iter().for_each(|s| pen.line(s, WHITE, 3.4));
            pieces.iter().for_each(|s| pen.line(s, style::INK, 1.4));
        });
    }
    sheet.canvas.draw(Layer::plain().with_halo(), |pen| {
        for (at, label) in labels {
            pen.text(label, at, TICK_SIZE, Anchor::Middle, style::INK);
        }
    });
}

/// The place of a label, with the gap that separates it from the lines.
fn around(at: Point, label: &str) -> Rect {
    let half = 0.5 * text_width(label, TICK_SIZE) + 8.0;
    Rect { left: at.0 - half, right: at.0 + half, top: at.1 - 16.0, bottom: at.1 + 16.0 }
}

/// Pieces of an iso line: every cell is cut into two triangles, on which the value is linear.
fn iso_segments(rows: &[Vec<Vertex>], level: f64) -> Vec<[Point; 2]> {
    let mut segments = Vec::new();
    for pair in rows.windows(2) {
        for (low, high) in pair[0].windows(2).zip(pair[1].windows(2)) {
            segments.extend(cut([low[0], low[1], high[1]], level));
            segments.extend(cut([low[0], high[0], high[1]], level));
        }
    }
    segments
}

/// Where the level crosses a triangle, if it does.
fn cut(triangle: [Vertex; 3], level: f64) -> Option<[Point; 2]> {
    let mut ends = Vec::new();
    for k in 0..3 {
        let (a, b) = (triangle[k], triangle[(k + 1) % 3]);
        let (va, vb) = (a.value?, b.value?);
        if (va < level) != (vb < level) {
            let s = (level - va) / (vb - va);
            ends.push((a.at.0 + s * (b.at.0 - a.at.0), a.at.1 + s * (b.at.1 - a.at.1)));
        }
    }
    <[Point; 2]>::try_from(ends).ok()
}

/// A boundary with fewer points is drawn as points.
const FEWEST_FOR_A_LINE: usize = 6;

/// A map over two parameters.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ParameterMap {
    /// Axes, parameters and values of the cells.
    pub cells: Surface,
    /// `marked[k][j]`: hatched, and grey if it has no value; cells that are not there are not marked.
    pub marked: Vec<Vec<bool>>,
    /// What the mark means, `"diverged"` say.
    pub marked_label: String,
    /// Boundary curves on top: the first solid, the second dashed, and so on; the predicted one first, say.
    pub boundaries: Vec<Series>,
}

/// Draws coloured cells, hatched where marked, with boundary curves.
pub fn parameter_map(figure: &ParameterMap) -> String {
    let lattice = Lattice::new(&figure.cells);
    let z = &figure.cells.z;
    let colours = ColourScale::sequential(&z.label, z.scale, lattice.values.iter().flatten().copied());
    let mut plan = lattice.plan(&figure.cells, &colours);
    plan.legend = entries(figure);
    plan.notes = lattice.notes(z.scale, |k, j| is_marked(figure, &lattice, k, j));
    let mut sheet = plan.lay_out();
    lattice.paint(&mut sheet, &colours);
    draw_marks(&mut sheet, figure, &lattice);
    draw_boundaries(&mut sheet, figure);
    colours.draw_bar(&mut sheet);
    sheet.finish()
}

fn is_marked(figure: &ParameterMap, lattice: &Lattice, k: usize, j: usize) -> bool {
    let row = figure.marked.get(lattice.rows[k]);
    row.and_then(|row| row.get(lattice.columns[j])).copied().unwrap_or(false)
}

fn entries(figure: &ParameterMap) -> Vec<Entry> {
    let boundary = |(k, series): (usize, &Series)| Entry {
        swatch: if is_sparse(series) {
            Swatch::Line { look: boundary_look(k), width: 0.0, marks: Marks::Open }
        } else {
            Swatch::Line { look: boundary_look(k), width: 3.0, marks: Marks::None }
        },
        label: series.label.clone(),
    };
    let mut entries: Vec<Entry> = figure.boundaries.iter().enumerate().map(boundary).collect();
    if figure.marked.iter().flatten().any(|&m| m) {
        entries.push(Entry { swatch: Swatch::Hatch(style::NO_VALUE), label: figure.marked_label.clone() });
    }
    entries
}

/// Whether a boundary is known at a few points only: a line between them would suggest points that were not computed.
fn is_sparse(series: &Series) -> bool {
    series.points.len() < FEWEST_FOR_A_LINE
}

/// Black or vermilion on a white rim: both stand out on all of the colour scale.
fn boundary_look(k: usize) -> Look {
    let colour = if k == 0 { style::INK } else { look(k).colour };
    Look { colour, ..look(k) }
}

fn draw_marks(sheet: &mut Sheet, figure: &ParameterMap, lattice: &Lattice) {
    let (x, y) = lattice.edges_on(sheet);
    sheet.canvas.draw(Layer::clipped(sheet.plot), |pen| {
        for k in 0..lattice.y.len() {
            let mut j = 0;
            while j < lattice.x.len() {
                let run = (j..lattice.x.len()).take_while(|&j| is_marked(figure, lattice, k, j)).count();
                if run > 0 {
                    hatch(pen, Rect { left: x[j], right: x[j + run], top: y[k + 1], bottom: y[k] });
                }
                j += run.max(1);
            }
        }
    });
}

/// All rims before all lines: where two boundaries agree, the gaps of the dashed one show the other.
fn draw_boundaries(sheet: &mut Sheet, figure: &ParameterMap) {
    for rim in [true, false] {
        for (k, series) in figure.boundaries.iter().enumerate() {
            let look = boundary_look(k);
            let (dash, colour, width) = if rim { (Dash::Solid, WHITE, 6.0) } else { (look.dash, look.colour, 3.0) };
            let positions: Vec<Option<Point>> = series.points.iter().map(|&p| sheet.px(p)).collect();
            let layer = Layer::clipped(sheet.plot).dashed(dash);
            let data = (!rim).then_some(series.points.as_slice());
            sheet.canvas.group(&readable::series(&series.label, data), |canvas| {
                if is_sparse(series) {
                    let at = positions.iter().flatten().filter(|_| !rim);
                    canvas
                        .draw(Layer::plain(), |pen| at.for_each(|&at| look.marker.draw(pen, at, colour, Marks::Open)));
                    return;
                }
                canvas.draw(layer, |pen| {
                    for line in positions.split(Option::is_none) {
                        let line: Vec<Point> = line.iter().flatten().copied().collect();
                        pen.line(&line, colour, width);
                    }
                });
            });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_iso_line_of_a_plane_is_straight() {
        let vertex = |x: f64, y: f64| Vertex { at: (x, y), value: Some(x) };
        let rows: Vec<Vec<Vertex>> =
            (0..3).map(|j| (0..3).map(|i| vertex(f64::from(i), f64::from(j))).collect()).collect();
        let segments = iso_segments(&rows, 0.5);
        assert_eq!(segments.len(), 4);
        assert!(segments.iter().flatten().all(|p| (p.0 - 0.5).abs() < 1e-12));
    }

    #[test]
    fn a_boundary_without_cells_is_still_a_document() {
        let figure = ParameterMap {
            boundaries: vec![Series { label: "b".into(), points: vec![(f64::NAN, 1.0), (0.5, 0.5)] }],
            ..Default::default()
        };
        assert!(parameter_map(&figure).ends_with("</svg>\n"));
    }
}
