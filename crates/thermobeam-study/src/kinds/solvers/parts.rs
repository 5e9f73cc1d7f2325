//! Two parts of a study: the contraction factor in contact, measured against α; and the difference between the fixed point
//! and Newton's method on a scene, against the fixed point's tolerance.

use super::{FixedPointStep, SolverTask, positive_numbers};
use crate::error::reference::distance;
use crate::kinds::prelude::*;

/// Iterations after which a slow iteration, with a factor near 1, is abandoned.
const ITERATIONS: usize = 1000;
/// Increment at which a measurement stops: small enough that the slowest mode dominates, large against round-off.
const TOLERANCE: f64 = 1e-9;
/// Largest relative difference between measured and predicted factor.
const AGREEMENT: f64 = 0.03;
/// Ratio α/γ above which α dominates: γ then changes the factor by at most one percent.
const DOMINANCE: f64 = 100.0;
/// Slope of the beam pressed into the upper obstacle by a fifth of the gap.
const PRESSED: f64 = 0.12;

/// The table `[contraction]`.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Grid {
    elements: usize,
    dt: Vec<f64>,
    epsilon: Vec<f64>,
    zeta: Vec<f64>,
}

impl Grid {
    pub(super) fn read(section: &Section<'_>) -> Result<Self, InputError> {
        section.allow(&["elements", "dt", "epsilon", "zeta"])?;
        let [dt, epsilon, zeta] = ["dt", "epsilon", "zeta"].map(|key| positive_numbers(section, key));
        let (dt, epsilon, zeta) = (dt?, epsilon?, zeta?);
        limits::cases(&section.require("dt", "a list")?, &[dt.len(), epsilon.len(), zeta.len()])?;
        let elements = tables::elements(&section.require("elements", "a number of elements")?)?;
        Ok(Self { elements, dt, epsilon, zeta })
    }

    pub(super) fn cases(&self) -> Vec<Case<SolverTask>> {
        let cost = self.elements as f64 * ITERATIONS as f64;
        let case = |at: [f64; 3]| Case::new(name(at), cost, SolverTask::Contraction(at));
        let of = |zeta: f64, epsilon: f64| self.dt.iter().map(move |&dt| case([dt, epsilon, zeta]));
        let of_zeta = |&zeta: &f64| self.epsilon.iter().flat_map(move |&epsilon| of(zeta, epsilon));
        self.zeta.iter().flat_map(of_zeta).collect()
    }

    /// One step of a beam at rest, pressed into the upper obstacle.
    pub(super) fn measure(&self, [dt, epsilon, zeta]: [f64; 3]) -> Result<FixedPointStep, CaseFailure> {
        let mesh = Mesh::uniform(self.elements)?;
        let mut initial = Initial::at_rest(&mesh, 0.0);
        initial.u = mesh.nodes().iter().map(|x| PRESSED * x).collect();
        let beam = Beam { zeta, ..Beam::default() };
        let obstacles = Some(Obstacles { epsilon, ..Obstacles::default() });
        let problem = Problem { beam, obstacles, mesh, initial };
        FixedPointStep::run(&problem, dt, beam.axial_force(PRESSED * PRESSED), TOLERANCE, ITERATIONS)
    }
}

fn name([dt, epsilon, zeta]: [f64; 3]) -> String {
    format!("dt = {dt:e}, epsilon = {epsilon:e}, zeta = {zeta}")
}

