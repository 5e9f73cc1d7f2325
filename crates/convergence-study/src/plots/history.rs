//! Quantities over time, and errors over their cost.

use super::look::{Marks, look};
use super::xy::{Curve, Xy};
use super::{Axis, Series};

/// Quantities over time, `(t, value)`, times ascending.
///
/// Series may have any length: long ones are drawn as their envelope, which loses no spike.
pub fn history(y: Axis, series: &[Series]) -> Xy {
    let curves = series
        .iter()
        .enumerate()
        .map(|(k, series)| Curve::line(k, series))
        .collect();
    Xy {
        x: Axis::linear("time t"),
        y,
        curves,
        ..Xy::default()
    }
}

/// Iterations per time step, `(t at the end of the step, iterations)`, as steps from zero.
pub fn iterations(series: &[Series]) -> Xy {
    let mut figure = history(Axis::linear("iterations per step"), series);
    figure
        .curves
        .iter_mut()
        .for_each(|curve| curve.points = steps(&curve.points));
    // With a shorter axis, ticks would lie between whole numbers.
    Xy {
        show_y: vec![0.0, 5.0],
        ..figure
    }
}

/// Errors over cost, `(cost, error)` in order of refinement, log-log: lower and further left is
/// better.
///
/// * `cost`, `error`: the labels of the axes.
pub fn work_precision(cost: &str, error: impl Into<String>, series: &[Series]) -> Xy {
    Xy {
        x: Axis::log(cost),
        ..history(Axis::log(error), series).marked()
    }
}

impl Xy {
    /// The same with a marker at each point.
    pub fn marked(mut self) -> Self {
        self.curves
            .iter_mut()
            .for_each(|curve| curve.marks = Marks::Filled);
        self
    }

    /// The same with markers alone: points in no order.
    pub fn scattered(self) -> Self {
        let mut figure = self.marked();
        figure.curves.iter_mut().for_each(|curve| curve.width = 0.0);
        figure
    }

    /// The same with a title above the plot.
    pub fn titled(self, title: impl Into<String>) -> Self {
        Self {
            title: Some(title.into()),
            ..self
        }
    }

    /// The same with the [`look`] of each curve, which is then the same in every figure.
    pub fn with_looks(mut self, looks: &[usize]) -> Self {
        self.curves
            .iter_mut()
            .zip(looks)
            .for_each(|(curve, &k)| curve.look = look(k));
        self
    }
}

/// Every value held over its step, from the end of the previous one.
fn steps(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let mut held = Vec::with_capacity(2 * points.len());
    for (k, &(t, value)) in points.iter().enumerate() {
        if let Some(before) = k.checked_sub(1) {
            held.push((points[before].0, value));
        }
        held.push((t, value));
    }
    held
}

#[cfg(test)]
mod tests {
    #[test]
    fn a_step_holds_its_value() {
        assert_eq!(
            super::steps(&[(1.0, 3.0), (2.0, 5.0)]),
            [(1.0, 3.0), (1.0, 5.0), (2.0, 5.0)]
        );
    }
}
