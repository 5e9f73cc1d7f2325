//! The library of a language: parameters, integrals, functions.

use std::fmt::Write;

use super::functions::EmittedFunction;
use super::lower::Lowered;
use super::writer::{Alternative, Writer};
use super::{EmittedFile, Language, choice, fill, parameters, runtime};
use crate::model::Model;

/// Columns of a line.
const WIDTH: usize = 100;

/// The library, and in C its header.
pub(super) fn library(
    model: &Model,
    alternatives: &[Alternative<'_>],
    language: Language,
    functions: &[EmittedFunction],
) -> Vec<EmittedFile> {
    let name = &model.problem.name;
    let writer = Writer::new(model, alternatives, language);
    let head = head(&writer, functions);
    let mut body = choice::functions(&writer);
    body += &writer.integral_helpers();
    let places = 0..functions.len();
    let mut public: String = places.map(|place| function(&writer, place)).collect();
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

/// The names of the file that are written with `_` behind them, as a line of the first comment.
fn renamed(writer: &Writer<'_>, functions: &[EmittedFunction]) -> String {
    let quantities = functions.iter().map(|f| (&f.name, &f.quantity));
    let parameters = writer.model.problem.parameters.iter();
    let parameters = writer.parameters.iter().zip(parameters.map(|p| &p.name));
    let renamed = quantities.chain(parameters);
    let renamed = renamed.filter(|(name, plain)| !name.ends_with(plain.as_str()));
    let renamed: Vec<&str> = renamed.map(|(name, _)| name.as_str()).collect();
    if renamed.is_empty() {
        return String::new();
    }
    format!("Written with _ behind the name: {}\n", renamed.join(", "))
}

/// The first comment: equations, conventions, version and a hash of the input.
fn head(writer: &Writer<'_>, functions: &[EmittedFunction]) -> String {
    let problem = &writer.model.problem;
    let canonical = problem.canonical();
    let hash = canonical
        .bytes()
        .fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| {
            (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
        });
    let texts = writer.texts();
    let build = fill(texts.build, &[("NAME", &problem.name)]);
    let comment = texts.comment;
    let mut head = String::new();
    let version = env!("CARGO_PKG_VERSION");
    let lines = format!(
        "Manufactured solution `{}`, by manufacture {version}, input {hash:016x}.\n{canonical}{}\
         Conventions: grad(v)_ij = dv_i/dx_j, div(A)_i = sum_j dA_ij/dx_j; tensors row by row; n points outwards.\n\
         {}Build: {}",
        problem.name,
        choice::head(writer),
        renamed(writer, functions),
        build
    );
    for line in lines.lines() {
        for part in wrapped(line, WIDTH - comment.len() - 1) {
            let _ = writeln!(head, "{comment} {part}");
        }
    }
    head
}

/// A function, by its place among those of the file.
fn function(writer: &Writer<'_>, place: usize) -> String {
    let function = &writer.models[0].functions[place];
    let first = writer.model.problem.first_time();
    let first = first.map(|time| writer.language.number(time));
    let time = if function.has_time {
        "t"
    } else {
        first.as_deref().unwrap_or("t")
    };
    let indent = writer.texts().statements.indent;
    let mut bodies = vec![];
    let mut longest = vec![];
    for emitted in &writer.models {
        let roots = &emitted.functions[place].roots;
        let Lowered { constants, roots } = writer.statements(emitted, roots, "x", time);
        let mut body = String::new();
        for [name, value] in &constants {
            let _ = writeln!(body, "{indent}{}", writer.language.assign(name, value));
        }
        for (place, root) in roots.iter().enumerate() {
            let line = writer.language.result(&function.shape, place, root);
            let _ = writeln!(body, "{indent}{line}");
        }
        bodies.push(body);
        if constants.len() > longest.len() {
            longest = constants;
        }
    }
    let body = choice::body(writer, &bodies);
    runtime::framed(writer, place, &writer.declared(&longest), &body)
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
