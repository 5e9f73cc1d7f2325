//! Every value of a document, by its dotted path: a baseline keeps these of a study file.

use toml::Spanned;
use toml::de::{DeInteger, DeTable, DeValue};

/// Every value of a table: its dotted path, such as `expect[0].tolerance`, and its [`text`].
///
/// A list of plain values is one value; a list that holds tables or lists is taken apart. An empty
/// table or list is a value, so that adding or removing it does not go unnoticed.
pub(super) fn of_table(table: &DeTable<'_>) -> Vec<(String, String)> {
    let mut found = Vec::new();
    table
        .iter()
        .for_each(|(key, value)| collect(key_text(key.get_ref()), value.get_ref(), &mut found));
    found
}

fn collect(path: String, value: &DeValue<'_>, found: &mut Vec<(String, String)>) {
    match value {
        DeValue::Table(table) if !table.is_empty() => {
            for (key, value) in table {
                collect(
                    format!("{path}.{}", key_text(key.get_ref())),
                    value.get_ref(),
                    found,
                );
            }
        }
        DeValue::Array(items) if items.iter().any(|item| is_nested(item.get_ref())) => {
            for (index, item) in items.iter().enumerate() {
                collect(format!("{path}[{index}]"), item.get_ref(), found);
            }
        }
        _ => found.push((path, text(value))),
    }
}

fn is_nested(value: &DeValue<'_>) -> bool {
    value.is_table() || value.is_array()
}

/// A key as TOML writes it, so that `"a.b"` is not taken for `b` of the table `a`.
fn key_text(key: &str) -> String {
    let bare = !key.is_empty()
        && key
            .chars()
            .all(|c| c.is_ascii_alphanumeric() || matches!(c, '_' | '-'));
    if bare {
        key.to_owned()
    } else {
        format!("{key:?}")
    }
}

/// A value in one form, however it is written: 0.05 and 5e-2, 3 and 3.0, 0x10 and 16 have the same
/// text; a number and the same digits in quotes do not.
fn text(value: &DeValue<'_>) -> String {
    match value {
        DeValue::String(text) => format!("{text:?}"),
        DeValue::Integer(integer) => match whole(integer) {
            // Seeds may have more digits than a floating-point number.
            Some(exact) if exact as f64 as i128 == exact => number(exact as f64),
            Some(exact) => exact.to_string(),
            None => integer.as_str().to_owned(),
        },
        DeValue::Float(float) => float
            .as_str()
            .parse()
            .map_or_else(|_| float.as_str().to_owned(), number),
        DeValue::Boolean(value) => value.to_string(),
        DeValue::Datetime(value) => value.to_string(),
        DeValue::Array(items) => {
            let items: Vec<String> = items.iter().map(Spanned::get_ref).map(text).collect();
            format!("[{}]", items.join(", "))
        }
        DeValue::Table(_) => "{}".to_owned(),
    }
}

/// The value of an integer in any notation.
pub(super) fn whole(integer: &DeInteger<'_>) -> Option<i128> {
    i128::from_str_radix(integer.as_str(), integer.radix()).ok()
}

/// Enough digits to tell the number from its neighbours, and no more.
fn number(value: f64) -> String {
    let size = value.abs();
    let plain = size == 0.0 || !value.is_finite() || (1e-3..1e16).contains(&size);
    if plain {
        value.to_string()
    } else {
        format!("{value:e}")
    }
}

#[cfg(test)]
mod tests {
    use super::super::Document;

    fn settings(text: &str) -> Vec<(String, String)> {
        Document::parse(text, "a.toml", |root: &Document<'_>| Ok(root.settings())).unwrap()
    }

    #[test]
    fn every_value_has_a_path() {
        let text = "a = true\nlist = [1, 2.50]\n\"odd.key\" = 1\nempty = []\n[t]\n[[expect]]\norder = 1\n\
                    [[expect]]\nt = { x = \"sin(x)\" }\nnested = [[1], []]\n";
        let expected = [
            ("a", "true"),
            ("empty", "[]"),
            ("expect[0].order", "1"),
            ("expect[1].nested[0]", "[1]"),
            ("expect[1].nested[1]", "[]"),
            ("expect[1].t.x", "\"sin(x)\""),
            ("list", "[1, 2.5]"),
            ("\"odd.key\"", "1"),
            ("t", "{}"),
        ];
        let mut expected = expected
            .map(|(path, value)| (path.to_owned(), value.to_owned()))
            .to_vec();
        let mut found = settings(text);
        expected.sort();
        found.sort();
        assert_eq!(found, expected);
    }

    #[test]
    fn equal_values_have_equal_texts_and_different_ones_do_not() {
        let value = |written: &str| settings(&format!("a = {written}")).remove(0).1;
        for (one, other) in [
            ("0.05", "5e-2"),
            ("3", "3.0"),
            ("0x10", "16"),
            ("1_000", "1e3"),
            ("100000000000000000", "1e17"),
            ("1e-13", "0.1e-12"),
            ("\"a\"", "'a'"),
            ("[1, 2]", "[ 1.0,\n 2, ]"),
        ] {
            assert_eq!(value(one), value(other));
        }
        for (one, other) in [
            ("1", "\"1\""),
            ("true", "\"true\""),
            ("9007199254740993", "9007199254740992"),
            ("1.0", "1.0000000000000002"),
            ("[1]", "1"),
            ("[\"a, b\"]", "[\"a\", \"b\"]"),
            ("[]", "{}"),
        ] {
            assert_ne!(value(one), value(other));
        }
    }
}
