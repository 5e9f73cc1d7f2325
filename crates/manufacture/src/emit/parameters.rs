//! Parameters that are set at run time: their values in the file are defaults, and those that
//! depend on one that is set follow.

use std::fmt::Write;

use super::lower::Lowered;
use super::texts::Parameters;
use super::writer::{Emitted, Writer};
use super::{choice, fill};
use crate::model::Model;
use crate::problem::mentions;

/// The parameters that depend on one, each after those that it depends on.
fn followers(model: &Model, index: usize) -> Vec<usize> {
    let parameters = &model.problem.parameters;
    let depends =
        |on: usize, of: usize| mentions(&parameters[of].expression.tree, &parameters[on].name);
    let count = parameters.len();
    // In each round those whose operands are known: a file has no circles.
    let mut order: Vec<usize> = vec![];
    while order.len() < count {
        let is_ready = |of: &usize| {
            !order.contains(of) && (0..count).all(|on| !depends(on, *of) || order.contains(&on))
        };
        let Some(next) = (0..count).find(is_ready) else {
            break;
        };
        order.push(next);
    }
    let mut changed = vec![index];
    for of in order {
        if of != index && changed.iter().any(|on| depends(*on, of)) {
            changed.push(of);
        }
    }
    changed.split_off(1)
}

/// The definitions of all parameters.
pub(super) fn definitions(writer: &Writer<'_>) -> String {
    let texts = &writer.texts().parameters;
    let values = writer.model.graph.parameters.iter();
    let mut lines = String::new();
    for (name, value) in writer.parameters.iter().zip(values) {
        lines += &fill(
            texts.definition,
            &[
                ("NAME", name),
                ("VALUE", &writer.language.number(*value)),
                ("BITS", &format!("{:#x}", value.to_bits())),
                ("DIGITS", &format!("{value:?}")),
            ],
        );
    }
    if lines.is_empty() {
        return lines;
    }
    let ready = if writer.changes_parameters() {
        choice::ready(writer)
    } else {
        String::new()
    };
    fill(
        texts.definitions,
        &[
            ("LINES", &lines),
            ("CHANGES", &choice::changes(writer)),
            ("READY", &ready),
        ],
    )
}

/// The statements that set a parameter, and those that follow it.
struct SetterBranch<'w> {
    name: &'w str,
    statements: Vec<String>,
    constants: Vec<[String; 2]>,
}

fn branch<'w>(writer: &'w Writer<'_>, emitted: &Emitted<'_>, index: usize) -> SetterBranch<'w> {
    let language = writer.language;
    let texts = &writer.texts().parameters;
    let mut statements = vec![assignment(texts, &writer.parameters[index], "value")];
    let mut all = vec![];
    for follower in followers(emitted.model, index) {
        let node = emitted.model.parameters[follower];
        let Lowered { constants, roots } = writer.statements(emitted, &[node], "x", "t");
        // One after the other: constants are numbered anew for each, in C in a block of their own.
        let block = language.texts().statements.block;
        let block = block.filter(|_| !constants.is_empty());
        statements.extend(block.map(|[opening, _]| opening.to_owned()));
        for [name, value] in constants {
            statements.push(language.assign(&name, &value));
            if !all.contains(&[name.clone(), String::new()]) {
                all.push([name, String::new()]);
            }
        }
        let name = &writer.parameters[follower];
        statements.push(assignment(texts, name, &roots[0]));
        statements.extend(block.map(|[_, closing]| closing.to_owned()));
    }
    SetterBranch {
        name: &writer.model.problem.parameters[index].name,
        statements,
        constants: all,
    }
}

fn assignment(texts: &Parameters, name: &str, value: &str) -> String {
    fill(texts.assign, &[("NAME", name), ("VALUE", value)])
}

/// The functions that set and return a parameter; empty without parameters.
pub(super) fn functions(writer: &Writer<'_>) -> String {
    if writer.parameters.is_empty() {
        return String::new();
    }
    let texts = &writer.texts().parameters;
    let mut bodies = vec![];
    let mut longest = vec![];
    for emitted in &writer.models {
        let mut cases = String::new();
        for index in 0..writer.parameters.len() {
            let SetterBranch {
                name,
                statements,
                constants,
            } = branch(writer, emitted, index);
            cases += &fill(texts.case, &[("EL", choice::el(index)), ("NAME", name)]);
            for statement in statements {
                let _ = writeln!(cases, "{}{statement}", texts.indent);
            }
            cases += texts.close;
            if constants.len() > longest.len() {
                longest = constants;
            }
        }
        bodies.push(fill(texts.body, &[("CASES", &cases)]));
    }
    let globals: String = writer
        .parameters
        .iter()
        .map(|name| fill(texts.global, &[("NAME", name)]))
        .collect();
    let setter = fill(
        texts.setter,
        &[
            ("GLOBALS", &globals),
            ("DECLARED", &writer.declared(&longest)),
            ("READY", &choice::ready(writer)),
            ("BODY", &choice::body(writer, &bodies)),
            ("P", &writer.prefix),
        ],
    );
    setter + &getter(writer)
}

fn getter(writer: &Writer<'_>) -> String {
    let texts = &writer.texts().parameters;
    let parameters = &writer.model.problem.parameters;
    let cases = writer.parameters.iter().zip(parameters);
    let cases: String = cases
        .map(|(name, parameter)| {
            let value = writer.reading(name);
            fill(
                texts.getter_case,
                &[("NAME", &parameter.name), ("VALUE", &value)],
            )
        })
        .collect();
    fill(texts.getter, &[("CASES", &cases), ("P", &writer.prefix)])
}
