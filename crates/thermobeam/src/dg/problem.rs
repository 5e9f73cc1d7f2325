//! The problem and the settings of the method: the data, checked once.

use super::lengths::MAX_RUNGS;
use super::space::{Field, Space};
use super::{DgLevel, MAX_TIME_DEGREE};
use crate::error::SetupError;
use crate::mesh::Mesh;
use crate::parameters::{Beam, Obstacles, check, check_positive, check_stopping};

/// Allowed rounding errors of an initial value in a boundary condition, in units of the field's
/// largest coefficient.
const BOUNDARY_SLACK: f64 = 64.0 * f64::EPSILON;

/// The initial data (1.2) as functions of x.
pub struct InitialFunctions {
    /// u_0, zero at x = 0.
    pub u: Box<dyn Fn(f64) -> f64>,
    /// u_1, zero at x = 0.
    pub u_t: Box<dyn Fn(f64) -> f64>,
    /// φ_0, zero at x = 0.
    pub phi: Box<dyn Fn(f64) -> f64>,
    /// φ_1, zero at x = 0.
    pub phi_t: Box<dyn Fn(f64) -> f64>,
    /// The physical temperature θ_0: θ_A at x = 0 and zero at x = 1.
    pub theta: Box<dyn Fn(f64) -> f64>,
}

impl InitialFunctions {
    /// A straight beam at rest, with the steady temperature θ_A (1 - x).
    pub fn at_rest(theta_a: f64) -> Self {
        Self {
            u: Box::new(|_| 0.0),
            u_t: Box::new(|_| 0.0),
            phi: Box::new(|_| 0.0),
            phi_t: Box::new(|_| 0.0),
            theta: Box::new(move |x| theta_a * (1.0 - x)),
        }
    }
}

/// A beam, its obstacles, its elements and its initial data.
pub struct DgProblem {
    /// Coefficients of (1.1).
    pub beam: Beam,
    /// The obstacles of (1.3), if any.
    pub obstacles: Option<Obstacles>,
    /// The triangulation.
    pub mesh: Mesh,
    /// The degree p of the elements, 1..=[`MAX_DEGREE`](super::MAX_DEGREE).
    pub degree: usize,
    /// The initial data.
    pub initial: InitialFunctions,
}

/// Settings of the time steps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DgStepping {
    /// The degree q in time, 0..=[`MAX_TIME_DEGREE`].
    pub degree: usize,
    /// The largest step.
    pub dt: f64,
    /// The first step, at the start and after a contact event; at most `dt`.
    pub restart_dt: f64,
    /// Ratio of a step to its predecessor while they grow from `restart_dt` to `dt`, >= 1; with 1
    /// the second step has length `dt`.
    pub growth: f64,
    /// Bound on the last increment of the iteration for N(u), in the norm of the velocities and the
    /// temperature.
    pub tolerance: f64,
    /// Number of iterations after which a step fails.
    pub max_iterations: usize,
}

impl Default for DgStepping {
    /// For the paper's beam: the peak of an impact has the time scale (ε √ζ)^(2/3) = 5e-3.
    fn default() -> Self {
        Self {
            degree: 2,
            dt: 0.02,
            restart_dt: 1e-3,
            growth: 1.5,
            tolerance: 1e-14,
            max_iterations: 100,
        }
    }
}

pub(super) fn check_problem(
    beam: &Beam,
    obstacles: Option<&Obstacles>,
    stepping: &DgStepping,
) -> Result<(), SetupError> {
    beam.validate()?;
    obstacles.map_or(Ok(()), Obstacles::validate)?;
    let DgStepping {
        degree: q,
        dt,
        restart_dt,
        growth,
        tolerance,
        max_iterations,
    } = *stepping;
    let degrees = format!("an integer from 0 to {MAX_TIME_DEGREE}");
    check("degree in time", q as f64, q <= MAX_TIME_DEGREE, degrees)?;
    check_positive("dt", dt)?;
    let at_most_dt = format!("a number > 0 and at most dt = {dt}");
    check(
        "restart_dt",
        restart_dt,
        restart_dt > 0.0 && restart_dt <= dt,
        at_most_dt,
    )?;
    check(
        "growth",
        growth,
        growth >= 1.0 && growth.is_finite(),
        "a finite number >= 1",
    )?;
    let few_rungs = growth == 1.0 || (dt / restart_dt).ln() / growth.ln() <= MAX_RUNGS as f64;
    check(
        "growth",
        growth,
        few_rungs,
        format!("a ratio that leads from restart_dt to dt in {MAX_RUNGS} steps"),
    )?;
    check_stopping(tolerance, max_iterations)?;
    Ok(())
}

/// (3.6): the projections of the initial data, with the temperature lifted.
pub(super) fn initial_level(
    space: &Space,
    beam: &Beam,
    initial: &InitialFunctions,
) -> Result<DgLevel, SetupError> {
    let mut level = DgLevel::new(space);
    let theta_a = beam.theta_a;
    let lifted = |x: f64| (initial.theta)(x) - theta_a * (1.0 - x);
    let fields: [(_, _, &dyn Fn(f64) -> f64); 5] = [
        ("u", Field::U, &initial.u),
        ("u_t", Field::V, &initial.u_t),
        ("phi", Field::Phi, &initial.phi),
        ("phi_t", Field::W, &initial.phi_t),
        ("theta", Field::Theta, &lifted),
    ];
    for (name, field, f) in fields {
        let mut bad = None;
        let mut scale = 0.0_f64;
        space.project(field, f, |element, block, place, value| {
            if !value.is_finite() {
                bad.get_or_insert((element, value));
            }
            scale = scale.max(value.abs());
            match field {
                Field::U | Field::Phi => level.places[block][place] = value,
                Field::V | Field::W | Field::Theta => level.rates[block][place] = value,
            }
        });
        if let Some((element, found)) = bad {
            let nodes = space.mesh().nodes();
            return Err(SetupError::NotFiniteBetween {
                field: name,
                found,
                from: nodes[element],
                to: nodes[element + 1],
            });
        }
        if field == Field::Theta {
            scale = scale.max(theta_a.abs());
        }
        // A bubble function has no coefficients on a single linear element.
        let slack = BOUNDARY_SLACK
            * (0..=16).fold(scale, |scale, i| scale.max(f(f64::from(i) / 16.0).abs()));
        let ends: &[(f64, f64)] = if field == Field::Theta {
            &[(0.0, theta_a), (1.0, 0.0)]
        } else {
            &[(0.0, 0.0)]
        };
        for &(x, allowed) in ends {
            // NaN is not a valid boundary value either.
            if !(f(x).abs() <= slack) {
                let found = f(x) + allowed;
                return Err(SetupError::Boundary {
                    field: name,
                    x,
                    found,
                    allowed,
                });
            }
        }
    }
    Ok(level)
}
