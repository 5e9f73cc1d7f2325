//! The mesh of a scene, and its initial data with their conditions.

use convergence_study::file::{Count, Finite, Refusal};
use thermobeam::mesh::{Mesh, MeshError};
use thermobeam::parameters::Beam;

use super::file::{Formula, InitialTable, MeshTable, OfX, first_where};
use super::{Initial, tables};
use crate::exact::function::Function as _;
use crate::expression::{Expression, NotFinite, Variable};

impl MeshTable {
    /// The mesh.
    ///
    /// # Errors
    /// Nodes beside another rule, or nodes that do not increase from 0 to 1.
    pub(super) fn mesh(&self, default_elements: usize) -> Result<Mesh, Refusal> {
        if let Some(nodes) = &self.nodes {
            let other = first_where([
                ("elements", self.elements.is_some()),
                ("map", self.map.is_some()),
            ]);
            if let Some(other) = other {
                let allowed = "either nodes, or elements and map";
                return Err(Refusal::written_and(other, " beside nodes", allowed));
            }
            return listed_nodes(nodes);
        }
        let elements = self.elements.map_or(default_elements, Count::get);
        let Some(map) = &self.map else {
            return tables::mapped("elements", Mesh::uniform(elements));
        };
        let map = map.parse("map", 1.0, 0)?;
        tables::mapped("map", Mesh::mapped(elements, |s| map.eval(s)))
    }
}

/// The mesh of a list of nodes, of the key `nodes`.
pub(crate) fn listed_nodes(nodes: &[Finite]) -> Result<Mesh, Refusal> {
    let nodes = nodes.iter().map(|node| node.get()).collect();
    Mesh::from_nodes(nodes).map_err(|error| match error {
        MeshError::TooFew { .. } => Refusal::written(
            "nodes",
            "a list of at least two numbers that increase strictly from 0 to 1",
        ),
        MeshError::Ends { index, .. }
        | MeshError::NotIncreasing { index, .. }
        | MeshError::TooClose { index, .. } => {
            Refusal::invalid(format!("nodes[{index}]"), error.to_string())
        }
    })
}

impl Initial {
    /// The initial data of a table, which must be finite at the nodes of `mesh`.
    pub(crate) fn new(table: &InitialTable, beam: &Beam, mesh: &Mesh) -> Result<Self, Refusal> {
        let clamped = [(0.0, 0.0)];
        let ends = [(0.0, beam.theta_a), (1.0, 0.0)];
        let initial = Initial {
            u: function("u", &table.u, mesh, &clamped)?,
            u_t: function("u_t", &table.u_t, mesh, &clamped)?,
            phi: function("phi", &table.phi, mesh, &clamped)?,
            phi_t: function("phi_t", &table.phi_t, mesh, &clamped)?,
            theta: function("theta", &table.theta, mesh, &ends)?,
        };
        if initial.theta.is_none() && beam.theta_a != 0.0 {
            let found = "nothing, which means 0 everywhere";
            let allowed = format!(
                "a function with theta(0) = {:?}, which is beam.theta_a, and theta(1) = 0",
                beam.theta_a
            );
            return Err(Refusal::new("theta", found, allowed));
        }
        Ok(initial)
    }
}

/// A function of x with these values, if it is given.
///
/// * `ends`: where it must be what.
fn function(
    key: &str,
    formula: &Option<Formula<OfX>>,
    mesh: &Mesh,
    ends: &[(f64, f64)],
) -> Result<Option<Expression>, Refusal> {
    let Some(formula) = formula else {
        return Ok(None);
    };
    let function = formula.parse(key, 1.0, 0)?;
    finite_at_nodes(key, &function, mesh)?;
    for &(at, expected) in ends {
        meets(key, &function, at, expected)?;
    }
    Ok(Some(function))
}

/// Initial data are interpolated, so every node is checked, not only the samples.
fn finite_at_nodes(path: &str, function: &Expression, mesh: &Mesh) -> Result<(), Refusal> {
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
            Err(Refusal::invalid(path, found.to_string()))
        }
    }
}

/// Checks a boundary condition, up to the rounding error of the function.
fn meets(path: &str, function: &Expression, x: f64, expected: f64) -> Result<(), Refusal> {
    let found = function.eval(x);
    // The rounding error takes thousands of evaluations, too expensive for every case of a sweep.
    if found == expected || (found - expected).abs() <= function.roundoff(1.0) {
        return Ok(());
    }
    Err(Refusal::new(
        path,
        format!("{path}({x}) = {found:?}"),
        format!("{path}({x}) = {expected:?}, the boundary condition"),
    ))
}
