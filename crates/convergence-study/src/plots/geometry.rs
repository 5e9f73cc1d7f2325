//! Points and rectangles of a page, its grid, and the parts of a line inside a rectangle.

/// A position in px, `y` downwards.
pub type Point = (f64, f64);

/// A rectangle in px.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rect {
    /// Left edge.
    pub left: f64,
    /// Upper edge; less than `bottom`.
    pub top: f64,
    /// Right edge.
    pub right: f64,
    /// Lower edge.
    pub bottom: f64,
}

impl Rect {
    /// Horizontal extent.
    pub fn width(&self) -> f64 {
        self.right - self.left
    }

    /// Vertical extent.
    pub fn height(&self) -> f64 {
        self.bottom - self.top
    }

    /// The point in the middle.
    pub fn centre(&self) -> Point {
        (
            0.5 * (self.left + self.right),
            0.5 * (self.top + self.bottom),
        )
    }
}

/// The part of a segment that lies in a rectangle, as an interval of its parameter (Liang and
/// Barsky).
fn inside(a: Point, b: Point, r: &Rect) -> Option<(f64, f64)> {
    let mut enter = 0.0_f64;
    let mut leave = 1.0_f64;
    let directions = [
        (a.0, b.0 - a.0, r.left, r.right),
        (a.1, b.1 - a.1, r.top, r.bottom),
    ];
    for (start, step, low, high) in directions {
        if step == 0.0 {
            if start < low || start > high {
                return None;
            }
            continue;
        }
        let s = (low - start) / step;
        let t = (high - start) / step;
        enter = enter.max(s.min(t));
        leave = leave.min(s.max(t));
    }
    (enter <= leave).then_some((enter, leave))
}

fn along(a: Point, b: Point, s: f64) -> Point {
    (a.0 + s * (b.0 - a.0), a.1 + s * (b.1 - a.1))
}

/// The parts of a line inside a rectangle.
pub(super) fn keep_inside(line: &[Point], r: &Rect) -> Vec<Vec<Point>> {
    if line
        .iter()
        .all(|p| p.0 >= r.left && p.0 <= r.right && p.1 >= r.top && p.1 <= r.bottom)
    {
        return vec![line.to_vec()];
    }
    let mut parts: Vec<Vec<Point>> = Vec::new();
    for pair in line.windows(2) {
        let a = pair[0];
        let b = pair[1];
        let Some((enter, leave)) = inside(a, b, r) else {
            continue;
        };
        match parts.last_mut() {
            Some(last) if enter == 0.0 && last.last() == Some(&a) => last.push(along(a, b, leave)),
            _ => parts.push(vec![along(a, b, enter), along(a, b, leave)]),
        }
    }
    parts
}

/// Grid lines per px.
const RESOLUTION: f64 = 10.0;

/// From px to the page's grid. Far-away values are cut: plotters computes with `i32`.
pub fn grid(v: f64) -> i32 {
    (v * RESOLUTION).round().clamp(-1e6, 1e6) as i32
}

pub(super) fn on_grid(points: &[Point]) -> Vec<(i32, i32)> {
    points.iter().map(|&(x, y)| (grid(x), grid(y))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const UNIT: Rect = Rect {
        left: 0.0,
        top: 0.0,
        right: 1.0,
        bottom: 1.0,
    };

    #[test]
    fn a_line_that_leaves_is_cut_on_the_rim() {
        assert_eq!(
            keep_inside(&[(0.5, 0.5), (2.5, 0.5), (2.5, 0.9), (0.5, 0.9)], &UNIT),
            [vec![(0.5, 0.5), (1.0, 0.5)], vec![(1.0, 0.9), (0.5, 0.9)]]
        );
        assert!(keep_inside(&[(-1.0, 2.0), (2.0, 2.0)], &UNIT).is_empty());
    }
}
