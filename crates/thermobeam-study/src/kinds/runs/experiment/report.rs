//! Tables, figures and guarded numbers.

use super::{
    Experiments,
    group::{OfExperiment, SectionFive},
    judge,
    plotted::{ENERGY, Plotted, PlottedSeries, U_TIP},
    straight_energy,
};
use crate::kinds::prelude::*;
use crate::{
    figures,
    kinds::runs::{Findings, Listing},
};
use convergence_study::{
    Origin,
    internal::chart::{self, Chart, Guide},
};
use thermobeam::{kirchhoff::BUCKLING, parameters::Beam};

pub(super) fn findings(study: &Experiments, runs: &SectionFive<'_>) -> Findings {
    let plotted = plotted(runs);
    let checks = judge::checks(study, runs, &plotted);
    let headline = headline(&checks);
    let all = &runs.all.runs;
    let rests = runs
        .rests
        .iter()
        .map(|(beta, rest)| (vec![beta.to_string()], rest.readings()));
    let rows = all.iter().map(|runs| (names_of(runs), runs.readings()));
    let title = "Steady states without heating, and where the moving beam comes to rest";
    let mut listings = vec![
        Listing::of("The seven experiments", &["θ_A", "β"], rows),
        Listing::of(title, &["β"], rests),
    ];
    if let Some(tolerance) = study.fixed_point {
        let title = format!(
            "The paper's algorithm (4.1)-(4.5), η* = {tolerance:e} in the norm of (3.14), and Newton's method beside it"
        );
        let rows = all.iter().filter_map(|runs| {
            let paper = runs.paper?;
            Some((names_of(runs), paper.readings(runs.name())))
        });
        listings.push(Listing::of(title, &["θ_A", "β"], rows));
    }
    let drawn = plotted.iter().map(|plot| {
        let title = &plot.chart.title;
        let caption = format!("{}: {title}. {}.", plot.name, plot.accuracy().join(". "));
        Figure::new(plot.what, caption, plot.draw())
    });
    Findings {
        summary: headline.clone(),
        headline,
        checks,
        listings,
        figures: drawn.collect(),
        ..Findings::default()
    }
}

fn names_of(runs: &OfExperiment<'_>) -> Vec<String> {
    let Beam { theta_a, beta, .. } = runs.beam();
    vec![theta_a.to_string(), beta.to_string()]
}

/// How many statements hold: the paper's as printed, what holds in place of one that does not, and
/// ours. That every case completes is no statement.
fn headline(checks: &[Check]) -> String {
    let printed = Tally::of(checks, Origin::Source);
    let corrected = Tally::of(checks, Origin::Correction);
    let own = Tally::of(checks, Origin::Own);
    let of_the_last = if corrected.holding == 0 {
        "the last is not decided".to_owned()
    } else {
        format!(
            "{} has a threshold that is not sharp: several steady states for β < -1/2, where it is -B = -π²/4 / (1 + π²/4) = {:.4} for θ_A = 0",
            corrected.holding, -BUCKLING
        )
    };
    format!(
        "the paper's {} statements: {} hold as printed, {of_the_last}; {} of {} of ours hold",
        printed.count + corrected.count,
        printed.holding,
        own.holding,
        own.count
    )
}

/// Statements of one origin.
struct Tally {
    count: usize,
    holding: usize,
}

impl Tally {
    fn of(checks: &[Check], origin: Origin) -> Self {
        let own = checks.iter().filter(|check| check.origin == origin);
        Self {
            count: own.clone().count(),
            holding: own.filter(|check| check.verdict == Verdict::Pass).count(),
        }
    }
}

/// The figures of the paper, and the decay of the energy until each run is steady.
fn plotted(runs: &SectionFive<'_>) -> Vec<Plotted> {
    let first = &runs.first.runs;
    let second = &runs.second.runs;
    let mut plotted = vec![
        energies(first),
        Plotted::new(
            ["figure-3", "Figure 3"],
            displacement(
                first,
                "The beam bounces off both obstacles, faster for larger β",
            ),
            first,
            &[U_TIP],
        ),
        Plotted::new(
            ["figure-4", "Figure 4"],
            rotation("The free end turns most for β = −0.5"),
            first,
            &[PHI_TIP],
        ),
        Plotted::new(
            ["figure-5", "Figure 5"],
            displacement(
                second,
                "Heated, the beam ends on the upper obstacle unless β = 5",
            ),
            second,
            &[U_TIP],
        ),
        Plotted::new(
            ["figure-6", "Figure 6"],
            rotation("Heated, the free end keeps a rotation"),
            second,
            &[PHI_TIP],
        ),
    ];
    plotted.extend(beyond_buckling(&runs.third.runs));
    plotted.push(decay(first));
    plotted
}

