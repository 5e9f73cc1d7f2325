//! Where and how fast the paper's fixed point (4.2) converges, and whether Newton's method always
//! converges.
//!
//! The paper does not treat the convergence of its iteration. Near a state it multiplies errors by
//! a linear map ([`linearized`](thermobeam::linearized)), and converges if the spectral radius of
//! that map is below 1. Where contact dominates, the radius is `α = (dt/ε) [A_u⁻¹]_nn`; without
//! contact it is a factor γ < 1 ([`contraction`](thermobeam::contraction)). A study asks one or
//! more of three questions, one table of its file each:
//!
//! ```toml
//! [contraction]              # the factor of one step in contact against the spectral radius, for all combinations
//! elements = 100
//! dt = [1e-4, 1e-3]
//! epsilon = [1e-4, 1e-3]
//! zeta = [0.01, 0.1]
//!
//! [comparison]               # a scene solved by both solvers: is the difference within the tolerance η*?
//! scene = "scenes/paper-1-beta-0.toml"
//! elements = 100
//! steps = 1000               # with the scene's own dt
//! tolerances = [1e-4, 1e-8]  # η*, falling
//!
//! [map]                      # both solvers over dt and a second parameter
//! over = "epsilon"           # the second parameter: epsilon, beta, zeta or h
//! dt = [1e-6, 10.0]          # range of the map, logarithmic
//! range = [1e-8, 10.0]       # of the second parameter; logarithmic except for beta
//! points = 40                # along either axis
//! lines = [1e-6, 1e-3]       # values of the second parameter at which the boundary is found by bisection in dt
//! elements = 32
//! steps = 16                 # by Newton's method
//! agreement = 0.02           # of measured and predicted boundary, relative
//! ```

mod judge;
mod map;
mod parts;
mod spectrum;

use super::prelude::*;
use crate::kinds::settings;

pub use super::runs::side_by_side::SolverComparison;
pub use map::{Boundary, NewtonSteps, Point};
pub use parts::{Agreement, Contraction};

/// The row of the table of kinds.
pub const ROW: KindRow = KindRow {
    name: "solvers",
    read: reader::<Solvers>,
    why: "Near a state, the paper's fixed point (4.2) multiplies its error in each iteration by a matrix that is known beforehand; \
          it diverges if the spectral radius is above 1. In contact that is about alpha, from dt, epsilon, zeta and the mesh. \
          Newton's method solves the same step wherever its operator is definite.",
    judged: "The increments against those of the linearised iteration, and their ratio against its spectral radius, for all \
             combinations of dt, epsilon and zeta; the difference between both solvers against the fixed point's tolerance; over two parameters at a time, the boundary of convergence against alpha = 1, \
             and for Newton's method convergence, energy and balance at every point.",
    failure: "The iteration is not the paper's, its steps are not solved to the tolerance, or a solver is less stable \
              than theory says.",
    settings: settings::of_solvers,
};

/// A study of the two solvers; it has at least one part.
#[derive(Debug, Clone, PartialEq)]
pub struct Solvers {
    contraction: Option<parts::Grid>,
    comparison: Option<parts::Comparison>,
    map: Option<map::Map>,
}

/// What a case computes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SolverTask {
    /// One step by the fixed point in contact, with this time step, compliance of the obstacles and
    /// viscosity.
    Contraction([f64; 3]),
    /// The scene by both solvers, the fixed point to this tolerance η*.
    Comparison(f64),
    /// A row of the map: all time steps at this value of the second parameter.
    Row(f64),
    /// The boundary of convergence at this value of the second parameter.
    Boundary(f64),
}

/// The result of a case; the variants match those of [`SolverTask`].
#[derive(Debug, Clone, PartialEq)]
pub enum Found {
    /// Predicted and measured factor of the step.
    Contraction(Contraction),
    /// Difference between the two solvers.
    Comparison(Agreement),
    /// A row of the map, one point for each time step, ascending.
    Row(Vec<Point>),
    /// The boundary on a line.
    Boundary(Boundary),
}

