//! Columns that were left out by their names, and steps of two families.

use convergence_study::rates::{Choice, FrameColumn, RateTable};
use convergence_study::{Claim, Floor};

use super::forms::{Form, Law, Table, cells};
use super::{LAW, NEUTRAL, answer, in_each_form, never_pass_together, none_passes, with_each};

/// Names that once left a column out, whatever its numbers were.
const NAMES: &str = include_str!("names.txt");

/// Columns that no order 2 fits, with a point in each number.
fn lost() -> Vec<Vec<String>> {
    let over = |f: fn(f64) -> f64| cells(&LAW.steps().into_iter().map(f).collect::<Vec<f64>>());
    let ends_in = |word: &str| {
        let mut column = over(|h| 0.5 * h * h);
        column[LAW.levels - 1] = word.to_owned();
        column
    };
    // Another error but for NaN.
    let mut same = cells(&LAW.errors());
    same[LAW.levels - 1] = "nan".to_owned();
    vec![
        same,
        over(|h| 0.3 * h),
        over(|h| 0.3 * h.sqrt()),
        // It stalls, grows, tends to a constant, stands still.
        over(|h| 4.7e-3 + h * h),
        over(|h| 1e-3 * h.powf(-0.2)),
        over(|h| 0.65 + 0.1 * h * h),
        over(|_| 0.0699),
        ends_in("nan"),
        ends_in("******"),
        ends_in("diverged"),
    ]
}

/// The same, and columns that names of counts and costs explain.
fn lost_under_a_neutral_name() -> Vec<Vec<String>> {
    let scatters = [1.0, 1.64, 0.47, 0.8, 1.69].map(|factor| 0.01 * factor);
    let negative = LAW.errors().into_iter().map(|error| -error);
    let more = [
        vec![3.0, 5.0, 9.0, 14.0, 22.0],
        scatters.to_vec(),
        vec![0.0; 5],
        negative.collect(),
    ];
    let more = more.map(|column| cells(&column)).to_vec();
    [lost(), more].concat()
}

#[test]
fn no_name_leaves_out_a_column_that_is_lost() {
    none_passes(with_each(&Table::of(LAW), NAMES.lines(), &lost()));
}

#[test]
fn no_neutral_name_leaves_out_a_column_that_is_lost() {
    for errors in [&[("L2", 2.0)][..], &[("L2", 2.0), ("H1", 2.0)]] {
        let table = Table::new("h", LAW, errors);
        let columns = lost_under_a_neutral_name();
        none_passes(with_each(&table, NEUTRAL.into_iter(), &columns));
    }
}

#[test]
fn no_name_leaves_out_a_table_that_is_lost() {
    let forms = [Form::Csv, Form::JsonRecords].into_iter().cycle();
    for (name, form) in NAMES.lines().zip(forms) {
        let good = form.write(&Table::of(LAW));
        for column in lost() {
            let bad = Table::new("h", LAW, &[]).with(name, column);
            never_pass_together(&good, &form.write(&bad), "\n");
        }
    }
}

#[test]
fn no_name_leaves_out_a_column_of_a_frame() {
    let column = |name: &str, numbers: Vec<f64>| FrameColumn::of_numbers(name, numbers);
    let claim = Claim::new(2.0, 0.25);
    let passes = |columns: &[FrameColumn]| {
        let table = RateTable::from_columns(columns, "h", &Choice::default());
        table.is_ok_and(|table| {
            let mut judged = table.columns.iter();
            table.first_doubt().is_none()
                && judged.all(|column| column.judge(&claim, Floor::NONE).verdict.is_pass())
        })
    };
    let good = [column("h", LAW.steps()), column("L2", LAW.errors())];
    assert!(passes(&good));
    for name in NAMES.lines() {
        for cells in lost() {
            let number = |cell: &String| cell.parse().unwrap_or(f64::NAN);
            let numbers = cells.iter().map(number).collect();
            let both = [&good[..], &[column(name, numbers)]].concat();
            assert!(!passes(&both), "`{name}` {cells:?}");
        }
    }
}

/// A table over two steps, of which the errors are halved over the first.
fn two_families(space: &str, time: &str, ratio: f64) -> Table {
    let counts = [
        "N",
        "ny",
        "cells",
        "dofs",
        "nx",
        "steps",
        "nt",
        "time steps",
    ];
    let step = |name: &str, ratio: f64| {
        let powers = (0..5).map(|k| ratio.powi(k));
        let is_count = counts.contains(&name);
        let size = powers.map(|power| match is_count {
            true => format!("{:.0}", 64.0 * power),
            false => format!("{:.6}", 0.1 / power),
        });
        size.collect::<Vec<_>>()
    };
    let table = Table::default().with(space, step(space, 2.0));
    let errors = Law { order: 1.0, ..LAW }.errors();
    table
        .with(time, step(time, ratio))
        .with("L2", cells(&errors))
}

#[test]
fn errors_are_not_judged_over_one_of_two_steps_that_vary() {
    let mut tables = vec![];
    for space in ["N", "ny", "nx", "cells", "dofs", "h", "dx", "mesh size"] {
        for time in ["dt", "tau", "time step", "steps", "nt", "time steps"] {
            let table = two_families(space, time, std::f64::consts::SQRT_2);
            // Over the step in time, errors that are halved are of order 2.
            for order in ["1.00", "3.00"] {
                let orders = ["-", order, order, order, order];
                tables.push(table.clone().with("order", orders));
            }
            tables.push(table);
        }
    }
    none_passes(tables.into_iter());
}

#[test]
fn one_ladder_with_steps_of_both_families_is_judged() {
    in_each_form(&two_families("h", "dt", 2.0), |text| {
        answer(text, &["1"]).is_some_and(|sheet| sheet.verdict.is_pass())
    });
}
