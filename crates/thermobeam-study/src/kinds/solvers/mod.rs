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

mod comparison;
mod contraction;
mod map;
mod map_figures;
mod map_judge;
mod spectrum;
mod step;

use super::prelude::*;
use comparison::{Comparison, ComparisonTable};
use contraction::ContractionGrid;
use map::Map;

pub use super::runs::side_by_side::SolverComparison;
pub use comparison::Agreement;
pub use contraction::{Contraction, MeasuredPoint};
pub use map::{Boundary, MapPoint, MapRow, NewtonSteps};
pub use step::FixedPointStep;

/// The row of the table of kinds.
pub const ROW: KindRow = KindRow {
    name: "solvers",
    schema: schema::<SolversFile>,
    read: Solvers::read_study,
    why: "Near a state, the paper's fixed point (4.2) multiplies its error in each iteration by a matrix that is known beforehand; \
          it diverges if the spectral radius is above 1. In contact that is about alpha, from dt, epsilon, zeta and the mesh. \
          Newton's method solves the same step wherever its operator is definite.",
    judged: "The increments against those of the linearised iteration, and their ratio against its spectral radius, for all \
             combinations of dt, epsilon and zeta; the difference between both solvers against the fixed point's tolerance; over two parameters at a time, the boundary of convergence against alpha = 1, \
             and for Newton's method convergence, energy and balance at every point.",
    failure: "The iteration is not the paper's, its steps are not solved to the tolerance, or a solver is less stable \
              than theory says.",
};

/// A study of the two solvers; it has at least one part.
#[derive(Debug, Clone)]
pub struct Solvers {
    contraction: Option<ContractionGrid>,
    comparison: Option<Comparison>,
    map: Option<Map>,
}

/// What a case computes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SolverTask {
    /// One step by the fixed point in contact, with this time step, compliance of the obstacles and
    /// viscosity.
    Contraction(MeasuredPoint),
    /// The scene by both solvers, the fixed point to this tolerance η*.
    Comparison(f64),
    /// A row of the map: all time steps at this value of the second parameter.
    Row(f64),
    /// The boundary of convergence at this value of the second parameter.
    Boundary(f64),
}

/// The result of a case; the variants match those of [`SolverTask`].
#[derive(Debug, Clone, PartialEq)]
pub enum SolverResult {
    /// Predicted and measured factor of the step.
    Contraction(Contraction),
    /// Difference between the two solvers.
    Comparison(Agreement),
    /// A row of the map.
    Row(MapRow),
    /// The boundary on a line.
    Boundary(Boundary),
}

impl SolverResult {
    /// Its numbers, which must be finite.
    fn numbers(&self) -> Vec<Measured> {
        match self {
            SolverResult::Contraction(point) => point.numbers(),
            SolverResult::Comparison(agreement) => agreement.numbers(),
            SolverResult::Row(row) => row.points.iter().flat_map(MapPoint::numbers).collect(),
            SolverResult::Boundary(boundary) => boundary.numbers(),
        }
    }
}

/// The results of one part, in the order of its cases; a failed case has none, and fails the check
/// of completion.
///
/// * `part`: the result if it belongs to that part.
fn results<R>(
    ran: &[Ran<SolverTask, SolverResult>],
    part: fn(&SolverResult) -> Option<&R>,
) -> Vec<&R> {
    ran.iter().filter_map(|ran| part(ran.ok()?)).collect()
}

/// A study of the two solvers as it is written: at least one part.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SolversFile {
    /// measured contraction against the spectral radius
    contraction: Option<ContractionGrid>,
    /// the fixed point against Newton
    comparison: Option<ComparisonTable>,
    /// where the fixed point converges
    map: Option<Map>,
}

impl FromFile for Solvers {
    type File = SolversFile;

    fn from_file(file: SolversFile, _: &Header, folder: &Path) -> Result<Self, Refusal> {
        let contraction = file.contraction.map(ContractionGrid::checked).transpose();
        let comparison = file.comparison.map(|table| table.comparison(folder));
        let map = file.map.map(Map::checked).transpose();
        let study = Self {
            contraction: contraction.map_err(Refusal::within("contraction"))?,
            comparison: comparison
                .transpose()
                .map_err(Refusal::within("comparison"))?,
            map: map.map_err(Refusal::within("map"))?,
        };
        if study.contraction.is_none() && study.comparison.is_none() && study.map.is_none() {
            let allowed = format!(
                "at least one table for kind \"{}\": contraction, comparison, map",
                ROW.name
            );
            return Err(Refusal::missing("contraction", &allowed));
        }
        Ok(study)
    }

    fn named_files(file: &SolversFile) -> Vec<&str> {
        let comparison = file.comparison.iter();
        comparison.map(|table| table.scene.as_str()).collect()
    }
}

/// The reasons why items are not judged, with those of cases that have no result.
fn with_all<'r>(
    count: usize,
    reasons: impl Iterator<Item = Option<&'r str>>,
) -> Vec<Option<&'r str>> {
    let mut reasons: Vec<_> = reasons.collect();
    reasons.resize(count.max(reasons.len()), Some("without a result"));
    reasons
}

/// Refuses a list without a number.
fn not_empty<T>(path: &str, list: &[T]) -> Result<(), Refusal> {
    if list.is_empty() {
        return Err(Refusal::written(path, "a list of at least one number > 0"));
    }
    Ok(())
}

/// The part of the study to which a case belongs.
fn part<P>(part: &Option<P>) -> Result<&P, CaseFailure> {
    part.as_ref()
        .ok_or_else(|| CaseFailure::new("the study has no such part"))
}

impl Kind for Solvers {
    type Data = SolverTask;
    type Found = SolverResult;

    fn cases(&self) -> Vec<Case<SolverTask>> {
        let mut cases: Vec<_> = self
            .contraction
            .iter()
            .flat_map(ContractionGrid::cases)
            .collect();
        cases.extend(self.comparison.iter().flat_map(Comparison::cases));
        cases.extend(self.map.iter().flat_map(Map::cases));
        cases
    }

    fn run(&self, task: &SolverTask) -> Result<SolverResult, CaseFailure> {
        Ok(match *task {
            SolverTask::Contraction(place) => {
                SolverResult::Contraction(part(&self.contraction)?.measure(place)?)
            }
            SolverTask::Comparison(tolerance) => {
                SolverResult::Comparison(part(&self.comparison)?.run(tolerance)?)
            }
            SolverTask::Row(value) => SolverResult::Row(part(&self.map)?.row(value)?),
            SolverTask::Boundary(value) => {
                SolverResult::Boundary(part(&self.map)?.boundary(value)?)
            }
        })
    }

    fn judge(&self, ran: &[Ran<SolverTask, SolverResult>]) -> Outcome {
        let contraction = self.contraction.iter().map(|grid| grid.judge(ran));
        let comparison = self.comparison.iter().map(|_| Comparison::judge(ran));
        let map = self.map.iter().map(|map| map.judge(ran));
        let parts = contraction.chain(comparison).chain(map);
        let completion = Check::completion(ran, |found| Measured::not_finite(&found.numbers()));
        Outcome::of_parts(completion, parts)
    }
}
