//! What accuracy costs.

use super::marker::Marks;
use super::xy::{Curve, Xy};
use super::{Axis, Series};

/// Errors against cost.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WorkPrecision {
    /// Above the plot.
    pub title: Option<String>,
    /// The measure of cost; `None` is the run time in seconds.
    pub x_label: Option<String>,
    /// What is measured.
    pub y_label: String,
    /// `(cost, error)`, one series per method, in order of refinement.
    pub series: Vec<Series>,
}

/// Draws error over cost, log-log: the lower and the further left, the better.
pub fn work_precision(figure: &WorkPrecision) -> String {
    let curve = |(k, series): (usize, &Series)| Curve { marks: Marks::Filled, ..Curve::line(k, series) };
    Xy {
        title: figure.title.clone(),
        x: Axis::log(figure.x_label.as_deref().unwrap_or("run time (s)")),
        y: Axis::log(&*figure.y_label),
        curves: figure.series.iter().enumerate().map(curve).collect(),
        ..Xy::default()
    }
    .draw()
}
