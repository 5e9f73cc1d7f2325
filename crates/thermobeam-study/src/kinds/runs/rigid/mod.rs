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

mod judge;

use super::{
    Findings, Results, RunStudy, Runs,
    steady::{self, listed_scene, settle, steps_to_rest, tolerance},
};
use crate::kinds::prelude::*;
use crate::{
    kinds::settings::{CONTACT, Exercise, Integration},
    run::{
        ObservableMotion, RunError,
        driver::Driver,
        run_to,
        simulate::{self, Recording, Simulator},
    },
    scene::{Scene, limits, tables},
};
use convergence_study::internal::input::POSITIVE;
use thermobeam::{error::StepFailure, mesh::Mesh, parameters::Obstacles, solve::Solver};

/// The row of the table of kinds.
pub const ROW: KindRow = KindRow {
    name: "runs/rigid",
    keys: RigidObstacles::KEYS,
    read: read_study::<RunStudy<RigidObstacles>>,
    why: "As epsilon falls the obstacles become rigid: penetration falls like epsilon at rest and on a fixed grid, like \
          epsilon^(2/3) in an impact that the grid resolves.",
    judged: "The observed orders in epsilon, Newton's iterations, and where the fixed point ceases to converge.",
    failure: "The contact law, or its solution in closed form, loses digits or stability for stiff obstacles.",
};

/// The study.
#[derive(Debug, Clone, PartialEq)]
pub struct RigidObstacles {
    /// Compliances, descending.
    epsilons: Vec<f64>,
    /// The compliance that represents a rigid obstacle.
    limit: f64,
    /// Tolerance of the orders.
    tolerance: f64,
    /// A beam that bounces, on a fixed mesh with a fixed dt.
    moving: Scene,
    /// Iterations after which the fixed point iteration is abandoned.
    max_iterations: usize,
    /// A beam that comes to rest on an obstacle.
    resting: Scene,
    speed: f64,
    t_max: f64,
    /// A beam whose free end moves into the upper obstacle at t = 0, on a mesh graded towards that
    /// end.
    impact: Scene,
    /// Time steps in units of t*.
    steps: usize,
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

/// The scene of a table, at the table's resolution.
fn scene(section: &Section<'_>, folder: &Path, dt: f64) -> Result<Scene, InputError> {
    let scene = listed_scene(&section.require("scene", "a scene file")?, folder)?;
    let elements = section.require("elements", "a whole number >= 1")?;
    let mesh = Mesh::uniform(tables::elements(&elements)?)
        .map_err(|error| elements.refuse(error.to_string(), "a mesh"))?;
    Ok(scene.at(mesh, dt))
}

/// The scene of the beam that bounces, until the table's t_end.
fn moving_scene(section: &Section<'_>, folder: &Path) -> Result<Scene, InputError> {
    let t_end = section.positive("t_end")?;
    let dt = section.positive("dt")?;
    // Its tip is kept at every step.
    limits::steps_until(
        &section.require("dt", POSITIVE)?,
        t_end,
        dt,
        limits::RECORDED_STEPS,
    )?;
    Ok(Scene {
        t_end,
        ..scene(section, folder, dt)?
    })
}

/// The scene of the impact: its free end must start at the upper obstacle and move into it.
fn impact_scene(section: &Section<'_>, folder: &Path) -> Result<Scene, InputError> {
    let field = section.require("scene", "a scene file")?;
    let scene = listed_scene(&field, folder)?;
    let initial = &scene.initial;
    let [tip, velocity] = [&initial.u, &initial.u_t].map(|function| match function {
        Some(function) => function.eval(1.0),
        None => 0.0,
    });
    let on_the_obstacle = scene.obstacles.is_some_and(|obstacles| tip == obstacles.g2);
    if on_the_obstacle && velocity > 0.0 {
        return Ok(scene);
    }
    Err(field.refuse_as_written("a scene with u(1) = g2 and u_t(1) > 0"))
}

const KEYS: [Key; 4] = [
    Key::new(
        "obstacles",
        Form::Table(&[&[&OBSTACLE_KEYS]]),
        "compliances of the obstacles",
    ),
    Key::new(
        "moving",
        Form::Table(&[&[&SCENE, &MOVING]]),
        "a beam that bounces",
    ),
    Key::new(
        "rest",
        Form::Table(&[&[&SCENE, &REST]]),
        "a beam that comes to rest in contact",
    ),
    Key::new(
        "impact",
        Form::Table(&[&[&IMPACT]]),
        "a free end that moves into the upper obstacle",
    ),
];
const OBSTACLE_KEYS: [Key; 3] = [
    Key::new(
        "epsilon",
        Form::List(&Form::Positive),
        "normal compliances, at least three, descending",
    ),
    Key::new("limit", Form::Positive, "a compliance that counts as rigid"),
    steady::TOLERANCE,
];
const SCENE_FILE: Key = Key::new("scene", Form::Text, "a scene file, relative to this file");
const SCENE: [Key; 3] = [
    SCENE_FILE,
    Key::new("elements", Form::Count(1), "number of elements"),
    Key::new("dt", Form::Positive, "time step"),
];
const MOVING: [Key; 2] = [
    Key::new("t_end", Form::Positive, "final time"),
    Key::new(
        "max_iterations",
        Form::Count(1),
        "of the fixed point, after which a step fails",
    ),
];
const REST: [Key; 2] = [steady::SPEED, steady::T_MAX];
const IMPACT: [Key; 2] = [
    SCENE_FILE,
    Key::new("steps", Form::Count(1), "steps of a run"),
];

impl Runs for RigidObstacles {
    const KEYS: &'static [Keys] = &[&[&KEYS]];

