//! The figures of the paper, redrawn.

use super::{
    OfExperiment,
    plotted::{ENERGY, Plotted, PlottedSeries, U_TIP},
};
use crate::figures;
use crate::studies::paper::OBSTACLES;
use convergence_study::chart::{self, Chart, Guide};

/// The figures of the paper, and the decay of the energy until each run is steady.
///
/// * the experiments without heating, those with it, and that beyond buckling.
pub(super) fn plotted([first, second, third]: [&[OfExperiment<'_>]; 3]) -> Vec<Plotted> {
    let mut plotted = vec![
        energies(first),
        Plotted::new(
            ["figure-3", "Figure 3"],
            displacement("The beam bounces off both obstacles, faster for larger β"),
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
            displacement("Heated, the beam ends on the upper obstacle unless β = 5"),
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
    plotted.extend(beyond_buckling(third));
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
        ..displacement("Beyond buckling, the beam comes to rest bent")
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
    value: |experiment, point| point.energy - experiment.straight_energy(),
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
        value: runs.experiment.straight_energy(),
    }
}

fn energy(title: &str) -> Chart {
    over_time(chart::Axis::linear("energy E (dimensionless)")).titled(title)
}

fn displacement(title: &str) -> Chart {
    Chart {
        guides: figures::obstacle_lines(Some(OBSTACLES)),
        ..over_time(chart::Axis::linear(
            "tip displacement u(1, t) (dimensionless)",
        ))
        .titled(title)
    }
}

fn rotation(title: &str) -> Chart {
    over_time(chart::Axis::linear("tip rotation φ(1, t) (dimensionless)")).titled(title)
}
