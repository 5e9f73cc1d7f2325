//! What the name of a column says about it.

use super::names::without_unit;

/// What a column holds, by its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Meaning {
    /// A step size.
    Step,
    /// A number of cells, unknowns or time steps, which grows where the step shrinks. The smaller the rank, the nearer to the step.
    Count(u8),
    /// The number of the row.
    Index,
    /// A rate that the program has computed.
    Rate,
    /// A rate or an error: `order 1` may be the error of a method of first order, `conv_error` either.
    RateOrError,
    /// The cost of a level, or a parameter of the problem.
    Cost,
    /// A logarithm of a step or of an error.
    Logarithm,
    /// An error.
    Error,
    /// Anything else.
    Unknown,
}

const STEPS: [&str; 40] = [
    "h",
    "dt",
    "dx",
    "dy",
    "dz",
    "hmax",
    "hmin",
    "hmean",
    "havg",
    "maxh",
    "minh",
    "hx",
    "hy",
    "hz",
    "hk",
    "diam",
    "diameter",
    "cellsize",
    "celldiameter",
    "tau",
    "meshsize",
    "meshwidth",
    "gridsize",
    "gridspacing",
    "step",
    "stepsize",
    "timestep",
    "timestepsize",
    "deltat",
    "deltax",
    "deltay",
    "deltaz",
    "δt",
    "δx",
    "δy",
    "δz",
    "∆t",
    "∆x",
    "τ",
    "spacing",
];
/// Counts with their ranks: a mesh of n cells has the step n^(-1/dim) up to a constant, its unknowns only in the limit.
const COUNTS: [(u8, &[&str]); 4] = [
    (
        0,
        &[
            "cells",
            "cell",
            "elements",
            "element",
            "elems",
            "el",
            "elem",
            "steps",
            "timesteps",
            "intervals",
            "triangles",
            "tets",
            "tetrahedra",
            "quads",
            "hexes",
            "faces",
            "edges",
            "pointsperwavelength",
            "ppw",
        ],
    ),
    (1, &["n", "nx", "ny", "nz", "nt", "m", "nn", "e", "sqrtn"]),
    (2, &["nodes", "node", "vertices", "points", "gridpoints", "pts"]),
    (3, &["dofs", "dof", "unknowns", "degreesoffreedom", "kdofs", "kdof", "mdofs", "totaldofs", "sqrtdofs"]),
];
/// What stands before a name to say that it is counted.
const COUNTED: [&str; 7] = ["numberof", "number", "num", "nb", "nr", "no", "n"];
const INDICES: [&str; 11] = ["", "row", "index", "cycle", "level", "lvl", "refinement", "ref", "i", "k", "l"];
const RATES: [&str; 12] =
    ["rate", "rates", "order", "eoc", "roc", "slope", "orders", "red", "reduction", "conv", "ratio", "ratios"];
const COSTS: [&str; 32] = [
    "iterations",
    "iteration",
    "iter",
    "iters",
    "its",
    "niter",
    "niters",
    "nit",
    "nits",
    "cpu",
    "cputime",
    "tcpu",
    "seconds",
    "wall",
    "walltime",
    "twall",
    "wallclock",
    "elapsed",
    "elapsedtime",
    "runtime",
    "time",
    "solvetime",
    "tsolve",
    "assemblytime",
    "totaltime",
    "mem",
    "memory",
    "nnz",
    "cond",
    "condition",
    "conditionnumber",
    "cfl",
];
/// Parts of names of errors.
const ERRORS: [&str; 5] = ["err", "norm", "fehler", "residual", "‖"];
/// Parts of names that most often are those of errors.
const NORMS: [&str; 13] =
    ["l1", "l2", "h1", "h2", "linf", "linfty", "l∞", "lmax", "rms", "rmse", "mse", "hdiv", "hcurl"];
