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
    pub(super) change: EditKind,
    /// The factor that fits, of an edit that has one.
    pub(super) factor: f64,
    /// The label of the term, if the edit is about all of it.
    pub(super) label: Option<String>,
    pub(crate) edit: Edit,
}

/// A term with another factor.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct TermFactor {
    pub(super) label: String,
    pub(super) factor: f64,
}

/// An edit that does not fit, but comes nearest.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Nearest {
    pub(super) named: Named,
    /// The share of the difference that it leaves.
    pub(super) left: f64,
}

/// Nothing fits.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Unexplained {
    pub(super) nearest: Vec<Nearest>,
    /// How many edits were tried.
    pub(super) edits: usize,
    /// The limit of work was reached.
    pub(super) is_cut: bool,
}

/// What explains the values of another program.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Cause {
    Equal,
    SignOfSource,
    Normal,
    Constant(f64),
    FactorOfSource(f64),
    /// Several terms, each with a factor.
    Terms(Vec<TermFactor>),
    Edit(Named),
    /// The values of one time.
    Time(f64),
    Component(String),
    Coordinates([String; 2]),
    Parameter {
        name: String,
        value: f64,
    },
    None(Unexplained),
}

/// The name of a cause by the factors of its terms.
fn of_factors(mut factors: impl Iterator<Item = f64> + Clone) -> &'static str {
    if factors.clone().all(|factor| factor == -1.0) {
        "sign-of-term"
    } else if factors.all(|factor| factor == 0.0) {
        "missing-term"
    } else {
        "factor-of-term"
    }
}

/// The name of an edit, by what it changes.
pub(crate) fn kind(change: EditKind, factor: f64) -> &'static str {
    match change {
        EditKind::Term => of_factors(std::iter::once(factor)),
        EditKind::Exponent => "exponent",
        EditKind::Summand | EditKind::Part if factor == -1.0 => "sign",
        EditKind::Summand | EditKind::Part if factor == 0.0 => "missing-term",
        EditKind::Summand | EditKind::Part => "coefficient",
        EditKind::LostFactor | EditKind::LostDivisor | EditKind::LostTime => "missing-factor",
        EditKind::TimeFactor => "time-factor",
        EditKind::TimesForOver => "inverse-factor",
        EditKind::Square => "exponent",
        EditKind::LostOperator => "missing-operator",
        EditKind::Function => "function",
        EditKind::TransposedGradient => "transposed-gradient",
        EditKind::MissingTranspose => "missing-transpose",
        EditKind::Order => "order",
        EditKind::Operator | EditKind::Typed | EditKind::TakenBelow => "operator",
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
    }
}

impl Cause {
    pub(super) fn name(&self) -> &'static str {
        match self {
            Cause::Equal => "equal",
            Cause::SignOfSource => "sign-of-source",
            Cause::Normal => "normal",
            Cause::Constant(_) => "constant",
            Cause::FactorOfSource(_) => "factor-of-source",
            Cause::Terms(terms) => of_factors(terms.iter().map(|term| term.factor)),
            Cause::Edit(named) => named.edit.kind,
            Cause::Time(_) => "time",
            Cause::Component(_) => "components",
            Cause::Coordinates(_) => "coordinates",
            Cause::Parameter { .. } => "parameter",
            Cause::None(_) => "none",
        }
    }

    /// The terms or the names that it is about.
    pub(super) fn terms(&self) -> Vec<String> {
        match self {
            Cause::Terms(terms) => terms.iter().map(|term| term.label.clone()).collect(),
            Cause::Edit(named) => named.label.iter().cloned().collect(),
            Cause::Component(name) | Cause::Parameter { name, .. } => vec![name.clone()],
            Cause::Coordinates(names) => names.to_vec(),
            _ => vec![],
        }
    }

    /// A factor for each term or edit that has one, or the number that it is about.
    pub(super) fn factors(&self) -> Vec<f64> {
        match self {
            Cause::Constant(number)
            | Cause::FactorOfSource(number)
            | Cause::Time(number)
            | Cause::Parameter { value: number, .. } => vec![*number],
            Cause::Terms(terms) => terms.iter().map(|term| term.factor).collect(),
            Cause::Edit(named) if named.change.has_factor() => vec![named.factor],
            _ => vec![],
        }
    }

    /// What a colleague would say.
    ///
    /// * `labels`: those of all terms.
    /// * `file`: the name of the file.
    pub(super) fn words(&self, file: &str, labels: &[&str]) -> String {
        let terms = self.terms();
        let quoted = quoted(&terms);
        let others = others(labels, &terms);
        match self {
            Cause::Equal => "your values are right".to_owned(),
            Cause::SignOfSource => {
                "your source has the opposite sign: the equation was written on the other side"
                    .to_owned()
            }
            Cause::Normal => {
                "your values have the opposite sign: the normal points inwards".to_owned()
            }
            Cause::Constant(number) => {
                format!("your values differ from the right ones by the constant {number}")
            }
            Cause::FactorOfSource(number) => {
                format!("your values are the right ones times {number}")
            }
            Cause::Terms(terms) => of_terms(terms, &quoted, others),
            Cause::Edit(named) => one_edit(named, file, others),
            Cause::Time(number) => {
                format!("your values are those of the time {number} at all times")
            }
            Cause::Component(_) => format!("your values are those of {quoted}"),
            Cause::Coordinates(_) => {
                format!("your values fit with {quoted} exchanged")
            }
            Cause::Parameter { value, .. } => format!("your values fit with {quoted} = {value}"),
            Cause::None(unexplained) => unexplained.words(file),
        }
    }
}

