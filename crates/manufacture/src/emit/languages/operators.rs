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
    pub(crate) compare: fn(&str, Relation, &str) -> String,
    /// The second text where the first is true, otherwise the third.
    pub(crate) choose: fn([&str; 3]) -> String,
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
    compare: |left, relation, right| format!("{left} {} {right}", relation.symbol()),
    choose: |[condition, then, otherwise]| format!("({condition} ? {then} : {otherwise})"),
    parameter: str::to_owned,
};

pub(super) const FORTRAN: Operators = Operators {
    coordinate: |array, index| format!("{array}({})", index + 1),
    suffix: "_dp",
    power: |base, exponent| format!("({base})**({exponent})"),
    choose: |[condition, then, otherwise]| format!("merge({then}, {otherwise}, {condition})"),
    ..C
};

pub(super) const PYTHON: Operators = Operators {
    function: |name| match name.strip_prefix('a') {
        Some(inverse) => format!("np.arc{inverse}"),
        None => with_c_names("np.", name),
    },
    power: FORTRAN.power,
    choose: |[condition, then, otherwise]| format!("np.where({condition}, {then}, {otherwise})"),
    ..C
};

pub(super) const UFL: Operators = Operators {
    // The module defines the one that UFL does not have.
    function: |name| match name {
        "log10" => "_log10".to_owned(),
        _ => format!("ufl.{name}"),
    },
    compare: |left, relation, right| {
        let word = match relation {
            Relation::Less => "lt",
            Relation::LessOrEqual => "le",
            Relation::Greater => "gt",
            Relation::GreaterOrEqual => "ge",
        };
        format!("ufl.{word}({left}, {right})")
    },
    choose: |[condition, then, otherwise]| {
        format!("ufl.conditional({condition}, {then}, {otherwise})")
    },
    ..PYTHON
};

pub(super) const OCTAVE: Operators = Operators {
    coordinate: |array, index| format!("{array}({}, :)", index + 1),
    times: ".*",
    over: "./",
    power: |base, exponent| format!("({base}).^({exponent})"),
    choose: |[condition, then, otherwise]| format!("pick({condition}, {then}, {otherwise})"),
    parameter: |name| format!("parameters().{name}"),
    ..C
};

pub(super) const RUST: Operators = Operators {
    suffix: "_f64",
    function: |name| format!("f64::{name}"),
    power: |base, exponent| format!("f64::powf({base}, {exponent})"),
    choose: |[condition, then, otherwise]| {
        format!("(if {condition} {{ {then} }} else {{ {otherwise} }})")
    },
    parameter: |name| format!("current(&{name})"),
    ..C
};
