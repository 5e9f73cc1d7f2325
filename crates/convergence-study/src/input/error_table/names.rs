//! What the name of a column says, and what the words in cells say.

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
    /// What is left of an equation that a solver has solved, and no error of its solution.
    Residual,
    /// A value, or its limit.
    Value,
    /// Whether the code has solved a level.
    State,
    /// What tells several tables in one apart.
    Group,
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

const STEP_WORDS: &str = "h dt dx dy dz hmax hmin maxh hk diam diameter cellsize tau τ step stepsize meshsize meshwidth gridsize \
    gridspacing spacing timestep timestepsize deltat deltax deltay δt δx δy ∆t ∆x";
/// A mesh of n cells has the step n^(-1/dim) up to a constant; for unknowns, last here, this holds
/// only in the limit.
const COUNT_WORDS: &str = "cells elements elems elem steps timesteps intervals triangles tetrahedra quads hexes faces edges \
    subintervals pointsperwavelength n nx ny nz nt ni nj nk npts m ne nel sqrtn mesh grid resolution nodes vertices points dofs dof \
    unknowns kdofs mdofs finiteelementunknowns samples paths particles";
const RATE_WORDS: &str = "rate rates order eoc roc slope orders red reduction conv ratio ratios convergence orden ordnung ordre";
const COST_WORDS: &str = "time cpu wall seconds elapsed runtime duration sec secs ms tiempo zeit temps setup solve assembly iterations iteration iter iters \
    niter its nit sweeps gflops mem memory nnz cond cfl courant tol tolerance rtol atol ranks threads procs row index cycle level levels lvl \
    refinement refinements refine ref i k l";
const ERROR_WORDS: &str = "max maximum sup inf e energy mae mse rms u v w p velocity pressure displacement \
    temperature stress flux solution gradient";
/// Names of values.
const VALUE_WORDS: [&str; 9] = [
    "value",
    "values",
    "limit",
    "extrapolated",
    "extrapolation",
    "computed",
    "numerical",
    "approximate",
    "price",
];
/// Names of what values tend to.
const EXACT_WORDS: [&str; 8] = [
    "exact",
    "analytical",
    "analytic",
    "reference",
    "theor",
    "theory",
    "theoretical",
    "expected",
];
/// Words in the name of an error, whatever else stands there: `u - u_exact, difference`.
const DIFFERENCE_WORDS: [&str; 7] = [
    "diff",
    "difference",
    "differences",
    "dev",
    "deviation",
    "discrepancy",
    "misfit",
];
/// Names of columns that say whether a level was solved.
const STATE_WORDS: [&str; 13] = [
    "converged",
    "success",
    "succeeded",
    "ok",
    "status",
    "state",
    "solved",
    "failed",
    "outcome",
    "result",
    "passed",
    "reason",
    "convergedreason",
];
/// Those in which `true` and 1 say that a level was not solved.
const FAILURE_WORDS: [&str; 2] = ["failed", "diverged"];
/// Units behind the name of a cost: `PSOR, s`.
const TIME_UNITS: [&str; 2] = ["s", "ms"];
/// Words in the name of a step, beside that of what has the size: `panel_size`.
const SIZE_WORDS: [&str; 4] = ["size", "spacing", "width", "diameter"];
/// Words of what has a size that is a step.
const MESH_WORDS: [&str; 12] = [
    "mesh",
    "cell",
    "grid",
    "element",
    "edge",
    "panel",
    "bin",
    "time",
    "normalized",
    "max",
    "min",
    "average",
];
/// Words of what has a size that counts: `size of linear system`.
const SYSTEM_WORDS: [&str; 3] = ["system", "matrix", "problem"];
const NORMS: [&str; 11] = [
    "err", "norm", "‖", "|", "l1", "l2", "h1", "h2", "linf", "l∞", "hdiv",
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
        let is_rate = has(&RATES) || lower.contains("c.r.");
        if is_rate || joined.starts_with("eoc") || joined.starts_with("order") {
            return Self::Rate;
        }
        if joined.contains("resid") || joined.contains("functionnorm") {
            return Self::Residual;
        }
        // `Nonlinear solve converged due to CONVERGED_FNORM_RELATIVE iterations`.
        let last = words.last().copied().unwrap_or_default();
        if ["iterations", "iters", "its", "it", "sweeps"].contains(&last) {
            return Self::Cost;
        }
        if let Some(word) = Self::of_norm(&lower, &joined, &words) {
            return word;
        }
        if STEPS.contains_key(joined.as_str()) {
            return Self::Step;
        }
        let is_value = |word: &&str| VALUE_WORDS.contains(word) || EXACT_WORDS.contains(word);
        if words.iter().any(is_value) {
            return Self::Value;
        }
        if has(&ERRORS) && (words.contains(&"e") || !words.contains(&"time")) {
            return Self::Error;
        }
        if STATE_WORDS.contains(&joined.as_str()) || is_failure_name(name) {
            return Self::State;
        }
        if joined.len() > 1 && is_group(name) {
            return Self::Group;
        }
        if words.len() > 1 && has_time_unit(&lower) {
            return Self::Cost;
        }
        Self::of_counts_and_costs(&words, &joined)
    }

    /// The meaning of a name with a norm or a difference in it; what a level should give is no
    /// error, and no result.
    fn of_norm(lower: &str, joined: &str, words: &[&str]) -> Option<Self> {
        let has = |list: &[&str]| words.iter().any(|word| list.contains(word));
        if has(&["expected", "predicted"]) && !joined.contains("err") {
            return Some(Self::Value);
        }
        let has_norm = |name: &str| {
            let name = name.replace("normal", "");
            NORMS.iter().any(|part| name.contains(part))
        };
        (has_norm(lower) || has_norm(joined) || has(&DIFFERENCE_WORDS)).then_some(Self::Error)
    }

    /// The meaning of a name that is not that of an error.
    fn of_counts_and_costs(words: &[&str], joined: &str) -> Self {
        let some = |list: &Words| words.iter().any(|word| list.contains_key(word));
        if !words.is_empty() && words.iter().all(|word| COSTS.contains_key(word)) {
            return Self::Cost;
        }
        if let Some(rank) = count(joined) {
            return Self::Count(rank);
        }
        // `refinement cells`, but neither `time per element` nor `solver steps`.
        let last = words
            .last()
            .filter(|word| is_counted(word) && **word != "steps");
        if last.is_some() && !words.contains(&"per") {
            return Self::Count(COUNTS.len());
        }
        if some(&COSTS)
            || joined
                .strip_prefix('n')
                .is_some_and(|rest| COSTS.contains_key(rest))
        {
            return Self::Cost;
        }
        let has = |list: &[&str]| words.iter().any(|word| list.contains(word));
        // `inside_cells`, which may be some of them.
        let is_size = has(&SIZE_WORDS);
        let is_count = is_size && has(&SYSTEM_WORDS) || words.iter().any(|word| is_counted(word));
        if is_size && has(&MESH_WORDS) {
            Self::Step
        } else if is_count {
            Self::Count(COUNTS.len())
        } else {
            Self::Unknown
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
            Self::Residual => Some("a residual"),
            Self::Value => Some("a value"),
            Self::State => Some("a state"),
            Self::Group => Some("a group"),
            Self::Error | Self::Unknown => None,
        }
    }
}

