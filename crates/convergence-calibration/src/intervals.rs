//! What each law does to claims and to intervals, on 3 to 8 levels with equal and unequal ratios.

use convergence_judge::{
    random::SplitMix,
    verdict::{FEWEST_LEVELS, Judge, Reading},
};
use convergence_study::Verdict;

use crate::draw::{Counted, Draw};
use crate::laws::{LAWS, Law, LawErrors, LawGroup};
use crate::rules::CLAIMS;
use crate::sheet::{Sheet, SheetRow};
use crate::{judge, wrong};

/// Numbers of levels drawn: 3 to 8.
pub(crate) const LEVEL_COUNTS: usize = 6;

/// Laws that intervals are not made for: far from asymptotic, or with rates that wander too slowly
/// or endlessly.
const NO_INTERVAL: [&str; 12] = [
    "h^p |1 + a h^r|, r 0.25 to 0.5, |a| < 0.5",
    "h^p (1 + a h^(1/3)), a 0.5 to 3",
    "h^p (1 + a h), a 1 to 30",
    "h^p (1 + a h^2), a 1 to 100",
    "h^p |1 - a h^r|, a 1 to 30",
    "h^p (L - log h)^k",
    "h^p (1 ± a), odd and even",
    "h^p (1 + a cos)",
    "h^p + b h^(p - 1/2 or 1)",
    "h^p / (h + h0)^g",
    "noise 30 %",
    "one outlier, up to a factor of 3",
];

/// The row of all laws that are declared.
pub const ALL: &str = "all declared";

/// Whether the rule answers for a law: it has an order, and is not one of those excepted.
fn is_declared(law: &Law) -> bool {
    law.group != LawGroup::Stagnating && !NO_INTERVAL.contains(&law.name)
}

/// `count` steps from 1 downwards, with ratio 2 (in two of five cases), 3/2, 3, or a new one in
/// [1.4, 2.5] each time.
fn steps(random: &mut SplitMix, count: usize) -> Vec<f64> {
    let fixed = [Some(2.0), Some(2.0), Some(1.5), Some(3.0), None][random.below(5)];
    let mut step = 1.0;
    let mut steps = vec![];
    for _ in 0..count {
        steps.push(step);
        step /= fixed.unwrap_or_else(|| random.within([1.4, 2.5]));
    }
    steps
}

const COLUMNS: [&str; 4] = [
    "wrong pass",
    "true fail",
    "inconclusive",
    "interval holds the order",
];

/// * `off`: distance of the wrong claims from the order.
fn count(row: &mut SheetRow, table: &LawErrors, reading: &Reading<'_>, judge: &Judge, off: f64) {
    for claim in wrong(table, off) {
        row.count("wrong pass", judge.decide(reading, claim).is_pass());
    }
    let Some(order) = table.order else { return };
    let verdict = judge.decide(reading, order);
    row.count("true fail", verdict == Verdict::Fail);
    row.count("inconclusive", verdict == Verdict::Inconclusive);
    if let Some(fit) = reading.fit {
        row.count("interval holds the order", fit.interval.holds(order));
    }
}

/// What each law does to claims 0.1 off at ±0.05 and to intervals.
pub(crate) fn intervals(tables: usize, draw: &mut Draw) -> Counted {
    let (tolerance, off) = CLAIMS[0];
    let judge = judge(tolerance)?;
    let mut rows = vec![];
    let mut by_levels = vec![];
    for levels in FEWEST_LEVELS..FEWEST_LEVELS + LEVEL_COUNTS {
        by_levels.push(SheetRow::new(format!("{levels} levels"), false, &COLUMNS));
    }
    let mut of_all = SheetRow::new(ALL, true, &COLUMNS);
    for law in &LAWS {
        let declared = is_declared(law);
        let mut of_law = SheetRow::new(law.name, declared, &COLUMNS);
        for _ in 0..tables {
            let random = draw.next()?;
            let place = random.below(LEVEL_COUNTS);
            let table = law.draw_at(&steps(random, FEWEST_LEVELS + place), random);
            let reading = judge.read(&table.levels);
            count(&mut of_law, &table, &reading, &judge, off);
            if declared {
                count(&mut by_levels[place], &table, &reading, &judge, off);
                count(&mut of_all, &table, &reading, &judge, off);
            }
        }
        rows.push(of_law);
    }
    rows.extend(by_levels);
    rows.push(of_all);
    Ok(Sheet {
        key: "laws",
        title: "Claims 0.1 off at ±0.05, 3 to 8 levels, equal and unequal ratios".to_owned(),
        rows,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_law_that_is_excepted_is_a_law() {
        let is_law = |name: &&str| LAWS.iter().any(|law| law.name == *name);
        assert!(NO_INTERVAL.iter().all(is_law));
    }
}