/// * `found`: the results, each with its (dt, ε, ζ).
pub(super) fn judge_contraction(found: &[([f64; 3], &FixedPointStep)]) -> Outcome {
    let (mut checks, mut rows, mut quantities) = (vec![], vec![], vec![]);
    let mut worst = 0.0;
    for &(at, &FixedPointStep { alpha, gamma, converged, iterations, contraction, .. }) in found {
        let name = name(at);
        let factor = contraction.unwrap_or(f64::NAN);
        let deviation = (factor / alpha - 1.0).abs();
        let evidence = format!("alpha {alpha:.5}, measured {factor:.5}");
        if alpha < 1.0 - AGREEMENT && alpha >= DOMINANCE * gamma {
            worst = max_or_nan(worst, deviation);
            let holds = converged && deviation <= AGREEMENT;
            checks.push(Check::that(holds, format!("{name}: the contraction factor is alpha"), evidence));
            quantities.push(Quantity::new(format!("contraction, {name}"), factor, 1e-2));
        } else if alpha > 1.0 + AGREEMENT {
            checks.push(Check::that(!converged, format!("{name}: diverges, since alpha > 1"), evidence));
        }
        let [dt, epsilon, zeta] = at;
        let measured = if converged { format!("{factor:.5}") } else { "diverges".to_owned() };
        let [dt, epsilon] = [dt, epsilon].map(|value| format!("{value:e}"));
        rows.push(vec![dt, epsilon, zeta.to_string(), format!("{alpha:.5}"), measured, iterations.to_string()]);
    }
    let head = ["dt", "epsilon", "zeta", "alpha", "measured", "iterations"];
    let summary = format!("contraction within {:.1} % of alpha", 100.0 * worst);
    Outcome {
        headline: summary.clone(),
        tables: vec![Table::new("Contraction factor in contact", head, rows)],
        figures: vec![contraction_figure(found)],
        quantities,
        ..Outcome::new(summary, vec![], checks)
    }
}

fn contraction_figure(found: &[([f64; 3], &FixedPointStep)]) -> Figure {
    let mut zetas: Vec<f64> = found.iter().map(|([_, _, zeta], _)| *zeta).collect();
    zetas.dedup();
    let series = zetas.iter().map(|zeta| {
        let of_zeta = found.iter().filter(|([_, _, z], _)| z == zeta);
        let points = of_zeta.map(|(_, step)| (step.alpha, step.contraction.unwrap_or(f64::NAN)));
        plots::Series::new(format!("ζ = {zeta}"), points)
    });
    let svg = figures::contraction(&series.collect::<Vec<_>>());
    let caption =
        "Contraction factor of the fixed point in contact, measured over predicted; from 1 on it does not converge.";
    Figure::new("contraction", caption, svg)
}

/// Tolerance of the Newton run that is compared with the fixed point.
const SOLVED: f64 = 1e-14;

/// The table `[comparison]`.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Comparison {
    scene: Scene,
    elements: usize,
    steps: usize,
    tolerances: Vec<f64>,
}

/// The results of running both solvers.
#[derive(Debug, Clone, PartialEq)]
pub struct Agreement {
    /// Largest distance of their levels in the norm of Theorem 3.4, over all steps.
    pub distance: f64,
    /// Iterations of the fixed point per step.
    pub mean_iterations: f64,
    /// Its largest number of iterations in a step.
    pub most_iterations: usize,
    /// Its iterations in each step, as (t, iterations).
    pub iterations: Vec<(f64, f64)>,
    /// Newton iterations in each step, likewise.
    pub newton: Vec<(f64, f64)>,
    /// Time intervals of the steps that end in contact.
    pub contact: Vec<(f64, f64)>,
}

impl Comparison {
    pub(super) fn read(section: &Section<'_>, folder: &Path) -> Result<Self, InputError> {
        section.allow(&["scene", "elements", "steps", "tolerances"])?;
        Ok(Self {
            scene: Scene::read_one_step(&section.require("scene", "a scene file beside this one")?, folder)?,
            elements: tables::elements(&section.require("elements", "a number of elements")?)?,
            // Each step is a point of a figure.
            steps: section.count("steps", 1..=limits::RECORDED_STEPS)?,
            tolerances: positive_numbers(section, "tolerances")?,
        })
    }

    pub(super) fn cases(&self) -> Vec<Case<SolverTask>> {
        // Some four iterations of 60 ns per step and element; the unit of the runner is 25 ns.
        let cost = (self.elements * self.steps) as f64 * 10.0;
        let case = |&eta: &f64| Case::new(format!("tolerance {eta:e}"), cost, SolverTask::Comparison(eta));
        self.tolerances.iter().map(case).collect()
    }

