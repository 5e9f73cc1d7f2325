//! A motion by a one-step scheme with piecewise linear elements: its problem, its settings, and
//! [`OneStep`], which does one step at a time.

use crate::energy::{Balance, Energy, Rounding};
use crate::error::{SetupError, StepError, StepFailure};
use crate::mesh::Mesh;
use crate::motion::{Motion, StepReport, TipRange, Work};
use crate::parameters::{Beam, Obstacles, ParameterError, check, check_positive, check_stopping};
use crate::scheme::{Scheme, SteppedBeam};
use crate::solve::fixed_point::FixedPoint;
use crate::solve::newton::newton;
use crate::solve::stepper::Stepper;
use crate::solve::{Settings, Solver, Stopping, TimeLevel};

/// Tolerance of the boundary values of initial data, relative to the largest value of the field:
/// sin(πx) at x = 1 is 1e-16, 20 cos(5πx/2) there is 6e-15.
const BOUNDARY_SLACK: f64 = 64.0 * f64::EPSILON;

/// Nodal values of the initial data (1.2), n + 1 each.
///
/// The projections P_h* and P_h^0 of (3.6) are nodal interpolation in one dimension.
#[derive(Debug, Clone, PartialEq)]
pub struct InitialValues {
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

impl InitialValues {
    /// A straight beam at rest with the steady temperature θ_A (1 - x).
    pub fn at_rest(mesh: &Mesh, theta_a: f64) -> Self {
        let zeros = vec![0.0; mesh.nodes().len()];
        let theta = mesh.nodes().iter().map(|x| theta_a * (1.0 - x)).collect();
        Self {
            u: zeros.clone(),
            u_t: zeros.clone(),
            phi: zeros.clone(),
            phi_t: zeros,
            theta,
        }
    }
}

/// A beam, its obstacles, its mesh and its initial data.
#[derive(Debug, Clone, PartialEq)]
pub struct Problem {
    /// Coefficients of (1.1).
    pub beam: Beam,
    /// The obstacles of (1.3); `None` leaves the tip free.
    pub obstacles: Option<Obstacles>,
    /// The triangulation.
    pub mesh: Mesh,
    /// The initial data.
    pub initial: InitialValues,
}

impl Problem {
    /// The problem, stepped by a scheme.
    pub fn case(&self, scheme: Scheme, dt: f64) -> SteppedBeam {
        SteppedBeam {
            beam: self.beam,
            obstacles: self.obstacles,
            scheme,
            dt,
            lengths: self.mesh.lengths().collect(),
        }
    }
}

/// Time scheme, solver and time step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stepping {
    /// The time scheme.
    pub scheme: Scheme,
    /// Solver of a step, tolerance and iteration limit.
    pub settings: Settings,
    /// Time step δt > 0.
    pub dt: f64,
    /// Whether loads are given before each step ([`OneStep::load_mut`]).
    pub loaded: bool,
}

/// Memory of a [`OneStep`] by Newton's method with temperature, in bytes per element; the
/// factorisation takes 144 of them.
pub const BYTES_PER_ELEMENT: usize = 392;

/// A beam at one time level, in motion by a one-step scheme.
///
/// It takes [`BYTES_PER_ELEMENT`] with Newton's method, 256 without temperature, and 248 with the
/// fixed point.
pub struct OneStep {
    problem: Problem,
    case: SteppedBeam,
    loaded: bool,
    heated: bool,
    stepper: Box<dyn Stepper<f64>>,
    steps: usize,
}

impl OneStep {
    /// Checks the problem and its settings, and starts at t = 0 with the initial data (1.2), (3.6).
    ///
    /// # Errors
    /// [`SetupError`] for a coefficient out of range; initial data that are not finite, of the
    /// wrong length, or violate a boundary condition of (1.3); a dt, a tolerance or an iteration
    /// limit that is not positive.
    pub fn new(mut problem: Problem, stepping: Stepping) -> Result<Self, SetupError> {
        let level = prepare(&mut problem, &stepping)?;
        let case = problem.case(stepping.scheme, stepping.dt);
        let heated = stepping.loaded
            || stepping.settings.solver == Solver::FixedPoint
            || is_heated(&problem.beam, &level);
        let stepper = choose(case.clone(), stepping.settings, &level, heated)?;
        Ok(Self {
            problem,
            case,
            loaded: stepping.loaded,
            heated,
            stepper,
            steps: 0,
        })
    }

