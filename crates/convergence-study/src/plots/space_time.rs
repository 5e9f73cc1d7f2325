//! A field over space and time, as a picture of coloured cells.

use super::Scale;
use super::colour::ColourScale;
use super::heat::HeatMap;
use super::ruler::{Ruler, on_scale};
use super::sheet::Layout;
use super::xy::notes_on_missing_points;

/// Most cells of the picture along time and along space: even noise, in which no neighbours are
/// equal, stays below 400 kB.
const FINEST: (usize, usize) = (200, 110);

/// A field over space and time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SpaceTime {
    /// Above the plot.
    pub title: Option<String>,
    /// The quantity shown by colours, such as `"displacement u (dimensionless)"`.
    pub label: String,
    /// Times of the frames, ascending.
    pub times: Vec<f64>,
    /// Nodes of the mesh, ascending.
    pub nodes: Vec<f64>,
    /// `frames[n][i]` belongs to `times[n]` and `nodes[i]`.
    pub frames: Vec<Vec<f64>>,
}

/// Draws a field over time (horizontal) and space (vertical), white where it is zero.
pub fn space_time(figure: &SpaceTime) -> String {
    let t = Ruler::around(Scale::Linear, figure.times.iter().copied(), 0.0);
    let x = Ruler::around(Scale::Linear, figure.nodes.iter().copied(), 0.0);
    let values = figure.frames.iter().flatten().copied();
    let colours = ColourScale::diverging(&figure.label, values);
    let non_finite = figure
        .frames
        .iter()
        .flatten()
        .filter(|&&v| on_scale(Scale::Linear, v).is_none())
        .count();
    let values = raster(figure, &t, &x, FINEST);
    let columns = values.first().map_or(0, Vec::len);
    let rows = values.len();
    let cells = HeatMap {
        x: even(&t, columns),
        y: even(&x, rows),
        values,
        colours,
    };
    let plan = Layout {
        title: figure.title.clone(),
        x: t,
        y: x,
        x_label: "time t".into(),
        y_label: "position x".into(),
        notes: notes_on_missing_points(non_finite, 0),
        ..Layout::default()
    };
    cells.draw(plan, |_, _| {})
}

/// Edges of `cells` equal cells from end to end.
fn even(ruler: &Ruler, cells: usize) -> Vec<f64> {
    (0..=cells)
        .map(|k| ruler.lo + (ruler.hi - ruler.lo) * k as f64 / cells.max(1) as f64)
        .collect()
}

/// Values in the middle of the picture's cells, row by row: averaged over the cell in time,
/// linearly interpolated in space.
fn raster(figure: &SpaceTime, t: &Ruler, x: &Ruler, most: (usize, usize)) -> Vec<Vec<f64>> {
    if figure.times.is_empty() || figure.nodes.is_empty() {
        return Vec::new();
    }
    let columns = most.0.min(4 * figure.times.len());
    let rows = most.1.min(4 * figure.nodes.len());
    let half = 0.5 * (t.hi - t.lo) / columns as f64;
    let frames: Vec<Vec<FrameWeight>> = (0..columns)
        .map(|k| frames_near(&figure.times, middle(t, k, columns), half))
        .collect();
    let mut values = vec![];
    for k in 0..rows {
        let place = between(&figure.nodes, middle(x, k, rows));
        values.push(frames.iter().map(|near| mix(figure, near, place)).collect());
    }
    values
}

/// The middle of one of `cells` equal cells.
fn middle(ruler: &Ruler, cell: usize, cells: usize) -> f64 {
    ruler.lo + (ruler.hi - ruler.lo) * (cell as f64 + 0.5) / cells as f64
}

/// A place among ascending values.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Between {
    /// The value before it.
    index: usize,
    /// How far along the interval from there to the next value, from 0 to 1.
    fraction: f64,
}

/// A frame, and its share in a cell.
struct FrameWeight {
    frame: usize,
    weight: f64,
}

/// The interval of ascending values that holds `v`, and how far along it `v` lies.
fn between(values: &[f64], v: f64) -> Between {
    let k = values
        .partition_point(|&a| a <= v)
        .clamp(1, values.len().max(2) - 1)
        - 1;
    let fraction = match (values.get(k), values.get(k + 1)) {
        (Some(&a), Some(&b)) if b > a => ((v - a) / (b - a)).clamp(0.0, 1.0),
        _ => 0.0,
    };
    Between { index: k, fraction }
}

/// Frames and weights that make up a cell: all frames in it, or the two around it.
fn frames_near(times: &[f64], t: f64, half: f64) -> Vec<FrameWeight> {
    let first = times.partition_point(|&a| a < t - half);
    let last = times.partition_point(|&a| a < t + half);
    if last > first {
        let weight = 1.0 / (last - first) as f64;
        return (first..last)
            .map(|frame| FrameWeight { frame, weight })
            .collect();
    }
    let Between { index, fraction } = between(times, t);
    vec![
        FrameWeight {
            frame: index,
            weight: 1.0 - fraction,
        },
        FrameWeight {
            frame: index + 1,
            weight: fraction,
        },
    ]
}

/// The value of a cell: these frames, interpolated in space.
fn mix(figure: &SpaceTime, frames: &[FrameWeight], place: Between) -> f64 {
    let mut sum = 0.0;
    for FrameWeight { frame, weight } in frames {
        let values = figure.frames.get(*frame).map_or(&[][..], Vec::as_slice);
        sum += weighted(*weight, interpolate(values, place));
    }
    sum
}

/// A value between two nodes; NaN where a node that counts has none.
fn interpolate(values: &[f64], Between { index, fraction }: Between) -> f64 {
    let left = values.get(index).copied().unwrap_or(f64::NAN);
    let right = values.get(index + 1).copied().unwrap_or(f64::NAN);
    weighted(1.0 - fraction, left) + weighted(fraction, right)
}

/// A term of a mean. A weight of zero must not let a missing neighbour spoil the sum.
fn weighted(weight: f64, value: f64) -> f64 {
    if weight == 0.0 { 0.0 } else { weight * value }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_linear_field_is_reproduced() {
        let times = vec![0.0, 1.0, 2.0];
        let nodes = vec![0.0, 0.1, 0.4, 1.0];
        let frames = times
            .iter()
            .map(|t| nodes.iter().map(|x| t + 10.0 * x).collect())
            .collect();
        let figure = SpaceTime {
            times,
            nodes,
            frames,
            ..Default::default()
        };
        let t = Ruler::between(Scale::Linear, 0.0, 2.0);
        let x = Ruler::between(Scale::Linear, 0.0, 1.0);
        let cells = raster(&figure, &t, &x, (200, 100));
        let rows = cells.len();
        let columns = cells[0].len();
        let exact = 0.5 / rows as f64 * 10.0;
        // The first column holds the frame t = 0 and takes its value.
        assert!((cells[0][0] - exact).abs() < 1e-12);
        assert!((cells[rows - 1][columns - 2] - (10.0 - exact)).abs() < 2.0);
    }

    #[test]
    fn intervals_are_found_at_both_ends() {
        for (values, v, index, fraction) in [
            (&[0.0, 1.0, 2.0][..], 0.0, 0, 0.0),
            (&[0.0, 1.0, 2.0], 2.0, 1, 1.0),
            (&[0.0], 5.0, 0, 0.0),
            (&[], 5.0, 0, 0.0),
        ] {
            assert_eq!(between(values, v), Between { index, fraction });
        }
    }
}
