//! Tables and figures.

use convergence_study::plots::{Axis, Convergence, ErrorSeries, Guide, History, Series, convergence, history};
use convergence_study::study::{Figure, Table};

use super::RigidStudy;
use super::judge::{Compliance, LARGEST, Results};
use crate::figures::{Contraction, contraction};

pub(super) fn tables(results: &Results<'_>) -> Vec<Table> {
    vec![penetration_table(results), solver_table(results)]
}

fn penetration_table(results: &Results<'_>) -> Table {
    let row = |of: &Compliance<'_>| {
        let numbers = [
            of.largest_penetration(),
            of.bouncing.map_or(f64::NAN, |found| found.force),
            results.distance_to_limit(of),
            of.resting_penetration(),
            of.rest.map_or(f64::NAN, |found| found.force),
            of.peak_penetration(),
            of.impact.map_or(f64::NAN, |found| found.force),
        ];
        std::iter::once(format!("{:.1e}", of.epsilon)).chain(numbers.map(|number| format!("{number:.4e}"))).collect()
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
        title: "Penetrations and forces as the obstacles become rigid".into(),
        head: head.map(String::from).to_vec(),
        rows: results.by_compliance.iter().map(row).collect(),
    }
}

fn solver_table(results: &Results<'_>) -> Table {
    let cell = |text: Option<String>| text.unwrap_or_else(|| "-".into());
    let row = |of: &Compliance<'_>| {
        let (newton, fixed_point) = (of.bouncing, of.fixed_point);
        let ended = |at: Option<f64>| at.map_or("converges".into(), |t| format!("fails at t = {t:.3}"));
        vec![
            format!("{:.1e}", of.epsilon),
            cell(newton.map(|found| format!("{:.3}", found.mean_iterations))),
            cell(newton.map(|found| found.most_iterations.to_string())),
            cell(fixed_point.map(|found| format!("{:.2}", found.mean_iterations))),
            cell(fixed_point.map(|found| format!("{:.4}", found.alpha))),
            cell(fixed_point.and_then(|found| found.contraction).map(|factor| format!("{factor:.4}"))),
            cell(fixed_point.map(|found| ended(found.failed_at))),
        ]
    };
    let head =
        ["ε", "Newton's iterations", "most in a step", "fixed point's iterations", "α", "contraction", "fixed point"];
    Table {
        title: "Solvers of the bouncing beam".into(),
        head: head.map(String::from).to_vec(),
        rows: results.by_compliance.iter().map(row).collect(),
    }
}

pub(super) fn figures(study: &RigidStudy, results: &Results<'_>) -> Vec<Figure> {
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
            penetrations(results),
        ),
        figure("tip", "Displacement of the free end as the obstacles become rigid.", tip(study, results)),
        figure(
            "contraction",
            "Contraction of the fixed point in contact, measured over predicted; right of α = 1 it fails.",
            contractions(results),
        ),
    ]
}

/// The distance to the rigid limit is left out: on this scale it coincides with the largest penetration.
fn penetrations(results: &Results<'_>) -> String {
    let over_epsilon = |label: &str, number: fn(&Compliance<'_>) -> f64| ErrorSeries {
        label: label.into(),
        points: results.by_compliance.iter().map(|of| (of.epsilon, number(of))).collect(),
        ..ErrorSeries::default()
    };
    let resolved = results.by_compliance.first().map(|of| of.alpha() * of.epsilon);
    convergence(&Convergence {
        x_label: "compliance of the obstacles ε".into(),
        y_label: "penetration (dimensionless)".into(),
        series: vec![
            over_epsilon(LARGEST, |of| of.largest_penetration()),
            over_epsilon("peak of a resolved impact", |of| of.peak_penetration()),
            over_epsilon("at rest", |of| of.resting_penetration()),
        ],
        beyond: resolved.map(|epsilon| (epsilon, "impact resolved (α < 1)".into())),
        slopes: vec![1.0, 2.0 / 3.0],
        ..Convergence::default()
    })
}

/// The first decades, so that the curves stay distinct.
fn tip(study: &RigidStudy, results: &Results<'_>) -> String {
    let decades = [(1e-1, "ε = 10⁻¹"), (1e-2, "ε = 10⁻²"), (1e-3, "ε = 10⁻³")];
    let label = |epsilon: f64| decades.iter().find(|(decade, _)| (epsilon / decade - 1.0).abs() < 1e-6);
    let curve =
        |of: &Compliance<'_>| Some(Series { label: label(of.epsilon)?.1.into(), points: of.bouncing?.tip.clone() });
    let rigid = results.limit.map(|limit| Series { label: "rigid".into(), points: limit.tip.clone() });
    let guides = study
        .moving
        .obstacles
        .map_or(vec![], |o| vec![Guide { label: "g₁".into(), value: o.g1 }, Guide { label: "g₂".into(), value: o.g2 }]);
    history(&History {
        y: Axis::linear("tip displacement u(1, t) (dimensionless)"),
        series: results.by_compliance.iter().filter_map(curve).chain(rigid).collect(),
        guides,
        ..History::default()
    })
}

fn contractions(results: &Results<'_>) -> String {
    let series = |label: &str, converges: bool| {
        let runs = results.by_compliance.iter().filter_map(|of| of.fixed_point);
        let runs = runs.filter(|run| run.failed_at.is_none() == converges);
        let points = runs.map(|run| (run.alpha, run.contraction.unwrap_or(f64::NAN))).collect();
        Series { label: label.into(), points }
    };
    contraction(&Contraction { title: None, series: vec![series("converges", true), series("fails", false)] })
}
