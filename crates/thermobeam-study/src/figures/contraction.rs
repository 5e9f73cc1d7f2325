//! Measured against predicted contraction of the fixed point.

use convergence_study::plots::look::{Look, Marks};
use convergence_study::plots::style::{self, Dash};
use convergence_study::plots::xy::{Curve, Xy};
use convergence_study::plots::{Axis, Series};

/// Draws measured over predicted contraction, log-log, with the identity up to where it is claimed, and the region
/// without convergence. Markers there are open: they show a ratio of successive increments that no longer falls.
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

/// A series on both sides of α = 1, under one legend entry, whose marker is open if all points are.
fn curves((k, series): (usize, &Series)) -> Vec<Curve> {
    let (below, above): (Vec<_>, Vec<_>) = series.points.iter().partition(|point| point.0 < 1.0);
    let side = |(points, marks)| Curve { points, marks, width: 0.0, ..Curve::line(k, series) };
    let sides = [(below, Marks::Filled), (above, Marks::Open)].map(side);
    sides.into_iter().filter(|side| !side.points.is_empty()).collect()
}

/// The line on which prediction and measurement agree, up to α = 1.
fn identity(xy: &Xy) -> Curve {
    let points = [xy.x_ruler().lo, 0.0].map(|v| (10f64.powf(v), 10f64.powf(v))).to_vec();
    let line = Curve::line(0, &Series { label: "measured = predicted".into(), points });
    let look = Look { colour: style::MUTED, dash: Dash::Long, ..line.look };
    Curve { look, width: 1.6, is_data: false, ..line }
}
