//! What is wrong with a source: an edit of the file that gives its values, or what concerns all of
//! it; the names of causes, and their words.

use serde::Serialize;

use super::candidates::EditKind;

/// A change of the file that gives the values of the other program.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Edit {
    /// What it does.
    pub kind: &'static str,
    /// The key in the file, such as `define.tau`.
    pub key: String,
    /// From 1.
    pub line: usize,
    /// In characters, from 1.
    pub column: usize,
    /// What the file has there.
    pub old: String,
    /// What the other program has.
    pub new: String,
}

/// An edit with its data.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Named {
    /// The factor that fits, of an edit that has one; the number that it is about.
    pub(super) factors: Vec<f64>,
    /// The label of the term, if the edit is about all of it; the names that it is about.
    pub(super) terms: Vec<String>,
    pub(crate) edit: Edit,
}

/// The name of a cause by the factors of its terms.
pub(super) fn of_factors(mut factors: impl Iterator<Item = f64> + Clone) -> &'static str {
    if factors.clone().all(|factor| factor == -1.0) {
        "sign-of-term"
    } else if factors.all(|factor| factor == 0.0) {
        "missing-term"
    } else {
        "factor-of-term"
    }
}

/// The name of an edit, by what it changes.
pub(crate) fn word(kind: EditKind, factor: f64) -> &'static str {
    match kind {
        EditKind::Term => of_factors(std::iter::once(factor)),
        EditKind::Summand | EditKind::Part if factor == -1.0 => "sign",
        EditKind::Summand | EditKind::Part if factor == 0.0 => "missing-term",
        EditKind::Summand | EditKind::Part => "coefficient",
        EditKind::LostFactor | EditKind::LostTime => "missing-factor",
        EditKind::TimeFactor => "time-factor",
        EditKind::TimesForOver => "inverse-factor",
        EditKind::Exponent | EditKind::Square => "exponent",
        EditKind::LostOperator => "missing-operator",
        EditKind::Function => "function",
        EditKind::TransposedGradient => "transposed-gradient",
        EditKind::MissingTranspose => "missing-transpose",
        EditKind::Order => "order",
        EditKind::Operator | EditKind::TakenBelow => "operator",
        EditKind::Held | EditKind::OneDifferentiated => "product-rule",
        EditKind::Basis => "basis",
        EditKind::Parameters => "parameters",
        EditKind::Normal => "normal",
        EditKind::Derivative => "derivative",
        EditKind::Index => "index",
        EditKind::Branch => "branch",
        EditKind::LostBracket => "bracket",
        EditKind::Name => "name",
        EditKind::Added => "added-term",
        EditKind::Parameter => "parameter",
        EditKind::Time => "time",
        EditKind::Coordinates => "coordinates",
    }
}

/// What is said of terms with other factors, of which the equation has these labels.
pub(super) fn of_terms(terms: &[String], factors: &[f64], labels: &[&str]) -> String {
    let named = terms.iter().map(|term| format!("`{term}`"));
    let others = match labels.len().saturating_sub(terms.len()) {
        0 => "",
        1 => "; the other term is right",
        _ => "; the other terms are right",
    };
    match of_factors(factors.iter().copied()) {
        "sign-of-term" => {
            let terms = listed(named);
            format!("your source has the opposite sign in {terms}{others}")
        }
        "missing-term" => format!("your source lacks {}{others}", listed(named)),
        _ => {
            let pairs = factors.iter().zip(named);
            let parts = pairs.map(|(factor, name)| format!("{name} times {factor}"));
            let parts = parts.collect::<Vec<_>>().join(" and ");
            format!("your source has {parts}{others}")
        }
    }
}

/// What is said of an edit that no point sees.
pub(crate) fn unseen(kind: EditKind, edit: &Edit, file: &str) -> String {
    let Edit {
        kind: word,
        line,
        column,
        old,
        new,
        ..
    } = edit;
    let what = match kind {
        EditKind::Held => format!("if `{old}` is not differentiated"),
        _ => format!("with `{new}` in place of `{old}`"),
    };
    format!("{word}: the source is the same {what} ({file}:{line}:{column})")
}

/// `stress.toml:12:9: in tau: your source has 1/2 where the file has 1/3`.
pub(super) fn place_and_text(kind: EditKind, edit: &Edit, file: &str) -> String {
    let Edit {
        key,
        old,
        new,
        line,
        column,
        ..
    } = edit;
    let what = match kind {
        EditKind::Held => {
            format!("your source does not differentiate `{old}`: it stands outside the derivatives")
        }
        EditKind::OneDifferentiated => {
            format!("your source differentiates only `{new}` of the product `{old}`")
        }
        EditKind::Normal => "your normal points inwards".to_owned(),
        EditKind::Time => format!("your values are those of the time {new} at all times"),
        EditKind::Coordinates => format!("your values fit with `{old}` and `{new}` exchanged"),
        _ if old.is_empty() => format!("your source has another summand, `{}`", new.trim_start()),
        _ if new.is_empty() => format!("your source lacks `{old}`"),
        _ => format!("your source has `{new}` where the file has `{old}`"),
    };
    let key = key.strip_prefix("define.").unwrap_or(key);
    format!("{file}:{line}:{column}: in {key}: {what}")
}

/// `a`, `b` and `c`.
fn listed(names: impl Iterator<Item = String>) -> String {
    let names: Vec<String> = names.collect();
    match names.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("{} and {last}", rest.join(", ")),
        _ => names.concat(),
    }
}
