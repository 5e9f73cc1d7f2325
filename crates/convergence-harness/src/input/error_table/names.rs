//! What the name of a column says, if its numbers do not decide.

use std::collections::HashMap;
use std::sync::LazyLock;

/// What a column holds, by its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Word {
    Step,
    /// A number of cells or unknowns; the smaller the rank, the more directly it gives the step.
    Count(usize),
    Rate,
    /// The cost of a level, or its number.
    Cost,
    Logarithm,
    Error,
    Unknown,
}

/// Known words of one kind, each with its place in the list; a table may have a hundred thousand
/// names to look up.
type Words = LazyLock<HashMap<&'static str, usize>>;

fn ranked(list: &'static str) -> HashMap<&'static str, usize> {
    list.split(' ')
        .enumerate()
        .map(|(rank, word)| (word, rank))
        .collect()
}

static STEPS: Words = LazyLock::new(|| ranked(STEP_WORDS));
static COUNTS: Words = LazyLock::new(|| ranked(COUNT_WORDS));
static RATES: Words = LazyLock::new(|| ranked(RATE_WORDS));
static COSTS: Words = LazyLock::new(|| ranked(COST_WORDS));
static ERRORS: Words = LazyLock::new(|| ranked(ERROR_WORDS));

const STEP_WORDS: &str = "h dt dx dy dz hmax hmin hk diam diameter cellsize tau τ step stepsize meshsize meshwidth gridsize \
    gridspacing spacing timestep timestepsize deltat deltax deltay δt δx δy ∆t ∆x";
/// A mesh of n cells has the step n^(-1/dim) up to a constant; for unknowns, last here, this holds
/// only in the limit.
const COUNT_WORDS: &str = "cells elements elems elem steps timesteps intervals triangles tetrahedra quads hexes faces edges \
    pointsperwavelength n nx ny nz nt m ne nel sqrtn mesh grid resolution nodes vertices points dofs dof unknowns kdofs \
    mdofs finiteelementunknowns";
const RATE_WORDS: &str =
    "rate rates order eoc roc slope orders red reduction conv ratio ratios convergence";
const COST_WORDS: &str = "time cpu wall seconds elapsed runtime iterations iteration iter iters niter its nit gflops mem memory nnz cond \
    cfl row index cycle level lvl refinement i k l";
const ERROR_WORDS: &str = "max maximum sup inf e energy mae mse rms diff difference dev deviation u v w p velocity pressure \
    displacement temperature stress flux solution gradient";
const NORMS: [&str; 12] = [
    "err", "norm", "resid", "‖", "|", "l1", "l2", "h1", "h2", "linf", "l∞", "hdiv",
];

impl Word {
    /// The meaning of a name, with or without a unit after it.
    pub(super) fn of(name: &str) -> Self {
        match Self::whole(name) {
            Self::Unknown if without_unit(name) != name => Self::whole(without_unit(name)),
            word => word,
        }
    }

    fn whole(name: &str) -> Self {
        let lower = name.to_lowercase();
        if let Some(inverse) = reciprocal(&lower) {
            return match Self::of(inverse) {
                Self::Step => Self::Count(0),
                // 1/N is a step; 1/cells may be one, or its square.
                Self::Count(_) if inverse.len() < 3 => Self::Step,
                _ => Self::Unknown,
            };
        }
        let joined: String = lower
            .chars()
            .filter(|c| c.is_alphanumeric() || *c == '∆')
            .collect();
        let words: Vec<&str> = lower
            .split(|c: char| !c.is_alphanumeric())
            .filter(|word| !word.is_empty())
            .collect();
        let has = |list: &Words| words.iter().any(|word| list.contains_key(word));
        let argument = lower
            .trim_start_matches('\\')
            .strip_prefix("log")
            .or_else(|| lower.strip_prefix("ln"));
        if argument.is_some_and(|argument| !argument.starts_with(char::is_alphabetic)) {
            return Self::Logarithm;
        }
        if has(&RATES) || joined.starts_with("eoc") || joined.starts_with("order") {
            return Self::Rate;
        }
        if NORMS
            .iter()
            .any(|part| lower.contains(part) || joined.contains(part))
        {
            return Self::Error;
        }
        if STEPS.contains_key(joined.as_str()) {
            return Self::Step;
        }
        if has(&ERRORS) && !words.contains(&"time") {
            return Self::Error;
        }
        if !words.is_empty() && words.iter().all(|word| COSTS.contains_key(word)) {
            return Self::Cost;
        }
        match count(&joined) {
            Some(rank) => Self::Count(rank),
            None if has(&COSTS) => Self::Cost,
            None => Self::Unknown,
        }
    }

    /// What a column that is not an error holds; `None` if the name does not say so.
    pub(super) fn noun(self) -> Option<&'static str> {
        match self {
            Self::Step => Some("a step"),
            Self::Count(_) => Some("a count"),
            Self::Rate => Some("a rate"),
            Self::Cost => Some("a cost"),
            Self::Logarithm => Some("a logarithm"),
            Self::Error | Self::Unknown => None,
        }
    }
}