impl Found {
    /// Names of the numbers that are NaN, or infinite although only a finite value makes sense.
    fn not_finite(&self) -> Vec<String> {
        match self {
            Found::Contraction(found) => not_finite([
                ("alpha", found.alpha),
                ("gamma", found.gamma),
                ("the spectral radius", found.radius),
                ("the measured factor", found.measured),
                ("the deviation", found.deviation),
            ]),
            Found::Comparison(Agreement { solvers, .. }) => not_finite([
                ("the distance", solvers.distance),
                ("the mean number of iterations", solvers.mean_iterations),
            ]),
            Found::Row(row) => row.iter().flat_map(Point::not_finite).collect(),
            Found::Boundary(boundary) => boundary.not_finite(),
        }
    }
}

impl FromFile for Solvers {
    fn from_document(_: &Header, root: &Section<'_>, folder: &Path) -> Result<Self, InputError> {
        let parts = ["contraction", "comparison", "map"];
        root.allow(&[&["study"], &parts[..]].concat())?;
        if parts.iter().all(|part| root.get(part).is_none()) {
            let allowed = format!(
                "at least one table for kind \"{}\": {}",
                ROW.name,
                parts.join(", ")
            );
            return Err(root.missing(parts[0], &allowed));
        }
        Ok(Self {
            contraction: root
                .section(parts[0])?
                .map(|section| parts::Grid::read(&section))
                .transpose()?,
            comparison: root
                .section(parts[1])?
                .map(|section| parts::Comparison::read(&section, folder))
                .transpose()?,
            map: root
                .section(parts[2])?
                .map(|section| map::Map::read(&section))
                .transpose()?,
        })
    }
}

/// A list of at least one number > 0.
fn positive_numbers(section: &Section<'_>, key: &str) -> Result<Vec<f64>, InputError> {
    section.list(
        key,
        "a list of at least one number > 0",
        Field::positive,
        |list| !list.is_empty(),
    )
}

/// The part of the study to which a case belongs.
fn part<P>(part: &Option<P>) -> Result<&P, CaseFailure> {
    part.as_ref()
        .ok_or_else(|| CaseFailure::new("the study has no such part"))
}

impl Kind for Solvers {
    type Data = SolverTask;
    type Found = Found;

    fn cases(&self) -> Vec<Case<SolverTask>> {
        let contraction = self.contraction.iter().flat_map(parts::Grid::cases);
        let comparison = self.comparison.iter().flat_map(parts::Comparison::cases);
        contraction
            .chain(comparison)
            .chain(self.map.iter().flat_map(map::Map::cases))
            .collect()
    }

    fn run(&self, task: &SolverTask) -> Result<Found, CaseFailure> {
        Ok(match *task {
            SolverTask::Contraction(at) => {
                Found::Contraction(part(&self.contraction)?.measure(at)?)
            }
            SolverTask::Comparison(tolerance) => {
                Found::Comparison(part(&self.comparison)?.run(tolerance)?)
            }
            SolverTask::Row(value) => Found::Row(part(&self.map)?.row(value)?),
            SolverTask::Boundary(value) => Found::Boundary(part(&self.map)?.boundary(value)?),
        })
    }

