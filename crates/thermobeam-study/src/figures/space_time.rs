//! The displacement over space and time, as coloured cells.

use convergence_study::chart::{Axis, Cells, Chart, Table};

use crate::run::history::Frames;

/// A cell between each two successive frames and points, with the mean of its four corners. Time
/// runs to the right, space upwards; white where the displacement is zero.
pub(super) fn chart(Frames { times, points, u }: &Frames) -> Chart {
    let mut table = [vec![], vec![], vec![]];
    for (times, frames) in times.windows(2).zip(u.windows(2)) {
        for (left, ends) in points.windows(2).enumerate() {
            let corners = frames.iter().flat_map(|frame| &frame[left..left + 2]);
            let cell = [
                0.5 * (times[0] + times[1]),
                0.5 * (ends[0] + ends[1]),
                0.25 * corners.sum::<f64>(),
            ];
            for (column, value) in table.iter_mut().zip(cell) {
                column.push(value);
            }
        }
    }
    let [x, y, colours] =
        ["time t", "position x", "displacement u (dimensionless)"].map(Axis::linear);
    let names = [&x, &y, &colours].map(|axis| axis.label.clone());
    let [across, up, value] = names.clone();
    let cells = Cells {
        x: across,
        y: up,
        value,
        // White is zero.
        colours: colours.showing([0.0]),
        hatched: None,
    };
    Chart {
        cells: Some(cells),
        ..Chart::new(Table::new(names.into_iter().zip(table)), x, y)
    }
}
