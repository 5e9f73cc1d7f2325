//! Scene files: one beam, its initial state, mesh and time steps.
//!
//! ```toml
//! [beam]                      # all have defaults: (5.1), beta = 0, theta_a = 0
//! beta = 5.0
//!
//! [obstacles]                 # leave the table out: no obstacles; its keys default to (5.1)
//! epsilon = 1e-3
//!
//! [initial]                   # functions of x; left out: 0
//! u = "0.01*x*(x-2)"
//! theta = "sin(pi*x)"         # the physical temperature, theta_a included
//!
//! [mesh]
//! elements = 100              # uniform; or map = "s + 0.1*sin(2*pi*s)" beside it; or nodes = [0.0, ..., 1.0] instead
//!
//! [time]
//! dt = 1e-4
//! t_end = 10.0
//! ```

pub mod any_order;
pub(crate) mod functions;
pub(crate) mod limits;
pub(crate) mod tables;

use crate::scene::functions::FunctionField;
use std::path::Path;

use thermobeam::mesh::{Mesh, MeshError};
use thermobeam::parameters::{Beam, Obstacles};
use thermobeam::scheme::Scheme;
use thermobeam::solve::Settings;

use crate::exact::function::Function as _;
use crate::expression::{Expression, NotFinite, Variable};

use convergence_study::input::{self, Field, InputError, POSITIVE, Section};

/// Elements of a scene that does not say: the paper's number.
const DEFAULT_ELEMENTS: usize = 100;

/// The tables of a scene.
pub(crate) const TABLES: [&str; 5] = ["beam", "obstacles", "initial", "mesh", "time"];

/// Initial data (1.2), functions of x; `None` is 0.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Initial {
    /// Displacement.
    pub u: Option<Expression>,
    /// Velocity.
    pub u_t: Option<Expression>,
    /// Rotation.
    pub phi: Option<Expression>,
    /// Rate of rotation.
    pub phi_t: Option<Expression>,
    /// Physical temperature, θ_A at x = 0 and 0 at x = 1.
    pub theta: Option<Expression>,
}

/// Everything that a simulation needs, validated.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// The file's name without folder and extension.
    pub name: String,
    /// Coefficients of the equations.
    pub beam: Beam,
    /// The obstacles, if any.
    pub obstacles: Option<Obstacles>,
    /// Initial data; they meet the boundary conditions up to round-off and are finite at every node.
    pub initial: Initial,
    /// The mesh.
    pub mesh: Mesh,
    /// Time step.
    pub dt: f64,
    /// Final time, `steps * dt` up to round-off.
    pub t_end: f64,
    /// Number of time steps.
    pub steps: usize,
    /// Time scheme.
    pub scheme: Scheme,
    /// How each step is solved.
    pub settings: Settings,
}

impl Scene {
    /// Reads a scene file.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, InputError> {
        let path = path.as_ref();
        Self::parse(&input::read_text(path)?, &path.display().to_string())
    }

    /// Reads a scene from `text`; complaints and the scene's name refer to `file_name`.
    pub fn parse(text: &str, file_name: &str) -> Result<Self, InputError> {
        input::parse(text, file_name, |root| Self::from_document(root, stem(file_name)))
    }

    fn from_document(root: &Section<'_>, name: String) -> Result<Self, InputError> {
        root.allow(&TABLES)?;
        Self::from_tables(root, name)
    }

    /// The scene of the tables in a section, which may hold other keys besides.
    pub(crate) fn from_tables(root: &Section<'_>, name: String) -> Result<Self, InputError> {
        let beam = tables::beam(root)?;
        let obstacles = tables::obstacles(root)?;
        let time = root.require("time", "a table with dt and t_end")?.section()?;
        time.allow(&[&["dt", "t_end"], &tables::STEPPING_KEYS[..]].concat())?;
        let (dt, t_end, steps) = time_steps(&time)?;
        let (scheme, settings) = (tables::scheme(&time)?, tables::settings(&time)?);
        let mesh = mesh(root, DEFAULT_ELEMENTS)?;
        linear_elements(root)?;
        let initial = initial(root, &beam, &mesh)?;
        Ok(Self { name, beam, obstacles, initial, mesh, dt, t_end, steps, scheme, settings })
    }
}

/// A file's name without folder and extension.
pub(crate) fn stem(file_name: &str) -> String {
    Path::new(file_name).file_stem().map_or(file_name.into(), |stem| stem.to_string_lossy()).into_owned()
}

/// dt, t_end and the number of steps.
fn time_steps(time: &Section<'_>) -> Result<(f64, f64, usize), InputError> {
    // Each of dt, t_end and their quotient is rounded once.
    const SLACK: f64 = 4.0 * f64::EPSILON;
    let t_end = time.positive("t_end")?;
    let field = time.require("dt", POSITIVE)?;
    let dt = field.positive()?;
    let quotient = t_end / dt;
    if quotient > limits::STEPS as f64 {
        let found = format!("{dt:?}, which is {quotient:.3e} steps for t_end = {t_end:?}");
        return Err(field.refuse(found, format!("at most {:e} steps", limits::STEPS as f64)));
    }
    let steps = quotient.round();
    if steps >= 1.0 && (steps * dt - t_end).abs() <= SLACK * t_end {
        return Ok((dt, t_end, steps as usize));
    }
    let candidates = [quotient.floor().max(1.0), quotient.ceil()].map(|steps| (steps, t_end / steps));
    let distance = |candidate: f64| (candidate - dt).abs();
    let [low, high] = candidates;
    let (steps, nearest) = if distance(low.1) <= distance(high.1) { low } else { high };
    let found = format!("{dt:?}, which is {quotient} steps for t_end = {t_end:?}");
    Err(field.refuse(found, format!("a dt that divides t_end, the nearest being {nearest:?} ({steps} steps)")))
}

