//! A value and a category over two parameters.

use super::Series;
use super::canvas::Layer;
use super::colour::ColourScale;
use super::heat::hatch;
use super::legend::{Entry, Swatch};
use super::look::{Look, look};
use super::marker::Marks;
use super::readable;
use super::rect::{Point, Rect};
use super::sheet::Sheet;
use super::style::{self, Dash, WHITE};
use super::surface::{Lattice, Surface};

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
    fn a_boundary_without_cells_is_still_a_document() {
        let figure = ParameterMap {
            boundaries: vec![Series { label: "b".into(), points: vec![(f64::NAN, 1.0), (0.5, 0.5)] }],
            ..Default::default()
        };
        assert!(parameter_map(&figure).ends_with("</svg>\n"));
    }
}
