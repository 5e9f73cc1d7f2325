//! Tables, figures and guarded numbers.

use super::judge::{self, OfGroup};
use super::{Experiment, Experiments, Found, Measured, SPAN, SectionGroup, straight_energy};
use crate::kinds::prelude::*;

/// Duration of one cycle of the animation in seconds: slower than the beam, so that the impacts can be followed.
const SECONDS: f64 = 16.0;

pub(super) fn outcome(study: &Experiments, ran: &[Ran<usize, Found>]) -> Outcome {
    let rests = judge::rests(study, ran);
    let checks = judge::checks(study, ran, &rests);
    let headline = headline(&checks);
    let row = |(experiment, run): &(&Experiment, &Measured)| {
        let Scene { name, beam, .. } = &experiment.scene;
        let bent = experiment.group != SectionGroup::First;
        (
            vec![beam.theta_a.to_string(), beam.beta.to_string()],
            run.readings(name, bent),
        )
    };
    let runs: Vec<_> = OfGroup::of(study, ran, |_| true)
        .runs
        .iter()
        .map(row)
        .collect();
    let rests: Vec<_> = rests
        .iter()
        .map(|(beta, rest)| (vec![beta.to_string()], rest.readings()))
        .collect();
    let title = "Steady states without heating, and where the moving beam comes to rest";
    Outcome {
        tables: vec![
            readings::table("The seven experiments", &["θ_A", "β"], &runs),
            readings::table(title, &["β"], &rests),
        ],
        figures: figures(study, ran),
        quantities: readings::guarded(runs.iter().flat_map(|(_, readings)| readings)),
        headline: headline.clone(),
        ..Outcome::new(headline, vec![], checks)
    }
}

/// How many statements hold: the paper's as printed, what holds in place of one that does not, and ours. That every case
/// completes is no statement.
fn headline(checks: &[Check]) -> String {
    let count = |origin: Origin| checks.iter().filter(|check| check.origin == origin).count();
    let holding = |origin: Origin| {
        checks
            .iter()
            .filter(|check| check.origin == origin && check.verdict == Verdict::Pass)
            .count()
    };
    let [printed, refuted, own] = [Origin::Source, Origin::Correction, Origin::Own].map(holding);
    let all = count(Origin::Source) + count(Origin::Correction);
    let refutation = if refuted == 0 {
        "the last is not decided".to_owned()
    } else {
        format!(
            "{refuted} is refuted: several steady states for β < -1/2, where there are several only for β < {:.4}",
            -BUCKLING
        )
    };
    format!(
        "the paper's {all} statements: {printed} hold as printed, {refutation}; {own} of {} of ours hold",
        count(Origin::Own)
    )
}

fn figures(study: &Experiments, ran: &[Ran<usize, Found>]) -> Vec<Figure> {
    let first = OfGroup::of(study, ran, |group| group == SectionGroup::First).runs;
    let second = OfGroup::of(study, ran, |group| matches!(group, SectionGroup::Second(_))).runs;
    let third = OfGroup::of(study, ran, |group| group == SectionGroup::Third).runs;
    // The middle one has no axial force at rest.
    let beam = first.get(first.len() / 2).map(|(experiment, run)| {
        let caption = format!(
            "The experiment at {}, θ_A = 0, in motion up to t = {SPAN}.",
            beta_label(experiment)
        );
        let svg = figures::animation(&figures::Animation {
            title: Some("The beam between its obstacles".to_owned()),
            frames: run.frames.clone(),
            obstacles: experiment
                .scene
                .obstacles
                .map(|obstacles| (obstacles.g1, obstacles.g2)),
            seconds: SECONDS,
        });
        Figure::new("beam", caption, svg)
    });
    let above =
        |experiment: &Experiment, point: &Sample| point.energy - straight_energy(&experiment.scene);
    let decay = plots::Axis::log("E − β²/(4ρ) (dimensionless)");
    let of_energy =
        "Figure 2 of the paper: the energy for three β, θ_A = 0, and its limits β²/(4ρ), labelled.";
    let falls = "the energy beyond buckling, until steady; the line is β²/(4ρ), which the bent beam falls below.";
    let bends = "displacement and rotation of the free end beyond buckling, until steady: the beam comes to rest bent.";
    let [left, right] = [
        format!("Figure 7, left: {falls}"),
        format!("Figure 7, right: {bends}"),
    ];
    let decays = "Energy above that of the straight beam until each run is steady, θ_A = 0.";
    let drawn = [
        ("figure-2", of_energy, energy(&first, false)),
        (
            "figure-3",
            "Figure 3: displacement of the free end, θ_A = 0.",
            displacement(&first),
        ),
        (
            "figure-4",
            "Figure 4: rotation of the free end, θ_A = 0.",
            rotation(&first),
        ),
        (
            "figure-5",
            "Figure 5: displacement of the free end, θ_A = 20.",
            displacement(&second),
        ),
        (
            "figure-6",
            "Figure 6: rotation of the free end, θ_A = 20.",
            rotation(&second),
        ),
        ("figure-7-energy", &left, energy(&third, true)),
        ("figure-7-tip", &right, tip(&third)),
        ("decay", decays, curves(&first, decay, true, above)),
    ];
    beam.into_iter()
        .chain(drawn.map(|(what, caption, history)| Figure::new(what, caption, history.draw())))
        .collect()
}

