//! The functions that are emitted: one for all components of a quantity.

use super::Language;
use crate::arithmetic::NodeId;
use crate::derive::{Part, Quantity, Role, components};
use crate::model::Model;

/// A function of the coordinates and time.
#[derive(Debug, Clone)]
pub(crate) struct Function {
    /// Without the prefix of C.
    pub(crate) name: String,
    pub(crate) role: Role,
    /// The quantity's name.
    pub(crate) quantity: String,
    pub(crate) part: Part,
    pub(crate) shape: Vec<usize>,
    pub(crate) roots: Vec<NodeId>,
    /// The names of its components.
    pub(crate) components: Vec<String>,
    /// Whether time is an argument.
    pub(crate) has_time: bool,
}

/// All functions of a model, in a fixed order.
pub(crate) fn functions(model: &Model, language: Language) -> Vec<Function> {
    let mut functions: Vec<Function> = vec![];
    for (part, quantities) in &model.parts {
        for quantity in quantities {
            let Some(mut function) = function(model, *part, quantity) else {
                continue;
            };
            let names: Vec<&str> = functions.iter().map(|f| f.name.as_str()).collect();
            function.name = language.distinct(function.name, &names);
            functions.push(function);
        }
    }
    functions.sort_by_key(|function| place(function.role));
    functions
}

/// The order of the roles in a file.
fn place(role: Role) -> usize {
    match role {
        Role::Exact => 0,
        Role::Gradient => 1,
        Role::Source => 2,
        Role::Normal => 3,
        Role::Datum => 4,
        _ => 5,
    }
}

fn function(model: &Model, part: Part, quantity: &Quantity<NodeId>) -> Option<Function> {
    let name = &quantity.name;
    let name = match (quantity.role, part) {
        (Role::Exact, _) => format!("exact_{name}"),
        (Role::Gradient, _) => format!("gradient_{name}"),
        (Role::Source, _) => format!("source_{name}"),
        (Role::Normal, _) => format!("normal_{name}"),
        (Role::Datum, Part::Face(face)) => {
            format!("boundary_{}_{name}", model.problem.faces[face].name)
        }
        (Role::Initial, _) => format!("initial_{name}"),
        _ => return None,
    };
    Some(Function {
        name,
        role: quantity.role,
        quantity: quantity.name.clone(),
        part,
        shape: quantity.tensor.shape.clone(),
        roots: quantity.tensor.parts.clone(),
        components: components(&model.problem, &quantity.name, &quantity.tensor.shape),
        has_time: model.problem.time.is_some() && quantity.role != Role::Initial,
    })
}
