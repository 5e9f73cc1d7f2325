//! Obstacles becoming rigid, ε → 0: the Signorini limit.
//!
//! # The time scale of an impact
//!
//! When the free end meets an obstacle with velocity ν, at first only a layer of width √(ζt) moves:
//! there the beam is a viscous half-space, and its end resists a change of velocity with the force
//! `√ζ D^½`, a derivative of order one half. With the penetration δ = ν t* C(t/t*) and the law F =
//! δ/ε,
//!
//! ```text
//! C' + J C = 1,     C(0) = 0,      t* = (ε √ζ)^(2/3),
//! ```
//!
//! J being the integral of order one half. So the peak of an impact has the time scale t*, its
//! penetration is 0.858 ν (ε √ζ)^(2/3), and the force *grows* like ε^(-1/3). Three orders follow.
//!
//! | quantity | order in ε | why |
//! | --- | --- | --- |
//! | penetration of an impact, resolved in space and time | 2/3 | above |
//! | the same on a fixed mesh with a fixed dt, once t* < dt | 1 | the step averages the force, which then has a limit |
//! | penetration at rest | 1 | the force at rest has a limit |
//!
//! The fixed point contracts by `α = (dt/ε) [A_u⁻¹]_nn ≈ dt^(3/2) / (ε √ζ) = (dt/t*)^(3/2)`: it
//! fails approximately where the time step no longer resolves the impact. The number of Newton
//! iterations does not depend on ε.

mod figures;
mod judge;

use super::paper::{FIRST, SECOND};
use super::prelude::*;
use crate::run::{
    ObservableMotion, RunError,
    driver::Driver,
    run_to,
    simulate::{self, Recording, Simulator},
};
use crate::scene::Scene;
use crate::studies::steady::{cost_to_rest, settle};
use thermobeam::{error::StepFailure, mesh::Mesh, parameters::Obstacles, solve::Solver};

/// What the study says about itself.
pub const ABOUT: About = About {
    id: "rigid-obstacles",
    claim: "Penetration falls like epsilon at rest and on a fixed mesh with a fixed dt, like epsilon^(2/3) in a resolved impact",
    tier: Tier::Quick,
    group: "contact",
    home: file!(),
};

