//! Iso lines of values on a grid.

use super::canvas::{Anchor, Layer};
use super::rect::{Point, Rect, keep_outside};
use super::ruler::Ticks;
use super::sheet::Sheet;
use super::style::{self, TICK_SIZE, WHITE, text_width};

/// A grid point in px with its value on the colour scale.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Vertex {
    pub(super) at: Point,
    pub(super) value: Option<f64>,
}

/// Iso lines at the colour bar's ticks, labelled like them.
pub(super) fn draw_contours(sheet: &mut Sheet, rows: &[Vec<Vertex>], levels: &Ticks) {
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
}
