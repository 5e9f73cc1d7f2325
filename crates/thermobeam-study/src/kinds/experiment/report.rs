//! Tables, figures and guarded numbers.

use super::log::straight_energy;
use super::{Experiment, Experiments, Group, motion, of_group, resting, summary};
use crate::kinds::untyped::Measured;
use convergence_study::plots::{Axis, Guide, History, Series, history};
use convergence_study::study::outcome::{Check, Figure, Outcome, Quantity, Table};

/// Relative change of a number that depends smoothly on the data: far above round-off, far below a change of the method.
const SMOOTH: f64 = 1e-6;

/// The same where many bounces lie between the data and the number: each magnifies a perturbation.
const AFTER_BOUNCES: f64 = 1e-4;

pub(super) fn outcome(study: &Experiments, runs: &[Measured], rests: &[Measured], checks: Vec<Check>) -> Outcome {
    Outcome {
        tables: vec![table(study, runs), resting::table(&study.betas, rests)],
        figures: figures(study, runs),
        quantities: quantities(study, runs),
        headline: summary(&checks),
        ..Outcome::new(summary(&checks), vec![], checks)
    }
}

fn table(study: &Experiments, runs: &[Measured]) -> Table {
    let head = [
        "θ_A",
        "β",
        "first contact above",
        "below",
        "frequency of u(1)",
        "range of φ(1)",
        "steady by t",
        "E at the end",
        "u(1)",
        "φ(1)",
    ];
    let row = |(experiment, m): (&Experiment, &Measured)| {
        let number = |name: &str| m.value(name);
        vec![
            format!("{}", experiment.scene.beam.theta_a),
            format!("{}", experiment.scene.beam.beta),
            format!("{:.4}", number("first_upper")),
            format!("{:.4}", number("first_lower")),
            format!("{:.4}", number("frequency")),
            format!("{:.4}", number("phi_amplitude")),
            format!("{:.0}", number("t_steady")),
            format!("{:.8}", number("energy")),
            format!("{:.3e}", number("u_tip")),
            format!("{:.3e}", number("phi_tip")),
        ]
    };
    Table {
        title: "The seven experiments".into(),
        head: head.map(String::from).to_vec(),
        rows: study.experiments.iter().zip(runs).map(row).collect(),
    }
}

fn quantities(study: &Experiments, runs: &[Measured]) -> Vec<Quantity> {
    let mut quantities = Vec::new();
    for (experiment, m) in study.experiments.iter().zip(runs) {
        let mut guard = |name: &str, tolerance: f64| {
            let full = format!("{}: {name}", experiment.scene.name);
            quantities.push(Quantity { name: full, value: m.value(name), tolerance });
        };
        guard("first_upper", SMOOTH);
        guard("first_lower", AFTER_BOUNCES);
        guard("frequency", AFTER_BOUNCES);
        guard("phi_amplitude", AFTER_BOUNCES);
        // Where the end is zero its digits are those of the last of the motion.
        if experiment.group != Group::First {
            guard("energy", SMOOTH);
            guard("exact_u_tip", SMOOTH);
        }
    }
    quantities
}

fn figures(study: &Experiments, runs: &[Measured]) -> Vec<Figure> {
    let first: Vec<_> = of_group(study, runs, |group| group == Group::First).collect();
    let second: Vec<_> = of_group(study, runs, |group| matches!(group, Group::Second(_))).collect();
    let third: Vec<_> = of_group(study, runs, |group| group == Group::Third).collect();
    let figure = |what: &str, caption: &str, svg: String| Figure {
        file: format!("{}-{what}.svg", study.header.id),
        caption: caption.into(),
        svg,
    };
    // The middle one moves without axial force at rest.
    let beam = first.get(first.len() / 2).map(|(experiment, run)| {
        let caption =
            format!("The experiment at {}, θ_A = 0, in motion up to t = {}.", beta_label(experiment), motion::SPAN);
        figure("beam", &caption, motion::draw(experiment, run))
    });
    let drawn = vec![
        figure(
            "figure-2",
            "Figure 2 of the paper: the energy for three β, θ_A = 0, and its limits β²/(4ρ), labelled.",
            energy(&first, Span::Figure),
        ),
        figure("figure-3", "Figure 3: displacement of the free end, θ_A = 0.", displacement(&first)),
        figure("figure-4", "Figure 4: rotation of the free end, θ_A = 0.", rotation(&first)),
        figure("figure-5", "Figure 5: displacement of the free end, θ_A = 20.", displacement(&second)),
        figure("figure-6", "Figure 6: rotation of the free end, θ_A = 20.", rotation(&second)),
        figure(
            "figure-7-energy",
            "Figure 7, left: the energy beyond buckling, until steady; the line is β²/(4ρ), which the bent beam falls below.",
            energy(&third, Span::UntilSteady),
        ),
        figure(
            "figure-7-tip",
            "Figure 7, right: displacement and rotation of the free end beyond buckling, until steady: the beam comes to rest bent.",
            tip(&third),
        ),
        figure("decay", "Energy above that of the straight beam until each run is steady, θ_A = 0.", decay(&first)),
    ];
    beam.into_iter().chain(drawn).collect()
}

