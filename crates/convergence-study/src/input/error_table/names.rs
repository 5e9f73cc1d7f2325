//! What the name of a column says, where its numbers leave it open.

use std::collections::HashMap;
use std::sync::LazyLock;

/// What a column holds, by its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Word {
    Step,
    /// A number of cells or unknowns; the smaller the rank, the nearer to the step.
    Count(u8),
    Rate,
    /// A rate or an error: `order 1` may be the error of a method of first order, `conv_error` either.
    MaybeRate,
    /// The cost of a level, or its number.
    Cost,
    Logarithm,
    Error,
    Unknown,
}

static STEPS: &str = "h dt dx dy dz hmax hmin hmean havg maxh minh hx hy hz hk diam diameter cellsize celldiameter tau τ \
    step stepsize meshsize meshwidth gridsize gridspacing spacing timestep timestepsize deltat deltax deltay deltaz δt δx δy δz \
    ∆t ∆x";
/// A mesh of n cells has the step n^(-1/dim) up to a constant, its unknowns only in the limit.
static COUNTS: [&str; 4] = [
    "cells cell elements element elems elem steps timesteps intervals triangles tets tetrahedra quads hexes faces edges \
     pointsperwavelength ppw refinements",
    "n nx ny nz nt m nn ne nel sqrtn mesh grid resolution",
    "nodes node vertices points gridpoints pts",
    "dofs dof unknowns degreesoffreedom kdofs kdof mdofs sqrtdofs ndofs finiteelementunknowns",
];
static RATES: &str = "rate rates order eoc roc slope orders red reduction conv ratio ratios convergence p-obs";
static COSTS: &str = "time cpu wall seconds elapsed runtime iterations iteration iter iters its nit mem memory nnz \
    cond cfl row index cycle level lvl refinement ref i k l";
static ERRORS: &str = "max maximum sup inf e eh res resid energy mae mse rms rmse diff difference dev abs rel u v w p \
    velocity pressure displacement temperature stress flux solution gradient";
static METHODS: &str = "first second third fourth fifth low lower high higher scheme";

/// The lists that a word is in.
static WORDS: LazyLock<HashMap<&str, Vec<&str>>> = LazyLock::new(|| {
    let mut words: HashMap<&str, Vec<&str>> = HashMap::new();
    for list in [STEPS, RATES, COSTS, ERRORS, METHODS].into_iter().chain(COUNTS) {
        list.split_whitespace().for_each(|word| words.entry(word).or_default().push(list));
    }
    words
});

fn is_in(list: &str, word: &str) -> bool {
    WORDS.get(word).is_some_and(|lists| lists.iter().any(|other| std::ptr::eq(*other, list)))
}

impl Word {
    /// The meaning of a name, with or without the unit behind it.
    pub(super) fn of(name: &str) -> Self {
        match (Self::whole(name), without_unit(name)) {
            (Self::Unknown, plain) if plain != name => Self::whole(plain),
            (known, _) => known,
        }
    }

    pub(super) fn is_rate(self) -> bool {
        matches!(self, Self::Rate | Self::MaybeRate)
    }

    fn whole(name: &str) -> Self {
        if argument(name).is_some() {
            return Self::Logarithm;
        }
        match reciprocal(name).map(Self::whole) {
            Some(Self::Step) => return Self::Count(0),
            // Of other counts it is open whether they are those along an edge.
            Some(Self::Count(1)) => return Self::Step,
            _ => {}
        }
        let lower = name.to_lowercase();
        let joined: String = lower.chars().filter(|c| c.is_alphanumeric() || *c == '∆').collect();
        let words = lower.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty());
        let has = |list: &str| words.clone().any(|word| is_in(list, word));
        let has_digit = |word: &str| word.contains(|c: char| c.is_ascii_digit());
        let is_rate = has(RATES) || joined.starts_with("eoc") || joined.starts_with("order");
        let is_error = ["err", "norm", "fehler", "residual", "‖", "|"].iter().any(|part| lower.contains(part));
        let is_norm = ["l1", "l2", "h1", "h2", "linf", "l∞", "lmax", "rms", "hdiv", "hcurl"]
            .iter()
            .any(|part| joined.contains(part));
        let method =
            words.clone().any(|word| is_in(METHODS, word) || (has_digit(word) && !word.starts_with(['l', 'h'])));
        match () {
            () if is_rate && words.clone().next().is_some_and(|first| first.starts_with("eoc")) => Self::Rate,
            () if is_rate
                && (is_error || method || (joined.starts_with("order") && has_digit(&joined) && !is_norm)) =>
            {
                Self::MaybeRate
            }
            () if is_error => Self::Error,
            () if is_rate => Self::Rate,
            () if !has_digit(&joined) && is_in(STEPS, &joined) => Self::Step,
            () if is_norm || has(ERRORS) && !has("time") => Self::Error,
            () if words.clone().next().is_some() && words.clone().all(|word| is_in(COSTS, word)) => Self::Cost,
            () => count(&joined).map_or(if has(COSTS) { Self::Cost } else { Self::Unknown }, Self::Count),
        }
    }
}

