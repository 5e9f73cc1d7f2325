//! What scenes and study files have in common: the tables `[beam]` and `[obstacles]`, the mesh, the stepping keys.

use thermobeam::mesh::{Mesh, MeshError};
use thermobeam::parameters::{Beam, Obstacles, ParameterError};
use thermobeam::scheme::{self, Scheme};
use thermobeam::solve::{Settings, Solver};

pub(crate) use crate::scene::limits::elements;
use convergence_study::input::{Field, InputError, Section};

/// The keys of `[beam]`.
pub(crate) const BEAM_KEYS: [&str; 5] = ["zeta", "a", "rho", "beta", "theta_a"];

/// The keys of `[obstacles]`.
pub(crate) const OBSTACLE_KEYS: [&str; 3] = ["epsilon", "g1", "g2"];

/// The coefficient of that name; it must be one of [`BEAM_KEYS`].
pub(crate) fn beam_coefficient<'b>(beam: &'b mut Beam, key: &str) -> Option<&'b mut f64> {
    match key {
        "zeta" => Some(&mut beam.zeta),
        "a" => Some(&mut beam.a),
        "rho" => Some(&mut beam.rho),
        "beta" => Some(&mut beam.beta),
        "theta_a" => Some(&mut beam.theta_a),
        _ => None,
    }
}

/// The coefficient of that name; it must be one of [`OBSTACLE_KEYS`].
pub(crate) fn obstacle_coefficient<'o>(obstacles: &'o mut Obstacles, key: &str) -> Option<&'o mut f64> {
    match key {
        "epsilon" => Some(&mut obstacles.epsilon),
        "g1" => Some(&mut obstacles.g1),
        "g2" => Some(&mut obstacles.g2),
        _ => None,
    }
}

/// The table `[beam]`, each key with its default.
pub(crate) fn beam(root: &Section<'_>) -> Result<Beam, InputError> {
    let mut beam = Beam::default();
    if let Some(section) = root.section("beam")? {
        section.allow(&BEAM_KEYS)?;
        for key in BEAM_KEYS {
            if let (Some(field), Some(value)) = (section.get(key), beam_coefficient(&mut beam, key)) {
                *value = field.number()?;
            }
        }
        beam.validate().map_err(|error| out_of_range(&section, &error))?;
    }
    Ok(beam)
}

/// The table `[obstacles]`, each key with its default; no table, no obstacles.
pub(crate) fn obstacles(root: &Section<'_>) -> Result<Option<Obstacles>, InputError> {
    let Some(section) = root.section("obstacles")? else { return Ok(None) };
    section.allow(&OBSTACLE_KEYS)?;
    let mut obstacles = Obstacles::default();
    for key in OBSTACLE_KEYS {
        if let (Some(field), Some(value)) = (section.get(key), obstacle_coefficient(&mut obstacles, key)) {
            *value = field.number()?;
        }
    }
    obstacles.validate().map_err(|error| out_of_range(&section, &error))?;
    Ok(Some(obstacles))
}

/// A coefficient that the solver refuses, as a complaint about its key.
pub(crate) fn out_of_range(section: &Section<'_>, error: &ParameterError) -> InputError {
    match section.get(error.name) {
        Some(field) => field.refuse_as_written(error.allowed),
        None => section.refuse(error.name, format!("{:?}", error.found), error.allowed),
    }
}

/// The keys of [`scheme()`] and [`settings`].
pub(crate) const STEPPING_KEYS: [&str; 4] = ["scheme", "solver", "tolerance", "max_iterations"];

/// The key `scheme`.
pub(crate) fn scheme(section: &Section<'_>) -> Result<Scheme, InputError> {
    let schemes = scheme::SCHEMES.map(|scheme| (scheme.name, scheme));
    section.get("scheme").map_or(Ok(scheme::EULER_CRANK_NICOLSON), |field| field.choice(&schemes))
}

/// The keys `solver`, `tolerance` and `max_iterations`.
pub(crate) fn settings(section: &Section<'_>) -> Result<Settings, InputError> {
    let mut settings = Settings::default();
    if let Some(field) = section.get("solver") {
        settings.solver = field.choice(&Solver::ALL.map(|solver| (solver.name(), solver)))?;
    }
    if let Some(field) = section.get("tolerance") {
        settings.tolerance = field.positive()?;
    }
    if let Some(field) = section.get("max_iterations") {
        settings.max_iterations = field.count(1..=usize::MAX)?;
    }
    Ok(settings)
}

/// A mesh whose nodes come from the map in `field`.
pub(crate) fn checked_mesh(mesh: Result<Mesh, MeshError>, field: &Field<'_>) -> Result<Mesh, InputError> {
    mesh.map_err(|error| match error {
        MeshError::Ends { found, expected, .. } => {
            field.refuse(format!("{found:?} at s = {expected}"), "a map that takes 0 to 0 and 1 to 1")
        }
        MeshError::NotIncreasing { index, previous, found } => {
            let nodes = format!("nodes {} and {index} at {previous:?} and {found:?}", index - 1);
            field.refuse(nodes, "a map that increases strictly")
        }
        MeshError::TooClose { index, previous, found } => {
            let nodes = format!("nodes {} and {index} at {previous:?} and {found:?}", index - 1);
            field.refuse(nodes, "a map whose nodes are far enough apart: 1/h overflows")
        }
        MeshError::TooFew { elements } => field.refuse(format!("{elements} elements"), "at least 1"),
    })
}
