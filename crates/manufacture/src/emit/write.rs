//! The library of a language: parameters, integrals, functions.

use std::fmt::Write;

use super::functions::Function;
use super::lower::{Lowered, Names, lower};
use super::{EmittedFile, Language, fill, runtime};
use crate::arithmetic::quadrature::{self, POINTS};
use crate::arithmetic::tape::nodes_below;
use crate::arithmetic::{Node, NodeId};
use crate::model::Model;

/// Columns of a line.
const WIDTH: usize = 100;

/// What the functions of a file have in common.
pub(super) struct Writer<'m> {
    pub(super) model: &'m Model,
    pub(super) language: Language,
    /// The prefix of C.
    pub(super) prefix: String,
    parameters: Vec<String>,
    /// All integrals, the inner before the outer.
    integrals: Vec<NodeId>,
}

/// The library, and in C its header.
pub(super) fn library(
    model: &Model,
    language: Language,
    functions: &[Function],
) -> Vec<EmittedFile> {
    let name = &model.problem.name;
    let prefix = prefix(model, language);
    let mut parameters: Vec<String> = vec![];
    for parameter in &model.problem.parameters {
        let names: Vec<&str> = parameters.iter().map(String::as_str).collect();
        let name = format!("{prefix}parameter_{}", parameter.name);
        parameters.push(language.distinct(name, &names));
    }
    let writer = Writer {
        model,
        language,
        parameters,
        integrals: integrals(model, functions),
        prefix,
    };
    let head = writer.head(functions);
    let mut body = String::new();
    for integral in &writer.integrals {
        body += &writer.integral(*integral);
    }
    for function in functions {
        body += &writer.function(function);
    }
    body += &runtime::norms(&writer, functions);
    let opening = runtime::opening(&writer, functions);
    let closing = runtime::closing(&writer);
    let ending = match language {
        Language::C => ".c",
        Language::Fortran => ".f90",
        Language::Python => ".py",
        Language::Ufl => "_ufl.py",
        Language::Octave => ".m",
        Language::Rust => ".rs",
    };
    let text = format!(
        "{head}{opening}{}{}{body}{closing}",
        writer.constants(functions),
        runtime::helpers(&writer)
    );
    let mut files = vec![EmittedFile {
        name: format!("{name}{ending}"),
        text,
    }];
    if language == Language::C {
        files.push(EmittedFile {
            name: format!("{name}.h"),
            text: runtime::header(&writer, functions, &head),
        });
    }
    files
}

