//! Laws of the reader, over random tables in every form.

use convergence_study::Verdict;
use convergence_study::rates::{Choice, RateTable};
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::select;

use super::forms::{Form, Law, Table, cells};
use super::{BREAKS, answer, passes};

fn form() -> impl Strategy<Value = Form> {
    select(&Form::ALL[..])
}

/// Steps that are halved from any first one, and errors of any order near 1, 2 or 3.
fn law() -> impl Strategy<Value = Law> {
    let orders = select(vec![0.0, 0.5, 1.0, 1.9, 2.0, 2.1, 3.0]);
    (-4..5, 3..7_usize, orders, -3..2).prop_map(|(h, levels, order, constant)| Law {
        h: 0.2 * 2_f64.powi(h),
        levels,
        order,
        constant: 10_f64.powi(constant),
    })
}

fn table() -> impl Strategy<Value = Table> {
    let steps = select(vec!["h", "dt", "dx"]);
    let errors = select(vec!["L2", "H1", "max error"]);
    (law(), steps, errors)
        .prop_map(|(law, step, error)| Table::new(step, law, &[(error, law.order)]))
}

/// Names of columns that may be anything.
const NAMES: [&str; 14] = [
    "T", "ph", "B1", "beta", "column", "rho", "L1", "energy", "time", "residual", "value", "order",
    "q", "K",
];

/// A number as a code prints it, or what stands for one.
fn cell() -> impl Strategy<Value = String> {
    let number = (-9..3, 1.0..10.0)
        .prop_map(|(power, digits)| format!("{:.4e}", digits * 10_f64.powi(power)));
    let word =
        select(vec!["nan", "-", "****", "diverged", "0.0", "-1.5e-3"]).prop_map(str::to_owned);
    prop_oneof![6 => number, 1 => word]
}

/// What a text of tables is made of.
fn piece() -> impl Strategy<Value = String> {
    let pieces = include_str!("pieces.json");
    select(serde_json::from_str::<Vec<String>>(pieces).expect("texts"))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn two_tables_pass_only_if_each_does(
        tables in [table(), table()],
        forms in [form(), form()],
        between in select(&BREAKS[..]),
    ) {
        let texts = [forms[0].write(&tables[0]), forms[1].write(&tables[1])];
        let text = texts.join(between);
        if passes(&text) {
            prop_assert!(texts.iter().all(|text| passes(text)), "{text}");
        }
    }

    #[test]
    fn an_added_column_passes_alone_or_is_named_as_left_out(
        law in law(),
        form in form(),
        name in select(&NAMES[..]),
        column in vec(cell(), 7),
    ) {
        let law = Law { order: 2.0, ..law };
        let alone = Table::new("h", law, &[]).with("L2", &column);
        let text = form.write(&Table::of(law).with(name, column));
        if let Some(answer) = answer(&text, &["2"])
            && answer.verdict == Verdict::Pass
        {
            let is_named = answer.text.contains(&format!("left out: `{name}` ("));
            prop_assert!(is_named || passes(&form.write(&alone)), "{}\n{text}", answer.sentence);
        }
    }

    #[test]
    fn what_is_read_is_what_was_written(law in law(), form in form(), names in select(vec![["L2", "H1"], ["e", "max error"], ["rho", "E"]])) {
        let table = Table::new("h", law, &[(names[0], law.order), (names[1], 2.0)]);
        let text = form.write(&table);
        let read = RateTable::parse_all_with(&text, "t", &Choice::default());
        let Ok([read]) = read.as_deref() else {
            // A column that tends to a limit, and so may be a value.
            return Ok(());
        };
        prop_assert_eq!(read.columns.len(), 2, "{}", read.reading);
        for (k, column) in read.columns.iter().enumerate() {
            prop_assert_eq!(&column.name, names[k]);
            let written: Vec<f64> = table.rows.iter().map(|row| row[k + 1].parse().expect("a number")).collect();
            let numbers: Vec<f64> = column.levels.iter().map(|level| level.error).collect();
            prop_assert_eq!(numbers, written);
            let steps: Vec<f64> = column.levels.iter().map(|level| level.step).collect();
            let written: Vec<f64> = cells(&law.steps()).iter().map(|cell| cell.parse().expect("a number")).collect();
            prop_assert_eq!(steps, written);
        }
    }

    #[test]
    fn no_text_panics(pieces in vec(piece(), 0..60)) {
        let _ = answer(&pieces.concat(), &["2"]);
        let _ = answer(&pieces.join(" "), &["L2=2"]);
    }

    #[test]
    fn no_damaged_table_panics(table in table(), form in form(), damage in vec((0..400_usize, piece()), 1..6)) {
        let mut text = form.write(&table);
        for (place, piece) in damage {
            let place = place.min(text.len());
            let place = (0..=place).rev().find(|place| text.is_char_boundary(*place)).unwrap_or(0);
            text.insert_str(place, &piece);
        }
        let _ = answer(&text, &["2"]);
    }
}
