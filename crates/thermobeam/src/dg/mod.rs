//! Any order: elements of degree p in space, discontinuous Galerkin of degree q in time.
//!
//! # The scheme
//!
//! On a step of length τ the velocities v, w and the lifted temperature θ~ are polynomials of
//! degree q in time, discontinuous between steps; the displacements are their integrals,
//! `u = u_0 + ∫ v`, `φ = φ_0 + ∫ w`. For all polynomials of degree q in time with values in the
//! finite element spaces
//!
//! ```text
//! ∫ [(v_t, χ) + (u_x - φ + ζ (v_x - w), χ_x) + N(u)(u_x, χ_x) + g(u(1)) χ(1)] + (v(0+) - v_0, χ(0)) = 0
//! ∫ [(w_t, ψ) + (φ_x + ζ w_x, ψ_x) - (u_x - φ + ζ (v_x - w), ψ) - a (θ~, ψ_x) - a θ_A (1, ψ)] + (w(0+) - w_0, ψ(0)) = 0
//! ∫ [(θ~_t, η) + (θ~_x, η_x) + a (w_x, η)] + (θ~(0+) - θ~_0, η(0)) = 0
//! ```
//!
//! The new level is the value at the end. For q = 0 and p = 1 these are (3.7)-(3.8) with three
//! differences: contact and N are integrated over the step, and backward Euler is used for θ~. The
//! order is 2q + 1 at the ends of steps and p + 1 in space (p in the energy norm), the energy
//! balance is exact for every q, and steps end where contact begins or ends. See "Any order" in
//! [`crate::theory`].
//!
//! # The modules
//!
//! `element`, `space`, `forms`: the elements. `time`: integrals in time. `residual`: the equations
//! above. `operator`, `block`, `factor`: their matrix and its elimination. `stages`, `iteration`: a
//! step of given length. `phase`, `contact_event`, `lengths`: where steps end. `problem`,
//! `simulation`, `observe`: the interface for users, with the balance of the energy.
//!
//! ```
//! use thermobeam::dg::{Dg, DgProblem, DgStepping, Field, InitialFunctions};
//! use thermobeam::mesh::Mesh;
//! use thermobeam::motion::Motion;
//! use thermobeam::parameters::{Beam, Obstacles};
//!
//! // The paper's first experiment on a single element.
//! let initial = InitialFunctions {
//!     u: Box::new(|x| 0.01 * x * (x - 2.0)),
//!     u_t: Box::new(|x| 20.0 * x * (x - 1.0) * (x - 1.0)),
//!     theta: Box::new(|x| (std::f64::consts::PI * x).sin()),
//!     ..InitialFunctions::at_rest(0.0)
//! };
//! let problem =
//!     DgProblem { beam: Beam::default(), obstacles: Some(Obstacles::default()), mesh: Mesh::uniform(1)?, degree: 14, initial };
//! let mut simulation = Dg::new(problem, DgStepping::default())?;
//! simulation.advance(1.0)?;
//! let u = simulation.value(Field::U, 1.0, 1.0).expect("a time in the last step");
//! assert!((u - -0.011764243810).abs() < 1e-8);
//! assert_eq!(simulation.events().len(), 3);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod block;
mod contact_event;
pub mod element;
mod factor;
mod forms;
mod iteration;
mod legendre;
mod lengths;
mod observe;
mod operator;
mod phase;
mod problem;
mod residual;
mod simulation;
mod space;
mod stages;
mod time;

pub use crate::contact::ContactEvent;
pub use crate::contact::Phase;
pub use element::MAX_DEGREE;
pub use problem::{DgProblem, DgStepping, InitialFunctions};
pub use simulation::Dg;
pub use space::{BeamPoint, Field, Space};
pub use time::Load;

/// The highest degree in time.
pub const MAX_TIME_DEGREE: usize = time::MAX_STAGES - 1;

/// The discrete solution at one time: coefficients, block by block, in the numbering of
/// [`Space::place`].
#[derive(Debug, Clone, PartialEq)]
pub struct DgLevel {
    /// The time t.
    pub t: f64,
    /// u and φ.
    pub places: Vec<[f64; 2]>,
    /// v = u_t, w = φ_t, and the lifted temperature θ~.
    pub rates: Vec<[f64; 3]>,
}

impl DgLevel {
    /// A level of zeros for a space.
    pub fn new(space: &Space) -> Self {
        Self {
            t: 0.0,
            places: vec![[0.0; 2]; space.blocks()],
            rates: vec![[0.0; 3]; space.blocks()],
        }
    }

    /// Value and slope of a field at x.
    pub fn value_and_slope(&self, space: &Space, field: Field, x: f64) -> (f64, f64) {
        self.values_and_slopes(space, x)[field as usize]
    }

    /// Values and slopes of all fields at x, in the order of [`Field::ALL`].
    pub fn values_and_slopes(&self, space: &Space, x: f64) -> [(f64, f64); Field::ALL.len()] {
        self.values_and_slopes_at(space, &space.locate(x))
    }

    /// The same at a point that [`Space::locate`] has found.
    pub fn values_and_slopes_at(
        &self,
        space: &Space,
        point: &BeamPoint,
    ) -> [(f64, f64); Field::ALL.len()] {
        space.evaluate_all(point, |u, phi| {
            let (places, rates) = (&self.places, &self.rates);
            [
                places[u][0],
                places[phi][1],
                rates[u][0],
                rates[phi][1],
                rates[u][2],
            ]
        })
    }

    fn copy_from(&mut self, other: &Self) {
        self.t = other.t;
        self.places.copy_from_slice(&other.places);
        self.rates.copy_from_slice(&other.rates);
    }
}
