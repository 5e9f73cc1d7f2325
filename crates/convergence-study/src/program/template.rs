//! Words of a command with placeholders such as `{n}`.

use crate::input::Misread;
use crate::text::names::{did_you_mean, nearest};

use super::refine::Parameter;

/// A word of a command with these values, in the shortest notation that is read back as the same number; and whether it has a
/// placeholder. A name in braces is one, `{{name}}` the text `{name}`, any other brace a brace.
///
/// # Errors
/// A placeholder that has no value, with its place in the text.
pub(super) fn filled(text: &str, values: &[Parameter]) -> Result<(String, bool), Misread> {
    let (mut filled, mut rest, mut has_placeholder) = (String::new(), text, false);
    while let Some(at) = rest.find('{') {
        filled += &rest[..at];
        rest = &rest[at..];
        let quoted =
            rest.strip_prefix('{').and_then(name_in_braces).filter(|name| rest[name.len() + 3..].starts_with('}'));
        if let Some(name) = quoted {
            filled += &format!("{{{name}}}");
            rest = &rest[name.len() + 4..];
        } else if let Some(name) = name_in_braces(rest) {
            let found = values.iter().find(|(known, _)| *known == name);
            let unknown = || Misread { offset: text.len() - rest.len(), reason: unknown(name, values) };
            filled += &found.ok_or_else(unknown)?.1.to_string();
            has_placeholder = true;
            rest = &rest[name.len() + 2..];
        } else {
            filled.push('{');
            rest = &rest[1..];
        }
    }
    Ok((filled + rest, has_placeholder))
}

/// The name between the brace that the text begins with and the next one: a letter or `_`, then letters, digits and `_`.
fn name_in_braces(text: &str) -> Option<&str> {
    let (name, _) = text.strip_prefix('{')?.split_once('}')?;
    let is_name = name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
    (is_name && name.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_')).then_some(name)
}

fn unknown(name: &str, values: &[Parameter]) -> String {
    let known = || values.iter().map(|(name, _)| *name);
    let meant = did_you_mean(&nearest(name, known()).map(str::to_owned));
    let known: Vec<String> = known().map(|name| format!("{{{name}}}")).collect();
    format!(
        "found the placeholder {{{name}}}{meant}; expected one that `refine` gives a value, {}, or {{{{{name}}}}} for the text {{{name}}}",
        known.join(", ")
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    const KNOWN: [Parameter; 2] = [("n", 8.0), ("h", 0.125)];

    #[test]
    fn placeholders_are_filled_and_other_braces_stay() {
        for (text, expected) in [
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
            assert_eq!(filled(text, &KNOWN).unwrap().0, expected, "{text}");
        }
        assert!(filled("x{n}", &KNOWN).unwrap().1 && !filled("{{n}}", &KNOWN).unwrap().1);
    }

    #[test]
    fn an_unknown_placeholder_is_refused_at_its_place() {
        let misread = filled("--dt={dt}", &KNOWN).unwrap_err();
        assert_eq!(misread.offset, 5);
        let told = "found the placeholder {dt}; expected one that `refine` gives a value, {n}, {h}, or {{dt}} for the text {dt}";
        assert_eq!(misread.reason, told);
        assert!(filled("{N}", &KNOWN).unwrap_err().reason.contains("did you mean `n`?"));
    }
}
