//! The bounds of the shares: on few tables, and on many.

use convergence_study::Must;

use super::DECLARED;

/// A share with its bounds on few tables and on many.
pub(super) struct Share {
    pub(super) column: &'static str,
    pub(super) row: &'static str,
    pub(super) claims: [Option<Must>; 2],
}

const fn most(column: &'static str, row: &'static str, [few, many]: [f64; 2]) -> Share {
    Share {
        column,
        row,
        claims: [Some(Must::AtMost(few)), Some(Must::AtMost(many))],
    }
}

const fn least(column: &'static str, row: &'static str, [few, many]: [f64; 2]) -> Share {
    Share {
        column,
        row,
        claims: [Some(Must::AtLeast(few)), Some(Must::AtLeast(many))],
    }
}

/// A bound on many tables alone.
const fn of_many(column: &'static str, row: &'static str, claim: Must) -> Share {
    Share {
        column,
        row,
        claims: [None, Some(claim)],
    }
}

const OURS: &str = "this rule";

/// The shares with bounds, by sheet.
pub(super) const SHARES: &[(&str, &[Share])] = &[
    (
        "rules",
        &[
            most("wrong pass, ±0.05, 0.1 off", OURS, [0.0012, 0.00091]),
            most("wrong pass, ±0.1, 0.2 off", OURS, [0.0018, 0.0012]),
            most("wrong pass, ±0.25, 0.5 off", OURS, [0.0029, 0.0027]),
            least("true pass, ±0.1", OURS, [0.413, 0.418]),
            least("true pass, ±0.25", OURS, [0.573, 0.569]),
        ],
    ),
    (
        "rules-wide",
        &[
            most("wrong pass, ±0.05, 0.1 off", OURS, [0.0011, 0.00085]),
            most("wrong pass, ±0.1, 0.2 off", OURS, [0.0015, 0.0011]),
            most("wrong pass, ±0.25, 0.5 off", OURS, [0.0035, 0.0032]),
        ],
    ),
    (
        "levels",
        &[
            least("true pass", "4 levels", [0.399, 0.442]),
            most("true fail", "4 levels", [0.029, 0.031]),
            most("visibly wrong pass", "4 levels", [0.0035, 0.0016]),
            least("true pass", "5 levels", [0.529, 0.553]),
            most("true fail", "5 levels", [0.012, 0.0087]),
            most("visibly wrong pass", "5 levels", [0.0035, 0.0016]),
            least("true pass", "6 levels", [0.566, 0.598]),
            most("true fail", "6 levels", [0.014, 0.0089]),
            most("visibly wrong pass", "6 levels", [0.0022, 0.0014]),
            least("true pass", "added up to 8", [0.73, 0.746]),
            most("visibly wrong pass", "added up to 8", [0.0035, 0.0027]),
            most("true fail", "added up to 8", [0.023, 0.019]),
            most("wrong pass", "3 levels", [0.0028, 0.0019]),
            most("wrong pass", "4 levels", [0.0053, 0.0012]),
            most("wrong pass", "5 levels", [0.0059, 0.0012]),
            most("wrong pass", "6 levels", [0.0048, 0.001]),
            most("wrong pass", "8 levels", [0.0035, 0.0013]),
            least("true pass", "8 levels", [0.7, 0.718]),
            most(
                "passes without its coarsest level only",
                "4 levels",
                [0.014, 0.0125],
            ),
            most(
                "passes without its coarsest level only",
                "5 levels",
                [0.018, 0.017],
            ),
            most(
                "passes without its coarsest level only",
                "6 levels",
                [0.011, 0.0075],
            ),
            most(
                "passes without its coarsest level only",
                "8 levels",
                [0.011, 0.0015],
            ),
            of_many("wrong pass", "added up to 8", Must::AtMost(0.0045)),
            of_many("interval holds the order", "5 levels", Must::AtLeast(0.886)),
            of_many("interval holds the order", "8 levels", Must::AtLeast(0.937)),
        ],
    ),
    (
        "held-out",
        &[
            most("true fail", "added up to 8", [0.135, 0.13]),
            most("wrong pass", "4 levels", [0.027, 0.0155]),
            most("wrong pass", "8 levels", [0.024, 0.011]),
            least("true pass", "4 levels", [0.257, 0.359]),
            least("true pass", "8 levels", [0.69, 0.735]),
            of_many("true fail", "8 levels", Must::AtMost(0.072)),
            least("interval holds the order", "4 levels", [0.804, 0.858]),
            of_many("wrong pass", "added up to 8", Must::AtMost(0.032)),
        ],
    ),
    (
        "laws",
        &[
            most("wrong pass", DECLARED, [0.019, 0.0057]),
            most("true fail", DECLARED, [0.038, 0.046]),
            least("interval holds the order", DECLARED, [0.849, 0.881]),
            least("interval holds the order", "all declared", [0.947, 0.946]),
            most("wrong pass", "all declared", [0.0018, 0.00096]),
            most("true fail", "all declared", [0.0056, 0.0067]),
            most("wrong pass", "3 levels", [0.0035, 0.0011]),
            most("wrong pass", "4 levels", [0.0096, 0.0023]),
            most("wrong pass", "5 levels", [0.0035, 0.00087]),
            most("wrong pass", "6 levels", [0.0035, 0.0014]),
            most("wrong pass", "7 levels", [0.0035, 0.00071]),
            most("wrong pass", "8 levels", [0.0035, 0.0014]),
        ],
    ),
    ("hidden-8", &[most("10 %", OURS, [0.026, 0.004])]),
    (
        "hidden-wide",
        &[
            most("10 %", OURS, [0.026, 0.004]),
            of_many("5 %", OURS, Must::AtMost(0.009)),
        ],
    ),
    (
        "limits",
        &[
            most(
                "and departs without its coarsest levels",
                DECLARED,
                [1e-9, 1e-9],
            ),
            most("wrong limit passes", "±0.1", [0.26, 0.16]),
            most("three terms pass", "±0.2", [0.28, 0.16]),
        ],
    ),
    ("grids", &[most("constant passes", DECLARED, [1e-9, 1e-9])]),
    (
        "claims",
        &[
            most(
                "at least half an order too much passes",
                DECLARED,
                [0.011, 0.011],
            ),
            least("interval holds the constant", DECLARED, [0.952, 0.979]),
            most("right constant fails", DECLARED, [0.0042, 0.00017]),
            most("wrong constant passes", DECLARED, [0.0042, 0.00017]),
            least("right constant passes", "6 levels", [0.919, 0.921]),
        ],
    ),
    (
        "three",
        &[
            most("wrong limit passes", DECLARED, [0.013, 0.0062]),
            most("lower order passes", DECLARED, [0.037, 0.015]),
        ],
    ),
    (
        "benign",
        &[
            least("true pass", "4 levels", [0.83, 0.87]),
            least("true pass", "8 levels", [0.999, 0.999]),
            of_many("interval holds the order", "5 levels", Must::AtLeast(0.96)),
            of_many("true fail", "added up to 8", Must::AtMost(1e-9)),
        ],
    ),
    (
        "differences",
        &[
            least("true pass", "4 levels", [0.83, 0.87]),
            most("wrong pass", DECLARED, [1e-9, 1e-9]),
            of_many("true pass", "6 levels", Must::AtLeast(0.97)),
        ],
    ),
    (
        "noisy",
        &[
            most(
                "hidden order passes",
                "8 levels, noise 0.3 %",
                [0.013, 0.002],
            ),
            most("hidden order passes", "8 levels, noise 1 %", [0.045, 0.03]),
            least("true pass", "8 levels, noise 1 %", [0.9, 0.92]),
            least("true pass", "8 levels, noise 3 %", [0.9, 0.92]),
            most("hidden order passes", "8 levels, noise 3 %", [0.38, 0.3]),
            of_many(
                "hidden order passes",
                "5 levels, noise 1 %",
                Must::AtMost(0.37),
            ),
            of_many("true pass", "5 levels, noise 1 %", Must::AtLeast(0.87)),
        ],
    ),
    (
        "compared",
        &[
            most("wrong pass", OURS, [0.026, 0.0255]),
            least("true pass", OURS, [0.53, 0.545]),
        ],
    ),
];
