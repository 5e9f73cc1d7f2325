//! What accuracy costs.

use super::marker::Marks;
use super::style::{self, look};
use super::xy::{Curve, Xy};
use super::{Axis, Series};

/// Errors against run time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WorkPrecision {
    /// Above the plot.
    pub title: Option<String>,
    /// What is measured.
    pub y_label: String,
    /// `(seconds, error)`, one series per method, in order of refinement.
    pub series: Vec<Series>,
}

/// Draws error over seconds, log-log: the lower and the further left, the better.
pub fn work_precision(figure: &WorkPrecision) -> String {
    let curve = |(k, series): (usize, &Series)| Curve {
        label: Some(series.label.clone()),
        points: series.points.clone(),
        look: look(k),
        width: style::LINE,
        marks: Marks::Filled,
        is_data: true,
    };
    Xy {
        title: figure.title.clone(),
        x: Axis::log("run time (s)"),
        y: Axis::log(&*figure.y_label),
        curves: figure.series.iter().enumerate().map(curve).collect(),
        ..Xy::default()
    }
    .draw()
}
