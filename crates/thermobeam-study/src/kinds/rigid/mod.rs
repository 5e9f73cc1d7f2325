//! Obstacles becoming rigid, ε → 0: the Signorini limit.
//!
//! # One scale decides
//!
//! When the free end meets an obstacle with velocity v, only a layer of width √(ζt) takes part at first: there the beam is
//! a viscous half-space, whose end resists a change of velocity with the force `√ζ D^½`, a derivative of half an order. With
//! the penetration p = v t* P(t/t*) and the law F = p/ε,
//!
//! ```text
//! P' + I^½ P = 1,   P(0) = 0,      t* = (ε √ζ)^(2/3),
//! ```
//!
//! so that an impact takes the time t*, its peak penetration is 0.858 v (ε √ζ)^(2/3), and the force *grows* like ε^(-1/3). Three orders follow.
//!
//! | quantity | order in ε | why |
//! | --- | --- | --- |
//! | penetration of an impact, resolved in space and time | 2/3 | above |
//! | the same on a fixed mesh with a fixed dt, once t* < dt | 1 | the step averages the force, which then has a limit |
//! | penetration at rest | 1 | the force at rest has a limit |
//!
//! The fixed point contracts by `α = (dt/ε) [A_u⁻¹]_nn ≈ dt^(3/2) / (ε √ζ) = (dt/t*)^(3/2)`: it fails exactly where the time step no
//! longer resolves the impact. Newton's method does not notice.

mod claims;
mod measure;
mod report;
mod spec;
mod theory;

use super::Study;
use super::complete::{all_ran, or_nothing};
use super::steady::at_resolution;
use crate::kinds::untyped::{Case, Measured};
use crate::scene::Scene;
use convergence_study::judge::verdict::Judge;
use convergence_study::study::CaseFailure;
use convergence_study::study::Header;
use convergence_study::study::outcome::Outcome;
use convergence_study::text::number::max_or_nan;

/// The study.
#[derive(Debug, Clone, PartialEq)]
pub struct RigidStudy {
    header: Header,
    /// Compliances, descending.
    epsilons: Vec<f64>,
    /// The compliance that stands for a rigid obstacle.
    limit: f64,
    judge: Judge,
    /// A beam that bounces, on a fixed mesh with a fixed dt.
    moving: Scene,
    /// Iterations after which the fixed point is given up.
    max_iterations: usize,
    /// A beam that comes to rest on an obstacle.
    resting: Scene,
    speed: f64,
    t_max: f64,
    /// A beam whose free end moves into the upper obstacle at t = 0, on a mesh graded towards that end.
    impact: Scene,
    /// Time steps in t*.
    steps: usize,
}

/// What a case computes.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Task {
    /// The bouncing beam by Newton's method; the first is the rigid limit.
    Moving(f64),
    /// The bouncing beam by the fixed point.
    FixedPoint(f64),
    Rest(f64),
    Impact(f64),
}

impl RigidStudy {
    fn tasks(&self) -> Vec<Task> {
        let kinds = [Task::Moving, Task::FixedPoint, Task::Rest, Task::Impact];
        let all = kinds.iter().flat_map(|kind| self.epsilons.iter().map(|&epsilon| kind(epsilon)));
        std::iter::once(Task::Moving(self.limit)).chain(all).collect()
    }

    fn impact_scene(&self, epsilon: f64) -> Scene {
        let scene = measure::with_compliance(&self.impact, epsilon);
        let time = theory::impact_time(epsilon, scene.beam.zeta);
        // The peak is at 1.65 t*.
        Scene { dt: time / self.steps as f64, steps: 3 * self.steps, t_end: 3.0 * time, ..scene }
    }
}

impl Study for RigidStudy {
    fn header(&self) -> &Header {
        &self.header
    }

    fn cases(&self) -> Vec<Case> {
        let case = |task: &Task| {
            let (name, epsilon, scene, steps) = match task {
                Task::Moving(epsilon) => ("bouncing", epsilon, &self.moving, self.moving.steps as f64),
                Task::FixedPoint(epsilon) => ("fixed point", epsilon, &self.moving, 4.0 * self.moving.steps as f64),
                Task::Rest(epsilon) => ("at rest", epsilon, &self.resting, 200.0 / self.resting.dt),
                Task::Impact(epsilon) => ("impact", epsilon, &self.impact, 3.0 * self.steps as f64),
            };
            let cost = steps * (scene.mesh.nodes().len() - 1) as f64;
            Case { label: format!("{name}, ε = {epsilon:.1e}"), cost }
        };
        self.tasks().iter().map(case).collect()
    }

    fn run(&self, index: usize) -> Result<Measured, CaseFailure> {
        match self.tasks()[index] {
            Task::Moving(epsilon) => measure::moving(&measure::with_compliance(&self.moving, epsilon)),
            Task::FixedPoint(epsilon) => {
                measure::fixed_point(&measure::with_compliance(&self.moving, epsilon), self.max_iterations)
            }
            Task::Rest(epsilon) => {
                measure::rest(&measure::with_compliance(&self.resting, epsilon), self.speed, self.t_max)
            }
            Task::Impact(epsilon) => measure::impact(&self.impact_scene(epsilon)),
        }
    }

    fn conclude(&self, results: &[Result<Measured, CaseFailure>]) -> Outcome {
        let cases = self.cases();
        let measured = or_nothing(cases.len(), results);
        let mut groups = measured[1..].chunks(self.epsilons.len());
        let mut next = || groups.next().unwrap_or(&[]);
        let found = Found { limit: &measured[0], moving: next(), fixed_point: next(), rest: next(), impact: next() };
        let mut checks = vec![all_ran(&cases, results)];
        checks.extend(claims::judge(self, &found));
        report::outcome(self, &found, claims::rates(self, &found), checks)
    }
}

/// The results, each list in the order of the compliances.
struct Found<'a> {
    limit: &'a Measured,
    moving: &'a [Measured],
    fixed_point: &'a [Measured],
    rest: &'a [Measured],
    impact: &'a [Measured],
}

impl Found<'_> {
    /// Largest distance over time between the free end of a bouncing beam and that with rigid obstacles.
    fn distance_to_limit(&self, moving: &Measured) -> f64 {
        let (tip, limit) = (moving.curve("u_tip"), self.limit.curve("u_tip"));
        if tip.is_empty() || tip.len() != limit.len() {
            return f64::NAN;
        }
        tip.iter().zip(limit).map(|(a, b)| (a.1 - b.1).abs()).fold(0.0, max_or_nan)
    }
}
