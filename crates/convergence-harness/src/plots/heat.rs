//! Values over two parameters as coloured cells, with marks and boundary curves on top.
//!
//! Cells are written compactly: one path per colour, one piece per run of equal neighbours.

use super::attributes;
use super::canvas::{Canvas, Layer, Pen, Point, Rect, grid};
use super::colour::ColourScale;
use super::legend::{Entry, Swatch};
use super::look::{Look, Marks, look};
use super::ruler::{Ruler, on_scale};
use super::sheet::{Layout, Page};
use super::style::{self, WHITE};
use super::xy::left_out;
use super::{Axis, Scale, Series};
use std::collections::BTreeMap;
use std::fmt::Write;

/// Half the width of the only cell of an axis with one value, in decades (or units, on a linear
/// axis).
const ALONE: f64 = 0.25;

/// Values over two parameters, as coloured cells.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Surface {
    /// Above the plot: what the reader should see.
    pub title: Option<String>,
    /// Horizontal axis, for example `dt`.
    pub x: Axis,
    /// Vertical axis, for example `h`.
    pub y: Axis,
    /// The quantity shown by colours; usually logarithmic.
    pub z: Axis,
    /// Values along the horizontal axis, in any order.
    pub x_values: Vec<f64>,
    /// Values along the vertical axis, in any order.
    pub y_values: Vec<f64>,
    /// `values[k][j]` belongs to `y_values[k]` and `x_values[j]`.
    pub values: Vec<Vec<f64>>,
    /// `marked[k][j]`: hatched, and grey if it has no value; missing cells are not marked.
    pub marked: Vec<Vec<bool>>,
    /// The meaning of the mark, for example `"diverged"`.
    pub marked_label: String,
    /// Boundary curves on top: the first solid, the second dashed, and so on; for example the
    /// predicted one first.
    pub boundaries: Vec<Series>,
}

/// Draws values over two parameters.
pub fn surface(figure: &Surface) -> String {
    let (x, columns): (Vec<f64>, Vec<usize>) = in_order(figure.x.scale, &figure.x_values)
        .into_iter()
        .unzip();
    let (y, rows): (Vec<f64>, Vec<usize>) = in_order(figure.y.scale, &figure.y_values)
        .into_iter()
        .unzip();
    let values = sorted(&figure.values, &rows, &columns, f64::NAN);
    let marked = sorted(&figure.marked, &rows, &columns, false);
    let plan = Layout {
        title: figure.title.clone(),
        x: span(figure.x.scale, &edges(&x, ALONE)),
        y: span(figure.y.scale, &edges(&y, ALONE)),
        x_label: figure.x.label.clone(),
        y_label: figure.y.label.clone(),
        legend: entries(figure),
        notes: notes(figure.z.scale, &values, &marked),
        ..Layout::default()
    };
    let colours = ColourScale::sequential(
        &figure.z.label,
        figure.z.scale,
        values.iter().flatten().copied(),
    );
    let cells = HeatMap {
        x: edges(&x, ALONE),
        y: edges(&y, ALONE),
        values,
        colours,
    };
    cells.draw(plan, |sheet, place| {
        draw_marks(sheet, &marked, place);
        draw_boundaries(sheet, figure);
    })
}

/// A picture of cells, each with a value.
pub(super) struct HeatMap {
    /// Edges on the scale, one more than there are cells in a row.
    pub(super) x: Vec<f64>,
    /// Edges on the scale, one more than there are rows.
    pub(super) y: Vec<f64>,
    /// Row by row; NaN if there is none.
    pub(super) values: Vec<Vec<f64>>,
    pub(super) colours: ColourScale,
}

impl HeatMap {
    /// Draws them, with the colour bar next to them.
    ///
    /// * `on_top`: draws on the cells, whose positions it gets by row and column.
    pub(super) fn draw(
        &self,
        plan: Layout,
        on_top: impl FnOnce(&mut Page, &dyn Fn(usize, usize) -> Rect),
    ) -> String {
        let mut sheet = Layout {
            right: self.colours.margin(),
            ..plan
        }
        .lay_out();
        let px = |ruler: &Ruler, edges: &[f64]| {
            edges
                .iter()
                .map(|&edge| ruler.px_of(edge))
                .collect::<Vec<_>>()
        };
        let x = px(&sheet.x, &self.x);
        let y = px(&sheet.y, &self.y);
        let place = |k: usize, j: usize| Rect {
            left: x[j],
            right: x[j + 1],
            top: y[k + 1],
            bottom: y[k],
        };
        self.paint(&mut sheet.canvas, &place);
        on_top(&mut sheet, &place);
        self.colours.draw_bar(&mut sheet);
        sheet.finish()
    }

