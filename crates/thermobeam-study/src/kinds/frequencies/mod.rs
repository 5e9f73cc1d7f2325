//! Frequencies of the beam on elements of degree p against the exact ones: order 2p, from above.
//!
//! Rayleigh and Ritz: the frequencies of a subspace lie above those of the beam, and their error is the square of the
//! modes' error in the energy, h^2p. On linear elements `ω_h - ω` is `ω³h²/24` to leading order for high modes.

mod cases;
mod file;
mod judge;

use convergence_study::study::{Case, CaseFailure, Header, Kind, KindRow, Outcome, Ran, reader};

use crate::expression::Expression;

/// The row of the table of kinds.
pub const ROW: KindRow = KindRow {
    name: "frequencies",
    read: reader::<Frequencies>,
    why: "Elements of degree p overestimate the eigenfrequencies of the clamped-free beam by O(h^2p); the exact ones are roots of \
          a scalar equation.",
    judged: "The rate of each frequency from the first to the last one asked for, and that the discrete ones lie above. Frequencies \
             below the first must be met on the finest mesh.",
    failure: "Mass, stiffness or coupling of the discretisation is wrong.",
};

/// A study of frequencies.
#[derive(Debug, Clone, PartialEq)]
pub struct Frequencies {
    header: Header,
    /// The lowest mode that is judged, from 1.
    first: usize,
    /// The highest.
    count: usize,
    degree: usize,
    elements: Vec<usize>,
    map: Option<Expression>,
    order: f64,
    tolerance: f64,
}

impl Kind for Frequencies {
    /// Number of elements.
    type Data = usize;
    /// The first discrete frequencies, ascending.
    type Found = Vec<f64>;

    fn header(&self) -> &Header {
        &self.header
    }

    fn cases(&self) -> Vec<Case<usize>> {
        cases::cases(self)
    }

    fn run(&self, elements: &usize) -> Result<Vec<f64>, CaseFailure> {
        cases::run(self, *elements)
    }

    fn judge(&self, ran: &[Ran<usize, Vec<f64>>]) -> Outcome {
        judge::judge(self, ran)
    }
}
