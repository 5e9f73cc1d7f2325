//! Errors against the mesh width or the time step.

use super::legend::{Entry, Swatch};
use super::look::{Look, look};
use super::marker::Marks;
use super::ruler::on_scale;
use super::slopes::{Trend, triangles};
use super::style::{self, Dash};
use super::xy::{Curve, Xy};
use super::{Axis, Guide, Scale};

/// `error = constant · h^rate`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PowerLaw {
    /// Observed exponent.
    pub rate: f64,
    /// Error at h = 1.
    pub constant: f64,
}

/// The errors in one norm.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ErrorSeries {
    /// The norm's name.
    pub label: String,
    /// `(h or dt, error)`.
    pub points: Vec<(f64, f64)>,
    /// What theory says, for the legend.
    pub order: Option<f64>,
    /// Line fitted to the points; drawn over their range, its rate stands in the legend.
    pub fit: Option<PowerLaw>,
    /// The same errors in an earlier, trusted run, drawn as rings around the points.
    pub baseline: Vec<(f64, f64)>,
}

/// A convergence plot, both axes logarithmic.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Convergence {
    /// Above the plot.
    pub title: Option<String>,
    /// What is refined.
    pub x_label: String,
    /// What is measured.
    pub y_label: String,
    /// One series per norm.
    pub series: Vec<ErrorSeries>,
    /// Orders to draw slope triangles for.
    pub slopes: Vec<f64>,
    /// A level of note, such as the round-off floor.
    pub floor: Option<Guide>,
}

impl Convergence {
    /// Labels for errors over the mesh width.
    pub fn in_space() -> Self {
        Self::over("mesh width h (dimensionless)")
    }

    /// Labels for errors over the time step.
    pub fn in_time() -> Self {
        Self::over("time step dt (dimensionless)")
    }

    fn over(x_label: &str) -> Self {
        Self { x_label: x_label.into(), y_label: "error (dimensionless)".into(), ..Self::default() }
    }
}

/// Draws errors over `h` or `dt`, log-log.
pub fn convergence(figure: &Convergence) -> String {
    let mut xy = Xy {
        title: figure.title.clone(),
        x: Axis::log(&*figure.x_label),
        y: Axis::log(&*figure.y_label),
        guides: figure.floor.clone().into_iter().collect(),
        ..Xy::default()
    };
    xy.curves.extend(baselines(&figure.series));
    for (k, series) in figure.series.iter().enumerate() {
        let (curves, entry) = curves(series, look(k));
        xy.curves.extend(curves);
        xy.legend.push(entry);
    }
    let (outlines, bottom) = triangles(&figure.slopes, &trends(&figure.series), &xy.x_ruler(), &xy.y_ruler());
    if !outlines.is_empty() {
        xy.show_y.push(bottom);
    }
    xy.outlines = outlines;
    xy.draw()
}

/// One entry in the legend for all baselines: their colours say which series they belong to.
fn baselines(series: &[ErrorSeries]) -> impl Iterator<Item = Curve> {
    let with_baseline = series.iter().enumerate().filter(|(_, s)| !s.baseline.is_empty());
    with_baseline.enumerate().map(|(nth, (k, s))| Curve {
        name: "baseline (ring)".to_owned(),
        is_listed: nth == 0,
        points: s.baseline.clone(),
        look: look(k),
        width: 0.0,
        marks: Marks::Ring,
        is_data: true,
    })
}

/// The line, which is the fit where there is one, the markers, and the legend's entry for both.
fn curves(series: &ErrorSeries, look: Look) -> (Vec<Curve>, Entry) {
    let entry = |look: Look, width: f64| Entry {
        swatch: Swatch::Line { look, width, marks: Marks::Filled },
        label: label(series),
    };
    let marked = Curve {
        name: label(series),
        is_listed: false,
        points: series.points.clone(),
        look,
        width: style::LINE,
        marks: Marks::Filled,
        is_data: true,
    };
    let Some(fit) = series.fit else { return (vec![marked], entry(look, style::LINE)) };
    let solid = Look { dash: Dash::Solid, ..look };
    let line = Curve {
        name: label(series),
        is_listed: false,
        points: fitted_line(&series.points, fit),
        look: solid,
        width: style::THIN,
        marks: Marks::None,
        is_data: false,
    };
    (vec![line, Curve { width: 0.0, ..marked }], entry(solid, style::THIN))
}

fn label(series: &ErrorSeries) -> String {
    let mut text = series.label.clone();
    if let Some(order) = series.order {
        text += &format!(", order {order}");
    }
    if let Some(rate) = series.fit.map(|fit| fit.rate).filter(|r| r.is_finite()) {
        text += &format!(", rate {rate:.3}");
    }
    text
}

/// The fitted power law between the outermost points.
fn fitted_line(points: &[(f64, f64)], fit: PowerLaw) -> Vec<(f64, f64)> {
    let xs = || points.iter().map(|p| p.0).filter(|x| x.is_finite() && *x > 0.0);
    let ends = [xs().fold(f64::INFINITY, f64::min), xs().fold(0.0, f64::max)];
    ends.map(|x| (x, fit.constant * x.powf(fit.rate))).to_vec()
}

fn trends(series: &[ErrorSeries]) -> Vec<Trend> {
    let log = |&(x, y): &(f64, f64)| Some((on_scale(Scale::Log, x)?, on_scale(Scale::Log, y)?));
    let trend = |s: &ErrorSeries| {
        let mut points: Vec<(f64, f64)> = s.points.iter().filter_map(log).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        Trend { points, order: s.order }
    };
    series.iter().map(trend).collect()
}