/// What a code says of one level, in place of a number.
const STATES: [&str; 14] = [
    "true",
    "false",
    "yes",
    "no",
    "ok",
    "converged",
    "diverged",
    "failed",
    "fail",
    "pass",
    "passed",
    "success",
    "nan",
    "none",
];

/// What a code writes where it has no result.
const FAILURES: [&str; 9] = [
    "nan", "inf", "nanq", "nans", "diverged", "failed", "fail", "error", "crashed",
];

/// Names of what tells several tables in one apart.
const GROUP_WORDS: [&str; 14] = [
    "p",
    "q",
    "deg",
    "degree",
    "polydeg",
    "polynomialdegree",
    "order",
    "method",
    "scheme",
    "case",
    "test",
    "element",
    "family",
    "variant",
];

/// Whether a cell says in a word how a level ended.
pub(super) fn is_state(cell: &str) -> bool {
    STATES.contains(&&*cell.to_lowercase())
}

/// Whether a cell stands for a number that a code did not find: `-nan(ind)`, `1.#QNAN`, `****`,
/// `diverged`.
pub(super) fn is_failure(cell: &str) -> bool {
    let lower = cell.to_lowercase();
    let word = lower
        .trim_start_matches(['-', '+'])
        .split(['(', ' '])
        .next();
    let is_stars = cell.len() > 1 && cell.chars().all(|c| c == '*');
    is_stars
        || lower.contains("#qnan")
        || lower.contains("#ind")
        || lower.contains("#inf")
        || word.is_some_and(|word| FAILURES.contains(&word))
}

/// Whether a name is that of groups of rows: of a degree, a method.
pub(super) fn is_group(name: &str) -> bool {
    let lower = without_unit(name).to_lowercase();
    let joined: String = lower.chars().filter(|c| c.is_alphanumeric()).collect();
    GROUP_WORDS.contains(&&*joined)
}

/// The rank of `cells`, `ncells`, `number of cells`, `#cells`.
fn count(name: &str) -> Option<usize> {
    ["", "numberof", "number", "num", "nr", "no", "n", "total"]
        .iter()
        .find_map(|prefix| COUNTS.get(name.strip_prefix(prefix)?).copied())
}

/// Whether values are those of one row above the other: 1/h counts, 1/N is a step.
pub(super) fn reciprocal(name: &str) -> Option<&str> {
    let name = without_unit(name);
    name.strip_prefix("1/")
        .or_else(|| name.strip_suffix("^-1"))
        .map(str::trim)
}

/// A name without the markup of mathematics.
pub(super) fn without_markup(text: &str) -> String {
    let text = text
        .trim_matches(|c: char| c.is_whitespace() || "*`$".contains(c))
        .replace('$', "");
    let inner = text
        .strip_prefix('{')
        .and_then(|text| text.strip_suffix('}'))
        .filter(|inner| !inner.starts_with('}'));
    let plain = [
        ("\\_", "_"),
        ("\\|", "|"),
        ("\\#", "#"),
        ("\\%", "%"),
        ("\\Delta ", "Δ"),
    ];
    plain.iter().fold(
        inner.unwrap_or(&text).trim().to_owned(),
        |text, (from, to)| text.replace(from, to),
    )
}

/// A name without a unit in brackets after it: `h [m]`, `CPU (s)`.
fn without_unit(name: &str) -> &str {
    let before = name
        .strip_suffix([']', ')'])
        .and_then(|name| name.rsplit_once(['[', '(']))
        .map(|(name, _)| name.trim());
    before.filter(|before| !before.is_empty()).unwrap_or(name)
}

/// Position of the name wanted: as written, or the only such name without its unit, or a nameless
/// column by its number.
pub(crate) fn position<'n>(
    names: impl Iterator<Item = &'n str> + Clone,
    wanted: &str,
) -> Option<usize> {
    for name in [wanted, &format!("column {wanted}")] {
        let position = names.clone().position(|other| other == name);
        if position.is_some() {
            return position;
        }
    }
    let mut without_their_unit = names
        .enumerate()
        .filter(|(_, name)| without_unit(name) == wanted);
    let (position, _) = without_their_unit.next()?;
    without_their_unit.next().is_none().then_some(position)
}
