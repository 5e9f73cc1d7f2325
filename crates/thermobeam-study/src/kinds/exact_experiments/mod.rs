//! The experiments of Section 5 by the scheme of any order: values to ten digits, and the error of the paper's own scheme.
//!
//! Two different discretisations (degree, elements, degree in time, steps) of one scene must agree. What they agree on is
//! then the reference for the scene's own scheme at its own resolution, over the whole time.

mod cases;
mod file;
mod judge;
mod report;

use convergence_study::study::{Case, CaseFailure, Header, Kind, KindRow, Outcome, Ran, reader};
use thermobeam::dg::ContactEvent;

use crate::kinds::tables::Discretisation;
use crate::run::tally::Sample;
use crate::scene::Scene;

/// The row of the table of kinds.
pub const ROW: KindRow = KindRow {
    name: "exact-experiments",
    read: reader::<ExactExperiments>,
    why: "Elements of high degree and dG(q), with contact located to round-off, converge so fast that some hundred steps give ten \
          digits. Two discretisations that share neither mesh nor degrees nor steps make different errors.",
    judged: "Both must agree at each time listed within the tolerance, in the state of the free end and the energy, and on every \
             contact event. The energy must fall, its balance close to round-off.",
    failure: "One of the two is not resolved: raise the degrees or lower the steps of both and see which one moves.",
};

/// By what a scene is run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Method {
    /// By the discretisation of this number.
    AnyOrder(usize),
    /// By the scene's own scheme, mesh and steps.
    Own,
}

/// One run of one scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Run {
    /// Number of the scene.
    pub scene: usize,
    /// How it is run.
    pub method: Method,
}

/// What a run shows.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Shown {
    /// States at the times listed.
    pub states: Vec<Sample>,
    /// Contact events; none by the scene's own scheme, which does not locate them.
    pub events: Vec<ContactEvent>,
    /// `(t, u(1, t))` at equally spaced times.
    pub tip: Vec<(f64, f64)>,
    /// Steps.
    pub steps: usize,
    /// Largest residual of the balance over E0, and largest change of the energy in a step.
    pub balance: [f64; 2],
}

/// A study of experiments.
pub struct ExactExperiments {
    header: Header,
    scenes: Vec<Scene>,
    times: Vec<f64>,
    discretisations: [Discretisation; 2],
    agreement: f64,
    /// Whether the scenes' own schemes are run and compared.
    compare: bool,
}

impl Kind for ExactExperiments {
    type Data = Run;
    type Found = Shown;

    fn header(&self) -> &Header {
        &self.header
    }

    fn cases(&self) -> Vec<Case<Run>> {
        cases::cases(self)
    }

    fn run(&self, run: &Run) -> Result<Shown, CaseFailure> {
        cases::run(self, *run)
    }

    fn judge(&self, ran: &[Ran<Run, Shown>]) -> Outcome {
        judge::judge(self, ran)
    }
}
