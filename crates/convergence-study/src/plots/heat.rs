//! Values over two parameters as coloured cells, with marks and boundary curves on top.
//!
//! Cells are written compactly: one path per colour, one piece per run of equal neighbours.

use super::attributes;
use super::canvas::{Canvas, Layer, Point, Rect, grid};
use super::colour::ColourScale;
use super::legend::{Entry, Swatch};
use super::look::{Look, Marks, look};
use super::ruler::{Ruler, on_scale};
use super::sheet::{Layout, Page};
use super::style::{self, WHITE};
use super::xy::notes_on_missing_points;
use super::{Axis, Scale, Series};
use plotters::style::RGBColor;
use std::collections::BTreeMap;
use std::fmt::Write;

/// Half the width of the only cell of an axis with one value, in decades (or units, on a linear
/// axis).
const ALONE: f64 = 0.25;

/// Values over two parameters, as coloured cells.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ColouredCells {
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
pub fn surface(figure: &ColouredCells) -> String {
    let columns = SortedAxis::new(figure.x.scale, &figure.x_values);
    let rows = SortedAxis::new(figure.y.scale, &figure.y_values);
    let values = select_cells(&figure.values, &rows, &columns, f64::NAN);
    let marked = select_cells(&figure.marked, &rows, &columns, false);
    let x = edges(&columns.positions, ALONE);
    let y = edges(&rows.positions, ALONE);
    let plan = Layout {
        title: figure.title.clone(),
        x: span(figure.x.scale, &x),
        y: span(figure.y.scale, &y),
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
        x,
        y,
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
        let x: Vec<f64> = self.x.iter().map(|&edge| sheet.x.px_of(edge)).collect();
        let y: Vec<f64> = self.y.iter().map(|&edge| sheet.y.px_of(edge)).collect();
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
            let colours: Vec<RGBColor> = row
                .iter()
                .map(|&value| self.colours.colour(value).unwrap_or(style::NO_VALUE))
                .collect();
            for run in runs(&colours) {
                let colour = run.content;
                let first = place(k, run.first);
                let last = place(k, run.last);
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

/// Equal neighbours in a row.
#[derive(Debug, PartialEq)]
struct CellRun<T> {
    /// Their first column.
    first: usize,
    /// Their last column.
    last: usize,
    /// What each of them is.
    content: T,
}

/// The runs of a row, from left to right.
fn runs<T: Copy + PartialEq>(row: &[T]) -> Vec<CellRun<T>> {
    let mut runs = vec![];
    let mut first = 0;
    for cells in row.chunk_by(|a, b| a == b) {
        runs.push(CellRun {
            first,
            last: first + cells.len() - 1,
            content: cells[0],
        });
        first += cells.len();
    }
    runs
}

/// Edges of cells around positions in ascending order: half way between neighbours.
fn edges(positions: &[f64], alone: f64) -> Vec<f64> {
    let (Some(&first), Some(&last)) = (positions.first(), positions.last()) else {
        return Vec::new();
    };
    let between: Vec<f64> = positions.windows(2).map(|w| 0.5 * (w[0] + w[1])).collect();
    let first_half = between.first().map_or(alone, |e| e - first);
    let last_half = between.last().map_or(alone, |e| last - e);
    let mut edges = vec![first - first_half];
    edges.extend(between);
    edges.push(last + last_half);
    edges
}

/// The values of an axis that it can show, ascending, each position once.
struct SortedAxis {
    /// On the scale.
    positions: Vec<f64>,
    /// The places of these values in the list that is given.
    indices: Vec<usize>,
}

impl SortedAxis {
    fn new(scale: Scale, values: &[f64]) -> Self {
        let mut order: Vec<(f64, usize)> = values
            .iter()
            .enumerate()
            .filter_map(|(k, &v)| Some((on_scale(scale, v)?, k)))
            .collect();
        order.sort_by(|a, b| a.0.total_cmp(&b.0));
        order.dedup_by(|a, b| a.0 == b.0);
        let (positions, indices) = order.into_iter().unzip();
        Self { positions, indices }
    }
}

/// The cells of these rows and columns; `none` for missing ones.
fn select_cells<T: Copy>(
    cells: &[Vec<T>],
    rows: &SortedAxis,
    columns: &SortedAxis,
    none: T,
) -> Vec<Vec<T>> {
    let mut selection = vec![];
    for &k in &rows.indices {
        let row = cells.get(k).map_or(&[][..], Vec::as_slice);
        let indices = columns.indices.iter();
        selection.push(
            indices
                .map(|&j| row.get(j).copied().unwrap_or(none))
                .collect(),
        );
    }
    selection
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
    let non_finite = count_off_scale(Scale::Linear, &unmarked);
    notes_on_missing_points(non_finite, count_off_scale(z, &unmarked) - non_finite)
}

/// The number of values without a position on a scale.
fn count_off_scale(scale: Scale, values: &[f64]) -> usize {
    let values = values.iter();
    values
        .filter(|value| on_scale(scale, **value).is_none())
        .count()
}

/// A boundary with fewer points is drawn as points.
const FEWEST_FOR_A_LINE: usize = 6;

fn entries(figure: &ColouredCells) -> Vec<Entry> {
    let mut entries = vec![];
    for (k, series) in figure.boundaries.iter().enumerate() {
        let (width, marks) = if is_sparse(series) {
            (0.0, Marks::Open)
        } else {
            (3.0, Marks::None)
        };
        entries.push(Entry {
            swatch: Swatch::Line {
                look: boundary_look(k),
                width,
                marks,
            },
            label: series.label.clone(),
        });
    }
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
        for run in runs(row).into_iter().filter(|run| run.content) {
            marks.push(Rect {
                right: place(k, run.last).right,
                ..place(k, run.first)
            });
        }
    }
    sheet
        .canvas
        .draw(Layer::clipped(sheet.plot), |pen| pen.hatch(&marks));
}

/// All rims before all lines: if two boundaries agree, the other shows through the gaps of the
/// dashed one.
fn draw_boundaries(sheet: &mut Page, figure: &ColouredCells) {
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
                        canvas.draw(Layer::default(), |pen| {
                            // Open markers have their own rim.
                            for position in positions.iter().flatten().filter(|_| !rim) {
                                look.mark(pen, *position, Marks::Open);
                            }
                        });
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
    fn edges_enclose_every_position() {
        assert_eq!(edges(&[1.0, 2.0, 4.0], 0.5), [0.5, 1.5, 3.0, 5.0]);
        assert_eq!(edges(&[3.0], 0.5), [2.5, 3.5]);
        assert!(edges(&[], 0.5).is_empty());
    }

    #[test]
    fn equal_neighbours_are_one_run() {
        let runs = runs(&['a', 'a', 'b', 'a']);
        let ends: Vec<_> = runs
            .iter()
            .map(|run| (run.first, run.last, run.content))
            .collect();
        assert_eq!(ends, [(0, 1, 'a'), (2, 2, 'b'), (3, 3, 'a')]);
    }

    #[test]
    fn an_axis_without_order_is_sorted() {
        let axis = SortedAxis::new(Scale::Log, &[10.0, -1.0, 1.0, f64::NAN, 1.0]);
        assert_eq!(axis.positions, [0.0, 1.0]);
        assert_eq!(axis.indices, [2, 0]);
    }

    /// Each stroke of a hatch is one line, however many cells it crosses, and ends at a cell that
    /// is not marked.
    #[test]
    fn strokes_go_on_from_one_marked_cell_to_the_next() {
        let drawn = |cells: usize, marked: fn(usize) -> bool| {
            let values: Vec<f64> = (0..cells)
                .map(|k| (k as f64 + 0.5) / cells as f64)
                .collect();
            let figure = ColouredCells {
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
        let figure = ColouredCells {
            boundaries: vec![Series::new("b", vec![(f64::NAN, 1.0), (0.5, 0.5)])],
            ..Default::default()
        };
        assert!(surface(&figure).ends_with("</svg>\n"));
    }
}
