//! The displacement over space and time, as coloured cells.

use convergence_study::chart::{Axis, Chart};

use crate::{figures, run::history::Frames};

/// A cell between each two successive frames and points, with the mean of its four corners. Time
/// runs to the right, space upwards; white where the displacement is zero.
pub(super) fn chart(Frames { times, points, u }: &Frames) -> Chart {
    let mut cells = vec![];
    for (times, frames) in times.windows(2).zip(u.windows(2)) {
        for (left, ends) in points.windows(2).enumerate() {
            let corners = frames.iter().flat_map(|frame| &frame[left..left + 2]);
            cells.push([
                0.5 * (times[0] + times[1]),
                0.5 * (ends[0] + ends[1]),
                0.25 * corners.sum::<f64>(),
            ]);
        }
    }
    let [x, y, colours] =
        ["time t", "position x", "displacement u (dimensionless)"].map(Axis::linear);
    // White is zero.
    figures::cells(&cells, [x, y, colours.showing([0.0])], "")
}