    /// Compliance of the obstacles, and the computation.
    type Run = (f64, RunOf);
    type Shown = ShownImpact;

    fn from_document(root: &Section<'_>, folder: &Path) -> Result<Self, InputError> {
        let obstacles = root.table("obstacles", &[&OBSTACLE_KEYS])?;
        let moving = root.table("moving", &[&SCENE, &MOVING])?;
        let rest = root.table("rest", &[&SCENE, &REST])?;
        let impact = root.table("impact", &[&IMPACT])?;
        let bouncing = moving_scene(&moving, folder)?;
        let (dt, t_max) = steps_to_rest(&rest)?;
        let allowed = "a list of at least three positive numbers, descending";
        // Descending, so that the last is the smallest.
        let fits = |list: &[f64]| {
            list.len() >= 3 && list.is_sorted_by(|a, b| a > b) && list[list.len() - 1] > 0.0
        };
        Ok(Self {
            epsilons: obstacles.list("epsilon", allowed, Field::number, fits)?,
            limit: obstacles.positive("limit")?,
            tolerance: tolerance(&obstacles)?,
            moving: bouncing,
            max_iterations: moving.count("max_iterations", 1..=usize::MAX)?,
            resting: scene(&rest, folder, dt)?,
            speed: rest.positive("speed")?,
            t_max,
            impact: impact_scene(&impact, folder)?,
            steps: impact.count("steps", 1..=1_000_000)?,
        })
    }

    fn exercise(&self, case: Option<&str>) -> Exercise {
        let scenes = [&self.moving, &self.resting, &self.impact];
        Exercise::of_scenes(CONTACT, Integration::PAPER, scenes, case)
    }

    /// The rigid limit, then each compliance in four scenes.
    fn runs(&self) -> Vec<Case<Self::Run>> {
        let mut runs = vec![self.case(RunOf::RigidLimit, self.limit)];
        for run in RunOf::OF_EACH_COMPLIANCE {
            runs.extend(self.epsilons.iter().map(|&epsilon| self.case(run, epsilon)));
        }
        runs
    }

    fn run(&self, &(epsilon, run): &Self::Run) -> Result<ShownImpact, CaseFailure> {
        let mut scene = self.scene(run).clone();
        scene.obstacles = scene.obstacles.map(|obstacles| Obstacles {
            epsilon,
            ..obstacles
        });
        match run {
            RunOf::RigidLimit | RunOf::Bouncing => newton(&scene, epsilon),
            RunOf::FixedPoint => fixed_point(&scene, self.max_iterations),
            RunOf::Rest => {
                let (_, level) = settle(&scene, self.speed, self.t_max)?;
                Ok(ShownImpact::by_force(level.contact_force.abs(), epsilon))
            }
            RunOf::Impact => {
                let time = self.impact_time(epsilon);
                // The peak is at 1.65 t*.
                scene.t_end = 3.0 * time;
                scene.method = scene.method.with_dt(time / self.steps as f64);
                newton(&scene, epsilon)
            }
        }
    }

    fn numbers(&self, _: &Self::Run, run: &ShownImpact) -> Vec<Reading> {
        let tip = run.tip.iter().map(|(t, u)| t.abs() + u.abs());
        vec![
            Reading::new("velocity", run.velocity),
            Reading::new("force", run.force),
            Reading::new("penetration", run.penetration),
            Reading::new("alpha", run.alpha),
            Reading::new("contraction", run.contraction),
            Reading::new("iterations", run.mean_iterations),
            Reading::new("tip", largest_of(tip)),
            Reading::new("time of failure", run.failed_at),
        ]
    }

    fn judge(&self, results: &Results<'_, Self>) -> Findings {
        judge::judge(self, results)
    }
}

impl RigidObstacles {
    fn scene(&self, run: RunOf) -> &Scene {
        match run {
            RunOf::RigidLimit | RunOf::Bouncing | RunOf::FixedPoint => &self.moving,
            RunOf::Rest => &self.resting,
            RunOf::Impact => &self.impact,
        }
    }

    fn case(&self, run: RunOf, epsilon: f64) -> Case<(f64, RunOf)> {
        let moving = self.moving.steps() as f64;
        let (name, steps) = match run {
            RunOf::RigidLimit | RunOf::Bouncing => ("bouncing", moving),
            RunOf::FixedPoint => ("fixed point", 4.0 * moving),
            RunOf::Rest => ("at rest", 200.0 / self.resting.dt()),
            RunOf::Impact => ("impact", 3.0 * self.steps as f64),
        };
        let cost = steps * self.scene(run).mesh.elements() as f64;
        Case::new(format!("{name}, ε = {epsilon:.1e}"), cost, (epsilon, run))
    }

    /// t*, the time scale of an impact.
    fn impact_time(&self, epsilon: f64) -> f64 {
        let obstacles = Obstacles {
            epsilon,
            ..Obstacles::default()
        };
        obstacles.impact_time(self.impact.beam.zeta)
    }
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
    let mean_iterations = Some(iterations as f64 / driver.work().steps.max(1) as f64);
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
