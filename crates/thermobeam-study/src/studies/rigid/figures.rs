//! The figures: contraction, penetrations, and the motion as obstacles become rigid.

use super::ShownImpact;
use super::judge::{Compliance, LARGEST};
use crate::figures::{ContractionFactors, NamedPoints, contraction, obstacle_lines};
use crate::studies::paper::OBSTACLES;
use convergence_study::{
    Figure,
    chart::{self, Chart, Series, Shade},
};

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
        measured: [("converges", converging), ("fails", failing)]
            .map(|(label, points)| NamedPoints {
                label: label.to_owned(),
                points,
            })
            .to_vec(),
        predicted: "predicted factor α".to_owned(),
        estimates: NamedPoints::default(),
    });
    let caption = "Contraction of the fixed point in contact, measured over predicted; right of α = 1 it fails.";
    Figure::new("contraction", caption, svg)
}

/// A penetration of each compliance.
type Penetration = fn(&Compliance<'_>) -> Option<f64>;

/// Without the distance to the rigid limit: on the scale of the figure it coincides with the
/// largest penetration.
const PENETRATIONS: [(&str, Penetration); 3] = [
    (LARGEST, |compliance| compliance.bouncing.penetration),
    ("peak of a resolved impact", |compliance| {
        compliance.impact.penetration
    }),
    ("at rest", |compliance| compliance.rest.penetration),
];

/// Penetrations over ε.
pub(super) fn penetrations(compliances: &[Compliance<'_>]) -> Figure {
    const EPSILON: &str = "compliance of the obstacles ε";
    let epsilons = compliances.iter().map(|compliance| compliance.epsilon);
    let mut table = chart::Columns::new([(EPSILON, epsilons.collect())]);
    let mut series = vec![];
    for (label, value) in PENETRATIONS {
        let values = compliances
            .iter()
            .map(|compliance| value(compliance).unwrap_or(f64::NAN));
        table.push(label, values);
        series.push(Series::errors(label, EPSILON, label));
    }
    let title = "Penetration vanishes with ε: order 1, and 2/3 in a resolved impact";
    let resolved = compliances
        .first()
        .map(|compliance| compliance.alpha() * compliance.epsilon);
    let bands = resolved.map(|epsilon| Shade {
        label: "impact resolved (α < 1)".to_owned(),
        intervals: vec![(epsilon, f64::INFINITY)],
    });
    let y = chart::Axis::log("penetration (dimensionless)");
    let chart = Chart {
        series,
        bands: bands.into_iter().collect(),
        slopes: vec![1.0, 2.0 / 3.0],
        ..Chart::new(table, chart::Axis::log(EPSILON), y).titled(title)
    };
    let caption = "Penetrations over ε: order 1 at rest and where a time step averages over the impact, left of α = 1; \
                   order 2/3 where it is resolved.";
    Figure::of("penetration", caption, chart)
}

/// The decades of ε whose curves are distinct.
const DECADES: [(f64, &str); 3] = [(1e-1, "ε = 10⁻¹"), (1e-2, "ε = 10⁻²"), (1e-3, "ε = 10⁻³")];

pub(super) fn tip(compliances: &[Compliance<'_>], limit: &ShownImpact) -> Figure {
    let mut series = vec![];
    for compliance in compliances {
        let decade = DECADES
            .iter()
            .find(|(decade, _)| (compliance.epsilon / decade - 1.0).abs() < 1e-6);
        series.extend(decade.map(|(_, label)| (*label, compliance.bouncing)));
    }
    series.push(("rigid", limit));
    let y = chart::Axis::linear("tip displacement u(1, t) (dimensionless)");
    let mut chart = Chart {
        guides: obstacle_lines(Some(OBSTACLES)),
        ..Chart::empty(chart::Axis::linear("time t"), y)
    };
    for (label, run) in series {
        chart.curve(label, run.tip.iter().copied());
    }
    let chart = chart.titled("The motion as obstacles become rigid");
    let caption = "Displacement of the free end as the obstacles become rigid.";
    Figure::of("tip", caption, chart)
}
