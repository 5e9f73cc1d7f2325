//! Measured against predicted contraction of the fixed point.

use convergence_study::plots::look::{Look, look};
use convergence_study::plots::marker::Marks;
use convergence_study::plots::style::{self, Dash};
use convergence_study::plots::xy::{Curve, Xy};
use convergence_study::plots::{Axis, Series};

/// Contraction factors of an iteration: predicted and measured.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Contraction {
    /// Above the plot.
    pub title: Option<String>,
    /// `(predicted, measured)`, one series per kind of case.
    pub series: Vec<Series>,
}

/// Draws measured over predicted contraction, log-log, with the identity and the region of divergence.
pub fn contraction(figure: &Contraction) -> String {
    let curve = |(k, series): (usize, &Series)| Curve { width: 0.0, marks: Marks::Filled, ..Curve::line(k, series) };
    let mut xy = Xy {
        title: figure.title.clone(),
        x: Axis::log("predicted contraction α (dimensionless)"),
        y: Axis::log("measured contraction (dimensionless)"),
        curves: figure.series.iter().enumerate().map(curve).collect(),
        beyond: Some((1.0, "diverges (α ≥ 1)".into())),
        ..Xy::default()
    };
    // Both axes alike, so that the identity is the diagonal; up to 10, so that the text fits above its region.
    let shown = xy.curves.iter().flat_map(|c| &c.points).filter(|p| p.0.min(p.1) > 0.0 && p.0.max(p.1).is_finite());
    let shown: Vec<f64> = shown.flat_map(|p| [p.0, p.1]).chain([1.0, 10.0]).collect();
    xy.show_x = shown.clone();
    xy.show_y = shown;
    xy.curves.insert(0, identity(&xy));
    xy.draw()
}

/// The line on which prediction and measurement agree, over the whole plot.
fn identity(xy: &Xy) -> Curve {
    let x = xy.x_ruler();
    Curve {
        name: "measured = predicted".into(),
        is_listed: true,
        points: [x.lo, x.hi].map(|v| (10f64.powf(v), 10f64.powf(v))).to_vec(),
        look: Look { colour: style::MUTED, dash: Dash::Long, ..look(0) },
        width: 1.6,
        marks: Marks::None,
        is_data: false,
    }
}
