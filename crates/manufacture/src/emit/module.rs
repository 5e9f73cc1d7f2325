//! A module of a language as its templates see it: names, and expressions as texts.

use std::collections::HashMap;
use std::fmt::Write as _;

use serde::Serialize;

use super::functions::{EmittedFunction, OTHERS, functions, others};
use super::lower::{Body, LoweringNames, lower};
use super::parameters::{ModuleParameter, parameters};
use super::{Alternative, Language};
use crate::arithmetic::quadrature::{self, POINTS};
use crate::arithmetic::{FieldDerivative, Node, NodeId};
use crate::derive::{Part, Role, components};
use crate::model::Model;
use crate::problem::Norm;

/// Points of the rule for averages, in each coordinate.
const AVERAGE_POINTS: usize = 8;

#[derive(Serialize)]
pub(super) struct Module<'m> {
    pub(super) name: &'m str,
    prefix: String,
    /// The first comment, without what depends on the language.
    head: Vec<String>,
    coordinates: usize,
    has_time: bool,
    parameters: Vec<ModuleParameter>,
    variants: Vec<ModuleVariant<'m>>,
    /// Whether parameters have other values in a variant.
    changes: bool,
    rules: Vec<Rule>,
    /// Whether branches of choices are functions of their own.
    has_choices: bool,
    /// Functions that no user calls.
    helpers: Vec<ModuleFunction>,
    functions: Vec<ModuleFunction>,
    norms: Vec<ErrorNorm>,
    /// What the answering program is asked for.
    groups: Vec<AnswerGroup>,
}

/// Points and weights of a quadrature on [0, 1].
#[derive(Serialize)]
struct Rule {
    name: &'static str,
    points: Vec<String>,
    weights: Vec<String>,
}

/// Another solution, and the parameters that have other values with it.
#[derive(Serialize)]
struct ModuleVariant<'m> {
    number: usize,
    name: &'m str,
    changes: Vec<[String; 2]>,
}

#[derive(Debug, Clone, PartialEq, Serialize)]
struct ModuleFunction {
    /// Without the prefix.
    name: String,
    /// The part of the name behind the role.
    suffix: String,
    is_exact: bool,
    shape: Vec<usize>,
    /// The number of components.
    count: usize,
    has_time: bool,
    /// Arguments that no statement uses: a compiler that is strict asks for a use of each.
    unused: Vec<&'static str>,
    /// The names of all constants.
    declared: Vec<String>,
    cases: Vec<Case>,
    /// What the body is integrated over.
    interval: Option<Interval>,
}

/// The statements of some variants, by their numbers; those of all other variants, and of the file,
/// come last and have no number.
#[derive(Debug, Clone, PartialEq, Serialize)]
struct Case {
    variants: Vec<usize>,
    body: Body,
}

#[derive(Debug, Clone, PartialEq, Serialize)]
struct Interval {
    axis: usize,
    low: String,
    /// Of a panel.
    width: String,
    panels: usize,
    /// Of each panel.
    points: usize,
}

#[derive(Serialize)]
struct ErrorNorm {
    name: &'static str,
    function: ModuleFunction,
}

/// The functions that answer for the sources, for a face, or for all else.
#[derive(Serialize)]
struct AnswerGroup {
    face: String,
    /// The names of all components, cut to lines.
    names: Vec<String>,
    functions: Vec<AnswerFunction>,
    count: usize,
}

#[derive(Serialize)]
struct AnswerFunction {
    name: String,
    shape: Vec<usize>,
    has_time: bool,
    /// Of its first component.
    place: usize,
}

impl<'m> Module<'m> {
    pub(super) fn new(
        model: &'m Model,
        alternatives: &'m [Alternative<'m>],
        language: Language,
    ) -> Self {
        let problem = &model.problem;
        let mut writer = Writer::new(model, alternatives, language);
        let emitted = functions(model, language);
        let functions: Vec<ModuleFunction> = (0..emitted.len())
            .map(|place| writer.function(place))
            .collect();
        let parameters = parameters(&mut writer);
        let norms = norms(model, &emitted, &functions);
        let variants = variants(&writer, alternatives);
        let mut rules = vec![];
        let helpers = writer.all_helpers();
        if helpers.iter().any(|helper| helper.interval.is_some()) {
            rules.push(rule("rule", POINTS, language));
        }
        rules.push(rule("gauss", AVERAGE_POINTS, language));
        Module {
            name: &problem.name,
            head: head(&writer, &emitted, alternatives),
            coordinates: problem.coordinates.len(),
            has_time: problem.time.is_some(),
            parameters,
            has_choices: helpers
                .iter()
                .any(|helper| helper.name.starts_with("branch")),
            changes: variants.iter().any(|variant| !variant.changes.is_empty()),
            groups: groups(model, &emitted),
            prefix: writer.prefix,
            variants,
            rules,
            helpers,
            functions,
            norms,
        }
    }
}

