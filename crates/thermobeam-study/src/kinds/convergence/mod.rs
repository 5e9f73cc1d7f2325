//! Convergence studies: a manufactured solution, levels of refinement, orders expected.
//!
//! Three shapes, by what `[refine]` says: one axis, a path on which both are refined together (h = dt), or the full grid
//! of (h, dt) with `e² = A(h)² + B(dt)²`, of which each order is judged by itself. The step of a level is 1/n, the mean mesh width, or dt.

mod cases;
mod details;
mod file;
mod grid;
mod judge;

use convergence_study::study::levels::Levels;
use convergence_study::study::{Axis, Case, CaseFailure, Header, Kind, KindRow, Outcome, Ran, Untested, reader};
use thermobeam::parameters::{Beam, Obstacles};

use crate::kinds::controls::untested;
use crate::kinds::tables::{Control, Expectation, Manufactured, Norms, Refine, norm_levels};

/// The row of the table of kinds.
pub const ROW: KindRow = KindRow {
    name: "convergence",
    read: reader::<Convergence>,
    why: "An exact solution is chosen, and the loads are derived from it by putting it into the equations in their strong form; \
          the solver works with the weak form and knows nothing of it. So the error is known at every step. Theorem 3.4 bounds \
          it by c (h + dt).",
    judged: "At each level of refinement the error is measured in each norm, as the maximum over all time levels. The rate at \
             which it falls is estimated with an interval (95 %), and the interval is held against the order: it must lie \
             within the tolerance, whole. Above is as wrong as below. What cannot be told is inconclusive, which is not a pass.",
    failure: "The scheme, as it is programmed, does not have the order: a term is missing, belongs to another time level, has a \
              wrong coefficient, or the quadrature is too coarse. Look which norm fails, and from which level on.",
};

/// A convergence study, validated.
#[derive(Debug, Clone)]
pub struct Convergence {
    /// Id, claim and tier.
    pub header: Header,
    /// Coefficients from which the sources are derived.
    pub beam: Beam,
    /// Obstacles from which the boundary load is derived.
    pub obstacles: Option<Obstacles>,
    /// The exact solution; it meets the essential boundary conditions.
    pub exact: Manufactured,
    /// What is refined and how.
    pub refine: Refine,
    /// The solver's own coefficients, where they differ: then the study must fail.
    pub control: Option<Control>,
    /// The orders expected; at least one, each norm once.
    pub expect: Vec<Expectation>,
}

impl Convergence {
    /// The coefficients that the solver works with: those of the control, or else those of the sources.
    pub fn solver_coefficients(&self) -> (Beam, Option<Obstacles>) {
        self.control.as_ref().map_or((self.beam, self.obstacles), |control| (control.beam, control.obstacles))
    }

    /// The step of a level: 1/n, the mean mesh width, or dt where time alone is refined.
    pub(crate) fn step(&self, elements: usize, steps: usize) -> f64 {
        match self.refine.axis {
            Axis::Space | Axis::Both => 1.0 / elements as f64,
            Axis::Time => self.refine.dt(steps),
        }
    }

    /// Errors of each level in each norm; NaN where the case failed, so that it cannot pass.
    fn levels(&self, ran: &[Ran<(usize, usize), Norms>]) -> Levels {
        let errors = ran.iter().map(|ran| (ran.case.data, ran.ok()));
        norm_levels(&self.refine, &self.expect, |elements, steps| self.step(elements, steps), errors)
    }
}

impl Kind for Convergence {
    /// Elements and steps.
    type Data = (usize, usize);
    /// The error in each norm, the maximum over the time levels.
    type Found = Norms;

    fn header(&self) -> &Header {
        &self.header
    }

    fn cases(&self) -> Vec<Case<(usize, usize)>> {
        cases::cases(self)
    }

    fn run(&self, resolution: &(usize, usize)) -> Result<Norms, CaseFailure> {
        cases::run(self, *resolution)
    }

    fn judge(&self, ran: &[Ran<(usize, usize), Norms>]) -> Outcome {
        judge::judge(self, ran)
    }

    fn details(&self) -> Vec<(String, String)> {
        details::details(self)
    }

    fn untested(&self) -> Vec<Untested> {
        untested(self)
    }
}