    /// Steps the scene by both solvers in parallel.
    pub(super) fn run(&self, tolerance: f64) -> Result<Agreement, CaseFailure> {
        let scene = Scene { mesh: Mesh::uniform(self.elements)?, ..self.scene.clone() };
        let driver = |settings| {
            let stepping = Stepping { settings, ..scene.one_step()? };
            Driver::new(simulate::problem(&scene), stepping)
        };
        let mut newton = driver(Settings { tolerance: SOLVED, ..Settings::default() })?;
        let mut fixed = driver(Settings { solver: Solver::FixedPoint, tolerance, ..Settings::default() })?;
        let lengths: Vec<f64> = scene.mesh.lengths().collect();
        let (mut farthest, mut total, mut most_iterations) = (0.0, 0, 0);
        let (mut iterations, mut of_newton, mut contact) = (vec![], vec![], vec![]);
        for _ in 0..self.steps {
            let solved = newton.advance(|_, _| ())?;
            let report = fixed.advance(|_, _| ())?;
            let t = fixed.simulation().t();
            let level = fixed.level();
            farthest = max_or_nan(farthest, distance(&lengths, level, newton.level()));
            total += report.iterations;
            most_iterations = most_iterations.max(report.iterations);
            iterations.push((t, report.iterations as f64));
            of_newton.push((t, solved.iterations as f64));
            if level.contact_force != 0.0 {
                contact.push((t - scene.dt(), t));
            }
        }
        let mean_iterations = total as f64 / self.steps as f64;
        Ok(Agreement { distance: farthest, mean_iterations, most_iterations, iterations, newton: of_newton, contact })
    }
}

/// * `found`: the results, each with its tolerance η*.
pub(super) fn judge_comparison(found: &[(f64, &Agreement)]) -> Outcome {
    let check = |(eta, found): &(f64, &Agreement)| {
        // A step leaves at most α/(1 - α) η* unsolved; here α is far below 1/2, and the beam damps the rest.
        let evidence = format!("{:.2e}, {:.3} of the tolerance", found.distance, found.distance / eta);
        Check::that(found.distance <= *eta, format!("eta* = {eta:e}: the error is below eta*"), evidence)
    };
    let row = |(eta, Agreement { distance, mean_iterations, most_iterations, .. }): &(f64, &Agreement)| {
        [format!("{eta:e}"), format!("{distance:.3e}"), format!("{mean_iterations:.3}"), most_iterations.to_string()]
            .into()
    };
    let head = ["tolerance", "distance to Newton", "mean iterations", "most iterations"];
    let last = found.last().map(|(_, found)| *found);
    let distance = last.map_or(f64::NAN, |found| found.distance);
    let summary = format!("distance to Newton's method {distance:.1e} at the smallest tolerance");
    let title = "Fixed point against Newton's method on the scene";
    Outcome {
        headline: summary.clone(),
        tables: vec![Table::new(title, head, found.iter().map(row))],
        figures: vec![iterations_figure(last)],
        ..Outcome::new(summary, vec![], found.iter().map(check).collect())
    }
}

fn iterations_figure(found: Option<&Agreement>) -> Figure {
    let curve = |of: fn(&Agreement) -> &Vec<(f64, f64)>| found.map_or(vec![], |found| of(found).clone());
    let fixed_point = plots::Series::new("fixed point", curve(|found| &found.iterations));
    let series = [fixed_point, plots::Series::new("Newton's method", curve(|found| &found.newton))];
    let phases = plots::Phases { label: "in contact".to_owned(), intervals: curve(|found| &found.contact) };
    let shaded = if phases.intervals.is_empty() { "" } else { "; shaded where the tip is in contact" };
    let caption =
        format!("Iterations per step of the fixed point at the smallest tolerance, and of Newton's method{shaded}.");
    Figure::new("iterations", caption, Xy { phases, ..plots::iterations(&series) }.draw())
}
