//! What surrounds the statements: signatures, tables of points, averages and norms.

use std::ops::Range;

use super::functions::EmittedFunction;
use super::texts::{Norm as NormTexts, Norms, Shaped, Time};
use super::writer::Writer;
use super::{choice, fill};
use crate::arithmetic::NodeId;
use crate::arithmetic::quadrature::POINTS;
use crate::derive::Role;
use crate::model::Model;
use crate::problem::Norm;

/// Points of the rule for averages, in each coordinate.
const AVERAGE_POINTS: usize = 8;

fn call_time(has_time: bool) -> &'static str {
    if has_time { ", t" } else { "" }
}

/// What stands before the parameters.
pub(super) fn opening(writer: &Writer<'_>, functions: &[EmittedFunction]) -> String {
    let texts = &writer.texts().library;
    let headers = if writer.has_alternatives() {
        texts.for_variants
    } else if writer.parameters.is_empty() {
        ""
    } else {
        texts.for_parameters
    };
    let mut names: Vec<String> = functions.iter().map(|f| f.name.clone()).collect();
    for error in errors(writer, functions) {
        names.push(format!(
            "error_{}_{}",
            suffix(error.function),
            error.norm.name()
        ));
    }
    let exact = functions.iter().filter(|f| f.role == Role::Exact);
    names.extend(exact.map(|f| format!("average_{}", suffix(f))));
    if !writer.parameters.is_empty() {
        names.extend(["set_parameter", "get_parameter"].map(str::to_owned));
    }
    let entries = names.iter().map(|name| fill(texts.entry, &[("F", name)]));
    fill(
        texts.opening,
        &[
            ("NAME", &writer.model.problem.name),
            ("HEADERS", headers),
            ("ENTRIES", &entries.collect::<String>()),
        ],
    )
}

pub(super) fn closing(writer: &Writer<'_>) -> String {
    let name = &writer.model.problem.name;
    fill(writer.texts().library.closing, &[("NAME", name)])
}

/// Tables of points and weights, and what else the statements call.
pub(super) fn helpers(writer: &Writer<'_>) -> String {
    let mut text = String::new();
    if writer.has_integrals() {
        text += &table(writer, "rule", POINTS);
    }
    if writer.texts().norms.is_some() {
        text += &table(writer, "gauss", AVERAGE_POINTS);
    }
    text + writer.texts().library.helpers
}

fn table(writer: &Writer<'_>, name: &str, count: usize) -> String {
    let [points, weights] = writer.rule(count);
    fill(
        writer.texts().library.table,
        &[
            ("RULE", name),
            ("RULE1", &name.to_uppercase()),
            ("K", &count.to_string()),
            ("X", &points),
            ("W", &weights),
            ("P", &writer.prefix),
        ],
    )
}

/// The texts that depend on whether a function is a scalar.
fn shaped(writer: &Writer<'_>, function: &EmittedFunction) -> &'static Shaped {
    if function.shape.is_empty() {
        &writer.texts().scalar
    } else {
        &writer.texts().tensor
    }
}

/// A function around its statements.
pub(super) fn framed(writer: &Writer<'_>, place: usize, declared: &str, body: &str) -> String {
    let function = &writer.models[0].functions[place];
    let all = writer.models.iter();
    let all: Vec<(&Model, &[NodeId])> = all
        .map(|emitted| (emitted.model, emitted.functions[place].roots.as_slice()))
        .collect();
    let Time {
        argument,
        declaration,
    } = writer.time(function.has_time);
    fill(
        shaped(writer, function).function,
        &[
            ("F", &function.name),
            ("T", argument),
            ("TIME", declaration),
            ("D", &writer.model.problem.coordinates.len().to_string()),
            ("N", &function.roots.len().to_string()),
            ("SHAPE", &sides(&function.shape)),
            ("RESULT", &nested(&function.shape)),
            ("DECLARED", declared),
            ("UNUSED", &writer.unused(&all, function.has_time)),
            ("READY", &choice::ready(writer)),
            ("BODY", body),
            ("P", &writer.prefix),
        ],
    )
}

/// The shape of an array of Fortran.
fn sides(shape: &[usize]) -> String {
    let sides: Vec<String> = shape.iter().map(usize::to_string).collect();
    // Ranks above two are stored row by row.
    match sides.len() {
        0 => String::new(),
        1 | 2 => format!("({})", sides.join(", ")),
        _ => format!("({})", shape.iter().product::<usize>()),
    }
}

/// The components of a result of UFL.
fn nested(shape: &[usize]) -> String {
    match shape {
        [] => "r0".to_owned(),
        [rows, columns] => {
            let rows: Vec<String> = (0..*rows)
                .map(|row| row * columns..(row + 1) * columns)
                .map(|row| format!("[{}]", names_of_roots(row)))
                .collect();
            format!("ufl.as_tensor([{}])", rows.join(", "))
        }
        shape => {
            let names = names_of_roots(0..shape.iter().product());
            format!("ufl.as_vector([{names}])")
        }
    }
}

fn names_of_roots(places: Range<usize>) -> String {
    let names: Vec<String> = places.map(|place| format!("r{place}")).collect();
    names.join(", ")
}

/// The part of a function's name behind its role.
fn suffix(function: &EmittedFunction) -> &str {
    function.name.split_once('_').map_or("", |parts| parts.1)
}

/// A norm of the difference from a function.
struct ErrorNorm<'f> {
    norm: Norm,
    function: &'f EmittedFunction,
}

