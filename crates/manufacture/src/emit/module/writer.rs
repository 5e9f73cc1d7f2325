//! The functions of a module, with the helpers that they call.

use std::collections::HashMap;
use std::fmt::Write as _;

use super::{Branch, ModuleFunction, Panels};
use crate::arithmetic::quadrature::POINTS;
use crate::arithmetic::{FieldDerivative, Node, NodeId};
use crate::derive::{Role, components};
use crate::emit::functions::{EmittedFunction, functions};
use crate::emit::lower::{Body, ConstantNames, LoweringNames, lower};
use crate::emit::{Alternative, Language};
use crate::model::Model;

/// The models of a module, and the helpers of their functions.
pub(in crate::emit) struct Writer<'m> {
    /// That of the file first.
    pub(in crate::emit) models: Vec<&'m Model>,
    functions: Vec<Vec<EmittedFunction>>,
    pub(in crate::emit) language: Language,
    pub(super) prefix: String,
    /// The names of the parameters in the module, and how functions read them.
    pub(in crate::emit) parameters: Vec<String>,
    readings: Vec<String>,
    pub(super) helpers: Vec<ModuleFunction>,
    /// Whether a helper is one side of a choice, evaluated where it is chosen.
    pub(super) has_choices: bool,
    /// The name of the helper of a node of a model.
    known: HashMap<(usize, NodeId), String>,
}

impl<'m> Writer<'m> {
    pub(super) fn new(
        model: &'m Model,
        alternatives: &'m [Alternative<'m>],
        language: Language,
    ) -> Self {
        let prefix = if language.row().has_prefix {
            format!("{}_", model.problem.name)
        } else {
            String::new()
        };
        let mut parameters: Vec<String> = vec![];
        for parameter in &model.problem.parameters {
            let name = format!("{prefix}parameter_{}", parameter.name);
            parameters.push(language.distinct(name, parameters.iter()));
        }
        let read = language.row().operators.parameter;
        let others = alternatives.iter().map(|alternative| alternative.model);
        let models: Vec<&Model> = std::iter::once(model).chain(others).collect();
        Writer {
            functions: models
                .iter()
                .map(|model| functions(model, language))
                .collect(),
            models,
            language,
            prefix,
            readings: parameters.iter().map(|name| read(name)).collect(),
            parameters,
            helpers: vec![],
            has_choices: false,
            known: HashMap::new(),
        }
    }

    /// The statements for nodes of a model.
    ///
    /// * `constants`: those of other bodies of the same function.
    pub(in crate::emit) fn body(
        &mut self,
        place: usize,
        roots: &[NodeId],
        array: &str,
        time: Option<&str>,
        constants: &mut ConstantNames,
    ) -> Body {
        let model = self.models[place];
        let readings = self.readings.clone();
        let names = LoweringNames {
            language: self.language,
            array,
            coordinates: model.problem.coordinates.len(),
            time: time.filter(|_| model.problem.time.is_some()),
            parameters: &readings,
        };
        let mut helper = |id| self.helper(place, id);
        lower(&model.graph, roots, &names, constants, &mut helper)
    }

    /// The name of the function that computes a node.
    fn helper(&mut self, place: usize, id: NodeId) -> String {
        if let Some(name) = self.known.get(&(place, id)) {
            return name.clone();
        }
        let model = self.models[place];
        let name = match *model.graph.node(id) {
            Node::Integral {
                body,
                variable,
                panels,
            } => {
                let [low, high] = model.graph.intervals[variable];
                let interval = Panels {
                    axis: variable,
                    low: self.language.number(low),
                    width: self.language.number((high - low) / panels as f64),
                    panels,
                    points: POINTS,
                };
                let body = self.body(place, &[body], "y", Some("t"), &mut HashMap::new());
                self.shared("integral", body, Some(interval))
            }
            Node::Field(_, derivative) => self.field(derivative),
            _ => {
                self.has_choices = true;
                let body = self.body(place, &[id], "x", Some("t"), &mut HashMap::new());
                self.shared("branch", body, None)
            }
        };
        let name = self.prefix.clone() + &name;
        self.known.insert((place, id), name.clone());
        name
    }

    /// The name of the function of a derivative of a field, with a case for the variants that are
    /// alike.
    fn field(&mut self, derivative: FieldDerivative) -> String {
        let name = self.name_of_field(derivative);
        if self.helpers.iter().any(|known| known.name == name) {
            return name;
        }
        let mut bodies = vec![];
        let mut constants = HashMap::new();
        for place in 0..self.models.len() {
            let graph = &self.models[place].graph;
            let mut nodes = (0..graph.len()).map(|node| graph.node(NodeId(node as u32)));
            let value = nodes.find_map(|node| match node {
                Node::Field(value, known) if *known == derivative => Some(*value),
                _ => None,
            });
            if let Some(value) = value {
                let body = self.body(place, &[value], "x", Some("t"), &mut constants);
                bodies.push((place, body));
            }
        }
        let helper = self.scalar(name.clone(), cases(bodies), None);
        self.helpers.push(helper);
        name
    }

    /// The name of a helper, which is that of all models that have the same.
    fn shared(&mut self, sort: &str, body: Body, interval: Option<Panels>) -> String {
        let cases = vec![Branch {
            variants: vec![],
            body,
        }];
        let mut helpers = self.helpers.iter();
        let same = helpers.find(|known| known.cases == cases && known.interval == interval);
        if let Some(known) = same {
            return known.name.clone();
        }
        let name = format!("{sort}_{}", self.helpers.len() + 1);
        let helper = self.scalar(name.clone(), cases, interval);
        self.helpers.push(helper);
        name
    }

    /// A helper with a value at each point.
    fn scalar(&self, name: String, cases: Vec<Branch>, interval: Option<Panels>) -> ModuleFunction {
        let has_time = self.models[0].problem.time.is_some();
        let mut function = ModuleFunction::new(name, vec![], has_time, cases);
        // The points of an integral are made from x.
        if interval.is_some() {
            function.unused.retain(|name| *name != "x");
        }
        function.interval = interval;
        function
    }

    /// The name of a derivative of a field: `field_u`, `field_u_xxt`.
    fn name_of_field(&self, derivative: FieldDerivative) -> String {
        let problem = &self.models[0].problem;
        let name = problem.exact_fields().nth(derivative.field.into());
        let mut exact = self.functions[0].iter();
        let exact = exact.find(|f| f.role == Role::Exact && Some(f.quantity.as_str()) == name);
        let shape = exact.map_or(&[][..], |function| &function.shape);
        let components = components(problem, name.unwrap_or_default(), shape);
        let mut text = format!("field_{}", components[usize::from(derivative.component)]);
        let variables = problem.variables();
        for (place, variable) in variables.iter().enumerate() {
            for _ in 0..derivative.times[place] {
                let _ = write!(text, "_{variable}");
            }
        }
        text
    }

    /// A function, by its place among those of the file.
    pub(super) fn function(&mut self, place: usize) -> ModuleFunction {
        let first = self.models[0].problem.first_time();
        let first = first.map(|time| self.language.number(time));
        let function = self.functions[0][place].clone();
        let time = if function.has_time {
            Some("t")
        } else {
            first.as_deref()
        };
        let mut bodies = vec![];
        let mut constants = HashMap::new();
        for model in 0..self.models.len() {
            let roots = self.functions[model][place].roots.clone();
            let body = self.body(model, &roots, "x", time, &mut constants);
            bodies.push((model, body));
        }
        let EmittedFunction {
            name,
            shape,
            has_time,
            ..
        } = function;
        ModuleFunction {
            is_exact: function.role == Role::Exact,
            ..ModuleFunction::new(name, shape, has_time, cases(bodies))
        }
    }
}

