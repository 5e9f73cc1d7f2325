//! The functions that are emitted: one for all components of a quantity.

use super::Language;
use crate::arithmetic::NodeId;
use crate::derive::{DerivedQuantity, Part, Role, Tensor, components};
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

/// All functions of a model, in the order of their roles.
pub(crate) fn functions(model: &Model, language: Language) -> Vec<EmittedFunction> {
    let mut all: Vec<EmittedFunction> = vec![];
    for (part, quantities) in &model.parts {
        for quantity in quantities {
            if let Some(name) = name(model, *part, quantity) {
                let DerivedQuantity { role, tensor, .. } = quantity;
                let function = EmittedFunction::new(model, *role, name, tensor);
                all.push(EmittedFunction {
                    part: *part,
                    quantity: quantity.name.clone(),
                    ..function
                });
            }
        }
    }
    all.extend(parts_of_sources(model));
    for place in 0..all.len() {
        let (known, rest) = all.split_at_mut(place);
        let function = &mut rest[0];
        let name = std::mem::take(&mut function.name);
        function.name = language.distinct(name, known.iter().map(|known| &known.name));
        // Sources and data are asked for by the names of their quantities, the others together.
        let name = match function.role {
            Role::Source | Role::Datum => &function.quantity,
            _ => &function.name,
        };
        function.components = components(&model.problem, name, &function.shape);
    }
    all.sort_by_key(|function| function.role);
    all
}

impl EmittedFunction {
    /// A function of the domain, which is a quantity of its own.
    fn new(model: &Model, role: Role, name: String, tensor: &Tensor<NodeId>) -> Self {
        Self {
            role,
            quantity: name.clone(),
            name,
            part: Part::Interior,
            shape: tensor.shape.clone(),
            roots: tensor.parts.clone(),
            components: vec![],
            has_time: model.problem.time.is_some() && role != Role::Initial,
        }
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
    let definitions = model.definitions.iter().map(|definition| {
        let name = format!("define_{}", definition.name);
        EmittedFunction::new(model, Role::Definition, name, &definition.tensor)
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
            functions.push(EmittedFunction::new(model, Role::Term, name, tensor));
        }
    }
    // Terms of a table are in the order of the file, on which no byte depends.
    functions.sort_by(|a, b| (a.role, &a.name).cmp(&(b.role, &b.name)));
    if sources.len() > 1 {
        let roots = sources.iter().flat_map(|source| &source.tensor.parts);
        let all = Tensor::vector(roots.copied().collect());
        let name = "sources".to_owned();
        functions.push(EmittedFunction::new(model, Role::Sources, name, &all));
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