/// First letters of what a code says of a level that it has solved, and of one that it has not.
const SOLVED: [&str; 7] = ["true", "yes", "ok", "converged", "pass", "success", "done"];
const NOT_SOLVED: [&str; 14] = [
    "false",
    "no",
    "not converged",
    "diverged",
    "div",
    "fail",
    "error",
    "crash",
    "abort",
    "killed",
    "timeout",
    "unstable",
    "stalled",
    "unconverged",
];

/// Words of a cell that stands for a number that a code did not find.
const FAILURES: &str = "nan nanq nans nat inf infinity ∞ \\infty diverged div failed fail error crash crashed aborted \
    unstable killed timeout oom singular overflow undefined breakdown blowup blow-up n/c nc n.c 0/0 #num! #div/0! \
    #value! #n/a <na>";
/// Words with which such a cell begins.
const FAILURE_BEGINNINGS: [&str; 4] = ["not conv", "no conv", "did not", "out of memory"];

/// Names of what tells several tables in one apart.
const GROUP_WORDS: [&str; 21] = [
    "p",
    "q",
    "deg",
    "degree",
    "polydeg",
    "polynomialdegree",
    "order",
    "method",
    "scheme",
    "stencil",
    "case",
    "test",
    "element",
    "family",
    "variant",
    "re",
    "reynolds",
    "pe",
    "peclet",
    "ra",
    "rayleigh",
];

/// Whether a cell says that its level was solved, or that it was not; `None` if it says neither.
pub(super) fn state(cell: &str) -> Option<bool> {
    let lower = cell.to_lowercase();
    let is_word = |word: &&str| {
        lower.strip_prefix(*word).is_some_and(|rest| {
            rest.is_empty() || word.len() > 3 && !rest.starts_with(' ') || rest.starts_with('_')
        })
    };
    if NOT_SOLVED.iter().any(&is_word) {
        return Some(false);
    }
    SOLVED.iter().any(is_word).then_some(true)
}

