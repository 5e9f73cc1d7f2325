//! What the name of a column says, if its numbers do not decide.

use super::number::unmarked;

/// What a column holds, by its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Word {
    Step,
    /// A number of cells or unknowns; the smaller the rank, the more directly it gives the step.
    Count(u8),
    Rate,
    /// The cost of a level, or its number.
    Cost,
    Logarithm,
    Error,
    Unknown,
}

const STEPS: &str = "h dt dx dy dz hmax hmin hmean havg maxh minh hx hy hz hk diam diameter cellsize celldiameter tau τ \
    step stepsize meshsize meshwidth gridsize gridspacing spacing timestep timestepsize deltat deltax deltay deltaz δt δx δy δz \
    ∆t ∆x";
/// A mesh of n cells has the step n^(-1/dim) up to a constant; for unknowns this holds only in the limit.
const COUNTS: [&str; 4] = [
    "cells cell elements element elems elem steps timesteps intervals triangles tets tetrahedra quads hexes faces edges \
     pointsperwavelength ppw refinements",
    "n nx ny nz nt m nn ne nel sqrtn mesh grid resolution",
    "nodes node vertices points gridpoints pts",
    "dofs dof unknowns degreesoffreedom kdofs kdof mdofs sqrtdofs ndofs finiteelementunknowns",
];
const RATES: &str = "rate rates order eoc roc slope orders red reduction conv ratio ratios convergence p-obs";
const COSTS: &str = "time cpu wall seconds elapsed runtime iterations iteration iter iters its nit mem memory nnz \
    cond cfl row index cycle level lvl refinement ref i k l";
const ERRORS: &str = "max maximum sup inf e eh res resid energy mae mse rms rmse diff difference dev abs rel u v w p \
    velocity pressure displacement temperature stress flux solution gradient";

fn is_in(list: &str, word: &str) -> bool {
    list.split(' ').any(|known| known == word)
}

impl Word {
    /// The meaning of a name, with or without a unit after it.
    pub(super) fn of(name: &str) -> Self {
        match (Self::whole(name), without_unit(name)) {
            (Self::Unknown, plain) if plain != name => Self::whole(plain),
            (known, _) => known,
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

    fn whole(name: &str) -> Self {
        let lower = name.to_lowercase();
        match reciprocal(name).map(Self::whole) {
            _ if is_logarithm(&lower) => return Self::Logarithm,
            Some(Self::Step) => return Self::Count(0),
            // Other counts may or may not be along an edge.
            Some(Self::Count(1)) => return Self::Step,
            _ => {}
        }
        let joined: String = lower.chars().filter(|c| c.is_alphanumeric() || *c == '∆').collect();
        let mut words = lower.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty()).peekable();
        let has = |list: &str| words.clone().any(|word| is_in(list, word));
        let holds = |parts: &[&str], text: &str| parts.iter().any(|part| text.contains(part));
        let is_norm = holds(&["l1", "l2", "h1", "h2", "linf", "l∞", "lmax", "rms", "hdiv", "hcurl"], &joined);
        let is_cost = has(COSTS);
        match () {
            () if has(RATES) || joined.starts_with("eoc") || joined.starts_with("order") => Self::Rate,
            () if holds(&["err", "norm", "fehler", "residual", "‖", "|"], &lower) => Self::Error,
            () if is_in(STEPS, &joined) => Self::Step,
            () if is_norm || has(ERRORS) && !words.clone().any(|word| word == "time") => Self::Error,
            () if words.peek().is_some() && words.all(|word| is_in(COSTS, word)) => Self::Cost,
            () => count(&joined).map_or(if is_cost { Self::Cost } else { Self::Unknown }, Self::Count),
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

/// `log10 L2`, `ln_e`, `\log h`, `loge`; not `logistic` or `lnorm`.
fn is_logarithm(name: &str) -> bool {
    let name = name.trim_start_matches('\\');
    let Some(rest) = name.strip_prefix("log").or_else(|| name.strip_prefix("ln")) else { return false };
    let argument = rest.trim_start_matches(['_', '{']).trim_start_matches("10").trim_start_matches('2');
    let argument = argument.trim_matches(|c: char| c.is_whitespace() || "_(){}[]".contains(c));
    !argument.is_empty() && (!rest.starts_with(char::is_alphabetic) || argument.chars().count() < 3)
}

/// A name without the markup of mathematics.
pub(super) fn shown(text: &str) -> String {
    if let Some((_, text)) = text.strip_prefix("\\multicolumn").and_then(|rest| rest.rsplit_once('{')) {
        return text.trim_end_matches('}').trim().trim_matches('$').to_owned();
    }
    let text = unmarked(text, &["**", "`", "$"]);
    // Drops the outer pair of `{$a_{b}$}`, and none of `{a}{b}`.
    let inner = text.strip_prefix('{').and_then(|text| text.strip_suffix('}'));
    let is_pair = |inner: &&str| inner.find('}').is_none_or(|close| inner.find('{').is_some_and(|open| open < close));
    let text = inner.filter(is_pair).unwrap_or(text).trim();
    let text = if text.matches('$').count().is_multiple_of(2) { text.replace('$', "") } else { text.to_owned() };
    let plain =
        [("\\_", "_"), ("\\|", "|"), ("\\lVert", "‖"), ("\\rVert", "‖"), ("\\#", "#"), ("\\%", "%"), ("\\Delta ", "Δ")];
    plain.iter().fold(text, |text, (from, to)| text.replace(from, to))
}

/// A name without a unit after it: `h [m]`, `CPU (s)`, `time in s`.
fn without_unit(name: &str) -> &str {
    let bracketed = |open: char, close: char| Some(name.strip_suffix(close)?.rsplit_once(open)?.0.trim_end());
    let worded = || {
        let (before, unit) = name.rsplit_once(" in ")?;
        (unit.chars().count() < 4 && unit.chars().all(|c| c.is_alphabetic() || c == '%')).then_some(before.trim_end())
    };
    let before = bracketed('[', ']').or_else(|| bracketed('(', ')')).or_else(worded);
    before.filter(|before| !before.is_empty()).unwrap_or(name)
}

/// Position of the name wanted: as written, or the only such name without its unit, or a nameless column by its number.
pub(crate) fn position<'n>(names: impl Iterator<Item = &'n str> + Clone, wanted: &str) -> Option<usize> {
    let numbered = format!("column {wanted}");
    names.clone().position(|name| name == wanted || name == numbered).or_else(|| {
        let mut same = names.clone().enumerate().filter(|(_, name)| without_unit(name) == wanted).map(|(k, _)| k);
        same.next().filter(|_| same.next().is_none())
    })
}
