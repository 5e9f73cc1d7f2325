//! How each language writes numbers, operations and statements: the tables of the printers.

use super::Language;
use crate::language::names::Function;
use crate::language::tree::Comparison;

impl Language {
    pub(super) fn comment(self) -> &'static str {
        match self {
            Language::C | Language::Rust => "//",
            Language::Fortran => "!",
            Language::Python | Language::Ufl => "#",
            Language::Octave => "%",
        }
    }

    /// A name with `_` behind it where the language cannot tell it from one of the others: Fortran
    /// does not tell capitals from small letters.
    pub(super) fn distinct(self, mut name: String, others: &[&str]) -> String {
        let is_same = |a: &str, b: &str| match self {
            Language::Fortran => a.eq_ignore_ascii_case(b),
            _ => a == b,
        };
        while others.iter().any(|other| is_same(other, &name)) {
            name.push('_');
        }
        name
    }

    /// A coordinate of the array of that name.
    pub(super) fn coordinate(self, array: &str, index: usize) -> String {
        match self {
            Language::Fortran => format!("{array}({})", index + 1),
            Language::Octave => format!("{array}({}, :)", index + 1),
            _ => format!("{array}[{index}]"),
        }
    }

    /// A number with the digits that read back exactly.
    pub(super) fn number(self, value: f64) -> String {
        let digits = if value == 0.0 || (1e-5..1e16).contains(&value.abs()) {
            format!("{value:?}")
        } else {
            format!("{value:e}")
        };
        // NaN and infinity are findings of the check; here they are divisions.
        if !value.is_finite() {
            return if value.is_nan() {
                "(0.0/0.0)"
            } else {
                "(1.0/0.0)"
            }
            .to_owned();
        }
        match self {
            Language::Fortran => format!("{digits}_dp"),
            Language::Rust => format!("{digits}_f64"),
            _ => digits,
        }
    }

    pub(super) fn times(self) -> &'static str {
        if self == Language::Octave { ".*" } else { "*" }
    }

    pub(super) fn over(self) -> &'static str {
        if self == Language::Octave { "./" } else { "/" }
    }

    pub(super) fn call(self, function: Function, argument: &str) -> String {
        let name = match (self, function) {
            (Language::Ufl, Function::Log10) => {
                return format!("(ufl.ln({argument})/{:?})", std::f64::consts::LN_10);
            }
            (Language::Rust | Language::Ufl, Function::Ln) => "ln",
            (_, Function::Ln) => "log",
            (Language::Python, Function::Asin) => "arcsin",
            (Language::Python, Function::Acos) => "arccos",
            (Language::Python, Function::Atan) => "arctan",
            (_, Function::Sin) => "sin",
            (_, Function::Cos) => "cos",
            (_, Function::Tan) => "tan",
            (_, Function::Asin) => "asin",
            (_, Function::Acos) => "acos",
            (_, Function::Atan) => "atan",
            (_, Function::Sinh) => "sinh",
            (_, Function::Cosh) => "cosh",
            (_, Function::Tanh) => "tanh",
            (_, Function::Exp) => "exp",
            (_, Function::Log10) => "log10",
            (_, Function::Sqrt) => "sqrt",
        };
        let prefix = match self {
            Language::Python => "np.",
            Language::Ufl => "ufl.",
            Language::Rust => "f64::",
            _ => "",
        };
        format!("{prefix}{name}({argument})")
    }

    pub(super) fn power(self, base: &str, exponent: &str) -> String {
        match self {
            Language::C => format!("pow({base}, {exponent})"),
            Language::Rust => format!("f64::powf({base}, {exponent})"),
            Language::Octave => format!("({base}).^({exponent})"),
            _ => format!("({base})**({exponent})"),
        }
    }

    pub(super) fn choose(
        self,
        comparison: Comparison,
        [left, right, then, otherwise]: [&str; 4],
    ) -> String {
        let condition = format!("{left} {} {right}", comparison.symbol());
        match self {
            Language::C => format!("({condition} ? {then} : {otherwise})"),
            Language::Fortran => format!("merge({then}, {otherwise}, {condition})"),
            Language::Python => format!("np.where({condition}, {then}, {otherwise})"),
            Language::Octave => format!("pick({condition}, {then}, {otherwise})"),
            Language::Rust => format!("(if {condition} {{ {then} }} else {{ {otherwise} }})"),
            Language::Ufl => {
                let name = match comparison {
                    Comparison::Less => "lt",
                    Comparison::LessOrEqual => "le",
                    Comparison::Greater => "gt",
                    Comparison::GreaterOrEqual => "ge",
                };
                format!("ufl.conditional(ufl.{name}({left}, {right}), {then}, {otherwise})")
            }
        }
    }

    /// A constant of a function.
    pub(super) fn assign(self, name: &str, value: &str) -> String {
        match self {
            Language::C => format!("const double {name} = {value};"),
            Language::Rust => format!("let {name} = {value};"),
            Language::Octave => format!("{name} = {value};"),
            _ => format!("{name} = {value}"),
        }
    }

    /// A component of the result, or all of a scalar result.
    pub(super) fn result(self, shape: &[usize], place: usize, value: &str) -> String {
        match (self, shape) {
            (Language::C, []) => format!("return {value};"),
            (Language::C, _) => format!("out[{place}] = {value};"),
            (Language::Fortran, []) => format!("out = {value}"),
            (Language::Fortran, [_, columns]) => {
                format!(
                    "out({}, {}) = {value}",
                    place / columns + 1,
                    place % columns + 1
                )
            }
            (Language::Fortran, _) => format!("out({}) = {value}", place + 1),
            (Language::Octave, _) => format!("out({}, :) = {value};", place + 1),
            (Language::Python, _) => format!("out[{place}] = {value}"),
            (Language::Rust, []) => value.to_owned(),
            (Language::Rust, _) => format!("out[{place}] = {value};"),
            (Language::Ufl, _) => format!("r{place} = ufl.as_ufl({value})"),
        }
    }
}
