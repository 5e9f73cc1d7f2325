//! Quantities over time.

use super::xy::{Curve, Xy};
use super::{Axis, Guide, Phases, Scale, Series};

/// Quantities over time, with limits and phases.
///
/// Series of any length: long ones are drawn as their envelope, in which no spike is lost.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct History {
    /// Above the plot.
    pub title: Option<String>,
    /// Label of the time axis; `"time t"` where it is empty.
    pub x_label: String,
    /// The vertical axis.
    pub y: Axis,
    /// `(t, value)`, times ascending.
    pub series: Vec<Series>,
    /// Which [`look`](super::look::look) each series has: the same wherever it is drawn. Empty: those of their places.
    pub looks: Vec<usize>,
    /// Limits and other values worth a line.
    pub guides: Vec<Guide>,
    /// Intervals to shade.
    pub phases: Phases,
}

/// Draws quantities over time.
pub fn history(figure: &History) -> String {
    let curve = |(k, series)| Curve::line(figure.looks.get(k).copied().unwrap_or(k), series);
    Xy {
        title: figure.title.clone(),
        x: time_axis(&figure.x_label),
        y: figure.y.clone(),
        curves: figure.series.iter().enumerate().map(curve).collect(),
        guides: figure.guides.clone(),
        phases: figure.phases.clone(),
        ..Xy::default()
    }
    .draw()
}

/// Iterations that each time step took.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Iterations {
    /// Above the plot.
    pub title: Option<String>,
    /// Label of the time axis; `"time t"` where it is empty.
    pub x_label: String,
    /// `(t at the end of the step, iterations)`, times ascending; one series per solver.
    pub series: Vec<Series>,
    /// Intervals to shade.
    pub phases: Phases,
}

/// Draws iterations per step as steps, from zero.
pub fn iterations(figure: &Iterations) -> String {
    let curve = |(k, series): (usize, &Series)| Curve { points: steps(&series.points), ..Curve::line(k, series) };
    Xy {
        title: figure.title.clone(),
        x: time_axis(&figure.x_label),
        y: Axis { label: "iterations per step".into(), scale: Scale::Linear },
        curves: figure.series.iter().enumerate().map(curve).collect(),
        phases: figure.phases.clone(),
        // With a shorter axis, ticks would lie between whole numbers.
        show_y: vec![0.0, 5.0],
        ..Xy::default()
    }
    .draw()
}

fn time_axis(label: &str) -> Axis {
    Axis::linear(if label.is_empty() { "time t" } else { label })
}

/// Every value held from the end of the step before to the end of its own.
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
