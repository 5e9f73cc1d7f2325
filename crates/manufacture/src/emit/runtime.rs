//! What surrounds the statements: signatures, tables of points, averages and norms.

use std::fmt::Write;

use super::functions::Function;
use super::write::Writer;
use super::{Language, choice, fill};
use crate::arithmetic::quadrature::POINTS;
use crate::arithmetic::tape::nodes_below;
use crate::arithmetic::{Node, NodeId};
use crate::derive::Role;
use crate::model::Model;
use crate::problem::Norm;

pub(super) fn indent(language: Language) -> &'static str {
    if language == Language::Octave {
        "  "
    } else {
        "    "
    }
}

/// The templates of a language.
struct Templates {
    integral: &'static str,
    average: &'static str,
    error: &'static str,
}

macro_rules! templates {
    ($ending:literal) => {
        Templates {
            integral: include_str!(concat!("templates/integral.", $ending)),
            average: include_str!(concat!("templates/average.", $ending)),
            error: include_str!(concat!("templates/error.", $ending)),
        }
    };
}

fn templates(language: Language) -> Templates {
    match language {
        Language::C => templates!("c"),
        Language::Fortran => templates!("f90"),
        Language::Python | Language::Ufl => templates!("py"),
        Language::Octave => templates!("m"),
        Language::Rust => templates!("rs"),
    }
}

/// The helper for an integral, with the arguments of time filled in.
pub(super) fn integral(language: Language, has_time: bool) -> String {
    let [declared, extra] = time(language, has_time);
    let points = POINTS.to_string();
    let values = [
        ("T", declared),
        ("TIME", extra),
        ("POINTS", points.as_str()),
    ];
    fill(templates(language).integral, &values)
}

/// Time in a list of arguments, and in Fortran its declaration.
fn time(language: Language, has_time: bool) -> [&'static str; 2] {
    match (language, has_time) {
        (_, false) => ["", ""],
        (Language::C, _) => [", double t", ""],
        (Language::Rust, _) => [", t: f64", ""],
        (Language::Fortran, _) => [", t", ", t"],
        _ => [", t", ""],
    }
}

fn call_time(has_time: bool) -> &'static str {
    if has_time { ", t" } else { "" }
}

/// What stands before the parameters.
pub(super) fn opening(writer: &Writer<'_>, functions: &[Function]) -> String {
    let name = &writer.model.problem.name;
    match writer.language {
        Language::C => {
            let headers = if writer.has_alternatives() {
                "#include <stdio.h>\n#include <stdlib.h>\n#include <string.h>\n"
            } else if writer.parameters.is_empty() {
                ""
            } else {
                "#include <string.h>\n"
            };
            format!("\n#include <math.h>\n{headers}#include \"{name}.h\"\n\n")
        }
        Language::Fortran => format!(
            "module {name}\nimplicit none\npublic\ninteger, parameter, private :: dp = kind(1.0d0)\n"
        ),
        Language::Python => "\nimport numpy as np\n\n".to_owned(),
        Language::Ufl => "\nimport ufl\n\n".to_owned(),
        Language::Rust => {
            "#![allow(dead_code, unused_variables, unused_parens, non_snake_case)]\n\n".to_owned()
        }
        Language::Octave => {
            let mut names: Vec<String> = functions.iter().map(|f| f.name.clone()).collect();
            for [field, norm, _] in errors(writer, functions) {
                names.push(format!("error_{field}_{norm}"));
            }
            let exact = functions.iter().filter(|f| f.role == Role::Exact);
            names.extend(exact.map(|f| format!("average_{}", suffix(f))));
            if !writer.parameters.is_empty() {
                names.extend(["set_parameter", "get_parameter"].map(str::to_owned));
            }
            // An unknown variant is refused at once.
            let variant = if writer.has_alternatives() {
                "  variant();\n"
            } else {
                ""
            };
            let mut text = format!("\nfunction p = {name}()\n{variant}");
            for name in names {
                let _ = writeln!(text, "  p.{name} = @{name};");
            }
            text + "end\n\n"
        }
    }
}

pub(super) fn closing(writer: &Writer<'_>) -> String {
    match writer.language {
        Language::Fortran => format!("end module {}\n", writer.model.problem.name),
        _ => String::new(),
    }
}

