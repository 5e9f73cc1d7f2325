//! One chart for every figure: columns of a table in, a self-contained SVG document out.
//!
//! A chart reads and writes no files, knows nothing about the solver, and gives the same bytes for
//! the same data. Bad data never stop it: points that are not finite, or not positive on a
//! logarithmic axis, are left out and counted in a note under the plot.
//!
//! Plotters' `ChartBuilder` draws grid, ticks and their labels over a coordinate of our own
//! (`ruler`). Titles, legends and labels are placed here: plotters would measure them through the
//! document of a browser, which a page's worker has not. The page is drawn in tenths of a pixel,
//! since plotters knows only whole units, and layer by layer, since it knows no groups.
//!
//! The drawing can be read back. The names and values that a page shows stand in attributes:
//!
//! | attribute | on | holds |
//! | --- | --- | --- |
//! | `data-plot` | the picture | left, top, right, bottom of the plot, in tenths of a px |
//! | `data-x`, `data-y` | the picture | `linear` or `log`, and the ends of the range, decimal logarithms for `log` |
//! | `data-x-label`, `data-y-label` | the picture | what the axes measure |
//! | `data-series` | the marks of a series | its name |
//! | `data-columns` | likewise | the columns of the table that it shows, with a bar between them |
//! | `data-points` | likewise | `x,y` of each point; empty for long series, whose lines give as much detail |
//! | `data-entry` | an entry of the legend | the name of the series |
//! | `data-title` | the title | nothing |
//!
//! ```
//! use convergence_study::chart::{Axis, Chart, Series, Columns};
//!
//! let table = Columns::new([("h", vec![0.25, 0.125]), ("L2", vec![4e-2, 1e-2])]);
//! let series = vec![Series::errors("L2", "h", "L2").claiming(2.0)];
//! let chart = Chart { series, ..Chart::new(table, Axis::log("mesh width h"), Axis::log("error")) };
//! assert!(chart.svg().starts_with("<svg"));
//! ```

mod cells;
mod curve;
mod draw;
pub(crate) mod glyphs;
mod layout;
mod legend;
mod page;
mod pen;
mod rates;
mod rows;
mod ruler;
mod triangles;

use std::ops::Range;

use convergence_judge::verdict::PowerLaw;
pub(crate) use page::titled_by_verdict;
#[cfg(feature = "reports")]
pub(crate) use page::without_title;
#[cfg(feature = "reports")]
pub(crate) use rows::deviations;
pub(crate) use rows::{Row, rates_of};

/// Columns of numbers by their names: the rows that a report prints, or curves over time.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Columns {
    columns: Vec<(String, Vec<f64>)>,
}

impl Columns {
    /// Columns, each with its name; they may differ in length.
    pub fn new<N: Into<String>>(columns: impl IntoIterator<Item = (N, Vec<f64>)>) -> Self {
        let columns = columns.into_iter();
        Self {
            columns: columns
                .map(|(name, values)| (name.into(), values))
                .collect(),
        }
    }

    /// Adds a column.
    pub fn push(&mut self, name: impl Into<String>, values: impl IntoIterator<Item = f64>) {
        self.columns
            .push((name.into(), values.into_iter().collect()));
    }

    /// Whether it has a column of that name.
    pub fn has(&self, name: &str) -> bool {
        self.columns.iter().any(|(own, _)| own == name)
    }

    /// The numbers of the column of that name; none if there is no such column.
    fn column(&self, name: &str) -> &[f64] {
        let found = self.columns.iter().find(|(own, _)| own == name);
        debug_assert!(
            found.is_some(),
            "a chart asks for the column '{name}', which its table has not"
        );
        found.map_or(&[], |(_, values)| values)
    }

    /// The rows of two columns.
    fn pairs(&self, x: &str, y: &str) -> Vec<(f64, f64)> {
        let x = self.column(x).iter().copied();
        x.zip(self.column(y).iter().copied()).collect()
    }
}

/// An axis: what it measures, and its scale.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Axis {
    /// Quantity, symbol and unit, such as `time t (s)`.
    pub label: String,
    /// Equal factors, not equal steps, are equal distances.
    pub is_log: bool,
    /// More values that the axis must show.
    pub show: Vec<f64>,
    /// The range, if it is not that of the values; those beyond stand on the rim.
    pub(crate) range: Option<[f64; 2]>,
    /// What the rows of a vertical axis are, from top to bottom: the first is at -0.5, the next at
    /// -1.5. Without any, the axis has a scale.
    pub(crate) rows: Vec<Row>,
}

impl Axis {
    /// A linear axis.
    pub fn linear(label: impl Into<String>) -> Self {
        Self {
            label: label.into(),
            ..Self::default()
        }
    }

    /// A logarithmic axis.
    pub fn log(label: impl Into<String>) -> Self {
        Self {
            is_log: true,
            ..Self::linear(label)
        }
    }

    /// The same, which also shows these values.
    #[must_use]
    pub fn showing(self, values: impl IntoIterator<Item = f64>) -> Self {
        Self {
            show: values.into_iter().collect(),
            ..self
        }
    }
}

/// Width of lines, in px.
const LINE: f64 = 2.2;

/// How points are marked.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Mark {
    /// No markers.
    #[default]
    None,
    /// In the colour of the series.
    Filled,
    /// Outline on white.
    Open,
}

