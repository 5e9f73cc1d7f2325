//! An error over a grid of mesh widths and time steps.

use super::colour::ColourScale;
use super::contour::{Vertex, draw_contours};
use super::heat::{edges, in_order, paint};
use super::ruler::{Ruler, on_scale};
use super::sheet::{Plan, Sheet};
use super::xy::left_out;
use super::{Axis, Scale};

/// Half the width of the only cell of an axis with one value, in decades (or units, on a linear axis).
pub(super) const ALONE: f64 = 0.25;

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
pub(super) struct Lattice {
    /// Positions on the scale.
    pub(super) x: Vec<f64>,
    pub(super) y: Vec<f64>,
    /// Row by row; NaN where there is none.
    pub(super) values: Vec<Vec<f64>>,
    /// Where each column and row was in the input.
    pub(super) columns: Vec<usize>,
    pub(super) rows: Vec<usize>,
}

impl Lattice {
    pub(super) fn new(figure: &Surface) -> Self {
        let (x, columns): (Vec<f64>, Vec<usize>) = in_order(figure.x.scale, &figure.x_values).into_iter().unzip();
        let (y, rows): (Vec<f64>, Vec<usize>) = in_order(figure.y.scale, &figure.y_values).into_iter().unzip();
        let value = |k: usize, j: usize| figure.values.get(k).and_then(|row| row.get(j)).copied().unwrap_or(f64::NAN);
        let values = rows.iter().map(|&k| columns.iter().map(|&j| value(k, j)).collect()).collect();
        Self { x, y, values, columns, rows }
    }

    pub(super) fn plan(&self, figure: &Surface, colours: &ColourScale) -> Plan {
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
    pub(super) fn notes(&self, z: Scale, excused: impl Fn(usize, usize) -> bool) -> Vec<String> {
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
    pub(super) fn edges_on(&self, sheet: &Sheet) -> (Vec<f64>, Vec<f64>) {
        let x = edges(&self.x, ALONE).iter().map(|&v| sheet.x.px_of(v)).collect();
        let y = edges(&self.y, ALONE).iter().map(|&v| sheet.y.px_of(v)).collect();
        (x, y)
    }

    pub(super) fn paint(&self, sheet: &mut Sheet, colours: &ColourScale) {
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
