//! The tables of errors in a report: each error with its rate, none too wide, none with gaps.

use crate::{Finished, LevelErrors, NamedNumber, NamedRate, Table, judge_pairs, report::tables};

use super::fake::{finished, passing};

/// Errors of several names, each with its order, on levels that may lack some of them.
pub(super) fn judged(names: &[(&str, f64)], lacks: impl Fn(usize, usize) -> bool) -> Finished {
    let mut finished = finished(vec![passing("a")]).remove(0);
    let steps = || (0..6).map(|level| 0.5_f64.powi(level + 3));
    let outcome = &mut finished.outcome;
    outcome.levels = steps()
        .enumerate()
        .map(|(level, h)| {
            let present = names.iter().enumerate().filter(|(k, _)| !lacks(*k, level));
            let errors = present
                .map(|(_, (name, order))| NamedNumber::new(*name, h.powf(*order)))
                .collect();
            let parameters = vec![NamedNumber::new("cells", 1.0 / h)];
            LevelErrors {
                parameters,
                step: Some(h),
                work: None,
                errors,
                without: vec![],
            }
        })
        .collect();
    let rate = |(k, (name, order)): (usize, &(&str, f64))| {
        let pairs = steps()
            .enumerate()
            .filter(|(level, _)| !lacks(k, *level))
            .map(|(_, h)| (h, h.powf(*order)));
        NamedRate::new(*name, judge_pairs(pairs, *order, 0.05))
    };
    outcome.rates = names.iter().enumerate().map(rate).collect();
    finished
}

fn errors_of(finished: &Finished) -> Vec<Table> {
    tables(finished)
        .into_iter()
        .filter(|table| table.title.starts_with("Errors"))
        .collect()
}

#[test]
fn the_rate_from_the_level_before_stands_beside_each_error() {
    let tables = errors_of(&judged(&[("L2", 2.0), ("H1", 1.0)], |_, _| false));
    assert_eq!(tables.len(), 1);
    assert_eq!(tables[0].head, ["cells", "L2", "rate", "H1", "rate"]);
    assert_eq!(tables[0].rows[0], ["8", "1.562e-2", "-", "1.250e-1", "-"]);
    assert_eq!(
        tables[0].rows[5],
        ["256", "1.526e-5", "2.000", "3.906e-3", "1.000"]
    );
    // An unjudged number has no rate.
    let mut unclaimed = judged(&[("L2", 2.0), ("H1", 1.0)], |_, _| false);
    unclaimed.outcome.rates.pop();
    assert_eq!(errors_of(&unclaimed)[0].head, ["cells", "L2", "rate", "H1"]);
}

#[test]
fn many_errors_are_several_tables_of_which_none_is_wide() {
    let names: Vec<String> = (0..20).map(|k| format!("norm number {k}")).collect();
    let names: Vec<(&str, f64)> = names.iter().map(|name| (name.as_str(), 2.0)).collect();
    let tables = errors_of(&judged(&names, |_, _| false));
    let width = |table: &Table| {
        let widest = |k: usize| {
            table
                .rows
                .iter()
                .chain([&table.head])
                .map(|row| row[k].chars().count())
                .max()
                .unwrap()
        };
        (0..table.head.len()).map(|k| widest(k) + 3).sum::<usize>()
    };
    assert!(
        tables.len() > 2 && tables.iter().all(|table| width(table) <= 120),
        "{tables:?}"
    );
    let shown: Vec<&String> = tables
        .iter()
        .flat_map(|table| &table.head)
        .filter(|name| name.starts_with("norm"))
        .collect();
    assert_eq!(
        shown,
        names.iter().map(|(name, _)| name).collect::<Vec<_>>()
    );
}

#[test]
fn errors_on_other_levels_are_a_table_without_gaps() {
    let tables = errors_of(&judged(&[("coarse", 1.0), ("fine", 2.0)], |k, level| {
        (k == 0) == (level >= 3)
    }));
    assert_eq!(
        tables
            .iter()
            .map(|table| table.rows.len())
            .collect::<Vec<_>>(),
        [3, 3]
    );
    assert_eq!(tables[1].rows[0], ["64", "2.441e-4", "-"]);
    assert_eq!(tables[1].rows[1][2], "2.000");
}