/// Tables of points and weights, and what else the statements call.
pub(super) fn helpers(writer: &Writer<'_>) -> String {
    let mut text = String::new();
    if writer.has_integrals() {
        text += &table(writer, "rule", writer.integral_rule(), POINTS);
    }
    if writer.language != Language::Ufl {
        text += &table(writer, "gauss", writer.rule(8), 8);
    }
    match writer.language {
        Language::Fortran => text += "contains\n\n",
        Language::Octave => {
            text += "function out = pick(condition, a, b)\n  \
                     % a where the condition holds, b elsewhere; neither is multiplied, so that NaN stays where it is.\n  \
                     out = b + zeros(size(condition));\n  a = a + zeros(size(condition));\n  \
                     condition = condition & true(size(out));\n  \
                     if isscalar(a), a = a*ones(size(out)); end\n  \
                     if isscalar(out), out = out*ones(size(a)); end\n  \
                     out(condition) = a(condition);\nend\n\n";
        }
        _ => text.push('\n'),
    }
    text
}

fn table(writer: &Writer<'_>, name: &str, [points, weights]: [String; 2], count: usize) -> String {
    let prefix = &writer.prefix;
    let upper = name.to_uppercase();
    let both = [("x", &points), ("w", &weights)];
    let one = |(part, numbers): (&str, &String)| match writer.language {
        Language::C => {
            format!("static const double {prefix}{name}_{part}[{count}] = {{\n    {numbers}\n}};\n")
        }
        Language::Fortran => {
            format!(
                "real(dp), parameter, private :: {name}_{part}({count}) = [ &\n    {numbers}]\n"
            )
        }
        Language::Rust => {
            let upper_part = part.to_uppercase();
            format!("const {upper}_{upper_part}: [f64; {count}] = [\n    {numbers},\n];\n")
        }
        Language::Octave => String::new(),
        Language::Python | Language::Ufl => {
            format!("{upper}_{} = [\n    {numbers},\n]\n", part.to_uppercase())
        }
    };
    if writer.language == Language::Octave {
        let [points, weights] = [points, weights].map(|numbers| numbers.replace(",\n", ", ...\n"));
        return format!(
            "function [points, weights] = {name}()\n  points = [ ...\n    {points}];\n  weights = [ ...\n    {weights}];\nend\n\n"
        );
    }
    both.map(one).concat()
}

/// The signature in C, without what follows it.
fn prototype(writer: &Writer<'_>, function: &Function) -> String {
    let [time, _] = time(Language::C, function.has_time);
    let name = format!("{}{}", writer.prefix, function.name);
    if function.shape.is_empty() {
        format!("double {name}(const double x[]{time})")
    } else {
        format!("void {name}(const double x[]{time}, double out[])")
    }
}

/// A function around its statements.
pub(super) fn framed(writer: &Writer<'_>, place: usize, declared: &str, body: &str) -> String {
    let function = &writer.models[0].functions[place];
    let Function { name, shape, .. } = function;
    let all = writer.models.iter();
    let all: Vec<(&Model, &[NodeId])> = all
        .map(|emitted| (emitted.model, emitted.functions[place].roots.as_slice()))
        .collect();
    let [time_declared, time_extra] = time(writer.language, function.has_time);
    let dimension = writer.model.problem.coordinates.len();
    let count = function.roots.len();
    match writer.language {
        Language::C => {
            let unused = unused(writer, &all, function.has_time);
            format!("{}\n{{\n{unused}{body}}}\n\n", prototype(writer, function))
        }
        Language::Fortran => {
            let shape = fortran_shape(shape);
            let unused = unused(writer, &all, function.has_time);
            let ready = choice::ready(writer);
            format!(
                "pure function {name}(x{time_declared}) result(out)\n    real(dp), intent(in) :: x(:){time_extra}\n    \
                 real(dp) :: out{shape}\n{declared}{unused}{ready}{body}end function {name}\n\n"
            )
        }
        Language::Python => {
            let result = if shape.is_empty() { "out[0]" } else { "out" };
            format!(
                "def {name}(x{time_declared}):\n    x = np.asarray(x, dtype=float)\n    \
                 out = np.empty(({count},) + x.shape[1:])\n{body}    return {result}\n\n\n"
            )
        }
        Language::Ufl => {
            format!(
                "def {name}(x{time_declared}):\n{body}    return {}\n\n\n",
                ufl_result(shape)
            )
        }
        Language::Octave => format!(
            "function out = {name}(x{time_declared})\n  out = zeros({count}, size(x, 2));\n{body}end\n\n"
        ),
        Language::Rust => {
            let arguments = format!("x: &[f64; {dimension}]{time_declared}");
            if shape.is_empty() {
                format!("pub fn {name}({arguments}) -> f64 {{\n{body}}}\n\n")
            } else {
                format!(
                    "pub fn {name}({arguments}) -> [f64; {count}] {{\n    let mut out = [0.0; {count}];\n{body}    out\n}}\n\n"
                )
            }
        }
    }
}

