//! Figures: plain data in, a self-contained SVG document out.
//!
//! Every figure is a struct of numbers and labels and a pure function from it to a `String`.
//! Figures know nothing about the solver, read and write no files, and give the same bytes for the
//! same data. Bad data never stop a figure: points that are not finite, or not positive on a
//! logarithmic axis, are left out and counted in a note under the plot.
//!
//! | figure | shows |
//! | --- | --- |
//! | [`convergence`] | errors against `h` or `dt`, fitted lines, slope triangles, a baseline |
//! | [`surface`] | a value and a category over two parameters, with boundary curves |
//! | [`history`] | quantities over time, with limits and shaded phases |
//! | [`space_time`] | `u(x, t)` as a picture |
//! | [`iterations`] | iterations per step |
//! | [`panels`] | figures one below the other |
//! | [`inset`] | a small figure inside a larger one |
//! | [`forest`] | judged rates with their intervals, relative to their claims or to one |
//! | [`work_precision`] | error against run time |
//!
//! The drawing can be read back: `attributes` writes names and values into the picture, for a page
//! that shows them.
//!
//! From data to document: an axis and its data give a `ruler`; rulers, legend and notes give a
//! `sheet`, which is a laid-out page; `xy`, `heat` and `space_time` draw on the sheet; the sheet's
//! `canvas` is the one place that emits SVG.
//!
//! ```
//! use convergence_study::internal::plots::{ErrorSeries, convergence, xy::Xy};
//!
//! let points = [8.0, 16.0, 32.0].map(|n: f64| (1.0 / n, 0.3 / n)).to_vec();
//! let series = ErrorSeries { label: "velocity".into(), points, order: Some(1.0), ..Default::default() };
//! let svg = convergence(Xy::of_errors("mesh width h"), &[series], &[]);
//! assert!(svg.starts_with("<svg"));
//! ```

pub(crate) mod attributes;
pub(crate) mod canvas;
mod colour;
mod convergence;
mod curve;
mod envelope;
mod forest;
mod geometry;
mod heat;
mod history;
mod legend;
pub(crate) mod look;
mod panels;
pub(crate) mod ruler;
pub(crate) mod sheet;
mod space_time;
pub(crate) mod style;
pub(crate) mod xy;

pub use convergence::{ErrorSeries, convergence};
pub use forest::{ForestAxis, ForestRow, forest};
pub use heat::{ColouredCells, surface};
pub use history::{history, iterations, work_precision};
pub use panels::panels;
pub use space_time::{SpaceTime, space_time};
pub(crate) use xy::inset;

/// How an axis maps its values to the page.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Scale {
    /// Equal steps, equal distances.
    #[default]
    Linear,
    /// Equal factors, equal distances; values that are not positive cannot be drawn.
    Log,
}

/// An axis: what it measures, and its scale.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Axis {
    /// Quantity, symbol and unit, such as `"time t (s)"`.
    pub label: String,
    /// Linear or logarithmic.
    pub scale: Scale,
}

impl Axis {
    /// A linear axis.
    pub fn linear(label: impl Into<String>) -> Self {
        Self {
            label: label.into(),
            scale: Scale::Linear,
        }
    }

    /// A logarithmic axis.
    pub fn log(label: impl Into<String>) -> Self {
        Self {
            label: label.into(),
            scale: Scale::Log,
        }
    }
}

/// Points with a name for the legend, in drawing order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Series {
    /// Name in the legend.
    pub label: String,
    /// `(x, y)`.
    pub points: Vec<(f64, f64)>,
}

impl Series {
    /// Points in drawing order, with their name in the legend.
    pub fn new(label: impl Into<String>, points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        Self {
            label: label.into(),
            points: points.into_iter().collect(),
        }
    }
}

/// A value worth a line across the plot: a limit, a value known exactly.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Guide {
    /// Short text, set in the right margin at the line's height.
    pub label: String,
    /// Position on the vertical axis.
    pub value: f64,
}

/// Intervals of the horizontal axis to shade, such as the phases in which something is switched on.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Phases {
    /// Name in the legend.
    pub label: String,
    /// `(from, to)`, in any order; they may touch or overlap.
    pub intervals: Vec<(f64, f64)>,
}
