//! The functions that are emitted: one for all components of a quantity.

use super::Language;
use crate::arithmetic::NodeId;
use crate::derive::{DerivedQuantity, Part, Role, Tensor, components};
use crate::language::is_of_name;
use crate::model::Model;

/// A function of the coordinates and time.
#[derive(Debug, Clone)]
pub(crate) struct EmittedFunction {
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
pub(crate) fn functions(model: &Model, language: Language) -> Vec<EmittedFunction> {
    let mut functions: Vec<EmittedFunction> = vec![];
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
    for mut function in parts_of_sources(model) {
        let names: Vec<&str> = functions.iter().map(|f| f.name.as_str()).collect();
        function.name = language.distinct(function.name, &names);
        functions.push(function);
    }
    for function in &mut functions {
        // The answers of the others are asked for together.
        if !matches!(function.role, Role::Source | Role::Datum) {
            function.components = components(&model.problem, &function.name, &function.shape);
        }
    }
    functions.sort_by_key(|function| place(function.role));
    functions
}

/// Of what sources are made: definitions and terms; and all sources of several equations in one
/// function, which shares their work.
fn parts_of_sources(model: &Model) -> Vec<EmittedFunction> {
    let mut functions: Vec<EmittedFunction> = vec![];
    for definition in &model.definitions {
        let name = format!("define_{}", definition.name);
        functions.push(part_of_source(
            model,
            Role::Definition,
            name,
            &definition.tensor,
        ));
    }
    let sources: Vec<_> = model.of_role(Role::Source).collect();
    for source in &sources {
        for (number, (label, tensor)) in source.terms.iter().enumerate() {
            let is_name = label.chars().all(is_of_name) && !label.is_empty();
            let number = (number + 1).to_string();
            // A term of a text has no name: its place in the text stands for one.
            let label = if is_name { label } else { &number };
            let name = format!("term_{}_{label}", source.name);
            functions.push(part_of_source(model, Role::Term, name, tensor));
        }
    }
    // Terms of a table are in the order of the file, on which no byte depends.
    functions.sort_by(|a, b| (place(a.role), &a.name).cmp(&(place(b.role), &b.name)));
    if sources.len() > 1 {
        let roots = sources.iter().flat_map(|source| &source.tensor.parts);
        let all = Tensor::vector(roots.copied().collect());
        functions.push(part_of_source(
            model,
            Role::Sources,
            "sources".to_owned(),
            &all,
        ));
    }
    functions
}

fn part_of_source(
    model: &Model,
    role: Role,
    name: String,
    tensor: &Tensor<NodeId>,
) -> EmittedFunction {
    EmittedFunction {
        quantity: name.clone(),
        name,
        role,
        part: Part::Interior,
        shape: tensor.shape.clone(),
        roots: tensor.parts.clone(),
        components: vec![],
        has_time: model.problem.time.is_some(),
    }
}

/// The functions that the answering programs evaluate together, besides sources and data.
pub(crate) fn others(functions: &[EmittedFunction]) -> Vec<&EmittedFunction> {
    const OTHERS: [Role; 5] = [
        Role::Exact,
        Role::Gradient,
        Role::Definition,
        Role::Term,
        Role::Sources,
    ];
    functions
        .iter()
        .filter(|function| OTHERS.contains(&function.role))
        .collect()
}

/// The order of the roles in a file.
fn place(role: Role) -> usize {
    match role {
        Role::Exact => 0,
        Role::Gradient => 1,
        Role::Definition => 2,
        Role::Term => 3,
        Role::Source => 4,
        Role::Sources => 5,
        Role::Normal => 6,
        Role::Datum => 7,
        _ => 8,
    }
}

fn function(
    model: &Model,
    part: Part,
    quantity: &DerivedQuantity<NodeId>,
) -> Option<EmittedFunction> {
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
    Some(EmittedFunction {
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
