//! Values over two parameters as coloured cells: with iso lines, or with marks and boundary curves on top.

use super::canvas::{Anchor, Layer, Pen};
use super::colour::ColourScale;
use super::heat::{edges, hatch, in_order, paint};
use super::legend::{Entry, Swatch};
use super::look::{Look, look};
use super::marker::Marks;
use super::rect::{Point, Rect, keep_outside};
use super::ruler::{Ruler, Ticks, on_scale};
use super::sheet::{Layout, Page};
use super::style::{Dash, TICK_SIZE, WHITE, text_width};
use super::xy::left_out;
use super::{Axis, Scale, Series, readable, style};

/// Half the width of the only cell of an axis with one value, in decades (or units, on a linear axis).
const ALONE: f64 = 0.25;

/// Values over two parameters, as coloured cells.
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
    /// `marked[k][j]`: hatched, and grey if it has no value; cells that are not there are not marked.
    pub marked: Vec<Vec<bool>>,
    /// What the mark means, `"diverged"` say.
    pub marked_label: String,
    /// Boundary curves on top: the first solid, the second dashed, and so on; the predicted one first, say.
    pub boundaries: Vec<Series>,
}

/// Draws an error over two parameters as coloured cells with iso lines.
pub fn surface(figure: &Surface) -> String {
    draw(figure, |sheet, lattice, colours| {
        draw_contours(sheet, &lattice.vertices(sheet, figure.z.scale), &colours.ticks());
    })
}

/// Draws coloured cells, hatched where marked, with boundary curves.
pub fn parameter_map(figure: &Surface) -> String {
    draw(figure, |sheet, lattice, _| {
        draw_marks(sheet, lattice);
        draw_boundaries(sheet, figure);
    })
}

fn draw(figure: &Surface, on_top: impl FnOnce(&mut Page, &Lattice, &ColourScale)) -> String {
    let lattice = Lattice::new(figure);
    let colours = ColourScale::sequential(&figure.z.label, figure.z.scale, lattice.values.iter().flatten().copied());
    let plan = Layout {
        title: figure.title.clone(),
        x: span(figure.x.scale, &edges(&lattice.x, ALONE)),
        y: span(figure.y.scale, &edges(&lattice.y, ALONE)),
        x_label: figure.x.label.clone(),
        y_label: figure.y.label.clone(),
        right: colours.margin(),
        above: None,
        legend: entries(figure),
        notes: lattice.notes(figure.z.scale),
    };
    let mut sheet = plan.lay_out();
    let [x, y] = lattice.edges_on(&sheet);
    let colour = |row: &Vec<f64>| row.iter().map(|&v| colours.colour(v)).collect();
    let rows: Vec<_> = lattice.values.iter().map(colour).collect();
    paint(&mut sheet.canvas, &x, &y, &rows);
    on_top(&mut sheet, &lattice, &colours);
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
    marked: Vec<Vec<bool>>,
}

impl Lattice {
    fn new(figure: &Surface) -> Self {
        let (x, columns): (Vec<f64>, Vec<usize>) = in_order(figure.x.scale, &figure.x_values).into_iter().unzip();
        let (y, rows): (Vec<f64>, Vec<usize>) = in_order(figure.y.scale, &figure.y_values).into_iter().unzip();
        fn sorted<T: Copy>(cells: &[Vec<T>], rows: &[usize], columns: &[usize], none: T) -> Vec<Vec<T>> {
            let cell = |k: usize, j: usize| cells.get(k).and_then(|row| row.get(j)).copied().unwrap_or(none);
            rows.iter().map(|&k| columns.iter().map(|&j| cell(k, j)).collect()).collect()
        }
        let values = sorted(&figure.values, &rows, &columns, f64::NAN);
        Self { x, y, values, marked: sorted(&figure.marked, &rows, &columns, false) }
    }

    /// Counts cells without a colour, but for the marked ones.
    fn notes(&self, z: Scale) -> Vec<String> {
        let cells = self.values.iter().flatten().zip(self.marked.iter().flatten());
        let unmarked = || cells.clone().filter(|(_, marked)| !**marked).map(|(value, _)| *value);
        let non_finite = unmarked().filter(|value| on_scale(Scale::Linear, *value).is_none()).count();
        let off_scale = unmarked().filter(|value| on_scale(z, *value).is_none()).count();
        left_out(non_finite, off_scale - non_finite)
    }

    /// Edges of the cells in px.
    fn edges_on(&self, sheet: &Page) -> [Vec<f64>; 2] {
        [(&self.x, &sheet.x), (&self.y, &sheet.y)]
            .map(|(at, ruler)| edges(at, ALONE).iter().map(|&v| ruler.px_of(v)).collect())
    }

    fn vertices(&self, sheet: &Page, z: Scale) -> Vec<Vec<Vertex>> {
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
fn draw_contours(sheet: &mut Page, rows: &[Vec<Vertex>], levels: &Ticks) {
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
    sheet.canvas.draw(Layer { halo: true, ..Layer::default() }, |pen| {
        for (at, label) in labels {
            pen.text(label, at, TICK_SIZE, Anchor::Center, style::INK);
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

fn entries(figure: &Surface) -> Vec<Entry> {
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

fn draw_marks(sheet: &mut Page, lattice: &Lattice) {
    let [x, y] = lattice.edges_on(sheet);
    sheet.canvas.draw(Layer::clipped(sheet.plot), |pen| {
        for (k, row) in lattice.marked.iter().enumerate() {
            let mut j = 0;
            for run in row.chunk_by(|a, b| a == b) {
                if run[0] {
                    hatch(pen, Rect { left: x[j], right: x[j + run.len()], top: y[k + 1], bottom: y[k] });
                }
                j += run.len();
            }
        }
    });
}

/// All rims before all lines: where two boundaries agree, the gaps of the dashed one show the other.
fn draw_boundaries(sheet: &mut Page, figure: &Surface) {
    for rim in [true, false] {
        for (k, series) in figure.boundaries.iter().enumerate() {
            let look = boundary_look(k);
            let (dash, colour, width) = if rim { (Dash::Solid, WHITE, 6.0) } else { (look.dash, look.colour, 3.0) };
            let positions: Vec<Option<Point>> = series.points.iter().map(|&p| sheet.px(p)).collect();
            let layer = Layer::clipped(sheet.plot).dashed(dash);
            let data = (!rim).then_some(series.points.as_slice());
            sheet.canvas.group(&readable::series(&series.label, data), |canvas| {
                if is_sparse(series) {
                    // Open markers have their own rim.
                    let at = || positions.iter().flatten().filter(|_| !rim);
                    let mark = |pen: &Pen<'_>, at| look.marker.draw(pen, at, colour, Marks::Open);
                    return canvas.draw(Layer::default(), |pen| at().for_each(|at| mark(pen, *at)));
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
        let figure = Surface {
            boundaries: vec![Series { label: "b".into(), points: vec![(f64::NAN, 1.0), (0.5, 0.5)] }],
            ..Default::default()
        };
        assert!(parameter_map(&figure).ends_with("</svg>\n"));
    }
}