/// A line or markers: one column of the table over another.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Series {
    /// Its name in the legend; of several series with the same name the first makes the entry.
    pub label: String,
    /// The column of the horizontal axis.
    pub x: String,
    /// The column of the vertical axis.
    pub y: String,
    /// Of its points.
    pub mark: Mark,
    /// Of its line in px; 0: none.
    pub width: f64,
    /// Of its line: dashes and gaps in turn, in tenths of px, such as [`SOLID`](Self::SOLID);
    /// `None`: those of its style.
    pub dashes: Option<&'static str>,
    /// The rows that count, such as the levels that a rate uses: the others have open markers.
    pub used: Option<Range<usize>>,
    /// Drawn over the rows that count, instead of the line through the points.
    pub(crate) law: Option<PowerLaw>,
    /// The order claimed, which has a slope triangle.
    pub(crate) order: Option<f64>,
    /// Whether it shows errors over steps: no line crosses nearly a decade of steps without points.
    pub(crate) is_over_steps: bool,
    /// Which colour, dashes and marker it has, by number; `None`: those of its place in the chart.
    pub style: Option<usize>,
}

impl Series {
    /// Dashes without gaps.
    pub const SOLID: &'static str = "";
    /// Short dashes.
    pub const SHORT: &'static str = "60 40";
    /// Dots.
    pub const DOTTED: &'static str = "22 36";

    /// A line through the points of two columns.
    pub fn new(label: impl Into<String>, x: impl Into<String>, y: impl Into<String>) -> Self {
        Self {
            label: label.into(),
            x: x.into(),
            y: y.into(),
            width: LINE,
            ..Self::default()
        }
    }

    /// The same with a marker at each point.
    #[must_use]
    pub fn marked(self) -> Self {
        Self {
            mark: Mark::Filled,
            ..self
        }
    }

    /// The same with markers alone.
    #[must_use]
    pub fn scattered(self) -> Self {
        Self {
            width: 0.0,
            ..self.marked()
        }
    }

    /// The same with the k-th colour, dashes and marker, whatever its place: the first 64 differ.
    #[must_use]
    pub fn styled(self, k: usize) -> Self {
        Self {
            style: Some(k),
            ..self
        }
    }
}

/// Values over two parameters as coloured cells, a row of the table for each.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Cells {
    /// The column of the horizontal axis.
    pub x: String,
    /// The column of the vertical axis.
    pub y: String,
    /// The column of the values, which the colours show.
    pub value: String,
    /// What the colours measure; a linear one that shows 0 is white there, blue below, red above.
    pub colours: Axis,
    /// What a cell without a value (NaN) is, which is hatched; empty: nothing, and a note counts
    /// them.
    pub missing: String,
}

/// A value worth a line across the plot: a limit, a value known exactly.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Guide {
    /// Short text, set in the right margin at the line's height.
    pub label: String,
    /// Its place on the vertical axis.
    pub value: f64,
}

/// Shaded intervals of the horizontal axis, such as the phases in which something is switched on.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Shade {
    /// Its name in the legend.
    pub label: String,
    /// `(from, to)`, in any order; what lies beyond the axis is cut off.
    pub intervals: Vec<(f64, f64)>,
}

/// A chart.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Chart {
    /// The numbers.
    pub table: Columns,
    /// What the reader should see, above the plot; empty: the vertical axis over the horizontal
    /// one.
    pub title: String,
    /// The horizontal axis.
    pub x: Axis,
    /// The vertical axis.
    pub y: Axis,
    /// In drawing order.
    pub series: Vec<Series>,
    /// Below the series.
    pub cells: Option<Cells>,
    /// Horizontal lines.
    pub guides: Vec<Guide>,
    /// Below everything else.
    pub bands: Vec<Shade>,
    /// Orders with a slope triangle, besides those of the series.
    pub slopes: Vec<f64>,
    /// Lines under the legend, before that on omitted points.
    pub notes: Vec<String>,
    /// Points that the table lacks, which the notes name.
    pub missing: usize,
    /// Whether its series are named in another panel.
    pub without_legend: bool,
}

impl Chart {
    /// A chart of no series yet.
    pub fn new(table: Columns, x: Axis, y: Axis) -> Self {
        Self {
            table,
            x,
            y,
            ..Self::default()
        }
    }

    /// A chart without numbers, for [`curve`](Self::curve).
    pub fn empty(x: Axis, y: Axis) -> Self {
        Self::new(Columns::default(), x, y)
    }

    /// The same with a title that says what one sees only where that was found.
    #[must_use]
    pub fn titled_where(self, holds: bool, title: impl Into<String>) -> Self {
        if holds { self.titled(title) } else { self }
    }

    /// The same with a title.
    #[must_use]
    pub fn titled(self, title: impl Into<String>) -> Self {
        Self {
            title: title.into(),
            ..self
        }
    }

    /// Adds a line through points that are in no table: their columns are named after it.
    ///
    /// Returns the series, whose style may be changed.
    pub fn curve(
        &mut self,
        label: impl Into<String>,
        points: impl IntoIterator<Item = (f64, f64)>,
    ) -> &mut Series {
        let label = label.into();
        let (x, y): (Vec<f64>, Vec<f64>) = points.into_iter().unzip();
        let place = self.series.len();
        let [over, of] = [&self.x.label, &label].map(|name| format!("{name} #{place}"));
        self.table.push(&over, x);
        self.table.push(&of, y);
        self.series.push(Series::new(label, over, of));
        &mut self.series[place]
    }
}
