//! How the scenes ended, the largest residuals, and a map of the residuals.

use convergence_study::plots::{self, Axis, ParameterMap, Surface};
use convergence_study::study::{Figure, Table};
use convergence_study::text::number::max_or_nan;

use super::{BATCH, Batch, End, Ends, Exception, RandomScenes, Scene};

/// Exceptions listed.
const LISTED: usize = 12;
/// Cells of the map along either axis.
const CELLS: usize = 14;
/// Powers of ten that the map spans: time steps, shortest elements.
const DT: [f64; 2] = [-6.0, 1.0];
const SHORTEST: [f64; 2] = [-4.0, 0.0];
/// The residual drawn in place of zero, which a logarithmic scale does not have.
const ZERO: f64 = 1e-18;

pub(super) fn counts(ends: &Ends) -> Table {
    let row = |end: End, count: usize| vec![end.name().to_owned(), count.to_string()];
    Table {
        title: "How the scenes ended".to_owned(),
        head: vec!["end".to_owned(), "scenes".to_owned()],
        rows: vec![
            row(End::Answer, ends.answers),
            row(End::Indefinite, ends.indefinite),
            row(End::IterationLimit, ends.iteration_limit),
            row(End::NotFinite, ends.not_finite),
        ],
    }
}

/// The largest residuals, each with what rounding errors grow with: dt, the axial stiffness, and short elements.
pub(super) fn exceptions(study: &RandomScenes, batches: &[&Batch]) -> Table {
    let mut all: Vec<Exception> = batches.iter().flat_map(|batch| batch.largest.iter().copied()).collect();
    all.sort_by(|a, b| b.residual.total_cmp(&a.residual));
    let row = |&Exception { scene, residual }: &Exception| {
        let (problem, dt) = study.problem(scene).ok()?;
        let shortest = problem.mesh.lengths().fold(f64::INFINITY, f64::min);
        Some(vec![
            scene.to_string(),
            study.scheme(scene / BATCH).name.to_owned(),
            problem.mesh.elements().to_string(),
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
pub(super) fn figure(id: &str, batches: &[&Batch]) -> Figure {
    let values = cells(batches.iter().flat_map(|batch| &batch.scenes));
    let marked = values.iter().map(|row| row.iter().map(|value| value.is_nan()).collect()).collect();
    let cells = Surface {
        title: None,
        x: Axis::log("time step dt"),
        y: Axis::log("shortest element (dimensionless)"),
        z: Axis::log("largest residual / energy"),
        x_values: centres(DT),
        y_values: centres(SHORTEST),
        values,
    };
    let map = ParameterMap { cells, marked, marked_label: "no scene".to_owned(), boundaries: vec![] };
    let caption = "Largest residual of the energy balance in a step of the random scenes, in units of the energy: round-off \
                   grows with the step and with short elements.";
    Figure { file: format!("{id}-residuals.svg"), caption: caption.to_owned(), svg: plots::parameter_map(&map) }
}

/// NaN where there is no scene.
fn cells<'b>(scenes: impl Iterator<Item = &'b Scene>) -> Vec<Vec<f64>> {
    let mut values = vec![vec![f64::NAN; CELLS]; CELLS];
    for scene in scenes {
        let (Some(column), Some(row)) = (index(DT, scene.dt), index(SHORTEST, scene.shortest)) else { continue };
        let cell = &mut values[row][column];
        let residual = max_or_nan(scene.residual, ZERO);
        *cell = if cell.is_nan() { residual } else { max_or_nan(*cell, residual) };
    }
    values
}

/// The cell of a value along an axis.
fn index([low, high]: [f64; 2], value: f64) -> Option<usize> {
    let at = (value.log10() - low) / (high - low) * CELLS as f64;
    (at >= 0.0).then(|| (at as usize).min(CELLS - 1))
}

fn centres([low, high]: [f64; 2]) -> Vec<f64> {
    let centre = |k: usize| 10f64.powf(low + (high - low) * (k as f64 + 0.5) / CELLS as f64);
    (0..CELLS).map(centre).collect()
}