/// Words that by themselves most often name an error.
const ERROR_WORDS: [&str; 15] = [
    "max",
    "maximum",
    "sup",
    "inf",
    "e",
    "eh",
    "res",
    "resid",
    "energy",
    "mae",
    "diff",
    "difference",
    "dev",
    "abs",
    "rel",
];
/// Unknowns, by which their errors are often named.
const FIELDS: [&str; 12] = [
    "u",
    "v",
    "w",
    "p",
    "velocity",
    "pressure",
    "displacement",
    "temperature",
    "stress",
    "flux",
    "solution",
    "gradient",
];
/// Words that make `order` the name of a method.
const METHODS: [&str; 10] = ["first", "second", "third", "fourth", "fifth", "low", "lower", "high", "higher", "scheme"];

/// The meaning of a name, with or without the unit behind it.
pub(super) fn meaning(name: &str) -> Meaning {
    let plain = without_unit(name);
    match by_words(name) {
        Meaning::Unknown if plain != name => by_words(plain),
        known => known,
    }
}

/// Whether values are those of one row above the other: 1/h counts, 1/N is a step.
pub(super) fn reciprocal(name: &str) -> Option<&str> {
    let name = without_unit(name).trim();
    let below = name.strip_prefix("1/").or_else(|| name.strip_suffix("^-1")).or_else(|| name.strip_suffix("^{-1}"));
    below.map(str::trim)
}

/// The known names that are steps as often as counts: of whole numbers they count.
pub(super) fn may_count(name: &str) -> bool {
    reciprocal(name).is_some() || matches!(joined(without_unit(name)).as_str(), "step" | "timestep")
}

fn joined(name: &str) -> String {
    name.to_lowercase().chars().filter(|c| c.is_alphanumeric() || *c == '∆').collect()
}

fn by_words(name: &str) -> Meaning {
    if is_logarithm(name) {
        return Meaning::Logarithm;
    }
    match reciprocal(name).map(by_words) {
        Some(Meaning::Step) => return Meaning::Count(0),
        // Of other counts it is open whether they are those along an edge.
        Some(Meaning::Count(1)) => return Meaning::Step,
        _ => {}
    }
    let lower = name.to_lowercase();
    let joined = joined(name);
    let words = || lower.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty());
    let is_rate = words().any(|word| RATES.contains(&word)) || joined.starts_with("eoc");
    if ERRORS.iter().any(|part| lower.contains(part)) {
        // The one word for a rate that names nothing else.
        let is_eoc = words().next().is_some_and(|first| first.starts_with("eoc"));
        return if is_eoc {
            Meaning::Rate
        } else if is_rate {
            Meaning::RateOrError
        } else {
            Meaning::Error
        };
    }
    if let Some(number) = joined.strip_prefix("orders").or_else(|| joined.strip_prefix("order"))
        && number.starts_with(|c: char| c.is_ascii_digit())
    {
        return Meaning::RateOrError;
    }
    if is_rate && words().any(|word| METHODS.contains(&word) || word.starts_with(|c: char| c.is_ascii_digit())) {
        return Meaning::RateOrError;
    }
    let is_norm = || {
        NORMS.iter().any(|part| joined.contains(part))
            || words().any(|word| ERROR_WORDS.contains(&word) || FIELDS.contains(&word))
            || lower.contains('|')
    };
    let otherwise = || if is_norm() { Meaning::Error } else { Meaning::Unknown };
    // No known name of one word has a digit; of many columns most have.
    if joined.contains(|c: char| c.is_ascii_digit()) && !is_rate {
        return otherwise();
    }
    if STEPS.contains(&joined.as_str()) {
        return Meaning::Step;
    }
    // Before counts, for `nnz` is no number of nz.
    if COSTS.contains(&joined.as_str()) {
        return Meaning::Cost;
    }
    if let Some(rank) = count(&joined) {
        return Meaning::Count(rank);
    }
    if is_rate {
        return Meaning::Rate;
    }
    if INDICES.contains(&joined.as_str()) { Meaning::Index } else { otherwise() }
}

