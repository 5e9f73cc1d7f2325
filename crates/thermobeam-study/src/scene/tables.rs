//! Common parts of scenes and study files: functions, the tables `[beam]` and `[obstacles]`, the
//! mesh, the stepping keys.

use thermobeam::mesh::{Mesh, MeshError};
use thermobeam::parameters::{Beam, Obstacles, ParameterError};
use thermobeam::scheme::{self, Scheme};
use thermobeam::solve::{Settings, Solver, Stopping};

use super::file::{BeamTable, Given, ObstacleTable};
use crate::expression::{Expression, Variable};
pub(crate) use crate::scene::limits::elements;
use convergence_study::{Field, Form, InputError, Key, Misread, Section, file::Refusal};

/// The keys of `[beam]`.
pub(crate) const BEAM_KEYS: [Key; 5] = [
    Key::new("zeta", Form::Number, "the viscosity ζ").or("0.1"),
    Key::new("a", Form::Number, "the thermal coupling a").or("0.017"),
    Key::new(
        "rho",
        Form::Number,
        "the factor ρ of ‖u_x‖² in the axial force",
    )
    .or("1.0"),
    Key::new(
        "beta",
        Form::Number,
        "the axial force β of the straight beam",
    )
    .or("0.0"),
    Key::new("theta_a", Form::Number, "the temperature θ_A at x = 0").or("0.0"),
];

/// The keys of `[obstacles]`.
pub(crate) const OBSTACLE_KEYS: [Key; 3] = [
    Key::new("epsilon", Form::Number, "the normal compliance ε").or("1e-3"),
    Key::new("g1", Form::Number, "the lower obstacle").or("-0.01"),
    Key::new("g2", Form::Number, "the upper obstacle").or("0.1"),
];

/// The table `[beam]`.
pub(crate) const BEAM: Key = Key::new(
    "beam",
    Form::Table(&[&[&BEAM_KEYS]]),
    "the coefficients of the equations (1.1)",
)
.or("each of its keys has a default");

/// The table `[obstacles]`.
pub(crate) const OBSTACLES: Key = Key::new(
    "obstacles",
    Form::Table(&[&[&OBSTACLE_KEYS]]),
    "the obstacles at the free end, (1.3)",
)
.or("no obstacles");

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
        BEAM_KEYS
            .into_iter()
            .chain(OBSTACLE_KEYS)
            .map(|key| key.name)
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
        new.set(beam.given());
        if let Some(obstacles) = obstacles {
            new.set(obstacles.given());
        }
        new.beam
            .validate()
            .map_err(|error| out_of_range("beam", error))?;
        if let Some(obstacles) = &new.obstacles {
            obstacles
                .validate()
                .map_err(|error| out_of_range("obstacles", error))?;
        }
        Ok(new)
    }

    fn set<const N: usize>(&mut self, given: Given<N>) {
        for (name, value) in given {
            if let (Some(coefficient), Some(value)) = (self.get_mut(name), value) {
                *coefficient = value.get();
            }
        }
    }

    /// The tables `[beam]` and `[obstacles]` of a document.
    pub(crate) fn read(root: &Section<'_>) -> Result<Self, InputError> {
        let beam = root.section("beam")?;
        let beam = beam.map_or(Ok(BeamTable::default()), |beam| beam.read())?;
        let obstacles = root.section("obstacles")?;
        let obstacles = obstacles.map(|obstacles| obstacles.read()).transpose()?;
        Self::new(&beam, obstacles.as_ref()).map_err(|refusal| root.locate(refusal))
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
pub(crate) const STEPPING_KEYS: [Key; 5] = [
    Key::new(
        "scheme",
        Form::Choice(|| scheme::SCHEMES.map(|scheme| scheme.name).to_vec()),
        "the one-step scheme",
    )
    .or("\"euler-crank-nicolson\""),
    Key::new(
        "solver",
        Form::Choice(|| Solver::ALL.map(Solver::name).to_vec()),
        "how a step is solved",
    )
    .or("\"newton\""),
    Key::new(
        "tolerance",
        Form::Positive,
        "the increment at which an iteration ends",
    )
    .or("1e-10"),
    Key::new(
        "max_iterations",
        Form::Count(1),
        "iterations after which a step fails",
    )
    .or("100"),
    Key::new(
        "iterations",
        Form::Count(1),
        "of the fixed point in each step, in place of tolerance and max_iterations",
    )
    .or(""),
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

/// A coefficient that the solver would refuse.
fn out_of_range(table: &str, error: ParameterError) -> Refusal {
    Refusal::written(format!("{table}.{}", error.name), error.allowed)
}

/// A mesh whose nodes are given by the map at `path`.
pub(crate) fn mapped(path: &str, mesh: Result<Mesh, MeshError>) -> Result<Mesh, Refusal> {
    mesh.map_err(|error| {
        let nodes = |index: usize, previous: f64, found: f64, allowed: &str| {
            let before = index - 1;
            let nodes = format!("nodes {before} and {index} at {previous:?} and {found:?}");
            Refusal::new(path, nodes, allowed)
        };
        match error {
            MeshError::Ends {
                found, expected, ..
            } => Refusal::new(
                path,
                format!("{found:?} at s = {expected}"),
                "a map that takes 0 to 0 and 1 to 1",
            ),
            MeshError::NotIncreasing {
                index,
                previous,
                found,
            } => nodes(index, previous, found, "a map that increases strictly"),
            MeshError::TooClose {
                index,
                previous,
                found,
            } => {
                let allowed = "a map whose nodes are far enough apart: 1/h overflows";
                nodes(index, previous, found, allowed)
            }
            MeshError::TooFew { elements } => {
                Refusal::new(path, format!("{elements} elements"), "at least 1")
            }
        }
    })
}

/// As [`mapped`], about a field that was looked up.
pub(crate) fn checked_mesh(
    mesh: Result<Mesh, MeshError>,
    field: &Field<'_>,
) -> Result<Mesh, InputError> {
    mapped("", mesh).map_err(|refusal| field.locate(refusal))
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