/// `cells`, `ncells`, `number of cells`, `#cells`.
fn count(name: &str) -> Option<u8> {
    let rank = |name: &str| COUNTS.iter().position(|names| is_in(names, name)).map(|rank| rank as u8);
    let counted = |before: &&str| name.strip_prefix(*before).filter(|rest| rest.len() > 1).and_then(rank);
    rank(name).or_else(|| ["numberof", "number", "num", "nb", "nr", "no", "n", "total"].iter().find_map(counted))
}

/// Whether values are those of one row above the other: 1/h counts, 1/N is a step.
pub(super) fn reciprocal(name: &str) -> Option<&str> {
    let name = without_unit(name).trim();
    name.strip_prefix("1/").or_else(|| name.strip_suffix("^-1")).or_else(|| name.strip_suffix("^{-1}")).map(str::trim)
}

/// What a column named `log(h)` is the logarithm of: `log10 L2`, `ln_e`, `\log h`, `loge`; not `logistic` or `lnorm`.
pub(super) fn argument(name: &str) -> Option<&str> {
    let name = name.trim_start_matches('\\');
    let mark = ["log", "ln"]
        .into_iter()
        .find(|mark| name.get(..mark.len()).is_some_and(|head| head.eq_ignore_ascii_case(mark)))?;
    let rest = name[mark.len()..].trim_start_matches(['_', '{']);
    let rest = rest.strip_prefix("10").or_else(|| rest.strip_prefix('2')).unwrap_or(rest);
    let inner = rest.trim_matches(|c: char| c.is_whitespace() || "_(){}[]".contains(c));
    let is_joined = name[mark.len()..].starts_with(char::is_alphabetic);
    (!inner.is_empty() && (!is_joined || inner.chars().count() < 3)).then_some(inner)
}

/// A name without the markup of mathematics.
pub(super) fn shown(text: &str) -> String {
    if let Some((_, text)) = text.strip_prefix("\\multicolumn").and_then(|rest| rest.rsplit_once('{')) {
        return text.trim_end_matches('}').trim().trim_matches('$').to_owned();
    }
    let mut text = text.trim();
    let between =
        |text: &str, mark: &str| Some(text.strip_prefix(mark)?.strip_suffix(mark)?.len()).filter(|inner| *inner > 0);
    while let Some(mark) = ["**", "`", "$"].into_iter().find(|mark| between(text, mark).is_some()) {
        text = text[mark.len()..text.len() - mark.len()].trim();
    }
    // Of `{$a_{b}$}` the outer pair is dropped, of `{a}{b}` none.
    let inner = text.strip_prefix('{').and_then(|text| text.strip_suffix('}'));
    let text = inner
        .filter(|inner| inner.find('}').is_none_or(|close| inner.find('{').is_some_and(|open| open < close)))
        .unwrap_or(text)
        .trim();
    let text = if text.matches('$').count().is_multiple_of(2) { text.replace('$', "") } else { text.to_owned() };
    let plain =
        [("\\_", "_"), ("\\|", "|"), ("\\lVert", "‖"), ("\\rVert", "‖"), ("\\#", "#"), ("\\%", "%"), ("\\Delta ", "Δ")];
    if text.contains('\\') { plain.iter().fold(text, |text, (from, to)| text.replace(from, to)) } else { text }
}

/// A name without one unit behind it: `h [m]`, `CPU (s)`, `time in s`.
fn without_unit(name: &str) -> &str {
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

/// Which of the names is asked for: as it is written, the only one that is so without its unit, or a nameless one by
/// its number.
pub(crate) fn position<'n>(names: impl Iterator<Item = &'n str> + Clone, wanted: &str) -> Option<usize> {
    let numbered = format!("column {wanted}");
    names.clone().position(|name| name == wanted || name == numbered).or_else(|| {
        let mut same = names.clone().enumerate().filter(|(_, name)| without_unit(name) == wanted).map(|(k, _)| k);
        same.next().filter(|_| same.next().is_none())
    })
}
