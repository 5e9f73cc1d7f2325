//! A scene by the fixed point and by Newton's method: their difference against the fixed point's tolerance.

use convergence_study::plots;
use convergence_study::study::{Case, CaseFailure, Check, Figure, Table};
use convergence_study::text::number::max_or_nan;
use thermobeam::mesh::Mesh;
use thermobeam::simulation::Stepping;
use thermobeam::solve::{Settings, Solver};

use super::{Part, Task};
use crate::error::evaluator;
use crate::run::driver::Driver;
use crate::run::simulate;
use crate::scene::Scene;

/// Tolerance of the Newton run that the fixed point is compared with.
const SOLVED: f64 = 1e-14;

/// The table `[comparison]`.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Comparison {
    pub(super) scene: Scene,
    pub(super) elements: usize,
    pub(super) steps: usize,
    pub(super) tolerances: Vec<f64>,
}

/// What a run of both solvers shows.
#[derive(Debug, Clone, PartialEq)]
pub struct Agreement {
    /// Largest distance of their levels in the norm of Theorem 3.4, over all steps.
    pub distance: f64,
    /// Iterations of the fixed point per step.
    pub mean_iterations: f64,
    /// Its iterations in the step that took most.
    pub most_iterations: usize,
    /// Its iterations in each step, as (t, iterations).
    pub iterations: Vec<(f64, f64)>,
    /// The same of Newton's method.
    pub newton: Vec<(f64, f64)>,
    /// Intervals of time of the steps that end in contact.
    pub contact: Vec<(f64, f64)>,
}

impl Agreement {
    pub(super) fn not_finite(&self) -> Vec<&'static str> {
        let named = [("the distance", self.distance), ("the mean number of iterations", self.mean_iterations)];
        named.into_iter().filter(|(_, value)| !value.is_finite()).map(|(name, _)| name).collect()
    }
}

impl Comparison {
    pub(super) fn cases(&self) -> Vec<Case<Task>> {
        // Some four iterations of 60 ns a step and element, against 25 ns for the runner's unit.
        let cost = (self.elements * self.steps) as f64 * 10.0;
        let case = |&eta: &f64| Case { label: format!("tolerance {eta:e}"), cost, data: Task::Comparison(eta) };
        self.tolerances.iter().map(case).collect()
    }

    /// Steps the scene by both solvers side by side.
    pub(super) fn run(&self, tolerance: f64) -> Result<Agreement, CaseFailure> {
        let scene = Scene { mesh: Mesh::uniform(self.elements)?, ..self.scene.clone() };
        let driver = |settings| {
            let stepping = Stepping { settings, ..scene.one_step()? };
            Driver::new(simulate::problem(&scene), stepping)
        };
        let mut newton = driver(Settings { tolerance: SOLVED, ..Settings::default() })?;
        let mut fixed = driver(Settings { solver: Solver::FixedPoint, tolerance, ..Settings::default() })?;
        let lengths: Vec<f64> = scene.mesh.lengths().collect();
        let (mut distance, mut total, mut most_iterations) = (0.0, 0, 0);
        let (mut iterations, mut of_newton, mut contact) = (vec![], vec![], vec![]);
        for _ in 0..self.steps {
            let solved = newton.advance(|_, _| ())?;
            let report = fixed.advance(|_, _| ())?;
            let t = fixed.simulation().t();
            let level = fixed.level();
            distance = max_or_nan(distance, evaluator::distance(&lengths, level, newton.level()));
            total += report.iterations;
            most_iterations = most_iterations.max(report.iterations);
            iterations.push((t, report.iterations as f64));
            of_newton.push((t, solved.iterations as f64));
            if level.contact_force != 0.0 {
                contact.push((t - scene.dt(), t));
            }
        }
        let mean_iterations = total as f64 / self.steps as f64;
        Ok(Agreement { distance, mean_iterations, most_iterations, iterations, newton: of_newton, contact })
    }
}

/// * `found`: the results, each with its tolerance η*.
pub(super) fn judge(id: &str, found: &[(f64, &Agreement)]) -> Part {
    let check = |(eta, found): &(f64, &Agreement)| {
        // A step leaves less than α/(1 - α) η* unsolved, with α far below 1/2 here, and the beam damps what is left.
        let evidence = format!("{:.2e}, {:.3} of the tolerance", found.distance, found.distance / eta);
        Check::that(found.distance <= *eta, format!("eta* = {eta:e}: the error is below eta*"), evidence)
    };
    let row = |(eta, found): &(f64, &Agreement)| {
        vec![
            format!("{eta:e}"),
            format!("{:.3e}", found.distance),
            format!("{:.3}", found.mean_iterations),
            found.most_iterations.to_string(),
        ]
    };
    let head = ["tolerance", "distance to Newton", "mean iterations", "most iterations"].map(str::to_owned).to_vec();
    let rows = found.iter().map(row).collect();
    let last = found.last().map(|(_, found)| *found);
    let distance = last.map_or(f64::NAN, |found| found.distance);
    let summary = format!("distance to Newton's method {distance:.1e} at the smallest tolerance");
    Part {
        headline: summary.clone(),
        summary,
        checks: found.iter().map(check).collect(),
        tables: vec![Table { title: "Fixed point against Newton's method on the scene".to_owned(), head, rows }],
        figures: vec![figure(id, last)],
        quantities: vec![],
    }
}

fn figure(id: &str, found: Option<&Agreement>) -> Figure {
    let curve = |of: fn(&Agreement) -> &Vec<(f64, f64)>| found.map_or(vec![], |found| of(found).clone());
    let series = |label: &str, points| plots::Series { label: label.to_owned(), points };
    let series = vec![
        series("fixed point", curve(|found| &found.iterations)),
        series("Newton's method", curve(|found| &found.newton)),
    ];
    let phases = plots::Phases { label: "in contact".to_owned(), intervals: curve(|found| &found.contact) };
    let shaded = if phases.intervals.is_empty() { "" } else { "; shaded where the tip is in contact" };
    let caption =
        format!("Iterations per step of the fixed point at the smallest tolerance, and of Newton's method{shaded}.");
    let svg = plots::iterations(&plots::Iterations { series, phases, ..plots::Iterations::default() });
    Figure { file: format!("{id}-iterations.svg"), caption, svg }
}
