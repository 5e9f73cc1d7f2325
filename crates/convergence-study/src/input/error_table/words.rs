//! What the name of a column says about it.

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
    /// The cost of a level.
    Cost,
    /// Anything else.
    Unknown,
}

const STEPS: [&str; 24] = [
    "h",
    "dt",
    "dx",
    "hmax",
    "hmin",
    "hmean",
    "hx",
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
    "δt",
    "δx",
    "∆t",
    "∆x",
    "cellsize",
    "spacing",
];
/// Counts with their ranks: a mesh of n cells has the step n^(-1/dim) up to a constant, its unknowns only in the limit.
const COUNTS: [(u8, &[&str]); 4] = [
    (0, &["cells", "cell", "elements", "element", "elems", "el", "elem", "steps", "timesteps", "intervals"]),
    (1, &["n", "nx", "nt", "m", "nn", "e"]),
    (2, &["nodes", "node", "vertices", "points", "gridpoints", "pts"]),
    (3, &["dofs", "dof", "unknowns", "degreesoffreedom"]),
];
const INDICES: [&str; 11] = ["", "row", "index", "cycle", "level", "lvl", "refinement", "ref", "i", "k", "l"];
const RATES: [&str; 10] = ["rate", "rates", "order", "eoc", "roc", "slope", "orders", "red", "reduction", "conv"];
const COSTS: [&str; 11] =
    ["iterations", "iteration", "iter", "iters", "its", "cpu", "cputime", "seconds", "walltime", "runtime", "time"];

/// The meaning of a name.
pub(super) fn meaning(name: &str) -> Meaning {
    let lower = name.to_lowercase();
    let joined: String = lower.chars().filter(|c| c.is_alphanumeric() || *c == '∆').collect();
    // No known name of one word has a digit; of many columns most have.
    if joined.contains(|c: char| c.is_ascii_digit()) && !RATES.iter().any(|rate| lower.contains(rate)) {
        return Meaning::Unknown;
    }
    if STEPS.contains(&joined.as_str()) {
        return Meaning::Step;
    }
    if let Some(rank) = count(&joined) {
        return Meaning::Count(rank);
    }
    if lower.split(|c: char| !c.is_alphanumeric()).any(|word| RATES.contains(&word)) {
        return Meaning::Rate;
    }
    if COSTS.contains(&joined.as_str()) {
        return Meaning::Cost;
    }
    if INDICES.contains(&joined.as_str()) { Meaning::Index } else { Meaning::Unknown }
}

/// `cells`, `ncells`, `number of cells`, `#cells`.
fn count(name: &str) -> Option<u8> {
    let rank = |name: &str| COUNTS.iter().find(|(_, names)| names.contains(&name)).map(|(rank, _)| *rank);
    // `e` and single letters count nothing by themselves but behind `n`: `ne`.
    let whole = if matches!(name, "e" | "m" | "el") { None } else { rank(name) };
    whole.or_else(|| ["numberof", "num", "no", "n"].iter().find_map(|before| rank(name.strip_prefix(before)?)))
}
