//! Tables, figures and guarded numbers.

use convergence_study::plots::{Axis, Guide, History, Series, history};
use convergence_study::study::{Check, Figure, Outcome, Quantity, Ran, Table};

use super::judge::{Runs, summary};
use super::rest::Rests;
use super::run::straight_energy;
use super::{Experiment, Experiments, Found, Group, Point, Run, Task, motion, rest};

/// Relative change of a number that depends smoothly on the data: far above round-off, far below a change of the method.
const SMOOTH: f64 = 1e-6;

/// The same where many bounces lie between the data and the number: each magnifies a perturbation.
const AFTER_BOUNCES: f64 = 1e-4;

pub(super) fn outcome(study: &Experiments, ran: &[Ran<Task, Found>], rests: &Rests<'_>, checks: Vec<Check>) -> Outcome {
    let all = Runs::of(study, ran, |_| true).runs;
    Outcome {
        tables: vec![table(&all), rest::table(rests)],
        figures: figures(study, ran),
        quantities: quantities(&all),
        headline: summary(&checks),
        ..Outcome::new(summary(&checks), vec![], checks)
    }
}

type Each<'r> = [(&'r Experiment, &'r Run)];

/// A time that need not be.
pub(super) fn time(t: Option<f64>) -> String {
    t.map_or_else(|| "never".to_owned(), |t| format!("t = {t:.4}"))
}

fn table(runs: &Each<'_>) -> Table {
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
    let number = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), |value| format!("{value:.4}"));
    let row = |(experiment, run): &(&Experiment, &Run)| {
        vec![
            format!("{}", experiment.scene.beam.theta_a),
            format!("{}", experiment.scene.beam.beta),
            number(run.first_upper),
            number(run.first_lower),
            number(run.frequency),
            format!("{:.4}", run.phi_amplitude),
            format!("{:.0}", run.t_steady),
            format!("{:.8}", run.energy),
            format!("{:.3e}", run.u_tip),
            format!("{:.3e}", run.phi_tip),
        ]
    };
    Table {
        title: "The seven experiments".into(),
        head: head.map(String::from).to_vec(),
        rows: runs.iter().map(row).collect(),
    }
}

fn quantities(runs: &Each<'_>) -> Vec<Quantity> {
    let mut quantities = Vec::new();
    for (experiment, run) in runs {
        let mut guard = |name: &str, value: Option<f64>, tolerance: f64| {
            let name = format!("{}: {name}", experiment.scene.name);
            quantities.push(Quantity { name, value: value.unwrap_or(f64::NAN), tolerance });
        };
        guard("first_upper", run.first_upper, SMOOTH);
        guard("first_lower", run.first_lower, AFTER_BOUNCES);
        guard("frequency", run.frequency, AFTER_BOUNCES);
        guard("phi_amplitude", Some(run.phi_amplitude), AFTER_BOUNCES);
        // Where the end is zero its digits are those of the last of the motion.
        if experiment.group != Group::First {
            guard("energy", Some(run.energy), SMOOTH);
            guard("exact_u_tip", run.nearest.map(|nearest| nearest.state.u_tip), SMOOTH);
        }
    }
    quantities
}

fn figures(study: &Experiments, ran: &[Ran<Task, Found>]) -> Vec<Figure> {
    let first = Runs::of(study, ran, |group| group == Group::First).runs;
    let second = Runs::of(study, ran, |group| matches!(group, Group::Second(_))).runs;
    let third = Runs::of(study, ran, |group| group == Group::Third).runs;
    let figure = |what: &str, caption: &str, svg: String| Figure {
        file: format!("{}-{what}.svg", study.header.id),
        caption: caption.into(),
        svg,
    };
    // The middle one moves without axial force at rest.
    let beam = first.get(first.len() / 2).map(|(experiment, run)| {
        let caption =
            format!("The experiment at {}, θ_A = 0, in motion up to t = {}.", beta_label(experiment), motion::SPAN);
        figure("beam", &caption, motion::draw(&experiment.scene, &run.frames))
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

fn beta_label(experiment: &Experiment) -> String {
    // A minus sign, not a hyphen.
    format!("β = {}", experiment.scene.beam.beta).replace('-', "−")
}

/// One curve for each run, over the figures' span or until the runs are steady.
fn series(runs: &Each<'_>, span: Span, value: impl Fn(&Experiment, &Point) -> f64) -> Vec<Series> {
    let curve = |(experiment, run): &(&Experiment, &Run)| {
        let scene = &experiment.scene;
        let end = if span == Span::Figure { scene.t_end + 0.5 * scene.dt() } else { f64::INFINITY };
        let shown = run.points.iter().filter(|point| point.t <= end);
        Series {
            label: beta_label(experiment),
            points: shown.map(|point| (point.t, value(experiment, point))).collect(),
        }
    };
    runs.iter().map(curve).collect()
}

fn looks(runs: &Each<'_>) -> Vec<usize> {
    crate::figures::looks(runs.iter().map(|(experiment, _)| &*experiment.scene.name))
}

fn obstacles(runs: &Each<'_>) -> Vec<Guide> {
    let obstacles = runs.first().and_then(|(e, _)| e.scene.obstacles);
    obstacles
        .map_or(vec![], |o| vec![Guide { label: "g₁".into(), value: o.g1 }, Guide { label: "g₂".into(), value: o.g2 }])
}

fn energy(runs: &Each<'_>, span: Span) -> String {
    let limit = |(e, _): &(&Experiment, &Run)| {
        let value = straight_energy(&e.scene);
        Guide { label: format!("{value:.4}").trim_end_matches('0').trim_end_matches('.').to_owned(), value }
    };
    history(&History {
        y: Axis::linear("energy E (dimensionless)"),
        series: series(runs, span, |_, point| point.energy),
        looks: looks(runs),
        guides: runs.iter().map(limit).collect(),
        ..History::default()
    })
}

fn decay(runs: &Each<'_>) -> String {
    let series = series(runs, Span::UntilSteady, |experiment, point| point.energy - straight_energy(&experiment.scene));
    history(&History {
        y: Axis::log("E − β²/(4ρ) (dimensionless)"), series, looks: looks(runs), ..History::default()
    })
}

fn displacement(runs: &Each<'_>) -> String {
    history(&History {
        y: Axis::linear("tip displacement u(1, t) (dimensionless)"),
        series: series(runs, Span::Figure, |_, point| point.u_tip),
        looks: looks(runs),
        guides: obstacles(runs),
        ..History::default()
    })
}

fn rotation(runs: &Each<'_>) -> String {
    history(&History {
        y: Axis::linear("tip rotation φ(1, t) (dimensionless)"),
        series: series(runs, Span::Figure, |_, point| point.phi_tip),
        looks: looks(runs),
        ..History::default()
    })
}

fn tip(runs: &Each<'_>) -> String {
    let curve = |label: &str, value: fn(&Point) -> f64| {
        let points = runs.first().map_or(&[][..], |(_, run)| &run.points);
        Series { label: label.into(), points: points.iter().map(|point| (point.t, value(point))).collect() }
    };
    history(&History {
        y: Axis::linear("u(1, t) and φ(1, t) (dimensionless)"),
        series: vec![
            curve("displacement u(1, t)", |point| point.u_tip),
            curve("rotation φ(1, t)", |point| point.phi_tip),
        ],
        guides: obstacles(runs),
        ..History::default()
    })
}
