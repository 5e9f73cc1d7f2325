//! Words of a command with placeholders such as `{n}`.

use std::fmt;

use crate::input::Misread;
use crate::text::names::{did_you_mean, nearest};

use super::refine::Parameter;

/// One word of a command.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Word(Vec<Piece>);

#[derive(Debug, Clone, PartialEq)]
enum Piece {
    Text(String),
    /// The name of a parameter.
    Value(&'static str),
}

impl Word {
    /// Reads a word: a name in braces is a placeholder, `{{name}}` the text `{name}`, any other brace a brace.
    ///
    /// * `known`: the placeholders that have a value.
    ///
    /// # Errors
    /// A placeholder that has none, with its place in the text.
    pub(super) fn parse(text: &str, known: &[&'static str]) -> Result<Self, Misread> {
        let mut pieces = vec![];
        let mut rest = text;
        while let Some(at) = rest.find('{') {
            pieces.push(Piece::Text(rest[..at].to_owned()));
            rest = &rest[at..];
            let quoted =
                rest.strip_prefix('{').and_then(name_in_braces).filter(|name| rest[name.len() + 3..].starts_with('}'));
            if let Some(name) = quoted {
                pieces.push(Piece::Text(format!("{{{name}}}")));
                rest = &rest[name.len() + 4..];
            } else if let Some(name) = name_in_braces(rest) {
                let found = known.iter().find(|known| **known == name);
                let offset = text.len() - rest.len();
                pieces.push(Piece::Value(found.ok_or_else(|| Misread { offset, reason: unknown(name, known) })?));
                rest = &rest[name.len() + 2..];
            } else {
                pieces.push(Piece::Text("{".to_owned()));
                rest = &rest[1..];
            }
        }
        pieces.push(Piece::Text(rest.to_owned()));
        Ok(Self(pieces))
    }

    /// Whether it has a placeholder.
    pub(super) fn has_placeholder(&self) -> bool {
        self.0.iter().any(|piece| matches!(piece, Piece::Value(_)))
    }

    /// The word with these values, in the shortest notation that is read back as the same number.
    pub(super) fn filled(&self, values: &[Parameter]) -> String {
        let text = |piece: &Piece| match piece {
            Piece::Text(text) => text.clone(),
            Piece::Value(name) => {
                let value = values.iter().find(|(known, _)| known == name);
                value.map_or_else(String::new, |(_, value)| value.to_string())
            }
        };
        self.0.iter().map(text).collect()
    }
}

/// As the study file has it, up to `{{name}}`.
impl fmt::Display for Word {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.iter().try_for_each(|piece| match piece {
            Piece::Text(text) => f.write_str(text),
            Piece::Value(name) => write!(f, "{{{name}}}"),
        })
    }
}

/// The name between the brace that the text begins with and the next one: a letter or `_`, then letters, digits and `_`.
fn name_in_braces(text: &str) -> Option<&str> {
    let (name, _) = text.strip_prefix('{')?.split_once('}')?;
    let is_name = name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
    (is_name && name.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_')).then_some(name)
}

fn unknown(name: &str, known: &[&'static str]) -> String {
    let meant = did_you_mean(&nearest(name, known.iter().copied()).map(str::to_owned));
    let known: Vec<String> = known.iter().map(|name| format!("{{{name}}}")).collect();
    format!(
        "found the placeholder {{{name}}}{meant}; expected one that `refine` gives a value, {}, or {{{{{name}}}}} for the text {{{name}}}",
        known.join(", ")
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    const KNOWN: [&str; 2] = ["n", "h"];

    #[test]
    fn placeholders_are_filled_and_other_braces_stay() {
        for (text, filled) in [
            ("--n={n}", "--n=8"),
            ("{h}{n}", "0.1258"),
            ("plain", "plain"),
            ("{{n}}", "{n}"),
            ("{{n}} {n}", "{n} 8"),
            ("{ print $1 }", "{ print $1 }"),
            ("a{3}", "a{3}"),
            ("{}", "{}"),
            ("{{", "{{"),
            ("{", "{"),
            ("é{n}é", "é8é"),
        ] {
            assert_eq!(Word::parse(text, &KNOWN).unwrap().filled(&[("n", 8.0), ("h", 0.125)]), filled, "{text}");
        }
        assert!(Word::parse("x{n}", &KNOWN).unwrap().has_placeholder());
        assert!(!Word::parse("{{n}}", &KNOWN).unwrap().has_placeholder());
    }

    #[test]
    fn an_unknown_placeholder_is_refused_at_its_place() {
        let misread = Word::parse("--dt={dt}", &KNOWN).unwrap_err();
        assert_eq!(misread.offset, 5);
        let told = "found the placeholder {dt}; expected one that `refine` gives a value, {n}, {h}, or {{dt}} for the text {dt}";
        assert_eq!(misread.reason, told);
        assert!(Word::parse("{N}", &KNOWN).unwrap_err().reason.contains("did you mean `n`?"));
    }
}