    fn paint(&self, canvas: &mut Canvas, place: &dyn Fn(usize, usize) -> Rect) {
        let mut paths: BTreeMap<(u8, u8, u8), String> = BTreeMap::new();
        for (k, row) in self.values.iter().enumerate() {
            // Cells without a value are grey.
            let colour = |&value: &f64| self.colours.colour(value).unwrap_or(style::NO_VALUE);
            for (from, to, colour) in runs(&row.iter().map(colour).collect::<Vec<_>>()) {
                let first = place(k, from);
                let last = place(k, to);
                let [left, top, right, bottom] =
                    [first.left, first.top, last.right, first.bottom].map(f64::round);
                let width = right - left;
                let height = bottom - top;
                let path = paths.entry((colour.0, colour.1, colour.2)).or_default();
                let _ = write!(path, "M{left} {top}h{width}v{height}h-{width}z");
            }
        }
        // Whole px, scaled to the page's grid: a third fewer digits.
        let mut layer = format!(
            "<g transform=\"scale({})\" shape-rendering=\"crispEdges\">\n",
            grid(1.0)
        );
        for ((r, g, b), path) in paths {
            let _ = writeln!(
                layer,
                "<path fill=\"#{r:02x}{g:02x}{b:02x}\" d=\"{path}\"/>"
            );
        }
        canvas.raw(&(layer + "</g>\n"));
    }
}

/// Equal neighbours: the columns of the first and the last, and what they are.
fn runs<T: Copy + PartialEq>(row: &[T]) -> Vec<(usize, usize, T)> {
    let mut end = 0;
    let place = |run: &[T]| {
        end += run.len();
        (end - run.len(), end - 1, run[0])
    };
    row.chunk_by(|a, b| a == b).map(place).collect()
}

/// Edges of cells around positions in ascending order: half way between neighbours.
fn edges(positions: &[f64], alone: f64) -> Vec<f64> {
    let (Some(&first), Some(&last)) = (positions.first(), positions.last()) else {
        return Vec::new();
    };
    let between: Vec<f64> = positions.windows(2).map(|w| 0.5 * (w[0] + w[1])).collect();
    let first_half = between.first().map_or(alone, |e| e - first);
    let last_half = between.last().map_or(alone, |e| last - e);
    let ends = (first - first_half, last + last_half);
    std::iter::once(ends.0)
        .chain(between)
        .chain([ends.1])
        .collect()
}

/// The values of an axis that it can show: position on the scale and index, ascending, each
/// position once.
fn in_order(scale: Scale, values: &[f64]) -> Vec<(f64, usize)> {
    let mut order: Vec<(f64, usize)> = values
        .iter()
        .enumerate()
        .filter_map(|(k, &v)| Some((on_scale(scale, v)?, k)))
        .collect();
    order.sort_by(|a, b| a.0.total_cmp(&b.0));
    order.dedup_by(|a, b| a.0 == b.0);
    order
}

/// The cells of these rows and columns; `none` for missing ones.
fn sorted<T: Copy>(cells: &[Vec<T>], rows: &[usize], columns: &[usize], none: T) -> Vec<Vec<T>> {
    let cell = |k: usize, j: usize| {
        cells
            .get(k)
            .and_then(|row| row.get(j))
            .copied()
            .unwrap_or(none)
    };
    rows.iter()
        .map(|&k| columns.iter().map(|&j| cell(k, j)).collect())
        .collect()
}

/// The range from the first to the last edge, or any range if there is none.
fn span(scale: Scale, edges: &[f64]) -> Ruler {
    match (edges.first(), edges.last()) {
        (Some(&lo), Some(&hi)) if lo < hi => Ruler::between(scale, lo, hi),
        _ => Ruler::around(scale, [], 0.0),
    }
}

/// Counts the cells that have neither colour nor mark.
fn notes(z: Scale, values: &[Vec<f64>], marked: &[Vec<bool>]) -> Vec<String> {
    let cells = values.iter().flatten().zip(marked.iter().flatten());
    let unmarked: Vec<f64> = cells
        .filter(|(_, marked)| !**marked)
        .map(|(value, _)| *value)
        .collect();
    let missing = |scale: Scale| {
        unmarked
            .iter()
            .filter(|value| on_scale(scale, **value).is_none())
            .count()
    };
    let non_finite = missing(Scale::Linear);
    left_out(non_finite, missing(z) - non_finite)
}

/// A boundary with fewer points is drawn as points.
const FEWEST_FOR_A_LINE: usize = 6;

