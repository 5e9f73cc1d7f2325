//! The claims about all scenes together, the exceptions with their reasons, and a map of where the residuals are.

use super::{ANSWER, BATCH, CLOSED, ENDS, INDEFINITE, LIMIT, NOT_FINITE, RandomScenes};
use crate::kinds::Study;
use crate::kinds::complete::{all_ran, or_nothing};
use crate::kinds::energy::wild;
use crate::kinds::untyped::Measured;
use crate::kinds::watch::of_allowed;
use convergence_study::plots::{self, Axis, ParameterMap, Surface};
use convergence_study::study::CaseFailure;
use convergence_study::study::outcome::{Check, Figure, Outcome, Quantity, Table};
use convergence_study::text::number::max_or_nan;

/// Exceptions listed.
const LISTED: usize = 12;
/// Share of the scenes that may be exceptions.
const RARE: f64 = 2e-3;
/// Cells of the map along either axis.
const CELLS: usize = 14;

pub(super) fn outcome(study: &RandomScenes, results: &[Result<Measured, CaseFailure>]) -> Outcome {
    let cases = study.cases();
    let measured = or_nothing(cases.len(), results);
    let sum = |name: &str| measured.iter().map(|m| m.value(name)).sum::<f64>();
    let worst = |name: &str| measured.iter().map(|m| m.value(name)).fold(f64::NEG_INFINITY, max_or_nan);
    let scenes = (study.batches * BATCH) as f64;
    let mut checks = vec![all_ran(&cases, results)];
    checks.extend(claims(scenes, &sum, &worst));
    let summary = format!(
        "{scenes} scenes, {} steps: {} answers, {} refused as indefinite, no other error; residual at most {:.1e} of the energy, {} above {CLOSED:.0e}",
        sum("steps"),
        sum(ANSWER),
        sum(INDEFINITE),
        worst("residual"),
        sum("exceptions"),
    );
    let headline = format!(
        "{scenes} scenes: {} answers, {} typed errors; largest residual {:.1e} of the energy",
        sum(ANSWER),
        sum(INDEFINITE) + sum(LIMIT) + sum(NOT_FINITE),
        worst("residual"),
    );
    let mut outcome = Outcome { headline, ..Outcome::new(summary, vec![], checks) };
    outcome.tables = vec![counts(&sum), exceptions(study, &measured)];
    outcome.figures = vec![figure(&study.header.id, &measured)];
    outcome.quantities = vec![
        // A scene at the edge of definiteness may fall to either side on another machine.
        Quantity { name: "answers".to_owned(), value: sum(ANSWER), tolerance: 1e-3 },
    ];
    outcome
}

fn claims(scenes: f64, sum: &dyn Fn(&str) -> f64, worst: &dyn Fn(&str) -> f64) -> Vec<Check> {
    let ends: f64 = ENDS.iter().map(|end| sum(end)).sum();
    let (broken, refused, exceptions) = (sum("broken"), sum("refused"), sum("exceptions"));
    let others = sum(LIMIT) + sum(NOT_FINITE);
    let (rise, risen) = (worst("rise"), worst("risen"));
    let (residual, open) = (worst("residual"), worst("open"));
    vec![
        Check::that(
            ends == scenes && broken == 0.0,
            "each scene ends with finite numbers or a typed error",
            format!("{ends} of {scenes} ended, {broken} levels with a number that is not finite"),
        ),
        Check::that(
            refused == 0.0 && others == 0.0,
            "a step is refused for an indefinite operator only, and never where β > -B (1 + 2ζ/dt)",
            format!("{refused} refused without need, {others} other errors"),
        ),
        Check::that(
            risen <= 1.0,
            "the energy never rises by more than rounding errors explain",
            format!("largest rise {rise:.1e} of the energy, {}", of_allowed(risen)),
        ),
        Check::that(
            open <= 1.0,
            "the balance closes to 1e-12 of the energy, or to what rounding errors explain",
            format!("largest residual {residual:.1e} of the energy, {}", of_allowed(open)),
        ),
        Check::that(
            exceptions <= RARE * scenes,
            "exceptions are rare",
            format!("{exceptions} of {scenes} scenes with a residual above 1e-12"),
        ),
    ]
}

