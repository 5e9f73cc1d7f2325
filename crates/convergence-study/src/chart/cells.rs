//! Values over two parameters as coloured cells, with a bar that explains the colours.

use std::collections::BTreeMap;
use std::fmt::Write;

use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

use super::layout::Layout;
use super::page::Page;
use super::pen::{INK, LABEL, Rect, TEXT, THIN, elide, font, frame, line, tenths, write};
use super::ruler::Ruler;
use super::{Cells, Chart, Columns};

/// Of the bar: from the plot, and its width, in px.
pub(super) const GAP: f64 = 22.0;
pub(super) const WIDTH: f64 = 20.0;
/// Of colour: few enough to merge equal neighbours, too many to see steps; odd, so that zero has
/// its own.
const LEVELS: usize = 65;
const NO_VALUE: RGBColor = RGBColor(200, 200, 200);
/// Blue, white, red: Brewer's RdBu, readable with all common kinds of colour vision.
const DIVERGING: [RGBColor; 9] = [
    RGBColor(33, 102, 172),
    RGBColor(67, 147, 195),
    RGBColor(146, 197, 222),
    RGBColor(209, 229, 240),
    RGBColor(247, 247, 247),
    RGBColor(253, 219, 199),
    RGBColor(244, 165, 130),
    RGBColor(214, 96, 77),
    RGBColor(178, 24, 43),
];

impl Cells {
    /// The scales of both axes and of the colours.
    pub(super) fn rulers(&self, chart: &Chart) -> [Ruler; 3] {
        let [x, y] = [(&chart.x, &self.x), (&chart.y, &self.y)].map(|(axis, column)| {
            let values = chart.table.column(column);
            let ruler = Ruler::new(axis, values.iter().copied(), 0.0);
            match edges(&ruler, values)[..] {
                [low, .., high] => Ruler { low, high, ..ruler },
                _ => ruler,
            }
        });
        let values = chart.table.column(&self.value).iter().copied();
        let mut z = Ruler::new(&self.colours, values, 0.0);
        if self.is_diverging() {
            z.high = z.high.max(-z.low);
            z.low = -z.high;
        }
        [x, y, z.with_ticks(8)]
    }

    /// Whether zero is white.
    fn is_diverging(&self) -> bool {
        !self.colours.is_log && self.colours.show.contains(&0.0)
    }

    /// How many values have no colour, and are not hatched.
    pub(super) fn without_colour(&self, table: &Columns) -> usize {
        let colours = Ruler::of_scale(&self.colours);
        let values = table.column(&self.value).iter();
        let without =
            values.filter(|value| !self.is_hatched(**value) && colours.place(**value).is_none());
        without.count()
    }

    /// Whether the cell of this value is hatched.
    pub(super) fn is_hatched(&self, value: f64) -> bool {
        value.is_nan() && !self.missing.is_empty()
    }

    fn colour(&self, fraction: f64) -> RGBColor {
        let level = (fraction * LEVELS as f64).floor().min(LEVELS as f64 - 1.0);
        let level = (level / (LEVELS - 1) as f64) as f32;
        if self.is_diverging() {
            DerivedColorMap::new(&DIVERGING).get_color(level)
        } else {
            ViridisRGB.get_color(level)
        }
    }

    pub(super) fn draw(&self, chart: &Chart, page: &mut Page, layout: &Layout) {
        let [left, top, right, bottom] = layout.plot;
        let table = &chart.table;
        let [x, y] = [(&layout.x, &self.x), (&layout.y, &self.y)]
            .map(|(ruler, column)| (ruler, edges(ruler, table.column(column))));
        let mut cells = vec![];
        let mut hatched = vec![];
        let places = table.pairs(&self.x, &self.y).into_iter();
        for ((across, up), value) in places.zip(table.column(&self.value)) {
            let Some(((from, to), (low, high))) = side(&x, across).zip(side(&y, up)) else {
                continue;
            };
            let (width, height) = (right - left, bottom - top);
            let cell = [
                left + from * width,
                bottom - high * height,
                left + to * width,
                bottom - low * height,
            ];
            let place = layout.z.fraction(*value);
            cells.push((cell, place.map_or(NO_VALUE, |at| self.colour(at))));
            if self.is_hatched(*value) {
                hatched.push(cell);
            }
        }
        fill(page, joined(cells));
        strokes(page, &hatched);
        self.draw_bar(page, layout);
    }

    fn draw_bar(&self, page: &mut Page, layout: &Layout) {
        let [_, top, right, bottom] = layout.plot;
        let (left, end) = (right + GAP, right + GAP + WIDTH);
        let height = |fraction: f64| bottom - fraction * (bottom - top);
        let levels = (0..LEVELS).map(|k| [k, k + 1].map(|k| k as f64 / LEVELS as f64));
        fill(
            page,
            levels.map(|[low, high]| ([left, height(high), end, height(low)], self.colour(low))),
        );
        page.layer(|area| {
            frame(area, [left, top, end, bottom]);
            for (value, label) in &layout.z.major {
                let y = height(layout.z.fraction(*value).unwrap_or(0.0));
                line(area, &[(end, y), (end + 5.0, y)], INK, THIN);
                write(area, label, (end + 9.0, y), font(TEXT), HPos::Left);
            }
            let name = elide(&self.colours.label, LABEL, bottom - top);
            let at = (
                end + 18.0 + layout.z.widest() + 0.5 * LABEL,
                0.5 * (top + bottom),
            );
            let upwards = font(LABEL).transform(FontTransform::Rotate270);
            write(area, &name, at, upwards, HPos::Center);
        });
    }
}

