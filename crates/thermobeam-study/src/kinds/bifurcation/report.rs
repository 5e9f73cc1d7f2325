//! Tables, figures and guarded numbers.

use thermobeam::equilibrium::Contact;
use thermobeam::kirchhoff::BUCKLING;

use super::branches::Event;
use super::{BifurcationStudy, CLOSE, family_name};
use crate::figures::{Bifurcation, Branch, bifurcation};
use crate::kinds::untyped::Measured;
use crate::scene::Scene;
use convergence_study::judge::verdict::RateVerdict;
use convergence_study::plots::{Guide, Series};
use convergence_study::study::outcome::{Check, Figure, Outcome, Quantity, Table};
use convergence_study::text::number::decimals;

pub(super) fn outcome(
    study: &BifurcationStudy,
    diagrams: &[Measured],
    forces: &[f64],
    rests: &[Measured],
    rates: Vec<(String, RateVerdict)>,
    checks: Vec<Check>,
) -> Outcome {
    let rests: Vec<&[Measured]> = rests.chunks(study.betas.len()).collect();
    let each = || study.scenes.iter().zip(diagrams).zip(&rests);
    let events: Vec<String> = diagrams.iter().map(|diagram| format!("{:.6}", diagram.value("event_low"))).collect();
    let summary = format!(
        "{} diagrams, {} runs to rest; buckling and lift-off at β = {}",
        diagrams.len(),
        rests.len() * study.betas.len(),
        events.join(", ")
    );
    Outcome {
        tables: vec![force_table(study, forces), rest_table(study, &rests)],
        figures: each().flat_map(|((scene, diagram), rests)| figures(study, scene, diagram, rests)).collect(),
        quantities: quantities(study, diagrams, forces),
        headline: format!("buckling and lift-off at β = {}", events.join(", ")),
        ..Outcome::new(summary, rates, checks)
    }
}

fn force_table(study: &BifurcationStudy, forces: &[f64]) -> Table {
    let row =
        |(n, force): (&usize, &f64)| vec![format!("{n}"), format!("-{force:.10}"), format!("{:.3e}", force - BUCKLING)];
    let mut rows: Vec<Vec<String>> = study.meshes.iter().zip(forces).map(row).collect();
    let limit = study.extrapolated(forces);
    rows.push(vec!["extrapolated".into(), format!("-{limit:.10}"), format!("{:.3e}", limit - BUCKLING)]);
    Table {
        title: "Buckling point of P1 elements".into(),
        head: ["elements", "β", "above -(π²/4)/(1 + π²/4)"].map(String::from).to_vec(),
        rows,
    }
}

fn rest_table(study: &BifurcationStudy, rests: &[&[Measured]]) -> Table {
    let row = |k: usize| {
        let mut row = vec![format!("{}", study.betas[k])];
        row.extend(rests.iter().flat_map(|rests| {
            let m = &rests[k];
            [decimals(m.value("u_tip"), 8), decimals(m.value("exact_u_tip"), 8)]
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
fn figures(study: &BifurcationStudy, scene: &Scene, diagram: &Measured, rests: &[Measured]) -> Vec<Figure> {
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
        let fork = diagram.value("event_low");
        figures.push(Figure {
            file: format!("{}-theta-a-{theta_a}-fork.svg", study.header.id),
            caption: "The same near the buckling point: the fork opens until the free end meets an obstacle.".into(),
            svg: drawing(study, scene, diagram, rests, [fork - CLOSE, fork + CLOSE]),
        });
    }
    figures
}

fn drawing(study: &BifurcationStudy, scene: &Scene, diagram: &Measured, rests: &[Measured], range: [f64; 2]) -> String {
    let shown = |points: &[(f64, f64)]| -> Vec<(f64, f64)> {
        points.iter().copied().filter(|(beta, _)| (range[0]..=range[1]).contains(beta)).collect()
    };
    let mut branches = Vec::new();
    for contact in [Contact::Free, Contact::Upper, Contact::Lower] {
        for stable in [true, false] {
            let name = family_name(contact, stable);
            let curves = diagram.series.iter().filter(|(found, _)| *found == name).map(|(_, points)| shown(points));
            let label = name.split(',').next().unwrap_or_default().to_owned();
            // A branch that is met at one β only is a corner of the diagram, not a line.
            let curves = curves.filter(|points| points.len() > 1);
            branches.extend(curves.map(|points| Branch { label: label.clone(), points, stable }));
        }
    }
    let ends: Vec<(f64, f64)> = study.betas.iter().zip(rests).map(|(beta, m)| (*beta, m.value("u_tip"))).collect();
    bifurcation(&Bifurcation {
        title: None,
        x_label: "axial force at rest β (dimensionless)".into(),
        y_label: "tip displacement u(1) (dimensionless)".into(),
        branches,
        obstacles: scene.obstacles.map_or(vec![], |o| {
            vec![Guide { label: "g₁".into(), value: o.g1 }, Guide { label: "g₂".into(), value: o.g2 }]
        }),
        states: vec![Series { label: "end of a run".into(), points: shown(&ends) }],
    })
}

fn quantities(study: &BifurcationStudy, diagrams: &[Measured], forces: &[f64]) -> Vec<Quantity> {
    let mut quantities: Vec<Quantity> = study
        .scenes
        .iter()
        .zip(diagrams)
        .map(|(scene, diagram)| Quantity {
            name: format!("event at θ_A = {}", scene.beam.theta_a),
            value: diagram.value("event_low"),
            tolerance: 1e-8,
        })
        .collect();
    quantities.extend(study.meshes.iter().zip(forces).map(|(n, force)| Quantity {
        name: format!("buckling force, n = {n}"),
        value: *force,
        tolerance: 1e-11,
    }));
    quantities
}