fn beta_label(experiment: &Experiment) -> String {
    // A minus sign, not a hyphen.
    format!("β = {}", experiment.scene.beam.beta).replace('-', "−")
}

fn obstacles(runs: &[(&Experiment, &Measured)]) -> Vec<plots::Guide> {
    figures::obstacle_lines(
        runs.first()
            .and_then(|(experiment, _)| experiment.scene.obstacles),
    )
}

/// A curve for each run, with the look of its scene.
///
/// * `until_steady`: whether the whole curve is shown; otherwise it ends at the scene's t_end, as in the paper.
fn curves(
    runs: &[(&Experiment, &Measured)],
    y: plots::Axis,
    until_steady: bool,
    value: impl Fn(&Experiment, &Sample) -> f64,
) -> Xy {
    let curve = |(experiment, run): &(&Experiment, &Measured)| {
        let scene = &experiment.scene;
        let end = if until_steady {
            f64::INFINITY
        } else {
            scene.t_end + 0.5 * scene.dt()
        };
        let shown = run.points.iter().filter(|point| point.t <= end);
        plots::Series::new(
            beta_label(experiment),
            shown.map(|point| (point.t, value(experiment, point))),
        )
    };
    let looks = figures::looks(runs.iter().map(|(experiment, _)| &*experiment.scene.name));
    plots::history(y, &runs.iter().map(curve).collect::<Vec<_>>()).with_looks(&looks)
}

fn energy(runs: &[(&Experiment, &Measured)], until_steady: bool) -> Xy {
    let limit = |(e, _): &(&Experiment, &Measured)| {
        let value = straight_energy(&e.scene);
        let label = format!("{value:.4}")
            .trim_end_matches('0')
            .trim_end_matches('.')
            .to_owned();
        plots::Guide { label, value }
    };
    let y = plots::Axis::linear("energy E (dimensionless)");
    Xy {
        guides: runs.iter().map(limit).collect(),
        ..curves(runs, y, until_steady, |_, point| point.energy)
    }
}

fn displacement(runs: &[(&Experiment, &Measured)]) -> Xy {
    let y = plots::Axis::linear("tip displacement u(1, t) (dimensionless)");
    Xy {
        guides: obstacles(runs),
        ..curves(runs, y, false, |_, point| point.u_tip)
    }
}

fn rotation(runs: &[(&Experiment, &Measured)]) -> Xy {
    curves(
        runs,
        plots::Axis::linear("tip rotation φ(1, t) (dimensionless)"),
        false,
        |_, point| point.phi_tip,
    )
}

fn tip(runs: &[(&Experiment, &Measured)]) -> Xy {
    let curve = |label: &str, value: fn(&Sample) -> f64| {
        let points = runs.first().into_iter().flat_map(|(_, run)| &run.points);
        plots::Series::new(label, points.map(|point| (point.t, value(point))))
    };
    let series = [
        curve("displacement u(1, t)", |point| point.u_tip),
        curve("rotation φ(1, t)", |point| point.phi_tip),
    ];
    let y = plots::Axis::linear("u(1, t) and φ(1, t) (dimensionless)");
    Xy {
        guides: obstacles(runs),
        ..plots::history(y, &series)
    }
}