    /// The time step δt.
    pub fn dt(&self) -> f64 {
        self.case.dt
    }

    /// The loads `(F_u, F_φ, F_θ)` of the next step at the n + 1 nodes, to be set before
    /// it is done.
    ///
    /// `None` unless [`Stepping::loaded`]. Entries at nodes with a prescribed value are not used.
    pub fn load_mut(&mut self) -> Option<&mut [[f64; 3]]> {
        self.loaded.then(|| self.stepper.load_mut())
    }

    /// Does one step, by (3.7)-(3.8) or by `midpoint`, without allocating memory: [`Motion::step`]
    /// without a limit.
    ///
    /// # Errors
    /// [`StepError`] with step, time and cause. The motion then stays at its old level.
    pub fn step_once(&mut self) -> Result<StepReport, StepError> {
        let mut outcome = [Err(StepFailure::NonFinite {
            iterations: 0,
            increment: f64::NAN,
        })];
        self.stepper.advance(&mut outcome);
        let [outcome] = outcome;
        let report = outcome.map_err(|failure| StepError {
            step: self.steps + 1,
            t: self.t(),
            dt: self.case.dt,
            failure,
        })?;
        self.steps += 1;
        Ok(report)
    }

    /// Copies the current level into `level`, which must have n + 1 nodes.
    pub fn observe(&self, level: &mut TimeLevel) {
        self.stepper.read(0, level);
    }

    /// A copy of the current level.
    pub fn level(&self) -> TimeLevel {
        let mut level = TimeLevel::new(self.case.lengths.len() + 1);
        self.observe(&mut level);
        level
    }

    /// The energy (3.9) of a level of this motion.
    pub fn energy(&self, level: &TimeLevel) -> Energy {
        self.case.energy(level)
    }

    /// The energy balance of the step between two consecutive levels of this motion, without
    /// loads.
    pub fn balance(&self, old: &TimeLevel, new: &TimeLevel) -> Balance {
        self.case.balance(old, new)
    }

    /// The change of the energy from one level to another: only [`Balance::change`], at half the
    /// cost.
    pub fn energy_change(&self, old: &TimeLevel, new: &TimeLevel) -> f64 {
        self.case.energy_change(old, new)
    }

    /// The scale of a level's energy, from absolute values, to which a residual of the balance is
    /// compared.
    pub fn energy_scale(&self, level: &TimeLevel) -> f64 {
        self.case.energy_scale(level)
    }

    /// Bounds on the rounding errors in the balance between two consecutive levels.
    pub fn rounding(&self, old: &TimeLevel, new: &TimeLevel) -> Rounding {
        self.case.rounding(old, new)
    }

    /// The problem. Its initial data satisfy the boundary conditions exactly.
    pub fn problem(&self) -> &Problem {
        &self.problem
    }

    /// Length of each element.
    pub fn lengths(&self) -> &[f64] {
        &self.case.lengths
    }
}

impl Motion for OneStep {
    fn step(&mut self, limit: f64) -> Result<Option<StepReport>, StepError> {
        if self.has_reached(limit) {
            return Ok(None);
        }
        self.step_once().map(Some)
    }

    fn has_reached(&self, limit: f64) -> bool {
        // A multiple of δt is the end of a step, whatever its rounding error.
        !(self.t() + 0.5 * self.case.dt < limit)
    }

    /// t_n = n δt.
    fn t(&self) -> f64 {
        self.steps as f64 * self.case.dt
    }

    fn steps(&self) -> usize {
        self.steps
    }

    fn work(&self) -> Work {
        self.stepper.work()
    }

    fn tip_range(&self) -> TipRange {
        TipRange::at(self.stepper.tip(0))
    }

    fn is_loaded(&self) -> bool {
        self.loaded
    }

    /// Newton's method omits the temperature if nothing heats the beam and there are no loads.
    fn is_heated(&self) -> bool {
        self.heated
    }
}

/// Checks a problem and its settings, sets the boundary values exactly, and returns the level at
/// t = 0.
pub(crate) fn prepare(problem: &mut Problem, stepping: &Stepping) -> Result<TimeLevel, SetupError> {
    check_settings(problem, stepping)?;
    initial_level(problem)
}

