//! The computations: a diagram for each scene, a discrete buckling force for each mesh, runs to rest.

use convergence_study::study::{Case, CaseFailure};
use convergence_study::text::number::max_or_nan;
use thermobeam::equilibrium::Equilibrium;
use thermobeam::mesh::Mesh;

use super::branches::{self, Diagram, Event};
use super::{BifurcationStudy, CLOSE, buckling};
use crate::kinds::steady::{at_resolution, exact_states, nearest, settle};
use crate::scene::Scene;

/// Width to which an event is bracketed.
pub(super) const BRACKET: f64 = 1e-9;

/// Points of the picture of a fork.
const FORK_POINTS: usize = 80;

/// What a case computes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Task {
    /// The branches of a scene, by its place in the list.
    Diagram(usize),
    /// The buckling force of so many elements.
    Buckling(usize),
    /// A moving beam until it rests: scene and β, by their places in the lists.
    Rest(usize, usize),
}

/// What a case finds.
#[derive(Debug, Clone, PartialEq)]
pub enum Found {
    /// The branches.
    Diagram(Diagram),
    /// The buckling force of P1 elements, positive.
    Force(f64),
    /// Where a moving beam came to rest.
    Rest(Rest),
}

/// A beam that came to rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rest {
    /// u(1).
    pub u_tip: f64,
    /// The exact steady state nearest to it; `None` if there is none.
    pub state: Option<Equilibrium>,
    /// Largest difference to that state over all nodes, in u and φ; NaN without one.
    pub distance: f64,
}

pub(super) fn cases(study: &BifurcationStudy) -> Vec<Case<Task>> {
    // Some 50 microseconds for each β: as long as 3000 elements of a step.
    let diagram = |(k, scene): (usize, &Scene)| Case {
        label: format!("branches, θ_A = {}", scene.beam.theta_a),
        cost: 3e3 * study.grid.len() as f64,
        data: Task::Diagram(k),
    };
    let force =
        |&n: &usize| Case { label: format!("buckling force, n = {n}"), cost: n as f64, data: Task::Buckling(n) };
    let rest = |scene: usize, beta: usize| Case {
        label: format!("to rest, θ_A = {}, β = {}", study.scenes[scene].beam.theta_a, study.betas[beta]),
        cost: 200.0 / study.dt * study.elements as f64,
        data: Task::Rest(scene, beta),
    };
    let rests = (0..study.scenes.len()).flat_map(|scene| (0..study.betas.len()).map(move |beta| rest(scene, beta)));
    study.scenes.iter().enumerate().map(diagram).chain(study.meshes.iter().map(force)).chain(rests).collect()
}

pub(super) fn run(study: &BifurcationStudy, task: Task) -> Result<Found, CaseFailure> {
    Ok(match task {
        Task::Diagram(scene) => Found::Diagram(diagram(study, &study.scenes[scene])?),
        Task::Buckling(n) => Found::Force(buckling::discrete_buckling_force(&Mesh::uniform(n)?)?),
        Task::Rest(scene, beta) => Found::Rest(rest(study, &study.scenes[scene], study.betas[beta])?),
    })
}

fn diagram(study: &BifurcationStudy, scene: &Scene) -> Result<Diagram, CaseFailure> {
    let coarse = branches::sample(scene, &study.grid, 0)?;
    let event = branches::bracket(scene, &coarse, BRACKET)?;
    let grid = finer_at(study, scene, event[0]);
    Ok(branches::trace(&branches::sample(scene, &grid, branches::HALVINGS)?, event))
}

/// The grid, with more points around a fork for the picture of it.
fn finer_at(study: &BifurcationStudy, scene: &Scene, fork: f64) -> Vec<f64> {
    if Event::of(scene) != Event::Buckling || fork.is_nan() {
        return study.grid.clone();
    }
    let more = (0..=FORK_POINTS).map(|k| fork + CLOSE * (2.0 * k as f64 / FORK_POINTS as f64 - 1.0));
    let mut grid: Vec<f64> = study.grid.iter().copied().chain(more).collect();
    grid.sort_by(f64::total_cmp);
    grid
}

fn rest(study: &BifurcationStudy, scene: &Scene, beta: f64) -> Result<Rest, CaseFailure> {
    let mut scene = at_resolution(scene, study.elements, study.dt)?;
    scene.beam.beta = beta;
    let end = settle(&scene, study.speed, study.t_max)?;
    let nearest = nearest(&scene.mesh, &end.level, &exact_states(&scene)?);
    Ok(Rest {
        u_tip: end.level.u[study.elements],
        state: nearest.map(|(state, _)| state),
        distance: nearest.map_or(f64::NAN, |(_, (in_u, in_phi))| max_or_nan(in_u, in_phi)),
    })
}
