//! The one time loop: step, then observe what was asked for.

use crate::energy::{self, Balance, Energy, Rounding};
use crate::error::{SetupError, StepError, StepFailure};
use crate::mesh::Mesh;
use crate::parameters::{Beam, Obstacles};
use crate::scheme::Scheme;
use crate::solve::fixed_point::FixedPoint;
use crate::solve::newton::{Case, Newton};
use crate::solve::{Level, Settings, Solver, StepReport, Work};

/// Rounding errors that an initial value may carry where the boundary condition asks for a number, in units of the
/// field's largest value: sin(πx) at x = 1 is 1e-16, 20 cos(5πx/2) there 6e-15.
const BOUNDARY_SLACK: f64 = 64.0 * f64::EPSILON;

/// Nodal values of the initial data (1.2), n + 1 of each; (3.6) is interpolation in one dimension.
#[derive(Debug, Clone, PartialEq)]
pub struct Initial {
    /// u_0, zero at x = 0.
    pub u: Vec<f64>,
    /// u_1, zero at x = 0.
    pub u_t: Vec<f64>,
    /// φ_0, zero at x = 0.
    pub phi: Vec<f64>,
    /// φ_1, zero at x = 0.
    pub phi_t: Vec<f64>,
    /// The physical temperature θ_0: θ_A at x = 0 and zero at x = 1.
    pub theta: Vec<f64>,
}

impl Initial {
    /// A straight beam at rest, its temperature the steady θ_A (1 - x).
    pub fn at_rest(mesh: &Mesh, theta_a: f64) -> Self {
        let zeros = vec![0.0; mesh.nodes().len()];
        let theta = mesh.nodes().iter().map(|x| theta_a * (1.0 - x)).collect();
        Self { u: zeros.clone(), u_t: zeros.clone(), phi: zeros.clone(), phi_t: zeros, theta }
    }
}

/// A beam, its obstacles, its mesh and its initial data.
#[derive(Debug, Clone, PartialEq)]
pub struct Problem {
    /// Coefficients of (1.1).
    pub beam: Beam,
    /// The obstacles of (1.3), if any.
    pub obstacles: Option<Obstacles>,
    /// The triangulation.
    pub mesh: Mesh,
    /// The initial data.
    pub initial: Initial,
}

/// How to step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stepping {
    /// The time scheme.
    pub scheme: Scheme,
    /// How a step is solved.
    pub settings: Settings,
    /// δt > 0.
    pub dt: f64,
    /// Whether loads will be given before each step ([`Simulation::load_mut`]).
    pub loaded: bool,
}

/// Memory of a heated simulation by Newton's method, in bytes an element: 144 are the factorisation's.
pub const BYTES_PER_ELEMENT: usize = 392;

/// A running simulation, standing at one time level.
///
/// It holds [`BYTES_PER_ELEMENT`] by Newton's method, 256 where nothing is heated, and 248 by the fixed point.
pub struct Simulation {
    problem: Problem,
    lengths: Vec<f64>,
    stepping: Stepping,
    stepper: Stepper,
    step: usize,
    loads: usize,
    observations: usize,
}

/// The stepper, chosen once: with or without temperature, or the paper's fixed point.
enum Stepper {
    Cold(Box<Newton<f64, 2>>),
    Heated(Box<Newton<f64, 3>>),
    FixedPoint(Box<FixedPoint>),
}

impl Simulation {
    /// Checks everything once and stands at t = 0.
    ///
    /// # Errors
    /// [`SetupError`] for coefficients out of range, initial data that are not finite, of the wrong length, or that
    /// break a boundary condition, and for a dt, tolerance or iteration limit that is not positive.
    pub fn new(mut problem: Problem, stepping: Stepping) -> Result<Self, SetupError> {
        let level = prepare(&mut problem, &stepping)?;
        let lengths: Vec<f64> = problem.mesh.lengths().collect();
        let case = Case { beam: problem.beam, obstacles: problem.obstacles, dt: stepping.dt, lengths: lengths.clone() };
        let stepper = choose(case, &stepping, &level)?;
        Ok(Self { problem, lengths, stepping, stepper, step: 0, loads: 0, observations: 0 })
    }

    /// Number n of the present time level.
    pub fn step(&self) -> usize {
        self.step
    }

    /// The time t_n = n δt.
    pub fn t(&self) -> f64 {
        self.step as f64 * self.stepping.dt
    }

    /// The time step δt.
    pub fn dt(&self) -> f64 {
        self.stepping.dt
    }