/// The models of a module, and the helpers of their functions.
pub(super) struct Writer<'m> {
    /// That of the file first.
    pub(super) models: Vec<&'m Model>,
    functions: Vec<Vec<EmittedFunction>>,
    pub(super) language: Language,
    prefix: String,
    /// The names of the parameters in the module, and how functions read them.
    pub(super) parameters: Vec<String>,
    readings: Vec<String>,
    helpers: Vec<ModuleFunction>,
    /// The bodies of the derivatives of fields, by the names of their helpers and the place of the
    /// model.
    fields: Vec<(String, Vec<(usize, Body)>)>,
    /// The name of the helper of a node of a model.
    known: HashMap<(usize, NodeId), String>,
}

impl<'m> Writer<'m> {
    fn new(model: &'m Model, alternatives: &'m [Alternative<'m>], language: Language) -> Self {
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
            fields: vec![],
            known: HashMap::new(),
        }
    }

    /// The statements for nodes of a model.
    pub(super) fn body(
        &mut self,
        place: usize,
        roots: &[NodeId],
        array: &str,
        time: Option<&str>,
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
        lower(&model.graph, roots, &names, &mut helper)
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
                let interval = Interval {
                    axis: variable,
                    low: self.language.number(low),
                    width: self.language.number((high - low) / panels as f64),
                    panels,
                    points: POINTS,
                };
                let body = self.body(place, &[body], "y", Some("t"));
                self.shared("integral", body, Some(interval))
            }
            Node::Field(value, derivative) => {
                let name = self.name_of_field(derivative);
                let body = self.body(place, &[value], "x", Some("t"));
                match self.fields.iter_mut().find(|field| field.0 == name) {
                    Some((_, bodies)) => bodies.push((place, body)),
                    None => self.fields.push((name.clone(), vec![(place, body)])),
                }
                name
            }
            _ => {
                let body = self.body(place, &[id], "x", Some("t"));
                self.shared("branch", body, None)
            }
        };
        let name = self.prefix.clone() + &name;
        self.known.insert((place, id), name.clone());
        name
    }

    /// The name of a helper, which is that of all models that have the same.
    fn shared(&mut self, sort: &str, body: Body, interval: Option<Interval>) -> String {
        let cases = vec![Case {
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
    fn scalar(&self, name: String, cases: Vec<Case>, interval: Option<Interval>) -> ModuleFunction {
        let has_time = self.models[0].problem.time.is_some();
        let mut function = ModuleFunction {
            suffix: String::new(),
            is_exact: false,
            shape: vec![],
            count: 1,
            has_time,
            unused: unused(&cases, has_time),
            declared: declared(cases.iter().map(|case| &case.body)),
            name,
            cases,
            interval,
        };
        // The points of an integral are made from x.
        if function.interval.is_some() {
            function.unused.retain(|name| *name != "x");
        }
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

    /// All helpers; the derivatives of fields with a case for the variants that are alike.
    fn all_helpers(&mut self) -> Vec<ModuleFunction> {
        let mut helpers = std::mem::take(&mut self.helpers);
        for (name, bodies) in std::mem::take(&mut self.fields) {
            helpers.push(self.scalar(name, cases(bodies), None));
        }
        helpers
    }

    /// A function, by its place among those of the file.
    fn function(&mut self, place: usize) -> ModuleFunction {
        let first = self.models[0].problem.first_time();
        let first = first.map(|time| self.language.number(time));
        let function = self.functions[0][place].clone();
        let time = if function.has_time {
            Some("t")
        } else {
            first.as_deref()
        };
        let mut bodies = vec![];
        for model in 0..self.models.len() {
            let roots = self.functions[model][place].roots.clone();
            bodies.push((model, self.body(model, &roots, "x", time)));
        }
        let cases = cases(bodies);
        ModuleFunction {
            suffix: suffix(&function.name).to_owned(),
            is_exact: function.role == Role::Exact,
            count: function.roots.len(),
            has_time: function.has_time,
            unused: unused(&cases, function.has_time),
            declared: declared(cases.iter().map(|case| &case.body)),
            cases,
            interval: None,
            shape: function.shape,
            name: function.name,
        }
    }
}

/// Bodies that are alike together, and that of the file last: it is also that of models that never
/// need it.
fn cases(bodies: Vec<(usize, Body)>) -> Vec<Case> {
    let mut bodies = bodies.into_iter();
    let Some((_, base)) = bodies.next() else {
        return vec![];
    };
    let mut cases: Vec<Case> = vec![];
    for (variant, body) in bodies.filter(|(_, body)| *body != base) {
        match cases.iter_mut().find(|case| case.body == body) {
            Some(case) => case.variants.push(variant),
            None => cases.push(Case {
                variants: vec![variant],
                body,
            }),
        }
    }
    cases.push(Case {
        variants: vec![],
        body: base,
    });
    cases
}

fn unused(cases: &[Case], has_time: bool) -> Vec<&'static str> {
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

/// The names of the constants of the longest body: those of the others are among them.
pub(super) fn declared<'b>(bodies: impl Iterator<Item = &'b Body>) -> Vec<String> {
    let longest = bodies.max_by_key(|body| body.constants.len());
    let constants = longest.map_or(&[][..], |body| &body.constants);
    constants
        .iter()
        .map(|constant| constant[0].clone())
        .collect()
}

/// The part of a function's name behind its role.
fn suffix(name: &str) -> &str {
    name.split_once('_').map_or("", |parts| parts.1)
}

fn rule(name: &'static str, points: usize, language: Language) -> Rule {
    let rule = quadrature::gauss(points);
    let texts = |part: usize| {
        let numbers = rule.iter().map(|pair| language.number(pair[part]));
        numbers.collect()
    };
    Rule {
        name,
        points: texts(0),
        weights: texts(1),
    }
}

fn variants<'m>(
    writer: &Writer<'m>,
    alternatives: &'m [Alternative<'m>],
) -> Vec<ModuleVariant<'m>> {
    let base = &writer.models[0].graph.parameters;
    let numbered = alternatives.iter().enumerate();
    let variants = numbered.map(|(place, Alternative { name, model })| {
        let values = base.iter().zip(&model.graph.parameters);
        let values = writer.parameters.iter().zip(values);
        let changed = values.filter(|(_, (base, value))| base != value);
        let changes =
            changed.map(|(name, (_, value))| [name.clone(), writer.language.number(*value)]);
        ModuleVariant {
            number: place + 1,
            name,
            changes: changes.collect(),
        }
    });
    variants.collect()
}