impl Unexplained {
    fn words(&self, file: &str) -> String {
        let edits = self.edits;
        let nearest: Vec<String> = self
            .nearest
            .iter()
            .map(|nearest| {
                let share = 100.0 * nearest.left;
                format!(
                    "{}, which leaves {share:.2} % of the difference",
                    place_and_text(&nearest.named, file)
                )
            })
            .collect();
        let nearest = match nearest.is_empty() {
            true => String::new(),
            false => format!("; nearest, but no explanation: {}", nearest.join("; ")),
        };
        let cut = match self.is_cut {
            true => ", where the limit of work was reached",
            false => "",
        };
        format!("no explanation found by {edits} edit(s){cut}{nearest}")
    }
}

fn of_terms(terms: &[TermFactor], quoted: &str, others: &str) -> String {
    match of_factors(terms.iter().map(|term| term.factor)) {
        "sign-of-term" => format!("your source has the opposite sign in {quoted}{others}"),
        "missing-term" => format!("your source lacks {quoted}{others}"),
        _ => {
            let parts: Vec<String> = terms
                .iter()
                .map(|term| format!("`{}` times {}", term.label, term.factor))
                .collect();
            format!("your source has {}{others}", parts.join(" and "))
        }
    }
}

/// An edit of a whole term in the words of terms, another with its place.
fn one_edit(named: &Named, file: &str, others: &str) -> String {
    match &named.label {
        Some(label) => {
            let term = TermFactor {
                label: label.clone(),
                factor: named.factor,
            };
            of_terms(&[term], &format!("`{label}`"), others)
        }
        None => place_and_text(named, file),
    }
}

/// What is said of an edit that no point sees.
pub(crate) fn unseen(named: &Named, file: &str) -> String {
    let Edit {
        kind,
        line,
        column,
        old,
        new,
        ..
    } = &named.edit;
    let what = match named.change {
        EditKind::Held => format!("if `{old}` is not differentiated"),
        _ => format!("with `{new}` in place of `{old}`"),
    };
    format!("{kind}: the source is the same {what} ({file}:{line}:{column})")
}

/// `stress.toml:12:9: in tau: your source has 1/2 where the file has 1/3`.
pub(super) fn place_and_text(named: &Named, file: &str) -> String {
    let Edit { key, old, new, .. } = &named.edit;
    let what = match named.change {
        EditKind::Held => {
            format!("your source does not differentiate `{old}`: it stands outside the derivatives")
        }
        EditKind::OneDifferentiated => {
            format!("your source differentiates only `{new}` of the product `{old}`")
        }
        EditKind::Normal => "your normal points inwards".to_owned(),
        _ if old.is_empty() => format!("your source has another summand, `{}`", new.trim_start()),
        _ if new.is_empty() => format!("your source lacks `{old}`"),
        _ => format!("your source has `{new}` where the file has `{old}`"),
    };
    let Edit { line, column, .. } = &named.edit;
    let key = key.strip_prefix("define.").unwrap_or(key);
    format!("{file}:{line}:{column}: in {key}: {what}")
}

fn quoted(names: &[String]) -> String {
    let names: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    match names.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("{} and {last}", rest.join(", ")),
        Some((last, _)) => last.clone(),
        None => String::new(),
    }
}

/// What is said of the terms that are right.
fn others(labels: &[&str], terms: &[String]) -> &'static str {
    match labels.len().saturating_sub(terms.len()) {
        0 => "",
        1 => "; the other term is right",
        _ => "; the other terms are right",
    }
}
