//! The coefficients of scenes and study files, and the refusals of a mapped mesh.

use thermobeam::mesh::{Mesh, MeshError};
use thermobeam::parameters::{Beam, Obstacles, ParameterError};

use super::file::{BeamTable, ObstacleTable};
use convergence_study::file::Refusal;
use serde::Serialize;

/// The coefficients of (1.1) and (1.3), which files and negative controls address by name.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coefficients {
    /// Of the beam.
    pub beam: Beam,
    /// Of the obstacles, if any.
    pub obstacles: Option<Obstacles>,
}

impl Coefficients {
    /// The names of those of the beam.
    pub(crate) const OF_BEAM: [&str; 5] = ["zeta", "a", "rho", "beta", "theta_a"];

    /// The names of those of the obstacles.
    pub(crate) const OF_OBSTACLES: [&str; 3] = ["epsilon", "g1", "g2"];

    /// All names, those of the obstacles last.
    pub(crate) fn names() -> impl Iterator<Item = &'static str> + Clone {
        Self::OF_BEAM.into_iter().chain(Self::OF_OBSTACLES)
    }

    /// The coefficient with that name; `None` if it belongs to obstacles and there are none.
    pub(crate) fn get_mut(&mut self, name: &str) -> Option<&mut f64> {
        let (beam, obstacles) = (&mut self.beam, self.obstacles.as_mut());
        match name {
            "zeta" => Some(&mut beam.zeta),
            "a" => Some(&mut beam.a),
            "rho" => Some(&mut beam.rho),
            "beta" => Some(&mut beam.beta),
            "theta_a" => Some(&mut beam.theta_a),
            "epsilon" => obstacles.map(|obstacles| &mut obstacles.epsilon),
            "g1" => obstacles.map(|obstacles| &mut obstacles.g1),
            "g2" => obstacles.map(|obstacles| &mut obstacles.g2),
            _ => None,
        }
    }

    /// The same with a relative error in one of them; `None` if there is none of that name, or it
    /// is zero.
    pub(crate) fn off(mut self, name: &str, relative: f64) -> Option<Self> {
        let coefficient = self
            .get_mut(name)
            .filter(|coefficient| **coefficient != 0.0)?;
        *coefficient *= 1.0 + relative;
        Some(self)
    }

    /// The coefficients of the tables `[beam]` and `[obstacles]`.
    ///
    /// # Errors
    /// One is out of its range.
    pub(crate) fn new(
        beam: &BeamTable,
        obstacles: Option<&ObstacleTable>,
    ) -> Result<Self, Refusal> {
        let mut new = Self {
            beam: Beam::default(),
            obstacles: obstacles.map(|_| Obstacles::default()),
        };
        new.set(beam);
        if let Some(obstacles) = obstacles {
            new.set(obstacles);
        }
        new.checked(["beam", "obstacles"])?;
        Ok(new)
    }

    /// Refuses what the solver would refuse, with the key of one of the two tables.
    pub(crate) fn checked(&self, [beam, obstacles]: [&str; 2]) -> Result<(), Refusal> {
        self.beam
            .validate()
            .map_err(|error| out_of_range(beam, error))?;
        let checked = self.obstacles.map_or(Ok(()), |own| own.validate());
        checked.map_err(|error| out_of_range(obstacles, error))
    }

    fn set(&mut self, table: &impl Serialize) {
        for (name, value) in given(table) {
            if let Some(coefficient) = self.get_mut(&name) {
                *coefficient = value;
            }
        }
    }
}

/// The coefficients that a table gives, by their names.
pub(crate) fn given(table: &impl Serialize) -> Vec<(String, f64)> {
    let table = serde_json::to_value(table).unwrap_or_else(|error| unreachable!("{error}"));
    let keys = table.as_object().into_iter().flatten();
    let given = keys.filter_map(|(name, value)| Some((name.clone(), value.as_f64()?)));
    given.collect()
}

/// A coefficient that the solver would refuse.
fn out_of_range(table: &str, error: ParameterError) -> Refusal {
    Refusal::written(format!("{table}.{}", error.name), error.allowed)
}

/// A mesh whose nodes are given by the map at `path`, from 0 to 1.
pub(crate) fn mapped(path: &str, mesh: Result<Mesh, MeshError>) -> Result<Mesh, Refusal> {
    mesh.map_err(|error| Refusal::invalid(path, format!("its mesh: {error}")))
}
