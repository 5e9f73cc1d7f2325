//! Common parts of scenes and study files: functions, the tables `[beam]` and `[obstacles]`, the
//! mesh, the stepping keys.

use thermobeam::mesh::{Mesh, MeshError};
use thermobeam::parameters::{Beam, Obstacles};
use thermobeam::scheme::{self, Scheme};
use thermobeam::solve::{Settings, Solver, Stopping};

use crate::expression::{Expression, Variable};
pub(crate) use crate::scene::limits::elements;
use convergence_harness::input::{Field, InputError, Misread, Section};

/// The keys of `[beam]`.
pub(crate) const BEAM_KEYS: [&str; 5] = ["zeta", "a", "rho", "beta", "theta_a"];

/// The keys of `[obstacles]`.
pub(crate) const OBSTACLE_KEYS: [&str; 3] = ["epsilon", "g1", "g2"];

/// The coefficients of (1.1) and (1.3), which files and negative controls address by name.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coefficients {
    /// Of the beam.
    pub beam: Beam,
    /// Of the obstacles, if any.
    pub obstacles: Option<Obstacles>,
}

impl Coefficients {
    /// All names, those of the obstacles last.
    pub(crate) fn names() -> impl Iterator<Item = &'static str> + Clone {
        BEAM_KEYS.into_iter().chain(OBSTACLE_KEYS)
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

    /// The names of the coefficients that differ.
    pub(crate) fn differing(mut self, mut other: Self) -> impl Iterator<Item = &'static str> {
        Self::names().filter(move |name| self.get_mut(name) != other.get_mut(name))
    }

    /// The tables `[beam]` and `[obstacles]`, each key with its default; obstacles need a table.
    pub(crate) fn read(root: &Section<'_>) -> Result<Self, InputError> {
        let obstacles = root.get("obstacles").map(|_| Obstacles::default());
        let mut read = Self {
            beam: Beam::default(),
            obstacles,
        };
        for (table, keys) in [("beam", &BEAM_KEYS[..]), ("obstacles", &OBSTACLE_KEYS)] {
            let Some(section) = root.section(table)? else {
                continue;
            };
            section.allow(keys)?;
            for key in keys {
                if let (Some(field), Some(value)) = (section.get(key), read.get_mut(key)) {
                    *value = field.number()?;
                }
            }
            read.check(&section)?;
        }
        Ok(read)
    }

    /// Refuses what the solver would refuse, with the key of `section`.
    pub(crate) fn check(&self, section: &Section<'_>) -> Result<(), InputError> {
        let obstacles = self
            .obstacles
            .map_or(Ok(()), |obstacles| obstacles.validate());
        self.beam
            .validate()
            .and(obstacles)
            .map_err(|error| match section.get(error.name) {
                Some(field) => field.refuse_as_written(error.allowed),
                None => section.refuse(error.name, format!("{:?}", error.found), error.allowed),
            })
    }
}

/// The keys of [`scheme()`] and [`settings`].
pub(crate) const STEPPING_KEYS: [&str; 5] = [
    "scheme",
    "solver",
    "tolerance",
    "max_iterations",
    "iterations",
];

/// The key `scheme`.
pub(crate) fn scheme(section: &Section<'_>) -> Result<Scheme, InputError> {
    let schemes = scheme::SCHEMES.map(|scheme| (scheme.name, scheme));
    section
        .get("scheme")
        .map_or(Ok(scheme::EULER_CRANK_NICOLSON), |field| {
            field.choice(&schemes)
        })
}

/// The keys `solver`, `tolerance` and `max_iterations`, or `iterations`, which excludes both.
pub(crate) fn settings(section: &Section<'_>) -> Result<Settings, InputError> {
    let mut settings = Settings::default();
    if let Some(field) = section.get("solver") {
        settings.solver = field.choice(&Solver::ALL.map(|solver| (solver.name(), solver)))?;
    }
    if let Some(field) = section.get("iterations") {
        let tested = ["tolerance", "max_iterations"]
            .into_iter()
            .find(|key| section.get(key).is_some());
        if let Some(key) = tested {
            return Err(section.refuse(
                key,
                "a second rule for the end of the iteration",
                "`iterations` alone",
            ));
        }
        if settings.solver != Solver::FixedPoint {
            return Err(field.refuse(
                format!("solver \"{}\"", settings.solver.name()),
                "the solver \"fixed-point\" beside it",
            ));
        }
        settings.stopping = Stopping::Iterations(field.count(1..=usize::MAX)?);
        return Ok(settings);
    }
    if let Stopping::Converged {
        tolerance,
        max_iterations,
    } = &mut settings.stopping
    {
        if let Some(field) = section.get("tolerance") {
            *tolerance = field.positive()?;
        }
        if let Some(field) = section.get("max_iterations") {
            *max_iterations = field.count(1..=usize::MAX)?;
        }
    }
    Ok(settings)
}

/// A mesh whose nodes are given by the map in `field`.
pub(crate) fn checked_mesh(
    mesh: Result<Mesh, MeshError>,
    field: &Field<'_>,
) -> Result<Mesh, InputError> {
    mesh.map_err(|error| match error {
        MeshError::Ends {
            found, expected, ..
        } => field.refuse(
            format!("{found:?} at s = {expected}"),
            "a map that takes 0 to 0 and 1 to 1",
        ),
        MeshError::NotIncreasing {
            index,
            previous,
            found,
        } => {
            let nodes = format!(
                "nodes {} and {index} at {previous:?} and {found:?}",
                index - 1
            );
            field.refuse(nodes, "a map that increases strictly")
        }
        MeshError::TooClose {
            index,
            previous,
            found,
        } => {
            let nodes = format!(
                "nodes {} and {index} at {previous:?} and {found:?}",
                index - 1
            );
            field.refuse(
                nodes,
                "a map whose nodes are far enough apart: 1/h overflows",
            )
        }
        MeshError::TooFew { elements } => {
            field.refuse(format!("{elements} elements"), "at least 1")
        }
    })
}

/// A function of `variable`, finite on [0, end] with its derivatives up to `order`; a message
/// points into the text.
pub(crate) fn function(
    field: &Field<'_>,
    variable: Variable,
    end: f64,
    order: usize,
) -> Result<Expression, InputError> {
    let expected = format!(
        "a function of {} in quotes, such as \"1 - {}\"",
        variable.name(),
        variable.name()
    );
    let function = field.parsed(&expected, |text| {
        Expression::parse(text, variable).map_err(|error| Misread {
            offset: error.offset,
            reason: format!("{}\n{}", error.problem, error.excerpt()),
        })
    })?;
    function
        .check_finite(end, order)
        .map_err(|found| field.invalid(found.to_string()))?;
    Ok(function)
}
