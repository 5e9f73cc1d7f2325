//! Quantities over time, and errors over their cost.

use super::look::Marks;
use super::xy::{Curve, Xy};
use super::{Axis, Guide, Phases, Scale, Series};

/// Quantities over time or another cost, with limits and phases.
///
/// Series may have any length: long ones are drawn as their envelope, which loses no spike.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct History {
    /// Above the plot.
    pub title: Option<String>,
    /// The quantity of the horizontal axis; if empty, `"time t"` or, for costs, `"run time (s)"`.
    pub x_label: String,
    /// The vertical axis.
    pub y: Axis,
    /// `(t, value)`, times ascending.
    pub series: Vec<Series>,
    /// Which [`look`](super::look::look) each series has: the same in every figure. Empty: by place in this figure.
    pub looks: Vec<usize>,
    /// Limits and other values worth a line.
    pub guides: Vec<Guide>,
    /// Intervals to shade.
    pub phases: Phases,
}

impl History {
    /// The figure with its horizontal axis, each curve changed by `change`.
    fn xy(&self, x: fn(String) -> Axis, unnamed: &str, change: impl Fn(Curve) -> Curve) -> Xy {
        let curve = |(k, series)| change(Curve::line(self.looks.get(k).copied().unwrap_or(k), series));
        Xy {
            title: self.title.clone(),
            x: x(if self.x_label.is_empty() { unnamed.to_owned() } else { self.x_label.clone() }),
            y: self.y.clone(),
            curves: self.series.iter().enumerate().map(curve).collect(),
            guides: self.guides.clone(),
            phases: self.phases.clone(),
            ..Xy::default()
        }
    }
}

/// Draws quantities over time.
pub fn history(figure: &History) -> String {
    figure.xy(Axis::linear, "time t", |curve| curve).draw()
}

/// Draws iterations per time step, `(t at the end of the step, iterations)`, as steps from zero. The vertical axis has its own label.
pub fn iterations(figure: &History) -> String {
    let held = |curve: Curve| Curve { points: steps(&curve.points), ..curve };
    Xy {
        y: Axis { label: "iterations per step".into(), scale: Scale::Linear },
        // With a shorter axis, ticks would lie between whole numbers.
        show_y: vec![0.0, 5.0],
        ..figure.xy(Axis::linear, "time t", held)
    }
    .draw()
}

/// Draws errors over cost, `(cost, error)` in order of refinement, log-log: lower and further left is better.
pub fn work_precision(figure: &History) -> String {
    let xy = figure.xy(Axis::log, "run time (s)", |curve| Curve { marks: Marks::Filled, ..curve });
    Xy { y: Axis { scale: Scale::Log, ..xy.y.clone() }, ..xy }.draw()
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
        assert_eq!(super::steps(&[(1.0, 3.0), (2.0, 5.0)]), [(1.0, 3.0), (1.0, 5.0), (2.0, 5.0)]);
    }
}