/// Compliances, descending.
const EPSILONS: [f64; 15] = [
    1e-1, 3.16e-2, 1e-2, 3.16e-3, 1e-3, 3.16e-4, 1e-4, 3.16e-5, 1e-5, 3.16e-6, 1e-6, 3.16e-7, 1e-7,
    3.16e-8, 1e-8,
];
/// The compliance that stands for a rigid obstacle.
const LIMIT: f64 = 1e-12;
/// A beam that bounces, on a fixed mesh with a fixed dt.
const MOVING: Grid = Grid {
    elements: 50,
    dt: 1e-3,
    t_end: 1.0,
};
/// Iterations after which the fixed point is abandoned.
const MAX_ITERATIONS: usize = 300;
/// A beam that comes to rest on an obstacle.
const RESTING: Grid = Grid {
    elements: 32,
    dt: 0.1,
    t_end: 2000.0,
};
/// The largest velocity of a beam at rest.
const SPEED: f64 = 1e-10;
/// A beam whose free end moves into the upper obstacle at t = 0, on a mesh graded towards that end.
const IMPACT: &str = "beam = { zeta = 0.1, a = 0.017, rho = 1.0, beta = 0.0, theta_a = 0.0 }
obstacles = { epsilon = 1e-3, g1 = -0.01, g2 = 0.0 }
initial = { u_t = \"sin(pi*x/2)\" }
mesh = { elements = 128, map = \"1 - (1-s)^4\" }
time = { dt = 1e-4, t_end = 0.02 }
";
const IMPACT_ELEMENTS: usize = 128;
/// ζ of that beam.
const IMPACT_ZETA: f64 = 0.1;
/// Its time steps in units of t*.
const STEPS: usize = 200;

/// Mesh, step and end of a run.
struct Grid {
    elements: usize,
    dt: f64,
    t_end: f64,
}

/// The beam at the obstacles as they become rigid.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RigidObstacles;

/// The study.
pub fn study() -> Described<RigidObstacles> {
    ABOUT.study(RigidObstacles)
}

/// A computation with one compliance.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RunOf {
    /// The bouncing beam between nearly rigid obstacles, by Newton's method.
    RigidLimit,
    /// The bouncing beam by Newton's method.
    Bouncing,
    /// The bouncing beam by the fixed point.
    FixedPoint,
    /// The beam that comes to rest on an obstacle.
    Rest,
    /// The impact, resolved in space and time.
    Impact,
}

impl RunOf {
    /// All but the rigid limit.
    const OF_EACH_COMPLIANCE: [RunOf; 4] = [
        RunOf::Bouncing,
        RunOf::FixedPoint,
        RunOf::Rest,
        RunOf::Impact,
    ];
}

/// The results of a run; a number that its computation lacks is `None`.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ShownImpact {
    /// Contact force in absolute value: the largest, the force at rest, or the peak of the impact.
    pub force: Option<f64>,
    /// ε times the force, which has the digits that the difference u(1) - g loses.
    pub penetration: Option<f64>,
    /// Velocity of the free end at t = 0.
    pub velocity: Option<f64>,
    /// Iterations per step done.
    pub mean_iterations: Option<f64>,
    /// Largest number of iterations in a step, by Newton's method.
    pub most_iterations: usize,
    /// (t, u(1, t)) of every level, by Newton's method.
    pub tip: Vec<(f64, f64)>,
    /// Predicted contraction factor of the fixed point in contact.
    pub alpha: Option<f64>,
    /// Largest factor measured in contact, or the factor of the last increments of a failing step;
    /// `None` if no step was in contact or the iterates overflowed.
    pub contraction: Option<f64>,
    /// Time of the step at which the fixed point fails, if any.
    pub failed_at: Option<f64>,
}

impl Kind for RigidObstacles {
    /// Compliance of the obstacles, and the computation.
    type Data = (f64, RunOf);
    type Found = ShownImpact;

    /// The rigid limit, then each compliance in four scenes.
    fn cases(&self) -> Vec<Case<Self::Data>> {
        let mut runs = vec![RunOf::RigidLimit.case(LIMIT)];
        for run in RunOf::OF_EACH_COMPLIANCE {
            runs.extend(EPSILONS.map(|epsilon| run.case(epsilon)));
        }
        runs
    }

    fn run(&self, &(epsilon, run): &Self::Data) -> Result<ShownImpact, CaseFailure> {
        let mut scene = run.scene()?;
        scene.obstacles = scene.obstacles.map(|obstacles| Obstacles {
            epsilon,
            ..obstacles
        });
        match run {
            RunOf::RigidLimit | RunOf::Bouncing => newton(&scene, epsilon),
            RunOf::FixedPoint => fixed_point(&scene, MAX_ITERATIONS),
            RunOf::Rest => {
                let (_, level) = settle(&scene, SPEED, RESTING.t_end)?;
                Ok(ShownImpact::by_force(level.contact_force.abs(), epsilon))
            }
            RunOf::Impact => {
                let time = impact_time(epsilon);
                // The peak is at 1.65 t*.
                scene.t_end = 3.0 * time;
                scene.method = scene.method.with_dt(time / STEPS as f64);
                newton(&scene, epsilon)
            }
        }
    }

    fn judge(&self, ran: &[Ran<Self::Data, ShownImpact>]) -> Outcome {
        Outcome::of_complete(self, ran, judge::judge)
    }
}

