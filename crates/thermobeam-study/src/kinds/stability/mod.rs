//! Where the two solvers converge: maps over the time step and a second parameter, and the boundary α = 1.
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
//! In contact an error of the fixed point shrinks by `α = (dt/ε) [A_u⁻¹]_nn` per iteration. Beside it stands the lag between
//! rotation and displacement, whose factor γ is positive where that of the contact is negative, so that together they make
//! at least `-α` and at most γ: the boundary lies at α = 1 where γ is small and above it where it is not, by a
//! share of γ. On lines through the map it is found by bisection in dt: the largest dt, up to the second, at which the
//! increments still shrink.
//!
//! Newton's method needs a definite operator: `B (ζ + dt/2) + m dt/2 > 0` is enough, with the buckling force B and
//! the mean axial force m >= β.
//!
//! ```toml
//! [stability]
//! over = "epsilon"           # the second parameter: epsilon, beta, zeta or h
//! dt = [1e-6, 10.0]          # range of the map, logarithmic
//! range = [1e-8, 10.0]       # of the second parameter; logarithmic, but for beta
//! points = 40                # along either axis
//! lines = [1e-6, 1e-3]       # values of the second parameter at which the boundary is bisected
//! elements = 32
//! steps = 16                 # by Newton's method
//! agreement = 0.02           # of measured and predicted boundary, relative
//! ```

mod boundary;
mod figures;
mod measure;
mod report;
mod spec;

use crate::kinds::untyped::{Case, Measured};
use crate::kinds::{FromFile, Study};
use convergence_study::input::{self, InputError};
use convergence_study::study::CaseFailure;
use convergence_study::study::Header;
use convergence_study::study::outcome::Outcome;
use std::path::Path;
use thermobeam::mesh::{Mesh, MeshError};
use thermobeam::parameters::{Beam, Obstacles};
use thermobeam::simulation::{Initial, Problem};

/// Name of the kind.
pub const KIND: &str = "stability";

/// The obstacles, close enough for the heat to press the beam against them whatever β on the maps.
const GAP: f64 = 0.01;
/// Temperature of the clamped end.
const HEAT: f64 = 20.0;
/// Velocity of the tip.
const SPEED: f64 = 0.1;

/// A study of this kind.
#[derive(Debug, Clone)]
pub struct Stability {
    header: Header,
    over: Parameter,
    dt: [f64; 2],
    range: [f64; 2],
    points: usize,
    lines: Vec<f64>,
    elements: usize,
    steps: usize,
    agreement: f64,
}

/// The second parameter of a map.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Parameter {
    Epsilon,
    Beta,
    Zeta,
    /// Mesh width; the number of elements is the nearest whole one.
    Width,
}

impl Parameter {
    const ALL: [(&str, Parameter); 4] = [
        ("epsilon", Parameter::Epsilon),
        ("beta", Parameter::Beta),
        ("zeta", Parameter::Zeta),
        ("h", Parameter::Width),
    ];

    fn name(self) -> &'static str {
        Self::ALL.iter().find(|(_, parameter)| *parameter == self).map_or("", |(name, _)| name)
    }

    fn is_linear(self) -> bool {
        self == Parameter::Beta
    }
}

/// Values from the first to the last of `range`, equally spaced on a linear or logarithmic scale.
fn spaced([low, high]: [f64; 2], points: usize, linear: bool) -> Vec<f64> {
    let at = |k: usize| k as f64 / (points - 1) as f64;
    let value = |s: f64| if linear { low + (high - low) * s } else { low * (high / low).powf(s) };
    (0..points).map(|k| value(at(k))).collect()
}

impl FromFile for Stability {
    fn parse(text: &str, file: &Path) -> Result<Self, InputError> {
        input::parse_beside(text, file, |root, _| spec::from_document(root))
    }
}

impl Stability {
    /// The time steps of the map.
    fn steps_of_map(&self) -> Vec<f64> {
        spaced(self.dt, self.points, false)
    }

    /// The values of the second parameter.
    fn rows(&self) -> Vec<f64> {
        spaced(self.range, self.points, self.over.is_linear())
    }

    /// The scene at a value of the second parameter.
    fn problem(&self, value: f64) -> Result<Problem, MeshError> {
        let mut beam = Beam { theta_a: HEAT, ..Beam::default() };
        let mut obstacles = Obstacles { g1: -GAP, g2: GAP, ..Obstacles::default() };
        let mut elements = self.elements;
        match self.over {
            Parameter::Epsilon => obstacles.epsilon = value,
            Parameter::Beta => beam.beta = value,
            Parameter::Zeta => beam.zeta = value,
            Parameter::Width => elements = (1.0 / value).round().max(1.0) as usize,
        }
        let mesh = Mesh::uniform(elements)?;
        let mut initial = Initial::at_rest(&mesh, HEAT);
        initial.u = mesh.nodes().iter().map(|x| GAP * x * (2.0 - x)).collect();
        initial.u_t = mesh.nodes().iter().map(|x| SPEED * x).collect();
        Ok(Problem { beam, obstacles: Some(obstacles), mesh, initial })
    }
}

impl Study for Stability {
    fn header(&self) -> &Header {
        &self.header
    }

    fn cases(&self) -> Vec<Case> {
        let name = self.over.name();
        let elements = |value: f64| if self.over == Parameter::Width { 1.0 / value } else { self.elements as f64 };
        let row = |value: f64| {
            let cost = (self.points * (measure::ITERATIONS + 4 * self.steps)) as f64 * elements(value);
            Case { label: format!("{name} = {value:.3e}"), cost }
        };
        let line = |value: &f64| {
            let cost = (2 * boundary::HALVINGS * boundary::ITERATIONS) as f64 * elements(*value);
            Case { label: format!("boundary at {name} = {value:e}"), cost }
        };
        self.rows().into_iter().map(row).chain(self.lines.iter().map(line)).collect()
    }

    fn run(&self, index: usize) -> Result<Measured, CaseFailure> {
        let rows = self.rows();
        match rows.get(index) {
            Some(&value) => measure::row(&self.problem(value)?, &self.steps_of_map(), self.steps),
            None => boundary::find(&self.problem(self.lines[index - rows.len()])?, self.dt),
        }
    }

    fn conclude(&self, results: &[Result<Measured, CaseFailure>]) -> Outcome {
        report::outcome(self, results)
    }
}
