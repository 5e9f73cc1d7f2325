//! Both solvers over the time step and a second parameter.
//!
//! # The scene
//!
//! A beam that touches the upper obstacle and is driven into it, by a velocity for short steps and by the heat of its
//! clamped end for long ones, so that the tip is in contact at the end of the first step for every parameter on the map. In
//! that step the fixed point is measured: does it converge, in how many iterations, and by which factor the last increment
//! shrank. Newton's method goes on for more steps: its iterations, the largest rise of the energy, and the largest
//! residual of its balance against what rounding errors explain.
//!
//! # The prediction
//!
//! The eigenvalues of the error propagation lie between `-α` (contact) and `γ` (coupling between rotation and
//! displacement): the boundary of convergence lies at α = 1 where γ is small, and above it where γ is not, by a share of
//! γ. On lines through the map it is found by bisection in dt.
//!
//! Newton's method needs a definite operator: `B (ζ + dt/2) + m dt/2 > 0` is enough, with the buckling force B and
//! the mean axial force m >= β.

mod boundary;
mod figures;
mod judge;
mod row;

use convergence_study::study::Case;
use convergence_study::text::number::plain_text;
use thermobeam::mesh::{Mesh, MeshError};
use thermobeam::parameters::{Beam, Obstacles};
use thermobeam::simulation::{Initial, Problem};

use super::Task;

pub use boundary::{Boundary, Crossing};
pub use row::{NewtonSteps, Point, Row};

/// The obstacles, close enough for the heat to press the beam against them for every β on the maps.
const GAP: f64 = 0.01;
/// Temperature of the clamped end.
const HEAT: f64 = 20.0;
/// Velocity of the tip.
const SPEED: f64 = 0.1;

/// The table `[map]`.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Map {
    pub(super) over: Parameter,
    pub(super) dt: [f64; 2],
    pub(super) range: [f64; 2],
    pub(super) points: usize,
    pub(super) lines: Vec<f64>,
    pub(super) elements: usize,
    pub(super) steps: usize,
    pub(super) agreement: f64,
}

/// The second parameter of a map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Parameter {
    Epsilon,
    Beta,
    Zeta,
    /// Mesh width; the number of elements is the nearest whole one.
    Width,
}

impl Parameter {
    pub(super) const ALL: [(&str, Parameter); 4] = [
        ("epsilon", Parameter::Epsilon),
        ("beta", Parameter::Beta),
        ("zeta", Parameter::Zeta),
        ("h", Parameter::Width),
    ];

    fn name(self) -> &'static str {
        Self::ALL.iter().find(|(_, parameter)| *parameter == self).map_or("", |(name, _)| name)
    }

    pub(super) fn is_linear(self) -> bool {
        self == Parameter::Beta
    }
}

/// Values from the first to the last of `range`, equally spaced on a linear or logarithmic scale.
fn spaced([low, high]: [f64; 2], points: usize, linear: bool) -> Vec<f64> {
    let at = |k: usize| k as f64 / (points - 1) as f64;
    let value = |s: f64| if linear { low + (high - low) * s } else { low * (high / low).powf(s) };
    (0..points).map(|k| value(at(k))).collect()
}

impl Map {
    /// The time steps of every row.
    fn time_steps(&self) -> Vec<f64> {
        spaced(self.dt, self.points, false)
    }

    /// The values of the second parameter, one for each row.
    fn row_values(&self) -> Vec<f64> {
        spaced(self.range, self.points, self.over.is_linear())
    }

    /// The coefficients at a value of the second parameter.
    fn beam(&self, value: f64) -> Beam {
        let mut beam = Beam { theta_a: HEAT, ..Beam::default() };
        match self.over {
            Parameter::Beta => beam.beta = value,
            Parameter::Zeta => beam.zeta = value,
            Parameter::Epsilon | Parameter::Width => {}
        }
        beam
    }

    /// The scene at a value of the second parameter.
    fn problem(&self, value: f64) -> Result<Problem, MeshError> {
        let mut obstacles = Obstacles { g1: -GAP, g2: GAP, ..Obstacles::default() };
        let mut elements = self.elements;
        match self.over {
            Parameter::Epsilon => obstacles.epsilon = value,
            Parameter::Width => elements = (1.0 / value).round().max(1.0) as usize,
            Parameter::Beta | Parameter::Zeta => {}
        }
        let mesh = Mesh::uniform(elements)?;
        let mut initial = Initial::at_rest(&mesh, HEAT);
        initial.u = mesh.nodes().iter().map(|x| GAP * x * (2.0 - x)).collect();
        initial.u_t = mesh.nodes().iter().map(|x| SPEED * x).collect();
        Ok(Problem { beam: self.beam(value), obstacles: Some(obstacles), mesh, initial })
    }

    pub(super) fn cases(&self) -> Vec<Case<Task>> {
        let name = self.over.name();
        let elements = |value: f64| if self.over == Parameter::Width { 1.0 / value } else { self.elements as f64 };
        let row = |value: f64| {
            let cost = (self.points * (row::ITERATIONS + 4 * self.steps)) as f64 * elements(value);
            Case { label: format!("{name} = {value:.3e}"), cost, data: Task::Row(value) }
        };
        let line = |&value: &f64| {
            let cost = (2 * boundary::HALVINGS * boundary::ITERATIONS) as f64 * elements(value);
            Case { label: format!("boundary at {name} = {}", plain_text(value)), cost, data: Task::Boundary(value) }
        };
        self.row_values().into_iter().map(row).chain(self.lines.iter().map(line)).collect()
    }
}

/// The axial force at the start; the first steps hardly change it.
fn axial_force(problem: &Problem) -> f64 {
    let lengths: Vec<f64> = problem.mesh.lengths().collect();
    problem.beam.axial_force(thermobeam::norms::slope_squared(&lengths, &problem.initial.u))
}
