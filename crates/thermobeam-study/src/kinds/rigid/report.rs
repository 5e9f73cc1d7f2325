//! Tables, figures and guarded numbers.

use super::claims::{LARGEST, numbers};
use super::{Found, RigidStudy};
use crate::figures::{Contraction, contraction};
use crate::kinds::untyped::Measured;
use convergence_study::judge::verdict::RateVerdict;
use convergence_study::plots::{Axis, Convergence, ErrorSeries, Guide, History, Series, convergence, history};
use convergence_study::study::outcome::{Check, Figure, Outcome, Quantity, Table};
use convergence_study::text::number::rate_text;

pub(super) fn outcome(
    study: &RigidStudy,
    found: &Found<'_>,
    rates: Vec<(String, RateVerdict)>,
    checks: Vec<Check>,
) -> Outcome {
    let observed: Vec<String> = rates.iter().map(|(name, rate)| format!("{name} {}", rate_text(rate.fitted))).collect();
    Outcome {
        tables: vec![penetration_table(study, found), solver_table(study, found)],
        figures: figures(study, found),
        quantities: quantities(study, found),
        ..Outcome::new(format!("orders in ε: {}", observed.join("; ")), rates, checks)
    }
}

fn penetration_table(study: &RigidStudy, found: &Found<'_>) -> Table {
    let row = |(k, epsilon): (usize, &f64)| {
        let numbers = [
            found.moving[k].value("penetration"),
            found.moving[k].value("force"),
            found.distance_to_limit(&found.moving[k]),
            found.rest[k].value("penetration"),
            found.rest[k].value("force"),
            found.impact[k].value("penetration"),
            found.impact[k].value("force"),
        ];
        std::iter::once(format!("{epsilon:.1e}")).chain(numbers.map(|number| format!("{number:.4e}"))).collect()
    };
    let head = [
        "ε",
        "bouncing: largest penetration",
        "largest force",
        "distance to the rigid limit",
        "at rest: penetration",
        "force",
        "impact, resolved: peak penetration",
        "peak force",
    ];
    Table {
        title: "Obstacles becoming rigid".into(),
        head: head.map(String::from).to_vec(),
        rows: study.epsilons.iter().enumerate().map(row).collect(),
    }
}

fn solver_table(study: &RigidStudy, found: &Found<'_>) -> Table {
    let row = |(k, epsilon): (usize, &f64)| {
        let (newton, fixed_point) = (&found.moving[k], &found.fixed_point[k]);
        let fails = fixed_point.value("failed_at");
        vec![
            format!("{epsilon:.1e}"),
            format!("{:.3}", newton.value("iterations")),
            format!("{}", newton.value("most_iterations")),
            format!("{:.2}", fixed_point.value("iterations")),
            format!("{:.4}", fixed_point.value("alpha")),
            format!("{:.4}", fixed_point.value("contraction")),
            if fails.is_nan() { "converges".into() } else { format!("fails at t = {fails:.3}") },
        ]
    };
    let head =
        ["ε", "Newton's iterations", "most in a step", "fixed point's iterations", "α", "contraction", "fixed point"];
    Table {
        title: "Solvers of the bouncing beam".into(),
        head: head.map(String::from).to_vec(),
        rows: study.epsilons.iter().enumerate().map(row).collect(),
    }
}

fn quantities(study: &RigidStudy, found: &Found<'_>) -> Vec<Quantity> {
    let lists = [
        ("largest penetration", found.moving),
        ("penetration at rest", found.rest),
        ("peak penetration", found.impact),
    ];
    let guard = |(name, list): (&str, &[Measured])| -> Vec<Quantity> {
        let each = study.epsilons.iter().zip(numbers(list, "penetration"));
        each.map(|(epsilon, value)| Quantity { name: format!("{name}, ε = {epsilon:.1e}"), value, tolerance: 1e-6 })
            .collect()
    };
    lists.into_iter().flat_map(guard).collect()
}

fn figures(study: &RigidStudy, found: &Found<'_>) -> Vec<Figure> {
    let figure = |what: &str, caption: &str, svg: String| Figure {
        file: format!("{}-{what}.svg", study.header.id),
        caption: caption.into(),
        svg,
    };
    vec![
        figure(
            "penetration",
            "Penetrations over ε: order 1 at rest and where a time step averages over the impact, left of α = 1; order \
             2/3 where it is resolved.",
            penetrations(study, found),
        ),
        figure("tip", "Displacement of the free end as the obstacles become rigid.", tip(study, found)),
        figure(
            "contraction",
            "Contraction of the fixed point in contact, measured over predicted; right of α = 1 it fails.",
            contractions(found),
        ),
    ]
}

/// The distance to the rigid limit is left out: it is the largest penetration, to what a marker can show.
fn penetrations(study: &RigidStudy, found: &Found<'_>) -> String {
    let over_epsilon = |label: &str, values: Vec<f64>| ErrorSeries {
        label: label.into(),
        points: study.epsilons.iter().copied().zip(values).collect(),
        ..ErrorSeries::default()
    };
    let rest = numbers(found.rest, "penetration");
    let boundary = found.fixed_point.first().map_or(f64::NAN, |m| m.value("alpha")) * study.epsilons[0];
    let range = [rest.last(), rest.first()].map(|end| (boundary, end.copied().unwrap_or(f64::NAN)));
    convergence(&Convergence {
        x_label: "compliance of the obstacles ε (dimensionless)".into(),
        y_label: "penetration (dimensionless)".into(),
        series: vec![
            over_epsilon(LARGEST, numbers(found.moving, "penetration")),
            over_epsilon("peak of a resolved impact", numbers(found.impact, "penetration")),
            over_epsilon("at rest", rest),
            ErrorSeries {
                label: "α = 1: left of it the fixed point fails".into(),
                points: range.to_vec(),
                ..ErrorSeries::default()
            },
        ],
        slopes: vec![1.0, 2.0 / 3.0],
        ..Convergence::default()
    })
}

/// The first decades, so that the curves can be told apart.
fn tip(study: &RigidStudy, found: &Found<'_>) -> String {
    let decades = [(1e-1, "ε = 10⁻¹"), (1e-2, "ε = 10⁻²"), (1e-3, "ε = 10⁻³")];
    let label = |epsilon: f64| decades.iter().find(|(decade, _)| (epsilon / decade - 1.0).abs() < 1e-6);
    let shown = study.epsilons.iter().zip(found.moving).filter_map(|(epsilon, m)| Some((label(*epsilon)?.1, m)));
    let mut series: Vec<Series> =
        shown.map(|(label, m)| Series { label: label.into(), points: m.curve("u_tip").to_vec() }).collect();
    series.push(Series { label: "rigid".into(), points: found.limit.curve("u_tip").to_vec() });
    let guides = study
        .moving
        .obstacles
        .map_or(vec![], |o| vec![Guide { label: "g₁".into(), value: o.g1 }, Guide { label: "g₂".into(), value: o.g2 }]);
    history(&History {
        y: Axis::linear("tip displacement u(1, t) (dimensionless)"),
        series,
        guides,
        ..History::default()
    })
}

fn contractions(found: &Found<'_>) -> String {
    let points = |converged: f64| -> Vec<(f64, f64)> {
        let runs = found.fixed_point.iter().filter(|m| m.value("converged") == converged);
        runs.map(|m| (m.value("alpha"), m.value("contraction"))).collect()
    };
    contraction(&Contraction {
        title: None,
        series: vec![
            Series { label: "converges".into(), points: points(1.0) },
            Series { label: "fails".into(), points: points(0.0) },
        ],
    })
}