/// Statements for the arguments that the nodes below roots of some models do not use: a compiler
/// that is strict asks for a use of each.
pub(super) fn unused(
    writer: &Writer<'_>,
    models: &[(&Model, &[NodeId])],
    has_time: bool,
) -> String {
    let time = writer.model.problem.coordinates.len();
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
    let statement = |name: &&str| match writer.language {
        Language::C => format!("    (void){name};\n"),
        Language::Fortran => format!("    associate (unused => {name})\n    end associate\n"),
        _ => String::new(),
    };
    unused.iter().map(statement).collect()
}

fn fortran_shape(shape: &[usize]) -> String {
    let sides: Vec<String> = shape.iter().map(usize::to_string).collect();
    // Ranks above two are stored row by row.
    match sides.len() {
        0 => String::new(),
        1 | 2 => format!("({})", sides.join(", ")),
        _ => format!("({})", shape.iter().product::<usize>()),
    }
}

fn ufl_result(shape: &[usize]) -> String {
    let names = |range: std::ops::Range<usize>| {
        let names: Vec<String> = range.map(|place| format!("r{place}")).collect();
        names.join(", ")
    };
    match shape {
        [] => "r0".to_owned(),
        [rows, columns] => {
            let row = |row: usize| format!("[{}]", names(row * columns..(row + 1) * columns));
            let rows: Vec<String> = (0..*rows).map(row).collect();
            format!("ufl.as_tensor([{}])", rows.join(", "))
        }
        shape => format!("ufl.as_vector([{}])", names(0..shape.iter().product())),
    }
}

/// The part of a function's name behind its role.
fn suffix(function: &Function) -> &str {
    function.name.split_once('_').map_or("", |parts| parts.1)
}

/// Field, norm, and the function that the values are compared with.
fn errors(writer: &Writer<'_>, functions: &[Function]) -> Vec<[String; 3]> {
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
            if let Some(function) = function {
                let name = norm.name().to_owned();
                errors.push([suffix(function).to_owned(), name, function.name.clone()]);
            }
        }
    }
    errors
}

/// Averages of the exact fields, and the norms that the file names.
pub(super) fn norms(writer: &Writer<'_>, functions: &[Function]) -> String {
    let mut text = String::new();
    if writer.language == Language::Ufl {
        return text;
    }
    for function in functions.iter().filter(|f| f.role == Role::Exact) {
        text += &average(writer, function);
    }
    for [field, norm, exact] in errors(writer, functions) {
        if let Some(function) = functions.iter().find(|f| f.name == exact) {
            text += &error(writer, function, &field, &norm);
        }
    }
    text
}

/// The values of a function at a point, as an array.
fn array_call(writer: &Writer<'_>, function: &Function, point: &str) -> String {
    let Function { name, .. } = function;
    let time = call_time(function.has_time);
    let prefix = &writer.prefix;
    match (writer.language, function.shape.is_empty()) {
        (Language::C, true) => format!("value[0] = {prefix}{name}({point}{time});"),
        (Language::C, false) => format!("{prefix}{name}({point}{time}, value);"),
        (_, true) => format!("[{name}({point}{time})]"),
        (_, false) => format!("{name}({point}{time})"),
    }
}

fn average(writer: &Writer<'_>, function: &Function) -> String {
    let dimension = writer.model.problem.coordinates.len();
    let count = function.roots.len();
    let is_scalar = function.shape.is_empty();
    let [time_declared, time_extra] = time(writer.language, function.has_time);
    let is_c = writer.language == Language::C;
    let kind = match (is_c, is_scalar) {
        (true, true) => "double".to_owned(),
        (true, false) => "void".to_owned(),
        (false, true) => "f64".to_owned(),
        (false, false) => format!("[f64; {count}]"),
    };
    let result = match (is_c, is_scalar) {
        (true, true) => "return sum[0];".to_owned(),
        (true, false) => format!("for (int j = 0; j < {count}; ++j) out[j] = sum[j];"),
        (false, true) => "sum[0]".to_owned(),
        (false, false) => "sum".to_owned(),
    };
    let point = if is_c { "x" } else { "&x" };
    fill(
        templates(writer.language).average,
        &[
            ("TYPE", &kind),
            ("F", suffix(function)),
            ("P", &writer.prefix),
            ("T", time_declared),
            ("TIME", time_extra),
            ("OUT", if is_scalar { "" } else { ", double out[]" }),
            ("N", &count.to_string()),
            ("D", &dimension.to_string()),
            ("CELLS", &8_usize.pow(dimension as u32).to_string()),
            ("SHAPE", &fortran_shape(&function.shape)),
            ("CALL", &array_call(writer, function, point)),
            ("RETURN", &result),
        ],
    )
}

