//! The library of a language: parameters, integrals, functions.

use std::collections::HashMap;
use std::fmt::Write;

use super::choice::Alternative;
use super::functions::{Function, functions};
use super::lower::{Lowered, Names, lower};
use super::texts::Texts;
use super::{EmittedFile, Language, choice, fill, parameters, runtime};
use crate::arithmetic::quadrature::{self, POINTS};
use crate::arithmetic::tape::nodes_below;
use crate::arithmetic::{Node, NodeId};
use crate::model::Model;

/// The coordinates in an integral.
const INTEGRAND: &str = "y";

/// Columns of a line.
const WIDTH: usize = 100;

/// What the functions of a file have in common.
pub(super) struct Writer<'m> {
    /// The model of the file.
    pub(super) model: &'m Model,
    /// This model, and then those that can replace it.
    pub(super) models: Vec<Emitted<'m>>,
    pub(super) language: Language,
    /// The prefix of C.
    pub(super) prefix: String,
    pub(super) parameters: Vec<String>,
    /// The helpers of all integrals, the inner before the outer, with `@NAME@` for the name.
    integrals: Vec<String>,
}

/// A model of a file, and its functions: they have the same names in all models.
pub(super) struct Emitted<'m> {
    /// Empty for the model of the file.
    pub(super) name: String,
    pub(super) model: &'m Model,
    pub(super) functions: Vec<Function>,
    /// The place of the helper of each integral.
    integrals: HashMap<NodeId, usize>,
}