/// Figure 2. Two of its limits lie too close together for labels: the panel below shows the
/// distance to each.
fn energies(runs: &[OfExperiment<'_>]) -> Plotted {
    let below = over_time(chart::Axis::log("E − β²/(4ρ)"));
    let chart = energy("Without heating, the energy falls to its limit β²/(4ρ)");
    let below = below.titled("Its distance to that limit");
    Plotted::new(["figure-2", "Figure 2"], chart, runs, &[ENERGY]).above(Plotted::new(
        ["", ""],
        below,
        runs,
        &[EXCESS],
    ))
}

/// Both parts of Figure 7.
fn beyond_buckling(runs: &[OfExperiment<'_>]) -> [Plotted; 2] {
    let whole = PlottedSeries {
        until_steady: true,
        ..ENERGY
    };
    let guides: Vec<Guide> = runs.iter().map(straight).collect();
    let energy = Chart {
        guides: guides.clone(),
        ..energy("Beyond buckling, the energy falls below β²/(4ρ)")
    };
    let late = Chart {
        guides,
        ..over_time(chart::Axis::linear("energy E")).titled("The same, enlarged")
    };
    let late = Plotted::new(["", ""], late, runs, &[LATE]);
    let tip = Chart {
        y: chart::Axis::linear("u(1, t) and φ(1, t) (dimensionless)"),
        ..displacement(runs, "Beyond buckling, the beam comes to rest bent")
    };
    [
        Plotted::new(
            ["figure-7-energy", "Figure 7, left"],
            energy,
            runs,
            &[whole],
        )
        .above(late),
        Plotted::new(["figure-7-tip", "Figure 7, right"], tip, runs, &TIP),
    ]
}

fn decay(runs: &[OfExperiment<'_>]) -> Plotted {
    let excess = PlottedSeries {
        until_steady: true,
        ..EXCESS
    };
    let chart = over_time(chart::Axis::log("E − β²/(4ρ) (dimensionless)"))
        .titled("Without heating, the energy of the straight beam is reached");
    let name = "Figure 2 until the beams are steady";
    Plotted::new(["decay", name], chart, runs, &[excess])
}

/// The energy when it is close to its limit.
const LATE: PlottedSeries = PlottedSeries {
    from: 7.0,
    until_steady: true,
    ..ENERGY
};

/// The energy above that of the straight beam.
const EXCESS: PlottedSeries = PlottedSeries {
    value: |experiment, point| point.energy - straight_energy(&experiment.scene),
    ..ENERGY
};

const PHI_TIP: PlottedSeries = PlottedSeries {
    value: |_, point| point.phi_tip,
    ..ENERGY
};

/// Both in one figure, until steady.
const TIP: [PlottedSeries; 2] = [
    PlottedSeries {
        label: Some("displacement u(1, t)"),
        until_steady: true,
        ..U_TIP
    },
    PlottedSeries {
        label: Some("rotation φ(1, t)"),
        until_steady: true,
        ..PHI_TIP
    },
];

fn over_time(y: chart::Axis) -> Chart {
    Chart::empty(chart::Axis::linear("time t"), y)
}

/// The energy of the straight beam.
fn straight(runs: &OfExperiment<'_>) -> Guide {
    Guide {
        label: "β²/(4ρ)".to_owned(),
        value: straight_energy(&runs.experiment.scene),
    }
}

fn energy(title: &str) -> Chart {
    over_time(chart::Axis::linear("energy E (dimensionless)")).titled(title)
}

fn displacement(runs: &[OfExperiment<'_>], title: &str) -> Chart {
    let scene = runs.first().map(|runs| &runs.experiment.scene);
    Chart {
        guides: figures::obstacle_lines(scene.and_then(|scene| scene.obstacles)),
        ..over_time(chart::Axis::linear(
            "tip displacement u(1, t) (dimensionless)",
        ))
        .titled(title)
    }
}

fn rotation(title: &str) -> Chart {
    over_time(chart::Axis::linear("tip rotation φ(1, t) (dimensionless)")).titled(title)
}