/// The table `[mesh]`.
fn mesh(root: &Section<'_>, default_elements: usize) -> Result<Mesh, InputError> {
    let section = root.section("mesh")?;
    let get = |key: &str| section.as_ref().and_then(|section| section.get(key));
    if let Some(section) = &section {
        section.allow(&["elements", "map", "nodes", "degree"])?;
    }
    if let Some(nodes) = get("nodes") {
        if let Some(other) = get("elements").or_else(|| get("map")) {
            return Err(
                other.refuse(format!("{} beside nodes", other.as_written()), "either nodes, or elements and map")
            );
        }
        return listed_nodes(&nodes);
    }
    let elements = get("elements").map_or(Ok(default_elements), |field| tables::elements(&field))?;
    let Some(field) = get("map") else {
        return Mesh::uniform(elements).map_err(|error| root.refuse("mesh", error.to_string(), "a valid mesh"));
    };
    let map = field.expression(Variable::S)?;
    field.finite(&map, 1.0, 0)?;
    tables::checked_mesh(Mesh::mapped(elements, |s| map.eval(s)), &field)
}

/// Refuses elements of a higher degree: one-step schemes work on linear ones.
fn linear_elements(root: &Section<'_>) -> Result<(), InputError> {
    let degree = root.section("mesh")?.and_then(|section| section.get("degree"));
    let Some(field) = degree.filter(|field| field.count(1..=1).is_err()) else { return Ok(()) };
    Err(field.refuse(field.as_written(), "1, or time.scheme = \"dg\" for elements of higher degree"))
}

fn listed_nodes(field: &Field<'_>) -> Result<Mesh, InputError> {
    let allowed = "a list of at least two numbers that increase strictly from 0 to 1";
    let items = field.items(allowed)?;
    let nodes = items.iter().map(Field::number).collect::<Result<Vec<f64>, _>>()?;
    Mesh::from_nodes(nodes).map_err(|error| match error {
        MeshError::TooFew { .. } => field.refuse_as_written(allowed),
        MeshError::Ends { index, expected, .. } => items[index].refuse_as_written(format!("{expected} at this end")),
        MeshError::NotIncreasing { index, previous, .. } => {
            items[index].refuse_as_written(format!("a number > {previous:?}, the node before"))
        }
        MeshError::TooClose { index, previous, .. } => {
            items[index].refuse_as_written(format!("a node further from {previous:?}, the one before: 1/h overflows"))
        }
    })
}

/// The table `[initial]`.
fn initial(root: &Section<'_>, beam: &Beam, mesh: &Mesh) -> Result<Initial, InputError> {
    let section = root.section("initial")?;
    if let Some(section) = &section {
        section.allow(&["u", "u_t", "phi", "phi_t", "theta"])?;
    }
    let function = |key: &str, conditions: &[(f64, f64)]| -> Result<Option<Expression>, InputError> {
        let Some(field) = section.as_ref().and_then(|section| section.get(key)) else { return Ok(None) };
        let function = field.expression(Variable::X)?;
        field.finite(&function, 1.0, 0)?;
        finite_at_nodes(&field, &function, mesh)?;
        for &(at, expected) in conditions {
            meets(&field, &function, key, at, expected)?;
        }
        Ok(Some(function))
    };
    let clamped = [(0.0, 0.0)];
    let initial = Initial {
        u: function("u", &clamped)?,
        u_t: function("u_t", &clamped)?,
        phi: function("phi", &clamped)?,
        phi_t: function("phi_t", &clamped)?,
        theta: function("theta", &[(0.0, beam.theta_a), (1.0, 0.0)])?,
    };
    if initial.theta.is_none() && beam.theta_a != 0.0 {
        let found = "nothing, which means 0 everywhere";
        let allowed = format!("a function with theta(0) = {:?}, which is beam.theta_a, and theta(1) = 0", beam.theta_a);
        return Err(match &section {
            Some(section) => section.refuse("theta", found, allowed),
            None => root.refuse("initial.theta", found, allowed),
        });
    }
    Ok(initial)
}

/// Initial data are interpolated, so that every node counts, not only the samples.
fn finite_at_nodes(field: &Field<'_>, function: &Expression, mesh: &Mesh) -> Result<(), InputError> {
    let values = mesh.nodes().iter().map(|&at| (at, function.eval(at)));
    match values.into_iter().find(|(_, value)| !value.is_finite()) {
        None => Ok(()),
        Some((at, found)) => Err(field.not_finite(NotFinite { variable: Variable::X, at, end: 1.0, order: 0, found })),
    }
}

/// A boundary condition, up to the rounding error of the function.
fn meets(field: &Field<'_>, function: &Expression, key: &str, at: f64, expected: f64) -> Result<(), InputError> {
    let found = function.eval(at);
    // The rounding error takes thousands of evaluations, which a sweep would pay in every case.
    if found == expected || (found - expected).abs() <= function.roundoff(1.0) {
        return Ok(());
    }
    Err(field.refuse(format!("{key}({at}) = {found:?}"), format!("{key}({at}) = {expected:?}, the boundary condition")))
}