fn entries(figure: &Surface) -> Vec<Entry> {
    let boundary = |(k, series): (usize, &Series)| {
        let (width, marks) = if is_sparse(series) {
            (0.0, Marks::Open)
        } else {
            (3.0, Marks::None)
        };
        Entry {
            swatch: Swatch::Line {
                look: boundary_look(k),
                width,
                marks,
            },
            label: series.label.clone(),
        }
    };
    let mut entries: Vec<Entry> = figure.boundaries.iter().enumerate().map(boundary).collect();
    if figure.marked.iter().flatten().any(|&m| m) {
        entries.push(Entry {
            swatch: Swatch::Hatch(style::NO_VALUE),
            label: figure.marked_label.clone(),
        });
    }
    entries
}

/// Whether a boundary is known only at a few points: a line between them would suggest points that
/// were not computed.
fn is_sparse(series: &Series) -> bool {
    series.points.len() < FEWEST_FOR_A_LINE
}

/// Black or vermilion on a white rim: both stand out on all of the colour scale.
fn boundary_look(k: usize) -> Look {
    let colour = if k == 0 { style::INK } else { look(k).colour };
    Look { colour, ..look(k) }
}

fn draw_marks(sheet: &mut Page, marked: &[Vec<bool>], place: &dyn Fn(usize, usize) -> Rect) {
    let mut marks = vec![];
    for (k, row) in marked.iter().enumerate() {
        for (from, to, _) in runs(row).into_iter().filter(|(.., marked)| *marked) {
            marks.push(Rect {
                right: place(k, to).right,
                ..place(k, from)
            });
        }
    }
    sheet
        .canvas
        .draw(Layer::clipped(sheet.plot), |pen| pen.hatch(&marks));
}

/// All rims before all lines: if two boundaries agree, the other shows through the gaps of the
/// dashed one.
fn draw_boundaries(sheet: &mut Page, figure: &Surface) {
    for rim in [true, false] {
        for (k, series) in figure.boundaries.iter().enumerate() {
            let look = boundary_look(k);
            let (dash, colour, width) = if rim {
                (style::SOLID, WHITE, 6.0)
            } else {
                (look.dash, look.colour, 3.0)
            };
            let positions: Vec<Option<Point>> =
                series.points.iter().map(|&p| sheet.px(p)).collect();
            let layer = Layer::clipped(sheet.plot).dashed(dash);
            let data = (!rim).then_some(series.points.as_slice());
            sheet
                .canvas
                .group(&attributes::series(&series.label, data), |canvas| {
                    if is_sparse(series) {
                        // Open markers have their own rim.
                        let at = || positions.iter().flatten().filter(|_| !rim);
                        let mark =
                            |pen: &Pen<'_>, at| look.marker.draw(pen, at, colour, Marks::Open);
                        return canvas
                            .draw(Layer::default(), |pen| at().for_each(|at| mark(pen, *at)));
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
    fn edges_enclose_every_position() {
        assert_eq!(edges(&[1.0, 2.0, 4.0], 0.5), [0.5, 1.5, 3.0, 5.0]);
        assert_eq!(edges(&[3.0], 0.5), [2.5, 3.5]);
        assert!(edges(&[], 0.5).is_empty());
    }

    #[test]
    fn equal_neighbours_are_one_run() {
        assert_eq!(
            runs(&['a', 'a', 'b', 'a']),
            [(0, 1, 'a'), (2, 2, 'b'), (3, 3, 'a')]
        );
    }

    #[test]
    fn an_axis_without_order_is_sorted() {
        assert_eq!(
            in_order(Scale::Log, &[10.0, -1.0, 1.0, f64::NAN, 1.0]),
            [(0.0, 2), (1.0, 0)]
        );
    }

    /// Each stroke of a hatch is one line, however many cells it crosses, and ends at a cell that
    /// is not marked.
    #[test]
    fn strokes_go_on_from_one_marked_cell_to_the_next() {
        let drawn = |cells: usize, marked: fn(usize) -> bool| {
            let values: Vec<f64> = (0..cells)
                .map(|k| (k as f64 + 0.5) / cells as f64)
                .collect();
            let figure = Surface {
                values: vec![vec![f64::NAN; cells]; cells],
                marked: (0..cells)
                    .map(|k| vec![marked(k * 4 / cells); cells])
                    .collect(),
                x_values: values.clone(),
                y_values: values,
                ..Default::default()
            };
            surface(&figure).matches("stroke=\"#606060\"").count()
        };
        let [few, many] = [4, 60].map(|cells| drawn(cells, |_| true));
        assert!(few > 50 && many.abs_diff(few) <= 2, "{few}, {many}");
        let interrupted = drawn(60, |quarter| quarter != 1);
        assert!(interrupted > many + 20, "{many}, {interrupted}");
    }

    #[test]
    fn a_boundary_without_cells_is_still_a_document() {
        let figure = Surface {
            boundaries: vec![Series::new("b", vec![(f64::NAN, 1.0), (0.5, 0.5)])],
            ..Default::default()
        };
        assert!(surface(&figure).ends_with("</svg>\n"));
    }
}
