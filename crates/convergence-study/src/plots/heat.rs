//! Coloured cells, written compactly: one path per colour, one piece per run of equal neighbours.

use super::Scale;
use super::canvas::{Canvas, Pen, grid};
use super::rect::Rect;
use super::ruler::on_scale;
use super::style;
use plotters::style::RGBColor;
use std::collections::BTreeMap;
use std::fmt::Write;

/// Edges of cells around positions in ascending order: half way between neighbours.
pub(super) fn edges(positions: &[f64], alone: f64) -> Vec<f64> {
    let (Some(&first), Some(&last)) = (positions.first(), positions.last()) else { return Vec::new() };
    let between: Vec<f64> = positions.windows(2).map(|w| 0.5 * (w[0] + w[1])).collect();
    let first_half = between.first().map_or(alone, |e| e - first);
    let last_half = between.last().map_or(alone, |e| last - e);
    let ends = (first - first_half, last + last_half);
    std::iter::once(ends.0).chain(between).chain([ends.1]).collect()
}

/// The values of an axis that it can show: position on the scale and index, ascending, each position once.
pub(super) fn in_order(scale: Scale, values: &[f64]) -> Vec<(f64, usize)> {
    let mut order: Vec<(f64, usize)> =
        values.iter().enumerate().filter_map(|(k, &v)| Some((on_scale(scale, v)?, k))).collect();
    order.sort_by(|a, b| a.0.total_cmp(&b.0));
    order.dedup_by(|a, b| a.0 == b.0);
    order
}

/// Cells between the edges (in px), row by row; cells without a colour are grey.
pub(super) fn paint(canvas: &mut Canvas, x_edges: &[f64], y_edges: &[f64], rows: &[Vec<Option<RGBColor>>]) {
    let mut paths: BTreeMap<(u8, u8, u8), String> = BTreeMap::new();
    let mut add = |x: Option<(f64, f64)>, y: Option<(f64, f64)>, colour: RGBColor| {
        let (Some((left, right)), Some((top, bottom))) = (x, y) else { return };
        let (width, height) = (right - left, bottom - top);
        let path = paths.entry((colour.0, colour.1, colour.2)).or_default();
        let _ = write!(path, "M{left} {top}h{width}v{height}h-{width}z");
    };
    let columns = transposed(rows);
    if count_runs(rows) <= count_runs(&columns) {
        for (k, row) in rows.iter().enumerate() {
            runs(row).iter().for_each(|&(from, to, c)| add(span(x_edges, from, to), span(y_edges, k, k + 1), c));
        }
    } else {
        for (k, column) in columns.iter().enumerate() {
            runs(column).iter().for_each(|&(from, to, c)| add(span(x_edges, k, k + 1), span(y_edges, from, to), c));
        }
    }
    // Whole px, scaled to the page's grid: a third fewer digits.
    let mut layer = format!("<g transform=\"scale({})\" shape-rendering=\"crispEdges\">\n", grid(1.0));
    for ((r, g, b), path) in paths {
        let _ = writeln!(layer, "<path fill=\"#{r:02x}{g:02x}{b:02x}\" d=\"{path}\"/>");
    }
    canvas.raw(&(layer + "</g>\n"));
}

/// Whole px between two edges, in ascending order.
fn span(edges: &[f64], from: usize, to: usize) -> Option<(f64, f64)> {
    let (a, b) = (edges.get(from)?.round(), edges.get(to)?.round());
    Some((a.min(b), a.max(b)))
}

fn transposed(rows: &[Vec<Option<RGBColor>>]) -> Vec<Vec<Option<RGBColor>>> {
    let columns = rows.iter().map(Vec::len).min().unwrap_or(0);
    (0..columns).map(|j| rows.iter().map(|row| row[j]).collect()).collect()
}

fn count_runs(rows: &[Vec<Option<RGBColor>>]) -> usize {
    rows.iter().map(|row| runs(row).len()).sum()
}

/// Pieces that [`paint`] writes: it merges along rows or along columns, whichever gives fewer.
pub(super) fn fewest_runs(rows: &[Vec<Option<RGBColor>>]) -> usize {
    count_runs(rows).min(count_runs(&transposed(rows)))
}

/// `(first, one past last, colour)` of equal neighbours.
fn runs(row: &[Option<RGBColor>]) -> Vec<(usize, usize, RGBColor)> {
    let mut runs: Vec<(usize, usize, RGBColor)> = Vec::new();
    for (k, colour) in row.iter().enumerate() {
        let colour = colour.unwrap_or(style::NO_VALUE);
        match runs.last_mut() {
            Some(run) if run.2 == colour => run.1 = k + 1,
            _ => runs.push((k, k + 1, colour)),
        }
    }
    runs
}

/// Diagonal strokes over a rectangle, continuing those of its neighbours.
pub fn hatch(pen: &Pen<'_>, r: Rect) {
    const SPACING: f64 = 9.0;
    // A stroke is where x + y is a multiple of the spacing.
    let first = ((r.left + r.top) / SPACING).ceil() as i32;
    let last = ((r.right + r.bottom) / SPACING).floor() as i32;
    for k in first..=last {
        let sum = f64::from(k) * SPACING;
        let (x0, x1) = ((sum - r.bottom).max(r.left), (sum - r.top).min(r.right));
        if x1 > x0 {
            pen.line(&[(x0, sum - x0), (x1, sum - x1)], style::MUTED, 1.1);
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
        let (a, b) = (Some(style::INK), Some(style::GRID));
        let found: Vec<_> = runs(&[a, a, b, a]).into_iter().map(|r| (r.0, r.1)).collect();
        assert_eq!(found, [(0, 2), (2, 3), (3, 4)]);
    }

    #[test]
    fn an_axis_without_order_is_sorted() {
        assert_eq!(in_order(Scale::Log, &[10.0, -1.0, 1.0, f64::NAN, 1.0]), [(0.0, 2), (1.0, 0)]);
    }
}