impl RunOf {
    fn scene(self) -> Result<Scene, CaseFailure> {
        let (experiment, grid) = match self {
            RunOf::RigidLimit | RunOf::Bouncing | RunOf::FixedPoint => (FIRST[1], MOVING),
            RunOf::Rest => (SECOND[1], RESTING),
            RunOf::Impact => return Ok(Scene::parse(IMPACT, "impact.toml")?),
        };
        let scene = experiment.scene()?;
        let mesh = Mesh::uniform(grid.elements)?;
        Ok(Scene {
            t_end: grid.t_end,
            ..scene.at(mesh, grid.dt)
        })
    }

    fn case(self, epsilon: f64) -> Case<(f64, RunOf)> {
        let moving = MOVING.t_end / MOVING.dt * MOVING.elements as f64;
        let (name, cost) = match self {
            RunOf::RigidLimit | RunOf::Bouncing => ("bouncing", moving),
            RunOf::FixedPoint => ("fixed point", 4.0 * moving),
            RunOf::Rest => ("at rest", cost_to_rest(RESTING.elements, RESTING.dt)),
            RunOf::Impact => ("impact", (3 * STEPS * IMPACT_ELEMENTS) as f64),
        };
        let scene = self.scene().ok();
        let parts = scene.map(|scene| match self {
            RunOf::FixedPoint => Parts::of(&scene).by_the_paper(Solver::FixedPoint),
            _ => Parts::of(&scene),
        });
        let label = format!("{name}, ε = {epsilon:.1e}");
        Case::new(label, cost, (epsilon, self)).described(&parts)
    }
}

/// t*, the time scale of an impact.
fn impact_time(epsilon: f64) -> f64 {
    let obstacles = Obstacles {
        epsilon,
        ..Obstacles::default()
    };
    obstacles.impact_time(IMPACT_ZETA)
}

impl ShownImpact {
    /// * `force`: in absolute value.
    fn by_force(force: f64, epsilon: f64) -> Self {
        Self {
            force: Some(force),
            penetration: Some(epsilon * force),
            ..Self::default()
        }
    }
}

/// A bouncing beam or an impact by Newton's method.
fn newton(scene: &Scene, epsilon: f64) -> Result<ShownImpact, CaseFailure> {
    let run = Simulator::new(scene)?
        .run(Recording::Curve(scene.steps()), &mut |_, _| ())
        .finished()?;
    let steps = run.history.iter().flat_map(|history| &history.rows).skip(1);
    let force = steps
        .map(|row| row.sample.contact_force.abs())
        .fold(0.0, max_or_nan);
    Ok(ShownImpact {
        velocity: Some(run.first.u_t_tip),
        mean_iterations: Some(run.iterations.total as f64 / run.steps as f64),
        most_iterations: run.iterations.max,
        tip: run.tip(),
        ..ShownImpact::by_force(force, epsilon)
    })
}

/// The fixed point up to its last step or the one that fails.
fn fixed_point(scene: &Scene, max_iterations: usize) -> Result<ShownImpact, CaseFailure> {
    let mut stepping = scene.one_step()?;
    let settings = &mut stepping.settings;
    settings.solver = Solver::FixedPoint;
    settings.stopping = settings.stopping.with_limit(max_iterations);
    let problem = simulate::problem(scene);
    // For the mean axial force β of a nearly straight beam.
    let alpha = problem
        .case(stepping.scheme, stepping.dt)
        .contact_contraction(scene.beam.beta);
    let mut driver = Driver::new(problem, stepping)?;
    let mut contraction = None;
    let mut iterations = 0;
    let outcome = run_to(&mut driver, scene.t_end, |driver, report| {
        iterations += report.iterations;
        // While the tip enters or leaves contact the law is not linear, and two increments show
        // nothing.
        let in_contact = driver.old_level().contact_force != 0.0 && report.in_contact;
        if let Some(measured) = report.contraction.filter(|_| in_contact) {
            contraction = Some(contraction.map_or(measured, |most| max_or_nan(most, measured)));
        }
    });
    let failed_at = match outcome {
        Ok(()) => None,
        Err(RunError::Step(error)) => {
            contraction = match error.failure {
                StepFailure::Diverged { contraction, .. }
                | StepFailure::IterationLimit { contraction, .. } => {
                    Some(contraction).filter(|contraction| contraction.is_finite())
                }
                _ => None,
            };
            Some(error.step as f64 * error.dt)
        }
        Err(other) => return Err(other.into()),
    };
    let mean_iterations = Some(iterations as f64 / driver.motion().steps().max(1) as f64);
    Ok(ShownImpact {
        alpha: Some(alpha),
        contraction,
        mean_iterations,
        failed_at,
        ..ShownImpact::default()
    })
}

