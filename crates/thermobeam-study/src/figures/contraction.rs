//! Measured against predicted contraction of the fixed point.

use convergence_study::plots::look::{Look, look};
use convergence_study::plots::marker::Marks;
use convergence_study::plots::style::{self, Dash};
use convergence_study::plots::xy::{Curve, Xy};
use convergence_study::plots::{Axis, Series};

/// Draws measured over predicted contraction, log-log, with the identity as far as it is claimed, and the region without
/// convergence, where markers are open: there the ratio of successive increments is measured, which no longer falls.
///
/// * `series`: `(predicted, measured)`, one for each kind of case.
pub fn contraction(series: &[Series]) -> String {
    let mut xy = Xy {
        x: Axis::log("predicted contraction α"),
        y: Axis::log("measured contraction"),
        curves: series.iter().enumerate().flat_map(curves).collect(),
        beyond: Some((1.0, "no convergence (α ≥ 1)".into())),
        ..Xy::default()
    };
    let is_split =
        |series: &Series| [false, true].iter().all(|above| series.points.iter().any(|p| (p.0 >= 1.0) == *above));
    if series.iter().any(is_split) {
        xy.notes.push("open markers: no convergence".to_owned());
    }
    // Up to 100, so that the text fits above its region.
    xy.show_x = vec![1.0, 100.0];
    xy.show_y = vec![1.0];
    xy.curves.insert(0, identity(&xy));
    xy.draw()
}

/// A series on both sides of α = 1, under one entry of the legend, whose marker is open where all points are.
fn curves((k, series): (usize, &Series)) -> [Curve; 2] {
    let (below, above): (Vec<_>, Vec<_>) = series.points.iter().partition(|point| point.0 < 1.0);
    let all_above = below.is_empty() && !above.is_empty();
    let side = |points, marks| Curve { points, marks, width: 0.0, ..Curve::line(k, series) };
    [
        Curve { is_listed: !all_above, ..side(below, Marks::Filled) },
        Curve { is_listed: all_above, ..side(above, Marks::Open) },
    ]
}

/// The line on which prediction and measurement agree, up to α = 1.
fn identity(xy: &Xy) -> Curve {
    let x = xy.x_ruler();
    Curve {
        name: "measured = predicted".into(),
        noted_as: None,
        is_listed: true,
        points: [x.lo, 0.0].map(|v| (10f64.powf(v), 10f64.powf(v))).to_vec(),
        look: Look { colour: style::MUTED, dash: Dash::Long, ..look(0) },
        width: 1.6,
        marks: Marks::None,
        is_data: false,
    }
}