/// The norms that the file names.
fn norms(
    model: &Model,
    emitted: &[EmittedFunction],
    functions: &[ModuleFunction],
) -> Vec<ErrorNorm> {
    let mut errors = vec![];
    for (field, norms) in &model.problem.norms {
        for norm in norms {
            let role = if *norm == Norm::H1 {
                Role::Gradient
            } else {
                Role::Exact
            };
            let mut pairs = emitted.iter().zip(functions);
            let pair = pairs.find(|(f, _)| f.role == role && f.quantity == *field);
            errors.extend(pair.map(|(_, function)| ErrorNorm {
                name: norm.name(),
                function: function.clone(),
            }));
        }
    }
    errors
}

fn groups(model: &Model, functions: &[EmittedFunction]) -> Vec<AnswerGroup> {
    let of = |role: Role, part: Part| {
        let functions = functions.iter();
        functions
            .filter(|f| f.role == role && f.part == part)
            .collect()
    };
    let mut groups = vec![group("", of(Role::Source, Part::Interior))];
    for (index, face) in model.problem.faces.iter().enumerate() {
        groups.push(group(&face.name, of(Role::Datum, Part::Face(index))));
    }
    groups.push(group(OTHERS, others(functions)));
    groups.retain(|group| !group.functions.is_empty());
    groups
}

fn group(face: &str, functions: Vec<&EmittedFunction>) -> AnswerGroup {
    const LONGEST: usize = 48;
    let mut names = vec![String::new()];
    for name in functions.iter().flat_map(|f| &f.components) {
        let last = names.len() - 1;
        if !names[last].is_empty() {
            names[last].push(' ');
        }
        if names[last].len() > LONGEST {
            names.push(String::new());
        }
        let last = names.len() - 1;
        names[last] += name;
    }
    let mut count = 0;
    let mut answers = vec![];
    for function in functions {
        answers.push(AnswerFunction {
            name: function.name.clone(),
            shape: function.shape.clone(),
            has_time: function.has_time,
            place: count,
        });
        count += function.roots.len();
    }
    AnswerGroup {
        face: face.to_owned(),
        names,
        functions: answers,
        count,
    }
}

/// The lines of the first comment: equations, conventions, version and a hash of the input.
fn head(
    writer: &Writer<'_>,
    functions: &[EmittedFunction],
    alternatives: &[Alternative<'_>],
) -> Vec<String> {
    let problem = &writer.models[0].problem;
    let canonical = problem.canonical();
    let bytes = canonical.bytes();
    let hash = bytes.fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    });
    let version = env!("CARGO_PKG_VERSION");
    let mut head = vec![format!(
        "Manufactured solution `{}`, by manufacture {version}, input {hash:016x}.",
        problem.name
    )];
    head.extend(canonical.lines().map(str::to_owned));
    if !alternatives.is_empty() {
        let names: Vec<&str> = alternatives.iter().map(|one| one.name.as_str()).collect();
        head.push(format!(
            "Variants, chosen by the environment variable MANUFACTURE_VARIANT: {}",
            names.join(" ")
        ));
    }
    head.push(
        "Conventions: grad(v)_ij = dv_i/dx_j, div(A)_i = sum_j dA_ij/dx_j; tensors row by row; n \
         points outwards."
            .to_owned(),
    );
    let quantities = functions.iter().map(|f| (&f.name, &f.quantity));
    let plain = problem.parameters.iter().map(|parameter| &parameter.name);
    let renamed = quantities.chain(writer.parameters.iter().zip(plain));
    let renamed = renamed.filter(|(name, plain)| !name.ends_with(plain.as_str()));
    let renamed: Vec<&str> = renamed.map(|(name, _)| name.as_str()).collect();
    if !renamed.is_empty() {
        head.push(format!(
            "Written with _ behind the name: {}",
            renamed.join(", ")
        ));
    }
    head
}