/// What stands before the name of a function.
pub(super) fn prefix(model: &Model, language: Language) -> String {
    if language == Language::C {
        format!("{}_", model.problem.name)
    } else {
        String::new()
    }
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

impl Writer<'_> {
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
        let build = match self.language {
            Language::C => "cc -O2 -o answer NAME.c NAME_answer.c -lm",
            Language::Fortran => "gfortran -O2 -o answer NAME.f90 NAME_answer.f90",
            Language::Python => "python3 NAME_answer.py",
            Language::Octave => "octave --quiet NAME_answer.m",
            Language::Rust => "rustc --edition 2021 -O -o answer NAME_answer.rs",
            Language::Ufl => "import NAME_ufl",
        };
        let comment = self.language.comment();
        let mut head = String::new();
        let version = env!("CARGO_PKG_VERSION");
        let lines = format!(
            "Manufactured solution `{}`, by manufacture {version}, input {hash:016x}.\n{canonical}\
             Conventions: grad(v)_ij = dv_i/dx_j, div(A)_i = sum_j dA_ij/dx_j; tensors row by row; n points outwards.\n\
             {}Build: {}",
            problem.name,
            self.renamed(functions),
            build.replace("NAME", &problem.name)
        );
        for line in lines.lines() {
            for part in wrapped(line, WIDTH - comment.len() - 1) {
                let _ = writeln!(head, "{comment} {part}");
            }
        }
        head
    }

    /// Whether a function or an integral uses a parameter.
    fn has_parameter(&self, place: usize, functions: &[Function]) -> bool {
        let mut roots: Vec<NodeId> = functions.iter().flat_map(|f| f.roots.clone()).collect();
        for integral in &self.integrals {
            if let Node::Integral { body, .. } = self.model.graph.node(*integral) {
                roots.push(*body);
            }
        }
        self.uses(&roots, |node| *node == Node::Parameter(place))
    }

    /// Whether some node below the roots is such a node.
    fn uses(&self, roots: &[NodeId], is_such: impl Fn(&Node) -> bool) -> bool {
        let graph = &self.model.graph;
        let mut nodes = nodes_below(graph, roots).into_iter();
        nodes.any(|id| is_such(graph.node(id)))
    }

    /// Whether a value below the roots depends on time; an integral is called with it.
    fn has_time(&self, roots: &[NodeId]) -> bool {
        let dimension = self.model.problem.coordinates.len();
        self.uses(roots, |node| match node {
            Node::Variable(variable) => *variable >= dimension,
            node => matches!(node, Node::Integral { .. }),
        })
    }

    /// The same for coordinates.
    fn has_point(&self, roots: &[NodeId]) -> bool {
        let dimension = self.model.problem.coordinates.len();
        self.uses(roots, |node| match node {
            Node::Variable(variable) => *variable < dimension,
            node => matches!(node, Node::Integral { .. }),
        })
    }

    /// Statements of C that use the arguments of a function where nothing else does: compilers warn
    /// about those that are not used.
    fn unused(&self, function: &Function) -> String {
        let mut text = String::new();
        if !self.has_point(&function.roots) {
            text += "    (void)x;\n";
        }
        if function.has_time && !self.has_time(&function.roots) {
            text += "    (void)t;\n";
        }
        text
    }

    fn constants(&self, functions: &[Function]) -> String {
        let mut text = String::new();
        let values = self.model.graph.parameters.iter();
        for (place, (name, value)) in self.parameters.iter().zip(values).enumerate() {
            let value = self.language.number(*value);
            let _ = match self.language {
                // Compilers warn about a constant that nothing uses.
                Language::C if !self.has_parameter(place, functions) => Ok(()),
                Language::C => writeln!(text, "static const double {name} = {value};"),
                Language::Fortran => {
                    writeln!(text, "real(dp), parameter, private :: {name} = {value}")
                }
                Language::Rust => {
                    writeln!(
                        text,
                        "#[allow(dead_code, non_upper_case_globals)]\nconst {name}: f64 = {value};"
                    )
                }
                // A function of Octave sees no variable of its file.
                Language::Octave => Ok(()),
                Language::Python | Language::Ufl => writeln!(text, "{name} = {value}"),
            };
        }
        text
    }

    fn call_of_integral(&self, id: NodeId, array: &str, time: &str) -> String {
        let number = self
            .integrals
            .iter()
            .position(|entry| *entry == id)
            .unwrap_or(0)
            + 1;
        let time = if self.model.problem.time.is_some() {
            format!(", {time}")
        } else {
            String::new()
        };
        format!("{}integral_{number}({array}{time})", self.prefix)
    }

    /// Constants and values of roots with these names of the coordinates and of time.
    fn statements(&self, roots: &[NodeId], array: &str, time: &str) -> Lowered {
        let array_argument = if self.language == Language::Rust && array == "y" {
            "&y"
        } else {
            array
        };
        let values = self.model.graph.parameters.iter();
        let values: Vec<String> = values.map(|value| self.language.number(*value)).collect();
        let is_octave = self.language == Language::Octave;
        let names = Names {
            language: self.language,
            array,
            coordinates: self.model.problem.coordinates.len(),
            time,
            parameters: if is_octave { &values } else { &self.parameters },
            integrals: &|id| self.call_of_integral(id, array_argument, time),
        };
        lower(&self.model.graph, roots, &names)
    }

    fn function(&self, function: &Function) -> String {
        let first = self.model.problem.first_time();
        let first = first.map(|time| self.language.number(time));
        let time = if function.has_time {
            "t"
        } else {
            first.as_deref().unwrap_or("t")
        };
        let Lowered { constants, roots } = self.statements(&function.roots, "x", time);
        let mut body = if self.language == Language::C {
            self.unused(function)
        } else {
            String::new()
        };
        let indent = runtime::indent(self.language);
        for [name, value] in &constants {
            let _ = writeln!(body, "{indent}{}", self.language.assign(name, value));
        }
        for (place, root) in roots.iter().enumerate() {
            let line = self.language.result(&function.shape, place, root);
            let _ = writeln!(body, "{indent}{line}");
        }
        runtime::framed(self, function, &declared(self.language, &constants), &body)
    }

    /// A helper for an integral over a coordinate, with fixed points.
    fn integral(&self, id: NodeId) -> String {
        let Node::Integral {
            body,
            variable,
            panels,
        } = self.model.graph.node(id)
        else {
            return String::new();
        };
        let Lowered { constants, roots } = self.statements(&[*body], "y", "t");
        let indent = runtime::indent(self.language).repeat(2);
        let deeper = if self.language == Language::Fortran {
            "    "
        } else {
            ""
        };
        let has_time = self.model.problem.time.is_some();
        // The point is copied.
        let mut statements = if self.language == Language::C && has_time && !self.has_time(&[*body])
        {
            format!("{indent}(void)t;\n")
        } else {
            String::new()
        };
        for [name, value] in &constants {
            let _ = writeln!(
                statements,
                "{indent}{deeper}{}",
                self.language.assign(name, value)
            );
        }
        let [low, high] = self.model.graph.intervals[*variable];
        let width = (high - low) / *panels as f64;
        let call = self.call_of_integral(id, "", "");
        let name = call.split('(').next().unwrap_or("");
        fill(
            &runtime::integral(self.language, has_time),
            &[
                ("NAME", name),
                ("DECLARED", &declared(self.language, &constants)),
                ("BODY", &statements),
                ("VALUE", &roots[0]),
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
            let separator = if self.language == Language::Fortran {
                ", &\n    "
            } else {
                ",\n    "
            };
            numbers.join(separator)
        })
    }

    pub(super) fn has_integrals(&self) -> bool {
        !self.integrals.is_empty()
    }

    pub(super) fn integral_rule(&self) -> [String; 2] {
        self.rule(POINTS)
    }
}

/// The declarations that Fortran needs.
fn declared(language: Language, constants: &[[String; 2]]) -> String {
    if language != Language::Fortran {
        return String::new();
    }
    let names: Vec<&str> = constants
        .iter()
        .map(|constant| constant[0].as_str())
        .collect();
    names
        .chunks(12)
        .map(|names| format!("    real(dp) :: {}\n", names.join(", ")))
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
