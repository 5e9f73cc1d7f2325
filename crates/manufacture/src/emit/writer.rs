//! What the texts of a file are written from: its models, the names of their parameters, and the
//! helpers of their integrals.

use std::collections::HashMap;
use std::fmt::Write;

use super::functions::{EmittedFunction, functions};
use super::lower::{Lowered, LoweringNames, lower};
use super::texts::{Texts, Time};
use super::{Language, fill};
use crate::arithmetic::quadrature::{self, POINTS};
use crate::arithmetic::tape::nodes_below;
use crate::arithmetic::{Node, NodeId};
use crate::model::Model;

/// The coordinates in an integral.
const INTEGRAND: &str = "y";

/// A model whose functions take the place of those of another where its name is chosen.
#[derive(Debug, Clone)]
pub(crate) struct Alternative<'m> {
    pub(crate) name: String,
    pub(crate) model: &'m Model,
}

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
    pub(super) functions: Vec<EmittedFunction>,
    /// The place of the helper of each integral.
    integrals: HashMap<NodeId, usize>,
}

/// What stands before the name of a function.
pub(super) fn prefix(model: &Model, language: Language) -> String {
    fill(language.texts().prefix, &[("NAME", &model.problem.name)])
}

/// The integrals below the functions, the inner before the outer.
fn integrals(model: &Model, functions: &[EmittedFunction]) -> Vec<NodeId> {
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
    pub(super) fn new(
        model: &'m Model,
        alternatives: &[Alternative<'m>],
        language: Language,
    ) -> Self {
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

    /// The helpers of all integrals with their names.
    pub(super) fn integral_helpers(&self) -> String {
        let helpers = self.integrals.iter().enumerate();
        helpers
            .map(|(place, helper)| fill(helper, &[("NAME", &self.name_of_integral(place))]))
            .collect()
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

    /// How functions read a parameter.
    pub(super) fn reading(&self, name: &str) -> String {
        let texts = &self.texts().parameters;
        let read = if self.changes_parameters() {
            texts.read_of_variant
        } else {
            texts.read
        };
        fill(read, &[("NAME", name), ("P", &self.prefix)])
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
        let values: Vec<String> = names.map(|name| self.reading(name)).collect();
        let names = LoweringNames {
            language: self.language,
            array,
            coordinates: self.model.problem.coordinates.len(),
            time,
            parameters: &values,
            integrals: &|id| self.call_of_integral(emitted, id, array_argument, time),
        };
        lower(&emitted.model.graph, roots, &names)
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
                ("DECLARED", &self.declared(&constants)),
                (
                    "UNUSED",
                    &self.unused(&[(emitted.model, &[*body])], has_time),
                ),
                ("BODY", &statements),
                ("T", self.time(has_time).argument),
                ("TIME", self.time(has_time).declaration),
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

    /// The declarations of constants, in Fortran.
    pub(super) fn declared(&self, constants: &[[String; 2]]) -> String {
        let declare = self.texts().statements.declare;
        let names: Vec<&str> = constants
            .iter()
            .map(|constant| constant[0].as_str())
            .collect();
        names
            .chunks(12)
            .map(|names| fill(declare, &[("NAMES", &names.join(", "))]))
            .collect()
    }

    /// Time in a list of arguments, and its declaration; empty without time.
    pub(super) fn time(&self, has_time: bool) -> &'static Time {
        const NO_TIME: Time = Time {
            argument: "",
            declaration: "",
        };
        if has_time {
            &self.texts().time
        } else {
            &NO_TIME
        }
    }

    /// Statements for the arguments that the nodes below roots of some models do not use: a
    /// compiler that is strict asks for a use of each.
    pub(super) fn unused(&self, models: &[(&Model, &[NodeId])], has_time: bool) -> String {
        let time = self.model.problem.coordinates.len();
        let uses = |is_time: bool| {
            models.iter().any(|(model, roots)| {
                let below = nodes_below(&model.graph, roots);
                below.iter().any(|id| match model.graph.node(*id) {
                    Node::Variable(index) => (*index == time) == is_time,
                    // Its helper has both arguments.
                    Node::Integral { .. } => true,
                    _ => false,
                })
            })
        };
        let mut unused = vec![];
        if !uses(false) {
            unused.push("x");
        }
        if has_time && !uses(true) {
            unused.push("t");
        }
        let statement = |name: &&str| fill(self.texts().statements.unused, &[("X", *name)]);
        unused.iter().map(statement).collect()
    }
}
