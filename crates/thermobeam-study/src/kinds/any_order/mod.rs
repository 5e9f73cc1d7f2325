//! Orders of the scheme of any order: elements of degree p in space, dG(q) in time.
//!
//! Against a manufactured solution, contact included, or a free vibration without any load: the error at the end falls like h^(p+1) in the fields and h^p in
//! their slopes; like dt^(2q+1) at the ends of steps and, inside steps, dt^(q+2) in u and dt^(q+1) in its velocity; and
//! exponentially in p.

mod cases;
mod file;
mod judge;

use convergence_study::study::{Case, CaseFailure, Header, Kind, KindRow, Outcome, Ran, reader};
use thermobeam::parameters::{Beam, Obstacles};

use crate::exact::solution::Manufactured;
use crate::expression::Expression;
use crate::kinds::tables::Control;

/// The row of the table of kinds.
pub const ROW: KindRow = KindRow {
    name: "any-order",
    read: reader::<AnyOrder>,
    why: "On a mesh of width h elements of degree p approximate a smooth solution to h^(p+1), its slopes to h^p; for fixed h the \
          error falls exponentially in p. dG(q) is of order 2q + 1 at the ends of steps, and inside them of the order of \
          polynomials of its degree: q + 2, but at most 2q + 1, for displacements, q + 1 for velocities (THEORY.md).",
    judged: "For each degree the rate over h or dt by the rule of every rate, other errors being at round-off; over p the error \
             must fall by the factor claimed for each degree until it reaches round-off.",
    failure: "Integrals in space or time are not exact enough, a term of the step is wrong, or the iteration for the axial force \
              is stopped too early: look at the highest degree that still passes.",
};

/// What is refined.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Over {
    /// The mesh, for each degree p.
    Space,
    /// The steps, for each degree q.
    Time,
    /// The degree p itself.
    Degree,
}

/// One run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Resolution {
    /// Degree p of the elements.
    pub degree: usize,
    /// Elements n.
    pub elements: usize,
    /// Degree q in time.
    pub time_degree: usize,
    /// Number of steps, all of the same length.
    pub steps: usize,
}

/// Errors of one run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Errors {
    /// Root of the sum of the squares of the L2 errors of u, φ, u_t, φ_t, θ at the end.
    pub fields: f64,
    /// The same of their slopes.
    pub slopes: f64,
    /// Largest L2 error of u inside steps.
    pub inside_u: f64,
    /// Largest L2 error of u_t inside steps.
    pub inside_u_t: f64,
}

/// Runs that are judged together.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Series {
    /// The runs, coarse to fine.
    pub(super) runs: Vec<Resolution>,
    /// How far a rate may be from its order; for runs over p the factor by which the error falls for each degree.
    pub(super) tolerance: f64,
}

/// A study of orders.
#[derive(Clone)]
pub struct AnyOrder {
    header: Header,
    beam: Beam,
    obstacles: Option<Obstacles>,
    exact: Manufactured,
    /// Whether loads keep the exact solution in place; a free vibration needs none.
    loaded: bool,
    /// The solver's own coefficients, where they differ: then the study must fail.
    control: Option<Control>,
    map: Option<Expression>,
    t_end: f64,
    over: Over,
    series: Vec<Series>,
}

impl AnyOrder {
    /// The coefficients from which the loads are derived.
    pub(super) fn coefficients(&self) -> (Beam, Option<Obstacles>) {
        (self.beam, self.obstacles)
    }

    /// The same study with other coefficients in the solver, or with none.
    pub(super) fn with_control(&self, control: Option<Control>) -> Self {
        Self { control, ..self.clone() }
    }

    /// The coefficients that the solver works with: those of the control, or else those of the loads.
    fn solver_coefficients(&self) -> (Beam, Option<Obstacles>) {
        self.control.as_ref().map_or((self.beam, self.obstacles), |control| (control.beam, control.obstacles))
    }
}

impl Kind for AnyOrder {
    type Data = Resolution;
    type Found = Errors;

    fn header(&self) -> &Header {
        &self.header
    }

    fn cases(&self) -> Vec<Case<Resolution>> {
        cases::cases(self)
    }

    fn run(&self, resolution: &Resolution) -> Result<Errors, CaseFailure> {
        cases::run(self, *resolution)
    }

    fn judge(&self, ran: &[Ran<Resolution, Errors>]) -> Outcome {
        judge::judge(self, ran)
    }
}