/// Peak penetration of an impact, in units of velocity times [`Obstacles::impact_time`]: 0.8581.
///
/// The largest value of `C(ξ) = Σ (-1)^n ξ^(1 + 3n/2) / Γ(2 + 3n/2)`, the inverse transform of
/// `1/(s² + √s)`.
fn peak_penetration() -> f64 {
    // One smooth maximum at τ = 1.65; a step of 1e-3 misses its height by 1e-7.
    (0..4000)
        .map(|k| penetration(1e-3 * f64::from(k)))
        .fold(0.0, f64::max)
}

/// C(ξ) for ξ >= 0: the terms with even n, less those with odd n.
fn penetration(tau: f64) -> f64 {
    // Γ(2) = 1, and Γ(7/2) = 15 √π / 8.
    let odd = tau.powf(2.5) / (1.875 * std::f64::consts::PI.sqrt());
    every_second_term(tau, tau, 2.0) - every_second_term(tau, odd, 3.5)
}

/// `Σ ξ^(x + 3m - 1) / Γ(x + 3m)`, m = 0, 1, ..., by Γ(x + 3) = x (x + 1) (x + 2) Γ(x); for ξ <= 5
/// the terms vanish long before the last.
///
/// * `first`: the term with m = 0.
fn every_second_term(tau: f64, first: f64, x: f64) -> f64 {
    const TERMS: u32 = 20;
    let mut term = first;
    let mut sum = 0.0;
    for m in 0..TERMS {
        sum += term;
        let x = x + 3.0 * f64::from(m);
        term *= tau.powi(3) / (x * (x + 1.0) * (x + 2.0));
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_penetration_starts_with_the_velocity_of_the_impact() {
        assert!((penetration(1e-6) - 1e-6).abs() < 1e-14);
    }

    #[test]
    fn the_penetration_solves_its_integral_equation() {
        // C' + J C = 1, with J C(ξ) = ∫₀^ξ C(s) / √(π (ξ - s)) ds; s = ξ - r² removes the root.
        let tau = 1.3_f64;
        let n = 2000;
        let dr = tau.sqrt() / n as f64;
        let integral: f64 = (0..n)
            .map(|k| dr * penetration(tau - ((k as f64 + 0.5) * dr).powi(2)))
            .sum();
        let half_integral = 2.0 / std::f64::consts::PI.sqrt() * integral;
        let slope = (penetration(tau + 1e-5) - penetration(tau - 1e-5)) / 2e-5;
        assert!((slope + half_integral - 1.0).abs() < 1e-6);
    }

    /// The model does not cover the end of contact: after its peak the force falls like t^(-1/2).
    #[test]
    fn the_penetration_of_the_half_space_has_no_end() {
        let largest = (0..4000)
            .map(|k| penetration(1.5 + f64::from(k) * 1e-4))
            .fold(0.0, f64::max);
        assert!(
            (largest - 0.858).abs() < 1e-3 && (largest - penetration(1.65)).abs() < 1e-4,
            "{largest}"
        );
        assert!(
            (penetration(5.0) - 0.182).abs() < 1e-3,
            "{}",
            penetration(5.0)
        );
        assert!((1..50).all(|k| penetration(0.1 * f64::from(k)) > 0.0));
    }
}