/// The library, and in C its header.
pub(super) fn library(
    model: &Model,
    alternatives: &[Alternative<'_>],
    language: Language,
    functions: &[Function],
) -> Vec<EmittedFile> {
    let name = &model.problem.name;
    let writer = Writer::new(model, alternatives, language);
    let head = writer.head(functions);
    let mut body = choice::functions(&writer);
    for (place, helper) in writer.integrals.iter().enumerate() {
        body += &fill(helper, &[("NAME", &writer.name_of_integral(place))]);
    }
    let places = 0..functions.len();
    let mut public: String = places.map(|place| writer.function(place)).collect();
    public += &runtime::norms(&writer, functions);
    body += &public;
    body += &parameters::functions(&writer);
    let opening = runtime::opening(&writer, functions);
    let closing = runtime::closing(&writer);
    let text = format!(
        "{head}{opening}{}{}{}{body}{closing}",
        parameters::definitions(&writer),
        choice::variable(&writer),
        runtime::helpers(&writer)
    );
    let mut files = vec![EmittedFile {
        name: format!("{name}{}", writer.texts().ending),
        text,
    }];
    let header = runtime::header(&writer, &public, &head);
    let texts = writer.texts().header.as_ref();
    files.extend(texts.zip(header).map(|(texts, text)| EmittedFile {
        name: format!("{name}{}", texts.ending),
        text,
    }));
    files
}

/// What stands before the name of a function.
pub(super) fn prefix(model: &Model, language: Language) -> String {
    fill(language.texts().prefix, &[("NAME", &model.problem.name)])
}

/// The integrals below the functions, the inner before the outer.
fn integrals(model: &Model, functions: &[Function]) -> Vec<NodeId> {
    let roots: Vec<NodeId> = functions.iter().flat_map(|f| f.roots.clone()).collect();
    let mut open = nodes_below(&model.graph, &roots);
    let mut integrals = vec![];
    while let Some(id) = open.pop() {
        if let Node::Integral { body, .. } = model.graph.node(id) {
            integrals.push(id);
            open.extend(nodes_below(&model.graph, &[*body]));
        }
    }
    integrals.sort();
    integrals.dedup();
    integrals
}

impl<'m> Writer<'m> {
    fn new(model: &'m Model, alternatives: &[Alternative<'m>], language: Language) -> Self {
        let prefix = prefix(model, language);
        let mut parameters: Vec<String> = vec![];
        for parameter in &model.problem.parameters {
            let names: Vec<&str> = parameters.iter().map(String::as_str).collect();
            let name = format!("{prefix}parameter_{}", parameter.name);
            parameters.push(language.distinct(name, &names));
        }
        let base = Alternative {
            name: String::new(),
            model,
        };
        let all = std::iter::once(&base).chain(alternatives);
        let models = all.map(|Alternative { name, model }| Emitted {
            name: name.clone(),
            model,
            functions: functions(model, language),
            integrals: HashMap::new(),
        });
        let mut writer = Writer {
            model,
            models: models.collect(),
            language,
            prefix,
            parameters,
            integrals: vec![],
        };
        writer.add_integrals();
        writer
    }

    /// The helpers of the integrals of all models, each once.
    fn add_integrals(&mut self) {
        for place in 0..self.models.len() {
            let Emitted {
                model, functions, ..
            } = &self.models[place];
            for id in integrals(model, functions) {
                let helper = self.integral(&self.models[place], id);
                let known = self.integrals.iter().position(|known| *known == helper);
                let number = known.unwrap_or_else(|| {
                    self.integrals.push(helper);
                    self.integrals.len() - 1
                });
                self.models[place].integrals.insert(id, number);
            }
        }
    }

    pub(super) fn texts(&self) -> &'static Texts {
        self.language.texts()
    }

    pub(super) fn has_alternatives(&self) -> bool {
        self.models.len() > 1
    }

    /// Whether parameters have other values in an alternative.
    pub(super) fn changes_parameters(&self) -> bool {
        let base = &self.model.graph.parameters;
        let mut models = self.models.iter();
        models.any(|model| model.model.graph.parameters != *base)
    }

    /// The names of the file that are written with `_` behind them, as a line of the first comment.
    fn renamed(&self, functions: &[Function]) -> String {
        let quantities = functions.iter().map(|f| (&f.name, &f.quantity));
        let parameters = self.model.problem.parameters.iter();
        let parameters = self.parameters.iter().zip(parameters.map(|p| &p.name));
        let renamed = quantities.chain(parameters);
        let renamed = renamed.filter(|(name, plain)| !name.ends_with(plain.as_str()));
        let renamed: Vec<&str> = renamed.map(|(name, _)| name.as_str()).collect();
        if renamed.is_empty() {
            return String::new();
        }
        format!("Written with _ behind the name: {}\n", renamed.join(", "))
    }

    /// The first comment: equations, conventions, version and a hash of the input.
    fn head(&self, functions: &[Function]) -> String {
        let problem = &self.model.problem;
        let canonical = problem.canonical();
        let hash = canonical
            .bytes()
            .fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| {
                (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
            });
        let texts = self.texts();
        let build = fill(texts.build, &[("NAME", &problem.name)]);
        let comment = texts.comment;
        let mut head = String::new();
        let version = env!("CARGO_PKG_VERSION");
        let lines = format!(
            "Manufactured solution `{}`, by manufacture {version}, input {hash:016x}.\n{canonical}{}\
             Conventions: grad(v)_ij = dv_i/dx_j, div(A)_i = sum_j dA_ij/dx_j; tensors row by row; n points outwards.\n\
             {}Build: {}",
            problem.name,
            choice::head(self),
            self.renamed(functions),
            build
        );
        for line in lines.lines() {
            for part in wrapped(line, WIDTH - comment.len() - 1) {
                let _ = writeln!(head, "{comment} {part}");
            }
        }
        head
    }

    fn name_of_integral(&self, place: usize) -> String {
        format!("{}integral_{}", self.prefix, place + 1)
    }

    fn call_of_integral(
        &self,
        emitted: &Emitted<'_>,
        id: NodeId,
        array: &str,
        time: &str,
    ) -> String {
        let name = self.name_of_integral(emitted.integrals[&id]);
        if self.model.problem.time.is_some() {
            format!("{name}({array}, {time})")
        } else {
            format!("{name}({array})")
        }
    }

    /// Constants and values of roots with these names of the coordinates and of time.
    pub(super) fn statements(
        &self,
        emitted: &Emitted<'_>,
        roots: &[NodeId],
        array: &str,
        time: &str,
    ) -> Lowered {
        let array_argument = if array == INTEGRAND {
            self.texts().statements.integrand
        } else {
            array
        };
        let names = self.parameters.iter();
        let values: Vec<String> = names.map(|name| parameters::read(self, name)).collect();
        let names = Names {
            language: self.language,
            array,
            coordinates: self.model.problem.coordinates.len(),
            time,
            parameters: &values,
            integrals: &|id| self.call_of_integral(emitted, id, array_argument, time),
        };
        lower(&emitted.model.graph, roots, &names)
    }

    /// A function, by its place among those of the file.
    fn function(&self, place: usize) -> String {
        let function = &self.models[0].functions[place];
        let first = self.model.problem.first_time();
        let first = first.map(|time| self.language.number(time));
        let time = if function.has_time {
            "t"
        } else {
            first.as_deref().unwrap_or("t")
        };
        let indent = self.texts().statements.indent;
        let mut bodies = vec![];
        let mut longest = vec![];
        for emitted in &self.models {
            let roots = &emitted.functions[place].roots;
            let Lowered { constants, roots } = self.statements(emitted, roots, "x", time);
            let mut body = String::new();
            for [name, value] in &constants {
                let _ = writeln!(body, "{indent}{}", self.language.assign(name, value));
            }
            for (place, root) in roots.iter().enumerate() {
                let line = self.language.result(&function.shape, place, root);
                let _ = writeln!(body, "{indent}{line}");
            }
            bodies.push(body);
            if constants.len() > longest.len() {
                longest = constants;
            }
        }
        let body = choice::body(self, &bodies);
        runtime::framed(self, place, &declared(self.language, &longest), &body)
    }

    /// A helper for an integral over a coordinate, with fixed points.
    fn integral(&self, emitted: &Emitted<'_>, id: NodeId) -> String {
        let Node::Integral {
            body,
            variable,
            panels,
        } = emitted.model.graph.node(id)
        else {
            return String::new();
        };
        let Lowered { constants, roots } = self.statements(emitted, &[*body], INTEGRAND, "t");
        let indent = self.texts().statements.integrand_indent;
        let mut statements = String::new();
        for [name, value] in &constants {
            let _ = writeln!(statements, "{indent}{}", self.language.assign(name, value));
        }
        let has_time = self.model.problem.time.is_some();
        let [low, high] = self.model.graph.intervals[*variable];
        let width = (high - low) / *panels as f64;
        fill(
            self.texts().integral,
            &[
                ("DECLARED", &declared(self.language, &constants)),
                (
                    "UNUSED",
                    &runtime::unused(self, &[(emitted.model, &[*body])], has_time),
                ),
                ("BODY", &statements),
                ("T", runtime::time(self.language, has_time).argument),
                ("TIME", runtime::time(self.language, has_time).declaration),
                ("POINTS", &POINTS.to_string()),
                ("VALUE", &format!("({})", roots[0])),
                ("LOW", &self.language.number(low)),
                ("WIDTH", &self.language.number(width)),
                ("PANELS", &panels.to_string()),
                ("AXIS", &variable.to_string()),
                ("AXIS1", &(variable + 1).to_string()),
                ("D", &self.model.problem.coordinates.len().to_string()),
                ("P", &self.prefix),
            ],
        )
    }

    /// Points and weights on [0, 1] as rows of text: one row for all points, one for all weights.
    pub(super) fn rule(&self, points: usize) -> [String; 2] {
        let rule = quadrature::gauss(points);
        [0, 1].map(|part| {
            let numbers: Vec<String> = rule
                .iter()
                .map(|pair| self.language.number(pair[part]))
                .collect();
            numbers.join(self.texts().library.separator)
        })
    }

    pub(super) fn has_integrals(&self) -> bool {
        !self.integrals.is_empty()
    }
}

/// The declarations of constants, in Fortran.
pub(super) fn declared(language: Language, constants: &[[String; 2]]) -> String {
    let declare = language.texts().statements.declare;
    let names: Vec<&str> = constants
        .iter()
        .map(|constant| constant[0].as_str())
        .collect();
    names
        .chunks(12)
        .map(|names| fill(declare, &[("NAMES", &names.join(", "))]))
        .collect()
}

/// A line cut at blanks to parts of at most so many characters.
fn wrapped(line: &str, width: usize) -> Vec<String> {
    let mut parts = vec![String::new()];
    for word in line.split(' ') {
        let last = parts.len() - 1;
        if !parts[last].is_empty() && parts[last].len() + 1 + word.len() > width {
            parts.push(format!("    {word}"));
        } else {
            if !parts[last].is_empty() {
                parts[last].push(' ');
            }
            parts[last] += word;
        }
    }
    parts
}
