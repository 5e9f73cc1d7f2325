//! The tables of a scene file: their keys, the mesh, and the initial data with their conditions.

use convergence_study::{Field, Form, InputError, Key, Section};
use thermobeam::mesh::{Mesh, MeshError};
use thermobeam::parameters::Beam;

use super::{Initial, method, tables};
use crate::exact::function::Function as _;
use crate::expression::{Expression, NotFinite, Variable};

/// The tables of a scene.
pub const KEYS: [Key; 5] = [
    tables::BEAM,
    tables::OBSTACLES,
    INITIAL,
    Key::new("mesh", Form::Table(&[&[&UNIFORM], &[&LISTED]]), "the mesh")
        .or("its keys have defaults"),
    Key::new(
        "time",
        Form::Table(&[
            &[&method::ONE_STEP_KEYS, &tables::STEPPING_KEYS],
            &[&method::DG_KEYS],
        ]),
        "the method, its steps, and where the run ends",
    ),
];

/// The table `[initial]`.
const INITIAL: Key = Key::new(
    "initial",
    Form::Table(&[&[&INITIAL_KEYS]]),
    "the initial data, functions of x",
)
.or("all 0");

const INITIAL_KEYS: [Key; 5] = [
    Key::new("u", Form::Text, "displacement; 0 at x = 0").or("\"0\""),
    Key::new("u_t", Form::Text, "velocity; 0 at x = 0").or("\"0\""),
    Key::new("phi", Form::Text, "rotation; 0 at x = 0").or("\"0\""),
    Key::new("phi_t", Form::Text, "rate of rotation; 0 at x = 0").or("\"0\""),
    Key::new(
        "theta",
        Form::Text,
        "temperature; theta_a at x = 0, 0 at x = 1",
    )
    .or("\"0\""),
];

const DEGREE_KEY: Key = Key::new("degree", Form::Count(1), "degree p of the elements")
    .or("1, or 13 with scheme = \"dg\"");

const UNIFORM: [Key; 3] = [
    Key::new("elements", Form::Count(1), "number of elements").or("100, or 1 with scheme = \"dg\""),
    Key::new(
        "map",
        Form::Text,
        "a function of s that places the nodes: 0 at 0, 1 at 1",
    )
    .or("\"s\""),
    DEGREE_KEY,
];

const LISTED: [Key; 2] = [
    Key::new(
        "nodes",
        Form::List(&Form::Number),
        "the nodes, increasing from 0 to 1",
    ),
    DEGREE_KEY,
];

/// The table `[mesh]`.
pub(super) fn mesh(root: &Section<'_>, default_elements: usize) -> Result<Mesh, InputError> {
    let section = root.section("mesh")?;
    let get = |key: &str| section.as_ref().and_then(|section| section.get(key));
    if let Some(nodes) = get("nodes") {
        if let Some(other) = get("elements").or_else(|| get("map")) {
            return Err(other.refuse(
                format!("{} beside nodes", other.as_written()),
                "either nodes, or elements and map",
            ));
        }
        return listed_nodes(&nodes);
    }
    let elements =
        get("elements").map_or(Ok(default_elements), |field| tables::elements(&field))?;
    let Some(field) = get("map") else {
        return Mesh::uniform(elements)
            .map_err(|error| root.refuse("mesh", error.to_string(), "a valid mesh"));
    };
    let map = tables::function(&field, Variable::S, 1.0, 0)?;
    tables::checked_mesh(Mesh::mapped(elements, |s| map.eval(s)), &field)
}

fn listed_nodes(field: &Field<'_>) -> Result<Mesh, InputError> {
    let allowed = "a list of at least two numbers that increase strictly from 0 to 1";
    let items = field.items(allowed)?;
    let nodes = items
        .iter()
        .map(Field::number)
        .collect::<Result<Vec<f64>, _>>()?;
    Mesh::from_nodes(nodes).map_err(|error| match error {
        MeshError::TooFew { .. } => field.refuse_as_written(allowed),
        MeshError::Ends {
            index, expected, ..
        } => items[index].refuse_as_written(format!("{expected} at this end")),
        MeshError::NotIncreasing {
            index, previous, ..
        } => items[index].refuse_as_written(format!("a number > {previous:?}, the node before")),
        MeshError::TooClose {
            index, previous, ..
        } => items[index].refuse_as_written(format!(
            "a node further from {previous:?}, the one before: 1/h overflows"
        )),
    })
}

impl Initial {
    /// The table `[initial]`, whose functions must be finite at the nodes of `mesh`.
    pub(crate) fn read(root: &Section<'_>, beam: &Beam, mesh: &Mesh) -> Result<Self, InputError> {
        let section = root.section("initial")?;
        let function =
            |key: &str, conditions: &[(f64, f64)]| -> Result<Option<Expression>, InputError> {
                let Some(field) = section.as_ref().and_then(|section| section.get(key)) else {
                    return Ok(None);
                };
                let function = tables::function(&field, Variable::X, 1.0, 0)?;
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
            let allowed = format!(
                "a function with theta(0) = {:?}, which is beam.theta_a, and theta(1) = 0",
                beam.theta_a
            );
            return Err(match &section {
                Some(section) => section.refuse("theta", found, allowed),
                None => root.refuse("initial.theta", found, allowed),
            });
        }
        Ok(initial)
    }
}

/// Initial data are interpolated, so every node is checked, not only the samples.
fn finite_at_nodes(
    field: &Field<'_>,
    function: &Expression,
    mesh: &Mesh,
) -> Result<(), InputError> {
    let values = mesh.nodes().iter().map(|&x| (x, function.eval(x)));
    match values.into_iter().find(|(_, value)| !value.is_finite()) {
        None => Ok(()),
        Some((at, found)) => {
            let found = NotFinite {
                variable: Variable::X,
                at,
                end: 1.0,
                order: 0,
                found,
            };
            Err(field.invalid(found.to_string()))
        }
    }
}

/// Checks a boundary condition, up to the rounding error of the function.
fn meets(
    field: &Field<'_>,
    function: &Expression,
    key: &str,
    x: f64,
    expected: f64,
) -> Result<(), InputError> {
    let found = function.eval(x);
    // The rounding error takes thousands of evaluations, too expensive for every case of a sweep.
    if found == expected || (found - expected).abs() <= function.roundoff(1.0) {
        return Ok(());
    }
    Err(field.refuse(
        format!("{key}({x}) = {found:?}"),
        format!("{key}({x}) = {expected:?}, the boundary condition"),
    ))
}
