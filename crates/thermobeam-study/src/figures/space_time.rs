//! A field over space and time, as coloured cells.

use convergence_study::chart::{Axis, Cells, Chart, Table};

/// Most cells of the picture along time and along space: even noise, in which no neighbours are
/// equal, stays below 400 kB.
const FINEST: [usize; 2] = [200, 110];

/// A field over space and time.
pub(super) struct SpaceTime<'a> {
    /// The quantity shown by colours.
    pub(super) label: &'a str,
    /// Times of the frames, ascending.
    pub(super) times: &'a [f64],
    /// Nodes of the mesh, ascending.
    pub(super) nodes: &'a [f64],
    /// `frames[n][i]` belongs to `times[n]` and `nodes[i]`.
    pub(super) frames: &'a [Vec<f64>],
}

impl SpaceTime<'_> {
    /// Time runs to the right, space upwards; white where the field is zero.
    ///
    /// The values are those in the middle of the cells: averaged over the cell in time, linearly
    /// interpolated in space.
    pub(super) fn chart(&self) -> Chart {
        let t = middles(self.times, FINEST[0]);
        let x = middles(self.nodes, FINEST[1]);
        let half = t
            .windows(2)
            .next()
            .map_or(0.0, |pair| 0.5 * (pair[1] - pair[0]));
        let frames: Vec<Vec<FrameWeight>> = t
            .iter()
            .map(|t| frames_near(self.times, *t, half))
            .collect();
        let mut table = [vec![], vec![], vec![]];
        for place in &x {
            let node = between(self.nodes, *place);
            for (time, near) in t.iter().zip(&frames) {
                let cell = [*time, *place, mix(self, near, node)];
                table
                    .iter_mut()
                    .zip(cell)
                    .for_each(|(column, value)| column.push(value));
            }
        }
        let [x, y] = ["time t", "position x"].map(Axis::linear);
        let names = [&x.label, &y.label, self.label].map(str::to_owned);
        let cells = Cells {
            x: names[0].clone(),
            y: names[1].clone(),
            value: names[2].clone(),
            // White is zero.
            colours: Axis::linear(self.label).showing([0.0]),
            hatched: None,
        };
        Chart {
            cells: Some(cells),
            ..Chart::new(Table::new(names.into_iter().zip(table)), x, y)
        }
    }
}

/// The middles of equal cells from end to end, at most four for each value.
fn middles(values: &[f64], most: usize) -> Vec<f64> {
    let (Some(low), Some(high)) = (values.first(), values.last()) else {
        return vec![];
    };
    let cells = most.min(4 * values.len());
    let width = (high - low) / cells as f64;
    (0..cells).map(|k| low + width * (k as f64 + 0.5)).collect()
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
fn mix(figure: &SpaceTime<'_>, frames: &[FrameWeight], place: Between) -> f64 {
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