fn counts(sum: &dyn Fn(&str) -> f64) -> Table {
    let rows = ENDS.iter().map(|end| vec![(*end).to_owned(), sum(end).to_string()]).collect();
    Table { title: "How the scenes ended".to_owned(), head: vec!["end".to_owned(), "scenes".to_owned()], rows }
}

/// The worst exceptions, each with what rounding errors grow with: dt, the axial stiffness, and short elements.
fn exceptions(study: &RandomScenes, measured: &[Measured]) -> Table {
    let all = measured.iter().flat_map(|m| m.curve("exceptions").iter().copied());
    let mut all: Vec<(f64, f64)> = all.collect();
    all.sort_by(|a, b| b.1.total_cmp(&a.1));
    let row = |(scene, residual): &(f64, f64)| {
        let scene = *scene as usize;
        let elements = scene % BATCH / super::LANES + 1;
        let (problem, dt) = wild(elements, study.seed_of(scene)).ok()?;
        let shortest = problem.mesh.lengths().fold(f64::INFINITY, f64::min);
        Some(vec![
            scene.to_string(),
            study.scheme(scene / BATCH).name.to_owned(),
            elements.to_string(),
            format!("{shortest:.1e}"),
            format!("{dt:.2e}"),
            format!("{:.1e}", problem.beam.beta),
            format!("{:.1e}", problem.beam.rho),
            problem.obstacles.map_or("none".to_owned(), |obstacles| format!("{:.1e}", obstacles.epsilon)),
            format!("{residual:.1e}"),
        ])
    };
    let head = ["scene", "scheme", "elements", "shortest", "dt", "beta", "rho", "epsilon", "residual"];
    Table {
        title: "Largest residuals above 1e-12: long steps (Δu as large as u) over short elements (u/h cancels)"
            .to_owned(),
        head: head.map(str::to_owned).to_vec(),
        rows: all.iter().take(LISTED).filter_map(row).collect(),
    }
}

/// The largest residual in each cell of (dt, shortest element).
fn figure(id: &str, measured: &[Measured]) -> Figure {
    let (dt_range, h_range) = ([-6.0, 1.0], [-4.0, 0.0]);
    let index = |[low, high]: [f64; 2], value: f64| {
        let at = (value.log10() - low) / (high - low) * CELLS as f64;
        (at >= 0.0).then(|| (at as usize).min(CELLS - 1))
    };
    let centres = |[low, high]: [f64; 2]| {
        let centre = |k: usize| 10f64.powf(low + (high - low) * (k as f64 + 0.5) / CELLS as f64);
        (0..CELLS).map(centre).collect::<Vec<f64>>()
    };
    let mut values = vec![vec![f64::NAN; CELLS]; CELLS];
    for m in measured {
        for ((dt, residual), (h, _)) in m.curve("over dt").iter().zip(m.curve("over h")) {
            let (Some(column), Some(row)) = (index(dt_range, *dt), index(h_range, *h)) else { continue };
            let cell = &mut values[row][column];
            // A residual of exactly zero has no place on a logarithmic scale.
            let residual = residual.max(1e-18);
            *cell = if cell.is_nan() { residual } else { max_or_nan(*cell, residual) };
        }
    }
    let marked = values.iter().map(|row| row.iter().map(|value| value.is_nan()).collect()).collect();
    let cells = Surface {
        title: None,
        x: Axis::log("time step dt (dimensionless)"),
        y: Axis::log("shortest element (dimensionless)"),
        z: Axis::log("largest residual / energy"),
        x_values: centres(dt_range),
        y_values: centres(h_range),
        values,
    };
    let map = ParameterMap { cells, marked, marked_label: "no scene".to_owned(), boundaries: vec![] };
    let caption = "Largest residual of the energy balance in a step of the random scenes, in units of the energy: round-off grows with the step and with short elements.";
    Figure { file: format!("{id}-residuals.svg"), caption: caption.to_owned(), svg: plots::parameter_map(&map) }
}