    /// The loads of the next step, `(F_u, F_φ, F_θ)` at each of the n + 1 nodes, to be filled before [`Self::advance`].
    ///
    /// `None` unless [`Stepping::loaded`] was set. Entries at clamped nodes are not read.
    pub fn load_mut(&mut self) -> Option<&mut [[f64; 3]]> {
        if !self.stepping.loaded {
            return None;
        }
        self.loads += 1;
        match &mut self.stepper {
            Stepper::Cold(_) => None,
            Stepper::Heated(newton) => Some(newton.load_mut()),
            Stepper::FixedPoint(fixed_point) => Some(fixed_point.load_mut()),
        }
    }

    /// Does one step; allocates nothing.
    ///
    /// # Errors
    /// [`StepError`] with step, time and numbers; the simulation then stands where it stood.
    pub fn advance(&mut self) -> Result<StepReport, StepError> {
        let mut outcome = [Err(StepFailure::NonFinite { iterations: 0, increment: f64::NAN })];
        match &mut self.stepper {
            Stepper::Cold(newton) => newton.advance(&mut outcome),
            Stepper::Heated(newton) => newton.advance(&mut outcome),
            Stepper::FixedPoint(fixed_point) => outcome[0] = fixed_point.advance(),
        }
        let [outcome] = outcome;
        let step = self.step + 1;
        let t = step as f64 * self.stepping.dt;
        let report = outcome.map_err(|failure| StepError { step, t, failure })?;
        self.step = step;
        Ok(report)
    }

    /// Copies the present level into `level`, which must have n + 1 nodes.
    pub fn observe(&mut self, level: &mut Level) {
        self.observations += 1;
        match &self.stepper {
            Stepper::Cold(newton) => newton.read(0, level),
            Stepper::Heated(newton) => newton.read(0, level),
            Stepper::FixedPoint(fixed_point) => fixed_point.read(level),
        }
    }

    /// The present level, as a new one.
    pub fn level(&mut self) -> Level {
        let mut level = Level::new(self.lengths.len() + 1);
        self.observe(&mut level);
        level
    }

    /// Energy of a level of this simulation.
    pub fn energy(&self, level: &Level) -> Energy {
        Energy::of(&self.problem.beam, self.problem.obstacles.as_ref(), &self.lengths, level)
    }

    /// Balance of the step between two consecutive levels of this simulation, for a step without loads.
    pub fn balance(&self, old: &Level, new: &Level) -> Balance {
        let obstacles = self.problem.obstacles.as_ref();
        Balance::of(&self.problem.beam, obstacles, &self.stepping.scheme, self.stepping.dt, &self.lengths, old, new)
    }

    /// The change of the energy alone, from one level to another: [`Balance::change`] at half the cost.
    pub fn energy_change(&self, old: &Level, new: &Level) -> f64 {
        Balance::change_of(&self.problem.beam, self.problem.obstacles.as_ref(), &self.lengths, old, new)
    }

    /// The size of a level's energy, without signs: what a residual of the balance is to be compared with.
    pub fn energy_scale(&self, level: &Level) -> f64 {
        energy::scale(&self.problem.beam, self.problem.obstacles.as_ref(), &self.lengths, level)
    }

    /// What rounding errors explain in the balance between two consecutive levels.
    pub fn rounding(&self, old: &Level, new: &Level) -> Rounding {
        let Problem { beam, obstacles, .. } = &self.problem;
        Rounding::of(beam, obstacles.as_ref(), self.stepping.dt, &self.lengths, old, new)
    }

    /// The problem being solved; its initial data have the boundary values exactly.
    pub fn problem(&self) -> &Problem {
        &self.problem
    }

    /// Length of each element.
    pub fn lengths(&self) -> &[f64] {
        &self.lengths
    }

    /// Counts of the work done so far.
    pub fn work(&self) -> Work {
        let work = match &self.stepper {
            Stepper::Cold(newton) => newton.work(),
            Stepper::Heated(newton) => newton.work(),
            Stepper::FixedPoint(fixed_point) => fixed_point.work(),
        };
        Work { loads: self.loads, observations: self.observations, ..work }
    }

    /// Whether the temperature is computed: it is left out where nothing heats the beam.
    pub fn is_heated(&self) -> bool {
        !matches!(self.stepper, Stepper::Cold(_))
    }
}

/// Checks a problem and its stepping, sets the boundary values exactly, and gives the level at t = 0.
pub(crate) fn prepare(problem: &mut Problem, stepping: &Stepping) -> Result<Level, SetupError> {
    check_settings(problem, stepping)?;
    initial_level(problem)
}

