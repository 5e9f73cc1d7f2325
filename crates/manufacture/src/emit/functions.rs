//! The functions that are emitted: one for all components of a quantity.

use super::Language;
use crate::arithmetic::NodeId;
use crate::derive::{DerivedQuantity, Part, Role, Tensor, components, quantity};
use crate::language::is_of_name;
use crate::model::Model;

/// The argument that asks the answering program for functions besides sources and data; no face
/// has this name.
const OTHERS: &str = ":others";

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
    let mut all = vec![];
    for (part, quantities) in &model.parts {
        all.extend(quantities.iter().filter_map(|quantity| {
            let name = name(model, *part, quantity)?;
            Some(function(model, *part, quantity.role, name, quantity))
        }));
    }
    all.extend(parts_of_sources(model));
    let mut functions: Vec<EmittedFunction> = vec![];
    for mut function in all {
        let names = functions.iter().map(|known| &known.name);
        function.name = language.distinct(function.name, names);
        // Sources and data are asked for by the names of their quantities, the others together.
        let is_asked_for = matches!(function.role, Role::Source | Role::Datum);
        let name = if is_asked_for {
            &function.quantity
        } else {
            &function.name
        };
        function.components = components(&model.problem, name, &function.shape);
        functions.push(function);
    }
    functions.sort_by_key(|function| place(function.role));
    functions
}

fn function(
    model: &Model,
    part: Part,
    role: Role,
    name: String,
    quantity: &DerivedQuantity<NodeId>,
) -> EmittedFunction {
    EmittedFunction {
        name,
        role,
        quantity: quantity.name.clone(),
        part,
        shape: quantity.tensor.shape.clone(),
        roots: quantity.tensor.parts.clone(),
        components: vec![],
        has_time: model.problem.time.is_some() && role != Role::Initial,
    }
}

fn name(model: &Model, part: Part, quantity: &DerivedQuantity<NodeId>) -> Option<String> {
    let name = &quantity.name;
    Some(match (quantity.role, part) {
        (Role::Exact, _) => format!("exact_{name}"),
        (Role::Gradient, _) => format!("gradient_{name}"),
        (Role::Source, _) => format!("source_{name}"),
        (Role::Normal, _) => format!("normal_{name}"),
        (Role::Datum, Part::Face(face)) => {
            format!("boundary_{}_{name}", model.problem.faces[face].name)
        }
        (Role::Initial, _) => format!("initial_{name}"),
        _ => return None,
    })
}

/// Of what sources are made: definitions and terms; and all sources of several equations in one
/// function, which shares their work.
fn parts_of_sources(model: &Model) -> Vec<EmittedFunction> {
    let part_of_source = |role: Role, name: String, tensor: &Tensor<NodeId>| {
        let quantity = quantity(role, &name, "", tensor.clone());
        function(model, Part::Interior, role, name, &quantity)
    };
    let definitions = model.definitions.iter().map(|definition| {
        let name = format!("define_{}", definition.name);
        part_of_source(Role::Definition, name, &definition.tensor)
    });
    let mut functions: Vec<EmittedFunction> = definitions.collect();
    let sources: Vec<_> = model.of_role(Role::Source).collect();
    for source in &sources {
        for (number, (label, tensor)) in source.terms.iter().enumerate() {
            let is_name = label.chars().all(is_of_name) && !label.is_empty();
            let number = (number + 1).to_string();
            // A term of a text has no name: its place in the text stands for one.
            let label = if is_name { label } else { &number };
            let name = format!("term_{}_{label}", source.name);
            functions.push(part_of_source(Role::Term, name, tensor));
        }
    }
    // Terms of a table are in the order of the file, on which no byte depends.
    functions.sort_by(|a, b| (place(a.role), &a.name).cmp(&(place(b.role), &b.name)));
    if sources.len() > 1 {
        let roots = sources.iter().flat_map(|source| &source.tensor.parts);
        let all = Tensor::vector(roots.copied().collect());
        functions.push(part_of_source(Role::Sources, "sources".to_owned(), &all));
    }
    functions
}

/// Functions that an answering program evaluates together.
pub(crate) struct AnsweredTogether<'f> {
    /// What asks for them.
    pub(crate) argument: &'f str,
    /// The face on which they are asked for.
    pub(crate) face: Option<&'f str>,
    pub(crate) functions: Vec<&'f EmittedFunction>,
}

/// The sources, the data of each face, and the functions of the domain besides sources.
pub(crate) fn answered_together<'f>(
    model: &'f Model,
    functions: &'f [EmittedFunction],
) -> Vec<AnsweredTogether<'f>> {
    const REST: [Role; 5] = [
        Role::Exact,
        Role::Gradient,
        Role::Definition,
        Role::Term,
        Role::Sources,
    ];
    let of = |roles: &[Role], part: Part| {
        let functions = functions.iter();
        functions
            .filter(|f| roles.contains(&f.role) && f.part == part)
            .collect()
    };
    let in_domain = |argument: &'f str, roles: &[Role]| AnsweredTogether {
        argument,
        face: None,
        functions: of(roles, Part::Interior),
    };
    let mut groups = vec![in_domain("", &[Role::Source])];
    for (index, face) in model.problem.faces.iter().enumerate() {
        groups.push(AnsweredTogether {
            argument: &face.name,
            face: Some(&face.name),
            functions: of(&[Role::Datum], Part::Face(index)),
        });
    }
    groups.push(in_domain(OTHERS, &REST));
    groups.retain(|group| !group.functions.is_empty());
    groups
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