/// The sides of the cell around a value, as fractions of the axis.
fn side((ruler, edges): &(&Ruler, Vec<f64>), value: f64) -> Option<(f64, f64)> {
    let place = ruler.place(value)?;
    let after = edges
        .partition_point(|edge| *edge <= place)
        .clamp(1, edges.len().max(2) - 1);
    let fraction = |edge: &f64| (edge - ruler.low) / (ruler.high - ruler.low);
    Some((fraction(edges.get(after - 1)?), fraction(edges.get(after)?)))
}

/// Edges of cells, half way between neighbouring places; the outer ones as wide as if they had
/// neighbours.
fn edges(ruler: &Ruler, values: &[f64]) -> Vec<f64> {
    let mut places: Vec<f64> = values
        .iter()
        .filter_map(|value| ruler.place(*value))
        .collect();
    places.sort_by(f64::total_cmp);
    places.dedup_by(|next, one| *next - *one <= 1e-9 * next.abs().max(1.0));
    let (Some(first), Some(last)) = (places.first(), places.last()) else {
        return vec![];
    };
    let mut edges: Vec<f64> = places
        .windows(2)
        .map(|pair| 0.5 * (pair[0] + pair[1]))
        .collect();
    // A cell alone is half a decade wide, or half a unit.
    let half = |end: &f64, edge: Option<&f64>| edge.map_or(0.25, |edge| (edge - end).abs());
    let ends = [
        first - half(first, edges.first()),
        last + half(last, edges.last()),
    ];
    edges.insert(0, ends[0]);
    edges.push(ends[1]);
    edges
}

/// Equal neighbours in a row become one: few bytes for many cells.
fn joined(cells: Vec<(Rect, RGBColor)>) -> Vec<(Rect, RGBColor)> {
    let mut cells = cells;
    cells
        .sort_by(|(one, _), (next, _)| one[1].total_cmp(&next[1]).then(one[0].total_cmp(&next[0])));
    let mut joined: Vec<(Rect, RGBColor)> = vec![];
    for (cell, colour) in cells {
        match joined.last_mut() {
            Some((last, own))
                if *own == colour && last[1] == cell[1] && cell[0] <= last[2] + 0.5 =>
            {
                last[2] = cell[2];
            }
            _ => joined.push((cell, colour)),
        }
    }
    joined
}

/// Fills rectangles, one path a colour, in whole px: few bytes, and no seams.
pub(super) fn fill(page: &mut Page, cells: impl IntoIterator<Item = (Rect, RGBColor)>) {
    let mut paths: BTreeMap<(u8, u8, u8), String> = BTreeMap::new();
    for (cell, RGBColor(r, g, b)) in cells {
        let [left, top, right, bottom] = cell.map(f64::round);
        let (width, height) = (right - left, bottom - top);
        // Writing into memory cannot fail.
        let _ = write!(
            paths.entry((r, g, b)).or_default(),
            "M{left} {top}h{width}v{height}h-{width}z"
        );
    }
    let scale = format!(
        " transform=\"scale({})\" shape-rendering=\"crispEdges\"",
        tenths(1.0)
    );
    if !paths.is_empty() {
        page.group(&scale, |page| {
            for ((r, g, b), path) in paths {
                page.raw(&format!(
                    "<path fill=\"#{r:02x}{g:02x}{b:02x}\" d=\"{path}\"/>\n"
                ));
            }
        });
    }
}

/// Grey rectangles with diagonals.
pub(super) fn hatch(page: &mut Page, cells: &[Rect]) {
    fill(page, cells.iter().map(|cell| (*cell, NO_VALUE)));
    strokes(page, cells);
}

/// A diagonal across each rectangle.
fn strokes(page: &mut Page, cells: &[Rect]) {
    let mut path = String::new();
    for cell in cells {
        let [left, top, right, bottom] = cell.map(tenths);
        let _ = write!(path, "M{left} {bottom}L{right} {top}");
    }
    if !path.is_empty() {
        page.raw(&format!(
            "<path fill=\"none\" stroke=\"#606060\" stroke-width=\"11\" d=\"{path}\"/>\n"
        ));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edges_enclose_every_place() {
        let ruler = Ruler::default();
        assert_eq!(edges(&ruler, &[4.0, 1.0, 2.0, 1.0]), [0.5, 1.5, 3.0, 5.0]);
        assert_eq!(edges(&ruler, &[3.0]), [2.75, 3.25]);
        assert!(edges(&ruler, &[]).is_empty());
    }
}
