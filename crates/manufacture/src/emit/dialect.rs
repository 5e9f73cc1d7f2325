//! Numbers, operations and statements, by the texts of each language.

use super::{Language, fill};
use crate::language::names::Function;
use crate::language::tree::Relation;

impl Language {
    /// A name with `_` behind it where the language cannot tell it from one of the others: Fortran
    /// does not tell capitals from small letters.
    pub(super) fn distinct(self, mut name: String, others: &[&str]) -> String {
        while others.iter().any(|other| self.is_same(other, &name)) {
            name.push('_');
        }
        name
    }

    /// Whether the language takes two names for one.
    pub(super) fn is_same(self, one: &str, other: &str) -> bool {
        one == other || (self.texts().names.ignores_case && one.eq_ignore_ascii_case(other))
    }

    /// A coordinate of the array of that name.
    pub(super) fn coordinate(self, array: &str, index: usize) -> String {
        let values = [
            ("ARRAY", array),
            ("I", &index.to_string()),
            ("I1", &(index + 1).to_string()),
        ];
        fill(self.texts().arithmetic.coordinate, &values)
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
        digits + self.texts().arithmetic.suffix
    }

    pub(super) fn call(self, function: Function, argument: &str) -> String {
        let call = self.texts().arithmetic.functions.call(function);
        fill(call, &[("X", argument)])
    }

    pub(super) fn power(self, base: &str, exponent: &str) -> String {
        let values = [("LEFT", base), ("RIGHT", exponent)];
        fill(self.texts().arithmetic.power, &values)
    }

    pub(super) fn choose(
        self,
        comparison: Relation,
        [left, right, then, otherwise]: [&str; 4],
    ) -> String {
        let word = match comparison {
            Relation::Less => "lt",
            Relation::LessOrEqual => "le",
            Relation::Greater => "gt",
            Relation::GreaterOrEqual => "ge",
        };
        fill(
            self.texts().arithmetic.choose,
            &[
                ("SYMBOL", comparison.symbol()),
                ("WORD", word),
                ("LEFT", left),
                ("RIGHT", right),
                ("THEN", then),
                ("ELSE", otherwise),
            ],
        )
    }

    /// A constant of a function.
    pub(super) fn assign(self, name: &str, value: &str) -> String {
        let values = [("NAME", name), ("VALUE", value)];
        fill(self.texts().statements.assign, &values)
    }

    /// A component of the result, or all of a scalar result.
    pub(super) fn result(self, shape: &[usize], place: usize, value: &str) -> String {
        let statements = &self.texts().statements;
        let statement = if shape.is_empty() {
            statements.scalar
        } else {
            statements.component
        };
        let next = (place + 1).to_string();
        let indices = match shape {
            [_, columns] => format!("{}, {}", place / columns + 1, place % columns + 1),
            _ => next.clone(),
        };
        fill(
            statement,
            &[
                ("I", &place.to_string()),
                ("I1", &next),
                ("INDICES", &indices),
                ("VALUE", value),
            ],
        )
    }
}