/// `cells`, `ncells`, `number of cells`, `#cells`.
fn count(name: &str) -> Option<u8> {
    let rank = |name: &str| COUNTS.iter().find(|(_, names)| names.contains(&name)).map(|(rank, _)| *rank);
    // `e` and single letters count nothing by themselves but behind `n`: `ne`.
    let whole = if matches!(name, "e" | "m" | "el") { None } else { rank(name) };
    let counted = |before: &str| {
        // `nrm` is a norm, not a number of m.
        let rest = name.strip_prefix(before).filter(|rest| before == "n" || rest.len() > 1)?;
        rank(rest)
    };
    whole.or_else(|| COUNTED.iter().find_map(|before| counted(before)))
}

/// `log(h)`, `log10 L2`, `ln_e`, `\log h`, `loge`; not `logistic` or `lnorm`.
fn is_logarithm(name: &str) -> bool {
    argument(name).is_some()
}

/// What a column named `log(h)` is the logarithm of: `h`.
pub(super) fn argument(name: &str) -> Option<&str> {
    let name = name.trim_start_matches('\\');
    let head = |mark: &str| name.get(..mark.len()).filter(|head| head.eq_ignore_ascii_case(mark));
    let mark = ["log", "ln"].into_iter().find(|mark| head(mark).is_some())?;
    let rest = name[mark.len()..].trim_start_matches(['_', '{']);
    let rest = rest.strip_prefix("10").or_else(|| rest.strip_prefix('2')).unwrap_or(rest);
    let inner = rest.trim_matches(|c: char| c.is_whitespace() || "_(){}[]".contains(c));
    let is_joined = rest.starts_with(char::is_alphabetic);
    let is_known = || inner.chars().count() == 1 || !matches!(by_words(inner), Meaning::Unknown | Meaning::Index);
    (!inner.is_empty() && (!is_joined || (mark == "log" || inner.chars().count() < 4) && is_known())).then_some(inner)
}

#[cfg(test)]
mod tests {
    use super::{Meaning, argument, meaning};

    #[test]
    fn a_name_means_what_people_mean_by_it() {
        for (means, names) in [
            (Meaning::Step, "h|H|h_K|h_avg|dt|dy|hz|Δt|tau|mesh size|time step|h [m]|h (m)|h in mm|1/N|diam|max_h"),
            (
                Meaning::Count(0),
                "cells|#cells|n_cells|nb_elements|number of triangles|1/h|1/Δt|h^-1|points per wavelength",
            ),
            (Meaning::Count(1), "N|n|nx|ny|sqrt(N)"),
            (Meaning::Count(3), "dofs|ndofs|n_dofs|# dofs|kdofs|dofs [10^3]|num dofs"),
            (Meaning::Rate, "rate|ratio|L2 order|order of L2|eoc(H1)|EOC error|eoc L2 [-]|L2...red.rate.log2"),
            (
                Meaning::RateOrError,
                "order 1|order_2|first order|2nd order|conv_error|error rate|rate (error)|err. red.",
            ),
            (Meaning::Cost, "time|Time [s]|CPU (s)|t_wall|solve time|n_iter|#nnz|memory (MB)|CFL|time in s"),
            (Meaning::Logarithm, "log(h)|log h|log10(L2)|log_10 h|ln(e)|ln_h|logh|lnu|logL2|\\log h|Log2(N)"),
            (
                Meaning::Error,
                "L2|L^2|L2(u)|u_L2|H1 [Pa]|Linf|max|error|rel. err.|E|e_h|‖u - u_h‖|residual|time (L2)|L2 time error",
            ),
            // Norms and functions whose names begin as counts, costs and logarithms do.
            (Meaning::Error, "nrm error|norm of m|lnorm|RMSE|iteration error|dofs error|time error"),
            (Meaning::Error, "u|p|grad u|velocity"),
            (Meaning::Unknown, "spam|nrm|Re(lambda)|logistic|login|1/cells|n_a"),
        ] {
            for name in names.split('|').filter(|name| !name.is_empty()) {
                assert_eq!(meaning(name), means, "{name}");
            }
        }
        assert_eq!([argument("log10(L2)"), argument("ln h"), argument("logic")], [Some("L2"), Some("h"), None]);
    }
}