/// Whether something heats the beam: its own deformation, or the heat that it starts with.
pub(crate) fn is_heated(beam: &Beam, level: &Level) -> bool {
    beam.a != 0.0 || level.theta.iter().any(|&theta| theta != 0.0)
}

fn choose(case: Case, stepping: &Stepping, level: &Level) -> Result<Stepper, SetupError> {
    let (scheme, settings) = (stepping.scheme, stepping.settings);
    if settings.solver == Solver::FixedPoint {
        return FixedPoint::new(case, scheme, settings, level)
            .map(|fixed_point| Stepper::FixedPoint(Box::new(fixed_point)))
            .map_err(|_| SetupError::TimeStep { found: stepping.dt });
    }
    let heated = stepping.loaded || is_heated(&case.beam, level);
    let nodes = 0..level.u.len();
    let initial = vec![nodes.clone().map(|i| [level.u[i], level.phi[i], level.theta[i]]).collect()];
    let velocity = vec![nodes.map(|i| [level.v[i], level.w[i]]).collect()];
    Ok(if heated {
        Stepper::Heated(Box::new(Newton::new(vec![case], scheme, settings, &initial, &velocity)))
    } else {
        Stepper::Cold(Box::new(Newton::new(vec![case], scheme, settings, &initial, &velocity)))
    })
}

fn check_settings(problem: &Problem, stepping: &Stepping) -> Result<(), SetupError> {
    problem.beam.validate()?;
    if let Some(obstacles) = &problem.obstacles {
        obstacles.validate()?;
    }
    if !(stepping.dt > 0.0 && stepping.dt.is_finite()) {
        return Err(SetupError::TimeStep { found: stepping.dt });
    }
    let Settings { tolerance, max_iterations, .. } = stepping.settings;
    if !(tolerance > 0.0 && tolerance.is_finite()) {
        return Err(SetupError::Setting { name: "tolerance", found: tolerance, allowed: "a finite number > 0" });
    }
    if max_iterations == 0 {
        return Err(SetupError::Setting { name: "max_iterations", found: 0.0, allowed: "an integer >= 1" });
    }
    Ok(())
}

/// Checks the initial data, sets their boundary values exactly, and lifts the temperature.
fn initial_level(problem: &mut Problem) -> Result<Level, SetupError> {
    let nodes = problem.mesh.nodes();
    let theta_a = problem.beam.theta_a;
    let Initial { u, u_t, phi, phi_t, theta } = &mut problem.initial;
    let last = nodes.len() - 1;
    check_field("u", u, nodes, &[(0, 0.0)])?;
    check_field("u_t", u_t, nodes, &[(0, 0.0)])?;
    check_field("phi", phi, nodes, &[(0, 0.0)])?;
    check_field("phi_t", phi_t, nodes, &[(0, 0.0)])?;
    check_field("theta", theta, nodes, &[(0, theta_a), (last, 0.0)])?;
    let mut level = Level::new(nodes.len());
    level.u.clone_from(u);
    level.v.clone_from(u_t);
    level.phi.clone_from(phi);
    level.w.clone_from(phi_t);
    for ((lifted, theta), x) in level.theta.iter_mut().zip(theta.iter()).zip(nodes) {
        *lifted = theta - theta_a * (1.0 - x);
    }
    level.contact_force = problem.obstacles.map_or(0.0, |obstacles| obstacles.force(u[last]));
    Ok(level)
}

fn check_field(
    field: &'static str,
    values: &mut [f64],
    nodes: &[f64],
    boundary: &[(usize, f64)],
) -> Result<(), SetupError> {
    if values.len() != nodes.len() {
        return Err(SetupError::Length { field, found: values.len(), expected: nodes.len() });
    }
    if let Some(node) = values.iter().position(|value| !value.is_finite()) {
        return Err(SetupError::NotFinite { field, node, found: values[node] });
    }
    let scale = values.iter().fold(0.0, |scale: f64, value| scale.max(value.abs()));
    for &(node, allowed) in boundary {
        if (values[node] - allowed).abs() > BOUNDARY_SLACK * scale {
            return Err(SetupError::Boundary { field, x: nodes[node], found: values[node], allowed });
        }
        values[node] = allowed;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_beam_at_rest_is_straight_and_has_the_steady_temperature() {
        let mesh = Mesh::from_nodes(vec![0.0, 0.25, 1.0]).unwrap();
        let Initial { u, u_t, phi, phi_t, theta } = Initial::at_rest(&mesh, 2.0);
        assert_eq!(theta, [2.0, 1.5, 0.0]);
        assert!([u, u_t, phi, phi_t].iter().all(|field| *field == [0.0; 3]));
    }
}
