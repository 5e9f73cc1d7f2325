//! Scenes that a study file lists, their runs to rest, and the exact steady states that they should end in.

use std::ops::ControlFlow;
use std::path::Path;

use thermobeam::equilibrium::{Contact, Equilibrium, EquilibriumError, equilibria};
use thermobeam::mesh::{Mesh, MeshError};
use thermobeam::solve::Level;

use crate::run::simulate;
use crate::scene::Scene;
use convergence_study::input::{Field, InputError};
use convergence_study::study::CaseFailure;
use convergence_study::text::number::max_or_nan;

/// Reads the scenes of a list of file names, which are relative to the folder of the study file.
pub(super) fn listed_scenes(field: &Field<'_>, folder: &Path) -> Result<Vec<Scene>, InputError> {
    let allowed = "a list of at least one scene file";
    let items = field.items(allowed)?;
    if items.is_empty() {
        return Err(field.refuse_as_written(allowed));
    }
    items.iter().map(|item| listed_scene(item, folder)).collect()
}

/// Reads the scene of a file name; as in [`listed_scenes`].
pub(super) fn listed_scene(field: &Field<'_>, folder: &Path) -> Result<Scene, InputError> {
    let scene = Scene::read_one_step(field, folder)?;
    if scene.obstacles.is_none() {
        return Err(field.refuse(format!("{}, without obstacles", scene.name), "a scene with obstacles"));
    }
    Ok(scene)
}

/// The scene on a uniform mesh and with another time step.
pub(super) fn at_resolution(scene: &Scene, elements: usize, dt: f64) -> Result<Scene, MeshError> {
    Ok(scene.at(Mesh::uniform(elements)?, dt))
}

/// A beam at rest.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Rest {
    /// The last level.
    pub(super) level: Level,
    /// Its time.
    pub(super) t: f64,
}

/// A beam is at rest when it has been slow for that long: at the turning points of an oscillation it is slow for a moment,
/// and the slowest oscillation of a beam near buckling differs from rest by its speed alone.
const QUIET: f64 = 5.0;

/// Runs until no node has been faster than `speed`, in u or φ, for a while.
///
/// # Errors
/// A step that cannot be done, or motion that lasts longer than `t_max`.
pub(super) fn settle(scene: &Scene, speed: f64, t_max: f64) -> Result<Rest, CaseFailure> {
    let mut moved = 0.0;
    let rest = simulate::driver(scene)?.run(usize::MAX, |step| {
        let t = step.simulation.t();
        if !step.new.is_slow(speed) {
            moved = t;
        } else if t - moved >= QUIET {
            return ControlFlow::Break(Some(Rest { level: step.new.clone(), t }));
        }
        if t < t_max { ControlFlow::Continue(()) } else { ControlFlow::Break(None) }
    })?;
    rest.flatten().ok_or_else(|| {
        let reason = format!("{} still moves faster than {speed:e} at t = {t_max}", scene.name);
        CaseFailure { reason }
    })
}

/// All exact steady states of the scene.
pub(super) fn exact_states(scene: &Scene) -> Result<Vec<Equilibrium>, EquilibriumError> {
    equilibria(&scene.beam, scene.obstacles.as_ref())
}

/// Largest differences over the nodes between a level and a steady state, of u and of φ.
pub(super) fn distances(mesh: &Mesh, level: &Level, state: &Equilibrium) -> (f64, f64) {
    let largest = |values: &[f64], exact: &dyn Fn(f64) -> f64| {
        let differences = mesh.nodes().iter().zip(values).map(|(&x, value)| (value - exact(x)).abs());
        differences.fold(0.0, max_or_nan)
    };
    (largest(&level.u, &|x| state.u(x)), largest(&level.phi, &|x| state.phi(x)))
}

/// The steady state next to a level, with its [`distances`].
pub(super) fn nearest(mesh: &Mesh, level: &Level, states: &[Equilibrium]) -> Option<(Equilibrium, (f64, f64))> {
    let measured = states.iter().map(|state| (*state, distances(mesh, level, state)));
    measured.min_by(|a, b| max_or_nan(a.1.0, a.1.1).total_cmp(&max_or_nan(b.1.0, b.1.1)))
}

/// A contact state in words.
pub(super) fn name_of(contact: Contact) -> &'static str {
    match contact {
        Contact::Free => "free",
        Contact::Upper => "on the upper obstacle",
        Contact::Lower => "on the lower obstacle",
    }
}
