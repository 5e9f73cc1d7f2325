//! Names of columns as they are shown and asked for.

use super::cells::Cell;

/// A name without the markup of mathematics.
pub(super) fn name(cell: Cell<'_>) -> String {
    let text = cell.text;
    if let Some((_, text)) = text.strip_prefix("\\multicolumn").and_then(|rest| rest.rsplit_once('{')) {
        return text.trim_end_matches('}').trim().trim_matches('$').to_owned();
    }
    let mut text = text;
    while let Some(inner) = undressed(text) {
        text = inner.trim();
    }
    // `$L^2$-error`.
    let text = if text.matches('$').count().is_multiple_of(2) { text.replace('$', "") } else { text.to_owned() };
    if !text.contains('\\') {
        return text;
    }
    let plain =
        [("\\_", "_"), ("\\|", "|"), ("\\lVert", "‖"), ("\\rVert", "‖"), ("\\#", "#"), ("\\%", "%"), ("\\Delta ", "Δ")];
    plain.iter().fold(text, |text, (from, to)| text.replace(from, to))
}

/// What one pair of marks surrounds.
fn undressed(text: &str) -> Option<&str> {
    let between = |mark: &str| text.strip_prefix(mark)?.strip_suffix(mark).filter(|inner| !inner.is_empty());
    ["**", "`"]
        .into_iter()
        .find_map(between)
        .or_else(|| between("$").filter(|inner| !inner.contains('$')))
        .or_else(|| text.strip_prefix('{')?.strip_suffix('}').filter(|inner| is_balanced(inner)))
}

/// Whether no brace closes one that was opened before.
fn is_balanced(text: &str) -> bool {
    let mut depth = 0;
    let mut escaped = false;
    for c in text.chars() {
        match c {
            _ if escaped => {}
            '{' => depth += 1,
            '}' => depth -= 1,
            _ => {}
        }
        escaped = c == '\\' && !escaped;
        if depth < 0 {
            return false;
        }
    }
    depth == 0
}

/// A name without one unit behind it: `h [m]`, `CPU (s)`, `time in s`.
pub(super) fn without_unit(name: &str) -> &str {
    let bracketed = |open: char, close: char| {
        let (before, _) = name.strip_suffix(close)?.rsplit_once(open)?;
        Some(before.trim_end()).filter(|before| !before.is_empty())
    };
    let worded = || {
        let (before, unit) = name.rsplit_once(" in ")?;
        (unit.chars().count() < 4 && unit.chars().all(|c| c.is_alphabetic() || c == '%')).then_some(before.trim_end())
    };
    bracketed('[', ']').or_else(|| bracketed('(', ')')).or_else(worded).unwrap_or(name)
}

/// Which of the names is asked for: as it is written, or the only one that is so without its unit.
pub(crate) fn position<'n>(names: impl Iterator<Item = &'n str> + Clone, wanted: &str) -> Option<usize> {
    names.clone().position(|name| name == wanted).or_else(|| {
        let mut same = names.enumerate().filter(|(_, name)| without_unit(name) == wanted).map(|(k, _)| k);
        same.next().filter(|_| same.next().is_none())
    })
}