/// What is summed, and what is done with the sum.
fn summed(language: Language, norm: &str) -> [&'static str; 2] {
    match (language, norm) {
        (Language::C | Language::Rust, "L1") => ["sum += weights[k]*difference;", "sum"],
        // NaN stays: no comparison holds with it; `max` of Fortran and Octave may lose it.
        (Language::C, "Linf") => [
            "if (!(difference <= sum)) sum = difference + 0.0*sum;",
            "sum",
        ],
        (Language::Rust, "Linf") => [
            "if !(difference <= sum) { sum = difference + 0.0 * sum; }",
            "sum",
        ],
        (Language::C, _) => ["sum += weights[k]*difference*difference;", "sqrt(sum)"],
        (Language::Rust, _) => [
            "sum += weights[k] * difference * difference;",
            "f64::sqrt(sum)",
        ],
        (Language::Python, "L1") => ["", "np.sum(weights*difference)"],
        (Language::Python, "Linf") => ["", "np.max(difference)"],
        (Language::Python, _) => ["", "np.sqrt(np.sum(weights*difference**2))"],
        (Language::Octave, "L1") => ["", "sum(sum(weights(:).'.*difference))"],
        (Language::Octave, "Linf") => ["", "max(difference(:)) + 0*sum(difference(:))"],
        (Language::Octave, _) => ["", "sqrt(sum(sum(weights(:).'.*difference.^2)))"],
        (Language::Fortran, "L1") => ["out = out + weights(k)*sum(difference)", "out"],
        (Language::Fortran, "Linf") => [
            "if (.not. all(difference <= out)) out = maxval(difference) + 0.0_dp*(out + sum(difference))",
            "out",
        ],
        (Language::Fortran, _) => ["out = out + weights(k)*sum(difference**2)", "sqrt(out)"],
        (Language::Ufl, _) => ["", ""],
    }
}

fn error(writer: &Writer<'_>, function: &Function, field: &str, norm: &str) -> String {
    let dimension = writer.model.problem.coordinates.len();
    let [time_declared, time_extra] = time(writer.language, function.has_time);
    let [add, root] = summed(writer.language, norm);
    let point = match writer.language {
        Language::C => format!("x + {dimension}*k"),
        _ => "&x[k]".to_owned(),
    };
    fill(
        templates(writer.language).error,
        &[
            ("F", field),
            ("NORM", norm),
            ("P", &writer.prefix),
            ("T", time_declared),
            ("TIME", time_extra),
            ("N", &function.roots.len().to_string()),
            ("D", &dimension.to_string()),
            ("CALL", &array_call(writer, function, &point)),
            ("COLONS", &":, ".repeat(function.shape.len().min(2))),
            ("EXACT", &function.name),
            (
                "UNUSED",
                if norm == "Linf" {
                    "    (void)weights;\n"
                } else {
                    ""
                },
            ),
            ("ADD", add),
            ("ROOT", root),
        ],
    )
}

/// The header of C.
pub(super) fn header(writer: &Writer<'_>, functions: &[Function], head: &str) -> String {
    let name = &writer.model.problem.name;
    let guard = format!("{}_H", name.to_uppercase());
    let mut text = format!(
        "{head}\n#ifndef {guard}\n#define {guard}\n\n#include <stddef.h>\n\n#ifdef __cplusplus\nextern \"C\" {{\n#endif\n\n"
    );
    for function in functions {
        let _ = writeln!(text, "{};", prototype(writer, function));
    }
    // What stands before the bodies.
    let norms = norms(writer, functions);
    for definition in norms
        .split("\n}\n")
        .filter_map(|text| text.split_once("\n{"))
    {
        let _ = writeln!(text, "{};", definition.0.trim_start());
    }
    if writer.has_alternatives() {
        text += "/* The number of the variant that MANUFACTURE_VARIANT names; 0 without it. */\n";
        let _ = writeln!(text, "int {}variant(void);", writer.prefix);
    }
    if !writer.parameters.is_empty() {
        text += "/* 0, or 1 if no parameter has the name; those that depend on it follow. */\n";
        let _ = writeln!(
            text,
            "int {}set_parameter(const char *name, double value);",
            writer.prefix
        );
        text += "/* NaN if no parameter has the name. */\n";
        let _ = writeln!(
            text,
            "double {}get_parameter(const char *name);",
            writer.prefix
        );
    }
    text + "\n#ifdef __cplusplus\n}\n#endif\n\n#endif\n"
}