    fn judge(&self, ran: &[Ran<SolverTask, Found>]) -> Outcome {
        // A failed case is omitted, and fails the check of completion.
        let (mut factors, mut agreements, mut rows, mut lines) = (vec![], vec![], vec![], vec![]);
        for (task, found) in ran
            .iter()
            .filter_map(|ran| Some((ran.case.data, ran.ok()?)))
        {
            match (task, found) {
                (SolverTask::Contraction(at), Found::Contraction(of)) => factors.push((at, of)),
                (SolverTask::Comparison(tolerance), Found::Comparison(of)) => {
                    agreements.push((tolerance, of));
                }
                (SolverTask::Row(value), Found::Row(row)) => rows.push((value, &row[..])),
                (SolverTask::Boundary(value), Found::Boundary(line)) => lines.push((value, line)),
                _ => {}
            }
        }
        let contraction = self
            .contraction
            .as_ref()
            .map(|grid| parts::judge_contraction(&factors, grid.cases().len()));
        let comparison = self
            .comparison
            .as_ref()
            .map(|_| parts::judge_comparison(&agreements));
        let map = self.map.as_ref().map(|map| map.judge(&rows, &lines));
        let parts: Vec<Outcome> = [contraction, comparison, map]
            .into_iter()
            .flatten()
            .collect();
        let join =
            |text: fn(&Outcome) -> &str| parts.iter().map(text).collect::<Vec<_>>().join("; ");
        let (summary, headline) = (join(|part| &part.summary), join(|part| &part.headline));
        let mut all = Outcome {
            headline,
            ..Outcome::new(summary, vec![], vec![completion(ran, Found::not_finite)])
        };
        parts.into_iter().for_each(|part| all.extend(part));
        all
    }
}

/// A step by the fixed point: the prediction, and the result.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FixedPointStep {
    /// The time step.
    pub dt: f64,
    /// Predicted factor of the contact; infinite if its operator is not definite.
    pub alpha: f64,
    /// Predicted factor of the coupling between rotation and displacement; infinite if its operator
    /// is not definite.
    pub gamma: f64,
    /// Whether the increment fell below the tolerance.
    pub converged: bool,
    /// Iterations done.
    pub iterations: usize,
    /// Ratio of the last two increments, if there were two; infinite if the iterates overflowed or
    /// the operator was not definite.
    pub contraction: Option<f64>,
}

impl FixedPointStep {
    /// The first step of the problem, with at most `iterations` iterations, to an increment below
    /// `tolerance`.
    ///
    /// * `n_value`: mean axial force for the predicted factors.
    ///
    /// # Errors
    /// [`CaseFailure`] if the solver refuses the problem or the time is up; divergence of the
    /// iteration is a result.
    fn run(
        problem: &Problem,
        dt: f64,
        n_value: f64,
        tolerance: f64,
        iterations: usize,
    ) -> Result<Self, CaseFailure> {
        let newton = Settings {
            stopping: Stopping::Converged {
                tolerance,
                max_iterations: iterations,
            },
            ..Settings::default()
        };
        let settings = Settings {
            solver: Solver::FixedPoint,
            ..newton
        };
        let stepping = Stepping {
            scheme: EULER_CRANK_NICOLSON,
            settings,
            dt,
            loaded: false,
        };
        let mut driver = Driver::new(problem.clone(), stepping)?;
        let mut reached = (0, None);
        let outcome = run_to(&mut driver, dt, |_, report| {
            reached = (report.iterations, report.contraction);
        });
        let (iterations, contraction) = match &outcome {
            Ok(()) => reached,
            Err(RunError::Step(error)) => match error.failure {
                StepFailure::Diverged {
                    iterations,
                    contraction,
                    ..
                }
                | StepFailure::IterationLimit {
                    iterations,
                    contraction,
                    ..
                } => (iterations, Some(contraction)),
                StepFailure::NonFinite { iterations, .. } => (iterations, Some(f64::INFINITY)),
                _ => (0, Some(f64::INFINITY)),
            },
            Err(other) => return Err(other.clone().into()),
        };
        let [alpha, gamma] = factors(problem, dt, n_value);
        Ok(Self {
            dt,
            alpha,
            gamma,
            converged: outcome.is_ok(),
            iterations,
            contraction,
        })
    }
}

/// The factors α of the contact and γ of the coupling, for a step with the mean axial force
/// `n_value`; infinite if the operator is not definite.
fn factors(problem: &Problem, dt: f64, n_value: f64) -> [f64; 2] {
    let case = problem.case(EULER_CRANK_NICOLSON, dt);
    [
        case.contact_contraction(n_value),
        case.coupling_contraction(n_value),
    ]
}