/// Whether a cell stands for a number that a code did not find: `-nan(ind)`, `1.#QNAN`, `****`,
/// `diverged`.
pub(super) fn is_failure(cell: &str) -> bool {
    let lower = cell.to_lowercase();
    let phrase = lower.trim_matches(|c| "-+$(){}[]%. ".contains(c));
    let word = phrase.split(['(', ' ']).next().unwrap_or_default();
    let is_stars = !cell.is_empty() && cell.chars().all(|c| c == '*');
    let is_mark_of_c = ["#qnan", "#snan", "#ind", "#inf", "#j"]
        .iter()
        .any(|mark| lower.contains(mark));
    let has_beginning = |beginning: &&str| phrase.starts_with(*beginning);
    is_stars
        || is_mark_of_c
        || FAILURES.split_whitespace().any(|known| known == word)
            && (word != "error" || phrase == word)
        || FAILURE_BEGINNINGS.iter().any(has_beginning)
}

/// Whether a column of states says by `true` or 1 that a level was not solved.
pub(super) fn is_failure_name(name: &str) -> bool {
    FAILURE_WORDS.contains(&name.trim().to_lowercase().as_str())
}

/// Whether a name is that of what a value tends to.
pub(super) fn is_exact(name: &str) -> bool {
    let lower = name.to_lowercase();
    let mut words = lower.split(|c: char| !c.is_alphanumeric());
    words.any(|word| EXACT_WORDS.contains(&word))
}

/// Whether a name is that of groups of rows: of a degree, a method.
pub(super) fn is_group(name: &str) -> bool {
    let lower = without_unit(name).to_lowercase();
    let joined: String = lower.chars().filter(|c| c.is_alphanumeric()).collect();
    GROUP_WORDS.contains(&&*joined)
}

/// Whether a name is that of the number of a level.
pub(super) fn is_level(name: &str) -> bool {
    let joined: String = name
        .to_lowercase()
        .chars()
        .filter(|c| c.is_alphanumeric())
        .collect();
    let noun = joined.strip_prefix("numberof").unwrap_or(&joined);
    [
        "level",
        "lvl",
        "cycle",
        "refinement",
        "refinements",
        "refine",
        "ref",
        "nref",
    ]
    .contains(&noun)
}

/// Whether a name ends with a unit of time: `PSOR, s`, `solver [ms]`; `T_s` does not.
fn has_time_unit(name: &str) -> bool {
    let name = name.trim_end_matches([')', ']']);
    let unit = name.rsplit([' ', '(', '[']).next();
    unit.is_some_and(|unit| TIME_UNITS.contains(&unit))
}

/// Whether a word is that of what is counted, beside others.
fn is_counted(word: &str) -> bool {
    word.len() > 3 && COUNTS.contains_key(word)
}

/// The rank of `cells`, `ncells`, `number of cells`, `#cells`.
fn count(name: &str) -> Option<usize> {
    let find = |name: &str| {
        ["", "numberof", "number", "num", "nr", "no", "n", "total"]
            .iter()
            .find_map(|prefix| COUNTS.get(name.strip_prefix(prefix)?).copied())
    };
    // `nx1` is that of the first direction.
    find(name).or_else(|| find(name.trim_end_matches(|c: char| c.is_ascii_digit())))
}

/// Whether values are those of one row above the other: 1/h counts, 1/N is a step.
pub(super) fn reciprocal(name: &str) -> Option<&str> {
    let name = without_unit(name);
    name.strip_prefix("1/")
        .or_else(|| name.strip_suffix("^-1"))
        .map(str::trim)
}

/// Whether a name has a word of an error, as `err`, `L2` or `residual`.
pub(super) fn is_error(name: &str) -> bool {
    let lower = name.to_lowercase();
    let joined: String = lower.chars().filter(|c| c.is_alphanumeric()).collect();
    let words: Vec<&str> = lower.split(|c: char| !c.is_alphanumeric()).collect();
    let is_mean = ["rms", "rmse", "mae", "mse"]
        .iter()
        .any(|word| words.contains(word));
    is_mean
        || joined.contains("resid")
        || Word::of_norm(&lower, &joined, &words) == Some(Word::Error)
}

/// Whether a name is a line of prose: `Now solving 8x8...`.
pub(super) fn is_sentence(name: &str) -> bool {
    name.ends_with(['.', '!', '…']) && name.contains(' ')
}

/// A name without the markup of mathematics.
pub(super) fn without_markup(text: &str) -> String {
    let text = text
        .trim_matches(|c: char| c.is_whitespace() || "*`$".contains(c))
        .replace(['$', '`'], "");
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

/// Position of the column that a claim names, perhaps behind the name of a table, as in `P1:L2`.
pub(super) fn claimed_position<'n>(
    names: impl Iterator<Item = &'n str> + Clone,
    claimed: &str,
) -> Option<usize> {
    let in_all = position(names.clone(), claimed);
    in_all.or_else(|| position(names, claimed.rsplit_once(':')?.1.trim()))
}

/// Position of the name wanted: as written, or the only such name without its unit, or a nameless
/// column by its number.
pub(crate) fn position<'n>(
    names: impl Iterator<Item = &'n str> + Clone,
    wanted: &str,
) -> Option<usize> {
    for name in [wanted, &format!("column {wanted}"), &without_markup(wanted)] {
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
