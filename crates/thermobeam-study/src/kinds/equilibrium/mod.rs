//! Where long runs end, against exact steady states, which no source term keeps in place.
//!
//! A beam at rest solves the discrete static problem to round-off, whatever the time step was: what is left is the error
//! of P1 elements, O(h²) at the nodes in u and in φ. By elements of high degree and dG(q) next to nothing is left. Four things
//! are judged: that, where the file asks for it, the rate at every scene that ends bent, the
//! error on the finest mesh, and that a beam whose steady state is straight ends straight, but for the motion left.

mod cases;
mod file;
mod judge;

use convergence_study::study::{Case, CaseFailure, Header, Kind, KindRow, Outcome, Ran, reader};
use thermobeam::equilibrium::Contact;

use crate::kinds::tables::Discretisation;
use crate::scene::Scene;

/// The row of the table of kinds.
pub const ROW: KindRow = KindRow {
    name: "equilibrium",
    read: reader::<EndStates>,
    why: "All steady states are roots of a function of one variable, known to round-off. A damped beam must come to rest at one.",
    judged: "Beams are run to rest on several meshes; their end states converge at second order to an exact \
             state; a run of any order ends in it.",
    failure: "The steady part of the equations is discretised wrongly, or the beam has not come to rest.",
};

/// A study of the steady states in which long runs end.
#[derive(Debug, Clone, PartialEq)]
pub struct EndStates {
    header: Header,
    scenes: Vec<Scene>,
    /// At least three numbers of elements, ascending.
    elements: Vec<usize>,
    dt: f64,
    /// The largest velocity of a beam at rest.
    speed: f64,
    t_max: f64,
    /// How far the observed rate may be from the order 2.
    tolerance: f64,
    /// The error allowed on the finest mesh.
    error: f64,
    /// The scenes by the scheme of any order as well.
    any_order: Option<AnyOrder>,
}

/// Long runs by the scheme of any order.
#[derive(Debug, Clone, Copy, PartialEq)]
struct AnyOrder {
    how: Discretisation,
    t_end: f64,
    /// The error allowed.
    error: f64,
}

/// A scene on one mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct OnMesh {
    /// Its place in the list of scenes.
    pub scene: usize,
    /// Linear elements; `None` for the run of any order.
    pub elements: Option<usize>,
}

/// A number of the displacement and one of the rotation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fields {
    /// Of u.
    pub u: f64,
    /// Of φ.
    pub phi: f64,
}

/// A beam at rest, and the exact stable state next to it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct End {
    /// When it came to rest.
    pub t: f64,
    /// u(1) and φ(1).
    pub tip: Fields,
    /// u(1) and φ(1) of the exact state.
    pub exact_tip: Fields,
    /// The contact of the exact state.
    pub contact: Contact,
    /// Largest errors at the nodes.
    pub error: Fields,
}

impl Kind for EndStates {
    type Data = OnMesh;
    type Found = End;

    fn header(&self) -> &Header {
        &self.header
    }

    fn cases(&self) -> Vec<Case<OnMesh>> {
        cases::cases(self)
    }

    fn run(&self, data: &OnMesh) -> Result<End, CaseFailure> {
        cases::run(self, *data)
    }

    fn judge(&self, ran: &[Ran<OnMesh, End>]) -> Outcome {
        judge::judge(self, ran)
    }
}