/// Whether anything heats the beam: its own deformation (a ≠ 0), or a temperature other than the
/// steady one.
pub(crate) fn is_heated(beam: &Beam, level: &TimeLevel) -> bool {
    beam.a != 0.0 || level.theta.iter().any(|&theta| theta != 0.0)
}

/// The solver of the steps.
fn choose(
    case: SteppedBeam,
    settings: Settings,
    level: &TimeLevel,
    heated: bool,
) -> Result<Box<dyn Stepper<f64>>, SetupError> {
    Ok(match settings.solver {
        Solver::Newton => newton(vec![case], settings, &[level], heated),
        Solver::FixedPoint => {
            let refused = ParameterError {
                name: "dt",
                found: case.dt,
                allowed: "a finite number > 0".into(),
            };
            Box::new(FixedPoint::new(case, settings, level).map_err(|_| refused)?)
        }
    })
}

fn check_settings(problem: &Problem, stepping: &Stepping) -> Result<(), SetupError> {
    problem.beam.validate()?;
    problem
        .obstacles
        .as_ref()
        .map_or(Ok(()), Obstacles::validate)?;
    check_positive("dt", stepping.dt)?;
    match stepping.settings.stopping {
        Stopping::Converged {
            tolerance,
            max_iterations,
        } => {
            check_stopping(tolerance, max_iterations)?;
        }
        Stopping::Iterations(iterations) => {
            let is_fixed_point = stepping.settings.solver == Solver::FixedPoint;
            let allowed = if is_fixed_point {
                "an integer >= 1"
            } else {
                "no such setting for Newton's method"
            };
            check(
                "iterations",
                iterations as f64,
                is_fixed_point && iterations > 0,
                allowed,
            )?;
        }
    }
    Ok(())
}

/// The initial level by (3.6): checks the data (1.2) against (1.3), sets boundary values exactly,
/// lifts the temperature.
fn initial_level(problem: &mut Problem) -> Result<TimeLevel, SetupError> {
    let nodes = problem.mesh.nodes();
    let theta_a = problem.beam.theta_a;
    let InitialValues {
        u,
        u_t,
        phi,
        phi_t,
        theta,
    } = &mut problem.initial;
    let last = nodes.len() - 1;
    check_field("u", u, nodes, &[(0, 0.0)])?;
    check_field("u_t", u_t, nodes, &[(0, 0.0)])?;
    check_field("phi", phi, nodes, &[(0, 0.0)])?;
    check_field("phi_t", phi_t, nodes, &[(0, 0.0)])?;
    check_field("theta", theta, nodes, &[(0, theta_a), (last, 0.0)])?;
    let mut level = TimeLevel::new(nodes.len());
    level.u.clone_from(u);
    level.v.clone_from(u_t);
    level.phi.clone_from(phi);
    level.w.clone_from(phi_t);
    for ((lifted, theta), x) in level.theta.iter_mut().zip(theta.iter()).zip(nodes) {
        *lifted = theta - theta_a * (1.0 - x);
    }
    level.contact_force = problem
        .obstacles
        .map_or(0.0, |obstacles| obstacles.force(u[last]));
    Ok(level)
}

/// Checks length, finiteness and boundary values of one field; `boundary` lists the nodes with a
/// prescribed value.
fn check_field(
    field: &'static str,
    values: &mut [f64],
    nodes: &[f64],
    boundary: &[(usize, f64)],
) -> Result<(), SetupError> {
    if values.len() != nodes.len() {
        return Err(SetupError::Length {
            field,
            found: values.len(),
            expected: nodes.len(),
        });
    }
    if let Some(node) = values.iter().position(|value| !value.is_finite()) {
        return Err(SetupError::NotFinite {
            field,
            node,
            found: values[node],
        });
    }
    let scale = values
        .iter()
        .fold(0.0, |scale: f64, value| scale.max(value.abs()));
    for &(node, allowed) in boundary {
        if (values[node] - allowed).abs() > BOUNDARY_SLACK * scale {
            return Err(SetupError::Boundary {
                field,
                x: nodes[node],
                found: values[node],
                allowed,
            });
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
        let InitialValues {
            u,
            u_t,
            phi,
            phi_t,
            theta,
        } = InitialValues::at_rest(&mesh, 2.0);
        assert_eq!(theta, [2.0, 1.5, 0.0]);
        assert!([u, u_t, phi, phi_t].iter().all(|field| *field == [0.0; 3]));
    }
}
