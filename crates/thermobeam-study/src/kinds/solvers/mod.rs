//! Where and how fast the paper's fixed point (4.2) converges, and whether Newton's method always does.
//!
//! The paper leaves the convergence of its iteration out. In contact an error shrinks by `α = (dt/ε) [A_u⁻¹]_nn` per
//! iteration ([`contact_contraction`](thermobeam::contraction::contact_contraction)), free of contact by a factor γ < 1
//! ([`coupling_contraction`](thermobeam::contraction::coupling_contraction)); past α = 1 the iteration diverges. A study
//! asks one or more of three questions, one table of its file each:
//!
//! ```toml
//! [contraction]              # the factor of one step in contact against α, for all combinations
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
mod file;
mod map;
mod step;

use convergence_study::study::levels::completion;
use convergence_study::study::{
    Case, CaseFailure, Check, Figure, Header, Kind, KindRow, Outcome, Quantity, Ran, Table, reader,
};

pub use comparison::Agreement;
pub use contraction::Contraction;
pub use map::{Boundary, Crossing, NewtonSteps, Point, Row};
pub use step::FixedPointStep;

/// The row of the table of kinds.
pub const ROW: KindRow = KindRow {
    name: "solvers",
    read: reader::<Solvers>,
    why: "In contact, the paper's fixed point (4.2) reduces its error by a factor alpha per iteration that is known beforehand from \
          dt, epsilon, zeta and the mesh; past alpha = 1 it diverges. Newton's method solves the same step wherever its operator \
          is definite.",
    judged: "The measured factor against alpha, for all combinations of dt, epsilon and zeta; the difference between both solvers \
             against the fixed point's tolerance; over two parameters at a time, the boundary of convergence against alpha = 1, \
             and for Newton's method convergence, energy and balance at every point.",
    failure: "The iteration is not the paper's, its steps are not solved to the tolerance asked for, or a solver is less stable \
              than theory says.",
};

/// A study of the two solvers; it has at least one part.
#[derive(Debug, Clone, PartialEq)]
pub struct Solvers {
    header: Header,
    contraction: Option<contraction::Grid>,
    comparison: Option<comparison::Comparison>,
    map: Option<map::Map>,
}

/// What a case computes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Task {
    /// One step by the fixed point in contact.
    Contraction {
        /// Time step.
        dt: f64,
        /// Compliance of the obstacles.
        epsilon: f64,
        /// Viscosity.
        zeta: f64,
    },
    /// The scene by both solvers, the fixed point to this tolerance η*.
    Comparison(f64),
    /// A row of the map: all time steps at this value of the second parameter.
    Row(f64),
    /// The boundary of convergence at this value of the second parameter.
    Boundary(f64),
}

/// What a case found, variant by variant as in [`Task`].
#[derive(Debug, Clone, PartialEq)]
pub enum Found {
    /// Predicted and measured factor.
    Contraction(Contraction),
    /// Difference between the two solvers.
    Comparison(Agreement),
    /// A row of the map.
    Row(Row),
    /// The boundary on a line.
    Boundary(Boundary),
}

impl Found {
    /// Names of the numbers that are NaN, or infinite where only a finite one makes sense.
    fn not_finite(&self) -> Vec<String> {
        let names = match self {
            Found::Contraction(found) => found.not_finite(),
            Found::Comparison(found) => found.not_finite(),
            Found::Row(row) => row.not_finite(),
            Found::Boundary(boundary) => boundary.not_finite(),
        };
        names.into_iter().map(str::to_owned).collect()
    }
}

/// What one part contributes to the outcome.
struct Part {
    summary: String,
    headline: String,
    checks: Vec<Check>,
    tables: Vec<Table>,
    figures: Vec<Figure>,
    quantities: Vec<Quantity>,
}

impl Solvers {
    /// What was found by the cases that `pick` takes, in the order of the cases; a failed case is left out, and fails
    /// the check of completion.
    fn found<'r, D, F>(
        ran: &'r [Ran<Task, Found>],
        pick: impl Fn(&'r Task, &'r Found) -> Option<(D, F)>,
    ) -> Vec<(D, F)> {
        ran.iter().filter_map(|ran| pick(&ran.case.data, ran.ok()?)).collect()
    }

    fn parts(&self, ran: &[Ran<Task, Found>]) -> Vec<Part> {
        let id = &self.header.id;
        let contraction = self.contraction.as_ref().map(|_| {
            let found = Self::found(ran, |task, found| match (task, found) {
                (Task::Contraction { dt, epsilon, zeta }, Found::Contraction(found)) => {
                    Some(([*dt, *epsilon, *zeta], found))
                }
                _ => None,
            });
            contraction::judge(id, &found)
        });
        let comparison = self.comparison.as_ref().map(|_| {
            let found = Self::found(ran, |task, found| match (task, found) {
                (Task::Comparison(tolerance), Found::Comparison(found)) => Some((*tolerance, found)),
                _ => None,
            });
            comparison::judge(id, &found)
        });
        let map = self.map.as_ref().map(|map| {
            let rows = Self::found(ran, |task, found| match (task, found) {
                (Task::Row(value), Found::Row(row)) => Some((*value, row)),
                _ => None,
            });
            let lines = Self::found(ran, |task, found| match (task, found) {
                (Task::Boundary(value), Found::Boundary(line)) => Some((*value, line)),
                _ => None,
            });
            map.judge(id, &rows, &lines)
        });
        [contraction, comparison, map].into_iter().flatten().collect()
    }
}

impl Kind for Solvers {
    type Data = Task;
    type Found = Found;

    fn header(&self) -> &Header {
        &self.header
    }

    fn cases(&self) -> Vec<Case<Task>> {
        let contraction = self.contraction.iter().flat_map(contraction::Grid::cases);
        let comparison = self.comparison.iter().flat_map(comparison::Comparison::cases);
        contraction.chain(comparison).chain(self.map.iter().flat_map(map::Map::cases)).collect()
    }

    fn run(&self, task: &Task) -> Result<Found, CaseFailure> {
        let absent = || CaseFailure { reason: "the study has no such part".to_owned() };
        Ok(match *task {
            Task::Contraction { dt, epsilon, zeta } => {
                let grid = self.contraction.as_ref().ok_or_else(absent)?;
                Found::Contraction(contraction::measure(grid.elements, [dt, epsilon, zeta])?)
            }
            Task::Comparison(tolerance) => {
                Found::Comparison(self.comparison.as_ref().ok_or_else(absent)?.run(tolerance)?)
            }
            Task::Row(value) => Found::Row(self.map.as_ref().ok_or_else(absent)?.row(value)?),
            Task::Boundary(value) => Found::Boundary(self.map.as_ref().ok_or_else(absent)?.boundary(value)?),
        })
    }

    fn judge(&self, ran: &[Ran<Task, Found>]) -> Outcome {
        let parts = self.parts(ran);
        let join = |text: fn(&Part) -> &str| parts.iter().map(text).collect::<Vec<_>>().join("; ");
        let (summary, headline) = (join(|part| &part.summary), join(|part| &part.headline));
        let mut checks = vec![completion(ran, Found::not_finite)];
        let (mut tables, mut figures, mut quantities) = (vec![], vec![], vec![]);
        for part in parts {
            checks.extend(part.checks);
            tables.extend(part.tables);
            figures.extend(part.figures);
            quantities.extend(part.quantities);
        }
        Outcome { headline, tables, figures, quantities, ..Outcome::new(summary, vec![], checks) }
    }
}
