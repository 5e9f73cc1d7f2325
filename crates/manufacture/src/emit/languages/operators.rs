//! How each language writes numbers and operations.

use crate::language::tree::Relation;

/// The operators of a language.
pub(crate) struct Operators {
    /// A coordinate of an array, counted from 0.
    pub(crate) coordinate: fn(&str, usize) -> String,
    /// Behind the digits of a number.
    pub(crate) suffix: &'static str,
    pub(crate) times: &'static str,
    pub(crate) over: &'static str,
    /// The name of a function, which is here called as in files.
    pub(crate) function: fn(&str) -> String,
    pub(crate) power: fn(&str, &str) -> String,
    /// The third text where the comparison of the first two holds, otherwise the fourth.
    pub(crate) choose: fn(Relation, [&str; 4]) -> String,
    /// How functions read a parameter.
    pub(crate) parameter: fn(&str) -> String,
}

fn with_c_names(prefix: &str, name: &str) -> String {
    format!("{prefix}{}", if name == "ln" { "log" } else { name })
}

pub(super) const C: Operators = Operators {
    coordinate: |array, index| format!("{array}[{index}]"),
    suffix: "",
    times: "*",
    over: "/",
    function: |name| with_c_names("", name),
    power: |base, exponent| format!("pow({base}, {exponent})"),
    choose: |relation, [left, right, then, otherwise]| {
        let symbol = relation.symbol();
        format!("({left} {symbol} {right} ? {then} : {otherwise})")
    },
    parameter: str::to_owned,
};

pub(super) const FORTRAN: Operators = Operators {
    coordinate: |array, index| format!("{array}({})", index + 1),
    suffix: "_dp",
    power: |base, exponent| format!("({base})**({exponent})"),
    choose: |relation, [left, right, then, otherwise]| {
        let symbol = relation.symbol();
        format!("merge({then}, {otherwise}, {left} {symbol} {right})")
    },
    ..C
};

pub(super) const PYTHON: Operators = Operators {
    function: |name| match name.strip_prefix('a') {
        Some(inverse) => format!("np.arc{inverse}"),
        None => with_c_names("np.", name),
    },
    power: FORTRAN.power,
    choose: |relation, [left, right, then, otherwise]| {
        let symbol = relation.symbol();
        format!("np.where({left} {symbol} {right}, {then}, {otherwise})")
    },
    ..C
};

pub(super) const UFL: Operators = Operators {
    // The module defines the one that UFL does not have.
    function: |name| match name {
        "log10" => "_log10".to_owned(),
        _ => format!("ufl.{name}"),
    },
    choose: |relation, [left, right, then, otherwise]| {
        let word = match relation {
            Relation::Less => "lt",
            Relation::LessOrEqual => "le",
            Relation::Greater => "gt",
            Relation::GreaterOrEqual => "ge",
        };
        format!("ufl.conditional(ufl.{word}({left}, {right}), {then}, {otherwise})")
    },
    ..PYTHON
};

pub(super) const OCTAVE: Operators = Operators {
    coordinate: |array, index| format!("{array}({}, :)", index + 1),
    times: ".*",
    over: "./",
    power: |base, exponent| format!("({base}).^({exponent})"),
    choose: |relation, [left, right, then, otherwise]| {
        let symbol = relation.symbol();
        format!("pick({left} {symbol} {right}, {then}, {otherwise})")
    },
    parameter: |name| format!("parameters().{name}"),
    ..C
};

pub(super) const RUST: Operators = Operators {
    suffix: "_f64",
    function: |name| format!("f64::{name}"),
    power: |base, exponent| format!("f64::powf({base}, {exponent})"),
    choose: |relation, [left, right, then, otherwise]| {
        let symbol = relation.symbol();
        format!("(if {left} {symbol} {right} {{ {then} }} else {{ {otherwise} }})")
    },
    parameter: |name| format!("current(&{name})"),
    ..C
};
