//! Claims other than an order, and wrong claims that few levels or a wrong limit suggest.

use convergence_judge::judge::{
    claims,
    verdict::{DEFAULT_TOLERANCE, FEWEST_LEVELS, Judge, Reading},
};
use convergence_study::{Interval, Reason, Verdict};

use crate::draw::{CalibrationError, Draw};
use crate::hidden::{hidden_term, three_terms, wrong_limit};
use crate::judge;
use crate::laws::{LAWS, Law, LawErrors};
use crate::sheet::{HitShare, Sheet, SheetCell, SheetRow};

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
pub(crate) fn three(tables: usize, draw: &mut Draw) -> Result<Sheet, CalibrationError> {
    let judge = judge(DEFAULT_TOLERANCE)?;
    let mut wrong_limit = HitShare::default();
    let mut lower_order = HitShare::default();
    for _ in 0..tables {
        let random = draw.next()?;
        let part = random.within([0.05, 0.6]);
        let table = hidden_term(FEWEST_LEVELS, part, random);
        let share = if table.order.is_some() {
            &mut lower_order
        } else {
            &mut wrong_limit
        };
        share.count(passes(&judge, &table));
    }
    let title = "Share of tables with three levels that pass at ±0.25 although something else makes up 5 to 60 % of the finest error";
    let cells = vec![
        wrong_limit.cell("wrong limit passes"),
        lower_order.cell("lower order passes"),
    ];
    Ok(Sheet {
        key: "three",
        title: title.to_owned(),
        rows: vec![SheetRow::new("3 levels", true, cells)],
    })
}

/// Wrong limits, and three terms of either sign, at three tolerances.
pub(crate) fn limits(tables: usize, draw: &mut Draw) -> Result<Sheet, CalibrationError> {
    let mut rows = vec![];
    for tolerance in [0.05, 0.1, 0.2] {
        let judge = judge(tolerance)?;
        let mut limit = HitShare::default();
        let mut departs_later = HitShare::default();
        let mut terms = HitShare::default();
        for _ in 0..tables {
            let table = wrong_limit(draw.next()?);
            let does_pass = passes(&judge, &table);
            limit.count(does_pass);
            departs_later.count(
                does_pass && judge.judge(&table.levels[3..], table.shown).kind == Reason::Departs,
            );
            terms.count(passes(&judge, &three_terms(draw.next()?)));
        }
        let cells = vec![
            limit.cell("wrong limit passes"),
            departs_later.cell("and departs without its coarsest levels"),
            terms.cell("three terms pass"),
        ];
        rows.push(SheetRow::new(format!("±{tolerance}"), true, cells));
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

/// Verdicts on a least order and on the constant.
#[derive(Debug, Clone, Copy, Default)]
struct OtherClaims {
    too_much_passes: HitShare,
    order_passes: HitShare,
    less_passes: HitShare,
    interval_holds_constant: HitShare,
    right_constant_passes: HitShare,
    right_constant_fails: HitShare,
    wrong_constant_passes: HitShare,
}

/// Whether the claim of at least this order passes.
fn passes_at_least(judge: &Judge, reading: &Reading<'_>, order: f64) -> bool {
    claims::at_least(judge.judge_read(reading, order))
        .verdict
        .is_pass()
}

impl OtherClaims {
    fn count(&mut self, law: &Law, table: &LawErrors, judge: &Judge) {
        let reading = judge.read(&table.levels);
        let half = 2.0 * DEFAULT_TOLERANCE;
        let Some(order) = table.order else {
            self.too_much_passes
                .count(passes_at_least(judge, &reading, table.shown + half));
            return;
        };
        let too_much = table.shown.max(order) + half;
        self.too_much_passes
            .count(passes_at_least(judge, &reading, too_much));
        self.order_passes
            .count(passes_at_least(judge, &reading, order));
        self.less_passes
            .count(passes_at_least(judge, &reading, order - half));
        let rate = judge.judge_read(&reading, order);
        if HAS_CONSTANT.contains(&law.name) && rate.verdict.is_pass() {
            if let Some(Interval { low, high }) = claims::constant(&table.levels, &rate) {
                // A pure power is known to the last digit.
                self.interval_holds_constant
                    .count(low <= 1.0 + 1e-12 && 1.0 - 1e-12 <= high);
            }
            let right = claims::with_constant(&table.levels, rate.clone(), RIGHT).verdict;
            let wrong = claims::with_constant(&table.levels, rate, WRONG).verdict;
            self.right_constant_passes.count(right.is_pass());
            self.right_constant_fails.count(right == Verdict::Fail);
            self.wrong_constant_passes.count(wrong.is_pass());
        }
    }

    fn cells(&self) -> Vec<SheetCell> {
        vec![
            self.too_much_passes
                .cell("at least half an order too much passes"),
            self.order_passes.cell("at least the order passes"),
            self.less_passes.cell("at least half an order less passes"),
            self.interval_holds_constant
                .cell("interval holds the constant"),
            self.right_constant_passes.cell("right constant passes"),
            self.right_constant_fails.cell("right constant fails"),
            self.wrong_constant_passes.cell("wrong constant passes"),
        ]
    }
}

/// A least order, and the constant of laws that have one.
pub(crate) fn other_claims(tables: usize, draw: &mut Draw) -> Result<Sheet, CalibrationError> {
    let judge = judge(DEFAULT_TOLERANCE)?;
    let mut rows = vec![];
    for levels in [4, 5, 6, 8] {
        let mut counted = OtherClaims::default();
        for law in &LAWS {
            for _ in 0..tables {
                let table = law.draw(levels, 2.0, draw.next()?);
                counted.count(law, &table, &judge);
            }
        }
        rows.push(SheetRow::new(
            format!("{levels} levels"),
            true,
            counted.cells(),
        ));
    }
    Ok(Sheet {
        key: "claims",
        title: "Other claims at ±0.25, steps halved".to_owned(),
        rows,
    })
}
