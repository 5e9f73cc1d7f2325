//! Damped vibrations without any source term: the one motion of this beam that is known in closed form.
//!
//! For a = β = ρ = 0 and without obstacles each mode of [`thermobeam::vibration`] moves by itself, and a beam started
//! from a sum of modes stays that sum for ever. Nothing is manufactured: no load keeps the solution in place, so an
//! error in the scheme and the same error in the sources cannot cancel. The module `clock` tells how space and time errors
//! are measured one without the other.

mod cases;
mod clock;
mod file;
mod judge;
mod mesh_modes;
mod motion;

use convergence_study::study::{Axis, Case, CaseFailure, Header, Kind, KindRow, Outcome, Ran, reader};
use thermobeam::parameters::Beam;

use crate::kinds::tables::{Expectation, Norms, Refine};

/// The row of the table of kinds.
pub const ROW: KindRow = KindRow {
    name: "vibration",
    read: reader::<Vibration>,
    why: "Without coupling, nonlinearity and obstacles the damped modes of the beam are exact solutions that no source term keeps \
          in place. Moved by the scheme's own recursion they leave the space error alone; the mesh's own modes, moved exactly, \
          leave the time error alone.",
    judged: "Errors in each norm over the levels, by the rule of every rate; and the solver against the closed form, to round-off.",
    failure: "The beam that is simulated is not the beam of the equations, or a step of the scheme is wrong. No manufactured load \
              can be to blame.",
};

/// A study of exact vibrations.
#[derive(Debug, Clone, PartialEq)]
pub struct Vibration {
    header: Header,
    /// The beam whose modes are exact.
    beam: Beam,
    /// The beam that the solver is given: another one in a negative control.
    solver: Beam,
    modes: Vec<Vibrating>,
    heat: Vec<Cooling>,
    refine: Refine,
    expect: Vec<Expectation>,
}

/// A vibration.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Vibrating {
    /// From 0, the lowest frequency.
    index: usize,
    /// The mode's tip displacement and velocity at t = 0.
    start: [f64; 2],
}

/// A temperature that decays.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Cooling {
    /// k of sin kπx.
    k: usize,
    /// Its amplitude at t = 0.
    amplitude: f64,
}

/// What a run has measured.
#[derive(Debug, Clone, PartialEq)]
pub struct Vibrated {
    /// The largest error over the time levels in each norm.
    pub errors: Norms,
    /// In the design that isolates time: the largest distance from the scheme's own steps of the mesh's modes, relative to
    /// the size of the motion, both in the norm of Theorem 3.4.
    pub closed_form: Option<f64>,
    /// (t, u(1, t)) of the reference at each time level.
    pub exact_tip: Vec<(f64, f64)>,
    /// (t, u(1, t)) of the solver at each time level.
    pub tip: Vec<(f64, f64)>,
}

impl Vibration {
    fn isolates(&self, axis: Axis) -> bool {
        self.refine.isolate && self.refine.axis == axis
    }
}

impl Kind for Vibration {
    /// Elements and steps.
    type Data = (usize, usize);
    type Found = Vibrated;

    fn header(&self) -> &Header {
        &self.header
    }

    fn cases(&self) -> Vec<Case<(usize, usize)>> {
        cases::cases(self)
    }

    fn run(&self, resolution: &(usize, usize)) -> Result<Vibrated, CaseFailure> {
        cases::run(self, *resolution)
    }

    fn judge(&self, ran: &[Ran<(usize, usize), Vibrated>]) -> Outcome {
        judge::judge(self, ran)
    }
}
