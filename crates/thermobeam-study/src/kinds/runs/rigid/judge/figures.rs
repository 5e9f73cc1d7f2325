//! The figures: contraction, penetrations, and the motion as obstacles become rigid.

use super::{Compliance, LARGEST, RigidObstacles, ShownImpact};
use crate::figures::{ContractionFactors, contraction, obstacle_lines};
use crate::kinds::prelude::*;
use convergence_study::internal::plots::{self, xy::Xy};

pub(super) fn contractions(compliances: &[Compliance<'_>]) -> Figure {
    let mut converging = vec![];
    let mut failing = vec![];
    for compliance in compliances {
        let point = (compliance.alpha(), compliance.contraction());
        if compliance.fails() {
            failing.push(point);
        } else {
            converging.push(point);
        }
    }
    let svg = contraction(&ContractionFactors {
        title: "The fixed point contracts by α, and fails from α = 1 on".to_owned(),
        measured: vec![
            plots::Series::new("converges", converging),
            plots::Series::new("fails", failing),
        ],
        predicted: "predicted factor α".to_owned(),
        estimates: plots::Series::default(),
    });
    let caption = "Contraction of the fixed point in contact, measured over predicted; right of α = 1 it fails.";
    Figure::new("contraction", caption, svg)
}

/// A penetration over ε.
fn penetration_series(
    label: &str,
    compliances: &[Compliance<'_>],
    value: fn(&Compliance<'_>) -> Option<f64>,
) -> plots::ErrorSeries {
    let mut points = vec![];
    for compliance in compliances {
        points.push((compliance.epsilon, value(compliance).unwrap_or(f64::NAN)));
    }
    plots::ErrorSeries {
        label: label.into(),
        points,
        ..plots::ErrorSeries::default()
    }
}

/// Without the distance to the rigid limit: on the scale of the figure it coincides with the
/// largest penetration.
pub(super) fn penetrations(compliances: &[Compliance<'_>]) -> Figure {
    let series = [
        penetration_series(LARGEST, compliances, |compliance| {
            compliance.bouncing.penetration
        }),
        penetration_series("peak of a resolved impact", compliances, |compliance| {
            compliance.impact.penetration
        }),
        penetration_series("at rest", compliances, |compliance| {
            compliance.rest.penetration
        }),
    ];
    let title = "Penetration vanishes with ε: order 1, and 2/3 in a resolved impact";
    let resolved = compliances
        .first()
        .map(|compliance| compliance.alpha() * compliance.epsilon);
    let xy = Xy {
        title: Some(title.to_owned()),
        x: plots::Axis::log("compliance of the obstacles ε"),
        y: plots::Axis::log("penetration (dimensionless)"),
        beyond: resolved.map(|epsilon| (epsilon, "impact resolved (α < 1)".into())),
        ..Xy::default()
    };
    let caption = "Penetrations over ε: order 1 at rest and where a time step averages over the impact, left of α = 1; \
                   order 2/3 where it is resolved.";
    let svg = plots::convergence(xy, &series, &[1.0, 2.0 / 3.0]);
    Figure::new("penetration", caption, svg)
}

/// The decades of ε whose curves are distinct.
const DECADES: [(f64, &str); 3] = [(1e-1, "ε = 10⁻¹"), (1e-2, "ε = 10⁻²"), (1e-3, "ε = 10⁻³")];

pub(super) fn tip(
    study: &RigidObstacles,
    compliances: &[Compliance<'_>],
    limit: &ShownImpact,
) -> Figure {
    let mut series = vec![];
    for compliance in compliances {
        let decade = DECADES
            .iter()
            .find(|(decade, _)| (compliance.epsilon / decade - 1.0).abs() < 1e-6);
        series.extend(decade.map(|(_, label)| (*label, compliance.bouncing)));
    }
    series.push(("rigid", limit));
    let curves: Vec<_> = series
        .into_iter()
        .map(|(label, run)| plots::Series::new(label, run.tip.clone()))
        .collect();
    let y = plots::Axis::linear("tip displacement u(1, t) (dimensionless)");
    let svg = Xy {
        guides: obstacle_lines(study.moving.obstacles),
        ..plots::history(y, &curves)
    }
    .titled("The motion tends to that between rigid obstacles")
    .draw();
    let caption = "Displacement of the free end as the obstacles become rigid.";
    Figure::new("tip", caption, svg)
}