/// The norms that the file names.
fn errors<'f>(writer: &Writer<'_>, functions: &'f [EmittedFunction]) -> Vec<ErrorNorm<'f>> {
    let mut errors = vec![];
    for (field, norms) in &writer.model.problem.norms {
        for norm in norms {
            let role = if *norm == Norm::H1 {
                Role::Gradient
            } else {
                Role::Exact
            };
            let mut functions = functions.iter();
            let function = functions.find(|f| f.role == role && f.quantity == *field);
            errors.extend(function.map(|function| ErrorNorm {
                norm: *norm,
                function,
            }));
        }
    }
    errors
}

/// Averages of the exact fields, and the norms that the file names.
pub(super) fn norms(writer: &Writer<'_>, functions: &[EmittedFunction]) -> String {
    let mut text = String::new();
    let Some(texts) = &writer.texts().norms else {
        return text;
    };
    for function in functions.iter().filter(|f| f.role == Role::Exact) {
        text += &average(writer, texts, function);
    }
    for error in errors(writer, functions) {
        text += &self::error(writer, texts, &error);
    }
    text
}

/// The values of a function at a point, as an array.
fn array_call(writer: &Writer<'_>, function: &EmittedFunction, point: &str) -> String {
    fill(
        shaped(writer, function).values,
        &[
            ("F", &function.name),
            ("AT", point),
            ("TIME", call_time(function.has_time)),
            ("P", &writer.prefix),
        ],
    )
}

fn average(writer: &Writer<'_>, texts: &Norms, function: &EmittedFunction) -> String {
    let dimension = writer.model.problem.coordinates.len();
    let count = function.roots.len().to_string();
    let Time {
        argument,
        declaration,
    } = writer.time(function.has_time);
    let shaped = shaped(writer, function);
    fill(
        texts.average,
        &[
            ("TYPE", shaped.kind),
            ("RETURN", shaped.result),
            ("OUT", shaped.out),
            ("F", suffix(function)),
            ("P", &writer.prefix),
            ("T", argument),
            ("TIME", declaration),
            ("N", &count),
            ("D", &dimension.to_string()),
            ("CELLS", &AVERAGE_POINTS.pow(dimension as u32).to_string()),
            ("SHAPE", &sides(&function.shape)),
            ("CALL", &array_call(writer, function, texts.point)),
        ],
    )
}

fn error(writer: &Writer<'_>, texts: &Norms, error: &ErrorNorm<'_>) -> String {
    let ErrorNorm { norm, function } = error;
    let dimension = writer.model.problem.coordinates.len().to_string();
    let Time {
        argument,
        declaration,
    } = writer.time(function.has_time);
    let NormTexts { add, root } = match norm {
        Norm::L1 => &texts.l1,
        Norm::Linf => &texts.linf,
        Norm::L2 | Norm::H1 => &texts.l2,
    };
    let unused = if *norm == Norm::Linf {
        texts.without_weights
    } else {
        ""
    };
    let point = fill(texts.points, &[("D", &dimension)]);
    fill(
        texts.error,
        &[
            ("F", suffix(function)),
            ("NORM", norm.name()),
            ("P", &writer.prefix),
            ("T", argument),
            ("TIME", declaration),
            ("N", &function.roots.len().to_string()),
            ("D", &dimension),
            ("CALL", &array_call(writer, function, &point)),
            ("COLONS", &":, ".repeat(function.shape.len().min(2))),
            ("EXACT", &function.name),
            ("UNUSED", unused),
            ("ADD", add),
            ("ROOT", root),
        ],
    )
}

/// The header of C: what stands before the bodies of these definitions.
pub(super) fn header(writer: &Writer<'_>, definitions: &str, head: &str) -> Option<String> {
    let texts = writer.texts().header.as_ref()?;
    let values = [("P", writer.prefix.as_str())];
    let definitions = definitions.split("\n}\n");
    let prototypes = definitions.filter_map(|text| text.split_once("\n{"));
    let prototypes = prototypes.map(|(prototype, _)| format!("{};\n", prototype.trim_start()));
    let variant = if writer.has_alternatives() {
        fill(texts.variant, &values)
    } else {
        String::new()
    };
    let parameters = if writer.parameters.is_empty() {
        String::new()
    } else {
        fill(texts.parameters, &values)
    };
    let guard = format!("{}_H", writer.model.problem.name.to_uppercase());
    Some(fill(
        texts.template,
        &[
            ("HEAD", head),
            ("GUARD", &guard),
            ("PROTOTYPES", &prototypes.collect::<String>()),
            ("VARIANT", &variant),
            ("PARAMETERS", &parameters),
        ],
    ))
}
