//! Claims other than an order, and wrong claims that few levels or a wrong limit suggest.

use convergence_judge::{
    claims,
    verdict::{DEFAULT_TOLERANCE, FEWEST_LEVELS, Judge, Reading},
};
use convergence_study::{Interval, Reason, Verdict};

use crate::draw::{Counted, Draw};
use crate::hidden::{hidden_term, three_terms, wrong_limit};
use crate::judge;
use crate::laws::{LAWS, Law, LawErrors};
use crate::sheet::{Sheet, SheetRow};

/// A claim about the constant 1, and one that it refutes.
const RIGHT: Interval = Interval {
    low: 0.8,
    high: 1.25,
};
const WRONG: Interval = Interval {
    low: 1.25,
    high: 2.0,
};

/// Whether the order that the coarse levels show passes.
fn passes(judge: &Judge, table: &LawErrors) -> bool {
    let reading = judge.read(&table.levels);
    judge.decide(&reading, table.shown).is_pass()
}

/// Three levels, of which a wrong limit or a lower order makes up 5 to 60 % of the finest error.
pub(crate) fn three(tables: usize, draw: &mut Draw) -> Counted {
    let judge = judge(DEFAULT_TOLERANCE)?;
    let columns = ["wrong limit passes", "lower order passes"];
    let mut row = SheetRow::new("3 levels", true, &columns);
    for _ in 0..tables {
        let random = draw.next()?;
        let part = random.within([0.05, 0.6]);
        let table = hidden_term(FEWEST_LEVELS, part, random);
        let column = columns[usize::from(table.order.is_some())];
        row.count(column, passes(&judge, &table));
    }
    let title = "Share of tables with three levels that pass at ±0.25 although something else makes up 5 to 60 % of the finest error";
    Ok(Sheet {
        key: "three",
        title: title.to_owned(),
        rows: vec![row],
    })
}

/// Wrong limits, and three terms of either sign, at three tolerances.
pub(crate) fn limits(tables: usize, draw: &mut Draw) -> Counted {
    let mut rows = vec![];
    let columns = [
        "wrong limit passes",
        "and departs without its coarsest levels",
        "three terms pass",
    ];
    for tolerance in [0.05, 0.1, 0.2] {
        let judge = judge(tolerance)?;
        let mut row = SheetRow::new(format!("±{tolerance}"), true, &columns);
        for _ in 0..tables {
            let table = wrong_limit(draw.next()?);
            let does_pass = passes(&judge, &table);
            let departs_later =
                does_pass && judge.judge(&table.levels[3..], table.shown).code == Reason::Departs;
            let three_terms = three_terms(draw.next()?);
            row.count("wrong limit passes", does_pass);
            row.count("and departs without its coarsest levels", departs_later);
            row.count("three terms pass", passes(&judge, &three_terms));
        }
        rows.push(row);
    }
    Ok(Sheet {
        key: "limits",
        title: "Share of wrong claims that pass with 8 levels, steps halved".to_owned(),
        rows,
    })
}

/// Laws that are h^p to leading order.
const HAS_CONSTANT: [&str; 7] = [
    "h^p",
    "h^p |1 + a h^r|, r 1 to 4, |a| < 0.5",
    "h^p |1 + a h^r|, r 0.5 to 1, |a| < 0.5",
    "noise 0.1 %",
    "noise 1 %",
    "noise 3 %",
    "pollution, noise 1 %",
];

const TOO_MUCH: &str = "at least half an order too much passes";
const COLUMNS: [&str; 7] = [
    TOO_MUCH,
    "at least the order passes",
    "at least half an order less passes",
    "interval holds the constant",
    "right constant passes",
    "right constant fails",
    "wrong constant passes",
];

/// Whether the claim of at least this order passes.
fn passes_at_least(judge: &Judge, reading: &Reading<'_>, order: f64) -> bool {
    claims::at_least(judge.judge_read(reading, order))
        .verdict
        .is_pass()
}

/// Counts the verdicts on a least order and on the constant.
fn count(row: &mut SheetRow, law: &Law, table: &LawErrors, judge: &Judge) {
    let reading = judge.read(&table.levels);
    let half = 2.0 * DEFAULT_TOLERANCE;
    let passes = |order| passes_at_least(judge, &reading, order);
    let Some(order) = table.order else {
        row.count(TOO_MUCH, passes(table.shown + half));
        return;
    };
    row.count(TOO_MUCH, passes(table.shown.max(order) + half));
    row.count("at least the order passes", passes(order));
    row.count("at least half an order less passes", passes(order - half));
    let rate = judge.judge_read(&reading, order);
    if !HAS_CONSTANT.contains(&law.name) || !rate.verdict.is_pass() {
        return;
    }
    if let Some(Interval { low, high }) = claims::constant(&table.levels, &rate) {
        // A pure power is known to the last digit.
        let holds = low <= 1.0 + 1e-12 && 1.0 - 1e-12 <= high;
        row.count("interval holds the constant", holds);
    }
    let right = claims::with_constant(&table.levels, rate.clone(), RIGHT).verdict;
    let wrong = claims::with_constant(&table.levels, rate, WRONG).verdict;
    row.count("right constant passes", right.is_pass());
    row.count("right constant fails", right == Verdict::Fail);
    row.count("wrong constant passes", wrong.is_pass());
}

/// A least order, and the constant of laws that have one.
pub(crate) fn other_claims(tables: usize, draw: &mut Draw) -> Counted {
    let judge = judge(DEFAULT_TOLERANCE)?;
    let mut rows = vec![];
    for levels in [4, 5, 6, 8] {
        let mut row = SheetRow::new(format!("{levels} levels"), true, &COLUMNS);
        for law in &LAWS {
            for _ in 0..tables {
                let table = law.draw(levels, 2.0, draw.next()?);
                count(&mut row, law, &table, &judge);
            }
        }
        rows.push(row);
    }
    Ok(Sheet {
        key: "claims",
        title: "Other claims at ±0.25, steps halved".to_owned(),
        rows,
    })
}
