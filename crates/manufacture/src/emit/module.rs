//! A module of a language as its templates see it: names, and expressions as texts.

mod writer;

use serde::Serialize;

use super::functions::{AnsweredTogether, EmittedFunction, answered_together, functions};
use super::lower::Body;
use super::parameters::{ModuleParameter, parameters, set_by};
use super::{Alternative, Language, MADE_BY, cut};
use crate::arithmetic::quadrature::{self, POINTS};
use crate::derive::Role;
use crate::model::Model;
use crate::problem::{Norm, System};

pub(super) use writer::{Writer, declared};

/// Characters of a line of names in an answering program.
const LONGEST_NAMES: usize = 64;

/// Points of the rule for averages, in each coordinate.
const AVERAGE_POINTS: usize = 8;

#[derive(Serialize)]
pub(super) struct Module<'m> {
    pub(super) name: &'m str,
    prefix: String,
    /// The first comment, without what depends on the language.
    head: Vec<String>,
    coordinates: usize,
    /// Whether the first coordinate is a radius, which cells have as a weight.
    is_radial: bool,
    has_time: bool,
    parameters: Vec<ModuleParameter>,
    /// The names of all constants of the parameters that follow others.
    set_by_parameters: Vec<String>,
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
    /// The constants that cases have in common.
    shared: Vec<[String; 2]>,
    cases: Vec<Branch>,
    /// What the body is integrated over.
    interval: Option<Panels>,
}

/// The statements of some variants, by their numbers; those of all other variants, and of the file,
/// come last and have no number.
#[derive(Debug, Clone, PartialEq, Serialize)]
struct Branch {
    variants: Vec<usize>,
    body: Body,
}

#[derive(Debug, Clone, PartialEq, Serialize)]
struct Panels {
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
        let head = head(&writer, &emitted, alternatives);
        let Writer {
            helpers,
            has_choices,
            prefix,
            ..
        } = writer;
        if helpers.iter().any(|helper| helper.interval.is_some()) {
            rules.push(rule("rule", POINTS, language));
        }
        rules.push(rule("gauss", AVERAGE_POINTS, language));
        Module {
            name: &problem.name,
            head,
            coordinates: problem.coordinates.len(),
            is_radial: problem.system != System::Cartesian,
            has_time: problem.time.is_some(),
            set_by_parameters: set_by(&parameters),
            parameters,
            has_choices,
            changes: variants.iter().any(|variant| !variant.changes.is_empty()),
            groups: answered_together(model, &emitted)
                .into_iter()
                .map(group)
                .collect(),
            prefix,
            variants,
            rules,
            helpers,
            functions,
            norms,
        }
    }
}

fn rule(name: &'static str, points: usize, language: Language) -> Rule {
    let rule = quadrature::gauss(points);
    let [points, weights] = [0, 1].map(|part| {
        let numbers = rule.iter().map(|pair| language.number(pair[part]));
        numbers.collect()
    });
    Rule {
        name,
        points,
        weights,
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

fn group(
    AnsweredTogether {
        argument,
        functions,
        ..
    }: AnsweredTogether<'_>,
) -> AnswerGroup {
    let components = functions.iter().flat_map(|f| &f.components);
    let components: Vec<&str> = components.map(String::as_str).collect();
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
        face: argument.to_owned(),
        names: cut(&components.join(" "), LONGEST_NAMES),
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
        "Manufactured solution `{}`{MADE_BY}{version}, input {hash:016x}.",
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
