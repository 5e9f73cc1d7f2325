//! Tables, figures and guarded numbers.

use convergence_study::plots::{Guide, Series};
use convergence_study::study::levels::Levels;
use convergence_study::study::{Check, Figure, Outcome, Quantity, Table};
use convergence_study::text::number::decimals;
use thermobeam::equilibrium::Contact;
use thermobeam::kirchhoff::BUCKLING;

use super::branches::Event;
use super::judge::{Results, extrapolated};
use super::{BifurcationStudy, CLOSE, Diagram, Rest};
use crate::figures;
use crate::scene::Scene;

pub(super) fn outcome(study: &BifurcationStudy, results: &Results<'_>, levels: &Levels, checks: Vec<Check>) -> Outcome {
    let rates = levels.judge();
    let events: Vec<String> = results.diagrams.iter().map(|diagram| format!("{:.6}", event(*diagram))).collect();
    let headline = format!("buckling and lift-off at β = {}", events.join(", "));
    let summary = format!(
        "{} diagrams, {} runs to rest; {headline}",
        study.scenes.len(),
        study.scenes.len() * study.betas.len(),
    );
    let each = study.scenes.iter().zip(&results.diagrams).zip(&results.rests);
    Outcome {
        tables: vec![force_table(study, &results.forces), rest_table(study, &results.rests)],
        figures: each
            .flat_map(|((scene, diagram), rests)| diagram.map(|diagram| figures(study, scene, diagram, rests)))
            .flatten()
            .collect(),
        quantities: quantities(study, results).into_iter().chain(levels.quantities(&rates)).collect(),
        levels: levels.errors(),
        headline,
        ..Outcome::new(summary, rates, checks)
    }
}

/// The lower end of the bracket of buckling or lift-off; NaN where the case failed.
fn event(diagram: Option<&Diagram>) -> f64 {
    diagram.map_or(f64::NAN, |diagram| diagram.event[0])
}

fn force_table(study: &BifurcationStudy, forces: &[f64]) -> Table {
    let row =
        |(n, force): (&usize, &f64)| vec![format!("{n}"), format!("-{force:.10}"), format!("{:.3e}", force - BUCKLING)];
    let mut rows: Vec<Vec<String>> = study.meshes.iter().zip(forces).map(row).collect();
    let limit = extrapolated(study, forces);
    rows.push(vec!["extrapolated".into(), format!("-{limit:.10}"), format!("{:.3e}", limit - BUCKLING)]);
    Table {
        title: "Buckling point of P1 elements".into(),
        head: ["elements", "β", "above -(π²/4)/(1 + π²/4)"].map(String::from).to_vec(),
        rows,
    }
}

/// u(1) at rest; NaN where the case failed.
fn u_tip(rest: Option<&Rest>) -> f64 {
    rest.map_or(f64::NAN, |rest| rest.u_tip)
}

fn rest_table(study: &BifurcationStudy, rests: &[Vec<Option<&Rest>>]) -> Table {
    let row = |k: usize| {
        let mut row = vec![format!("{}", study.betas[k])];
        row.extend(rests.iter().flat_map(|rests| {
            let rest = rests[k];
            let exact = rest.and_then(|rest| rest.state).map_or(f64::NAN, |state| state.u_tip);
            [decimals(u_tip(rest), 8), decimals(exact, 8)]
        }));
        row
    };
    let mut head = vec!["β".to_owned()];
    for scene in &study.scenes {
        head.extend([format!("u(1) at rest, θ_A = {}", scene.beam.theta_a), "exact".to_owned()]);
    }
    Table { title: "Where moving beams come to rest".into(), head, rows: (0..study.betas.len()).map(row).collect() }
}

/// The whole diagram, and the fork from close by where there is one.
fn figures(study: &BifurcationStudy, scene: &Scene, diagram: &Diagram, rests: &[Option<&Rest>]) -> Vec<Figure> {
    let theta_a = scene.beam.theta_a;
    let mut figures = vec![Figure {
        file: format!("{}-theta-a-{theta_a}.svg", study.header.id),
        caption: format!(
            "Steady states over β for θ_A = {theta_a}: solid where stable, dashed where not; open markers: where moving \
             beams come to rest."
        ),
        svg: drawing(study, scene, diagram, rests, [f64::NEG_INFINITY, f64::INFINITY]),
    }];
    if Event::of(scene) == Event::Buckling {
        let fork = diagram.event[0];
        figures.push(Figure {
            file: format!("{}-theta-a-{theta_a}-fork.svg", study.header.id),
            caption: "The same near the buckling point: the fork opens until the free end meets an obstacle.".into(),
            svg: drawing(study, scene, diagram, rests, [fork - CLOSE, fork + CLOSE]),
        });
    }
    figures
}

fn drawing(
    study: &BifurcationStudy,
    scene: &Scene,
    diagram: &Diagram,
    rests: &[Option<&Rest>],
    range: [f64; 2],
) -> String {
    let shown = |points: &[(f64, f64)]| -> Vec<(f64, f64)> {
        points.iter().copied().filter(|(beta, _)| (range[0]..=range[1]).contains(beta)).collect()
    };
    let mut branches = Vec::new();
    for (contact, label) in
        [(Contact::Free, "free"), (Contact::Upper, "upper obstacle"), (Contact::Lower, "lower obstacle")]
    {
        for stable in [true, false] {
            let found = diagram.branches.iter().filter(|branch| branch.contact == contact && branch.stable == stable);
            let curves = found.map(|branch| shown(&branch.points));
            // A branch that is met at one β only is a corner of the diagram, not a line.
            let curves = curves.filter(|points| points.len() > 1);
            branches.extend(curves.map(|points| figures::Branch { label: label.to_owned(), points, stable }));
        }
    }
    let ends: Vec<(f64, f64)> = study.betas.iter().zip(rests).map(|(beta, rest)| (*beta, u_tip(*rest))).collect();
    figures::bifurcation(&figures::Bifurcation {
        title: None,
        x_label: "axial force at rest β".into(),
        y_label: "tip displacement u(1) (dimensionless)".into(),
        branches,
        obstacles: scene.obstacles.map_or(vec![], |o| {
            vec![Guide { label: "g₁".into(), value: o.g1 }, Guide { label: "g₂".into(), value: o.g2 }]
        }),
        states: vec![Series { label: "end of a run".into(), points: shown(&ends) }],
    })
}

fn quantities(study: &BifurcationStudy, results: &Results<'_>) -> Vec<Quantity> {
    let events = study.scenes.iter().zip(&results.diagrams).map(|(scene, diagram)| Quantity {
        name: format!("event at θ_A = {}", scene.beam.theta_a),
        value: event(*diagram),
        tolerance: 1e-8,
    });
    let forces = study.meshes.iter().zip(&results.forces).map(|(n, force)| Quantity {
        name: format!("buckling force, n = {n}"),
        value: *force,
        tolerance: 1e-11,
    });
    events.chain(forces).collect()
}