/// How much of the runs a figure shows.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Span {
    /// The scene's t_end, as in the paper.
    Figure,
    /// All of it.
    UntilSteady,
}

type Runs<'a> = [(&'a Experiment, &'a Measured)];

fn beta_label(experiment: &Experiment) -> String {
    // A minus sign, not a hyphen.
    format!("β = {}", experiment.scene.beam.beta).replace('-', "−")
}

/// The curves of that name, over the figures' span or until the runs are steady.
fn series(runs: &Runs<'_>, name: &str, span: Span) -> Vec<Series> {
    let curve = |(e, m): &(&Experiment, &Measured)| {
        let end = if span == Span::Figure { e.scene.t_end + 0.5 * e.scene.dt } else { f64::INFINITY };
        let points = m.curve(name).iter().copied().filter(|(t, _)| *t <= end).collect();
        Series { label: beta_label(e), points }
    };
    runs.iter().map(curve).collect()
}

fn obstacles(runs: &Runs<'_>) -> Vec<Guide> {
    let obstacles = runs.first().and_then(|(e, _)| e.scene.obstacles);
    obstacles
        .map_or(vec![], |o| vec![Guide { label: "g₁".into(), value: o.g1 }, Guide { label: "g₂".into(), value: o.g2 }])
}

fn energy(runs: &Runs<'_>, span: Span) -> String {
    let limit = |(e, _): &(&Experiment, &Measured)| {
        let value = straight_energy(&e.scene);
        Guide { label: format!("{value:.4}").trim_end_matches('0').trim_end_matches('.').to_owned(), value }
    };
    history(&History {
        y: Axis::linear("energy E (dimensionless)"),
        series: series(runs, "energy", span),
        guides: runs.iter().map(limit).collect(),
        ..History::default()
    })
}

fn decay(runs: &Runs<'_>) -> String {
    let mut series = series(runs, "energy", Span::UntilSteady);
    for (series, (e, _)) in series.iter_mut().zip(runs) {
        series.points.iter_mut().for_each(|(_, energy)| *energy -= straight_energy(&e.scene));
    }
    history(&History { y: Axis::log("E − β²/(4ρ) (dimensionless)"), series, ..History::default() })
}

fn displacement(runs: &Runs<'_>) -> String {
    history(&History {
        y: Axis::linear("tip displacement u(1, t) (dimensionless)"),
        series: series(runs, "u_tip", Span::Figure),
        guides: obstacles(runs),
        ..History::default()
    })
}

fn rotation(runs: &Runs<'_>) -> String {
    history(&History {
        y: Axis::linear("tip rotation φ(1, t) (dimensionless)"),
        series: series(runs, "phi_tip", Span::Figure),
        ..History::default()
    })
}

fn tip(runs: &Runs<'_>) -> String {
    let curve = |label: &str, name: &str| {
        let points = runs.first().map_or(vec![], |(_, m)| m.curve(name).to_vec());
        Series { label: label.into(), points }
    };
    history(&History {
        y: Axis::linear("u(1, t) and φ(1, t) (dimensionless)"),
        series: vec![curve("displacement u(1, t)", "u_tip"), curve("rotation φ(1, t)", "phi_tip")],
        guides: obstacles(runs),
        ..History::default()
    })
}