impl ModuleFunction {
    fn new(name: String, shape: Vec<usize>, has_time: bool, mut cases: Vec<Branch>) -> Self {
        Self {
            suffix: suffix(&name).to_owned(),
            is_exact: false,
            count: shape.iter().product(),
            unused: unused(&cases, has_time),
            declared: declared(cases.iter().map(|case| &case.body)),
            shared: shared(&mut cases),
            interval: None,
            name,
            shape,
            has_time,
            cases,
        }
    }
}

/// Bodies that are alike together, and that of the file last: it is also that of models that never
/// need it.
fn cases(bodies: Vec<(usize, Body)>) -> Vec<Branch> {
    let mut bodies = bodies.into_iter();
    let Some((_, base)) = bodies.next() else {
        return vec![];
    };
    let mut cases: Vec<Branch> = vec![];
    for (variant, body) in bodies.filter(|(_, body)| *body != base) {
        match cases.iter_mut().find(|case| case.body == body) {
            Some(case) => case.variants.push(variant),
            None => cases.push(Branch {
                variants: vec![variant],
                body,
            }),
        }
    }
    cases.push(Branch {
        variants: vec![],
        body: base,
    });
    cases
}

/// Takes the constants that the body of the file has in common with another one out of all bodies.
/// Where no variant is chosen, nothing is computed that is not needed.
fn shared(cases: &mut [Branch]) -> Vec<[String; 2]> {
    let Some((of_file, others)) = cases.split_last() else {
        return vec![];
    };
    let mut shared = of_file.body.constants.clone();
    shared.retain(|constant| {
        let mut others = others.iter();
        others.any(|case| case.body.constants.contains(constant))
    });
    for case in cases {
        case.body
            .constants
            .retain(|constant| !shared.contains(constant));
    }
    shared
}

fn unused(cases: &[Branch], has_time: bool) -> Vec<&'static str> {
    let is_used = |place: usize| cases.iter().any(|case| case.body.uses[place]);
    let mut unused = vec![];
    if !is_used(0) {
        unused.push("x");
    }
    if has_time && !is_used(1) {
        unused.push("t");
    }
    unused
}

/// The names of all constants of a function.
pub(in crate::emit) fn declared<'b>(bodies: impl Iterator<Item = &'b Body>) -> Vec<String> {
    let mut names: Vec<String> = vec![];
    for [name, _] in bodies.flat_map(|body| &body.constants) {
        if !names.contains(name) {
            names.push(name.clone());
        }
    }
    names
}

/// The part of a function's name behind its role.
fn suffix(name: &str) -> &str {
    name.split_once('_').map_or("", |parts| parts.1)
}
