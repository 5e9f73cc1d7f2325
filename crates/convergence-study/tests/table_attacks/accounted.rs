//! Columns that were left out by their names, and steps of two families.

use convergence_study::rates::{Choice, FrameColumn, RateTable};
use convergence_study::{Claim, Floor};

use super::forms::{Form, Law, Table, cells};
use super::{Attacks, LAW, answer, passes};

/// Names that once left a column out, whatever its numbers were.
const NAMES: [&str; 64] = [
    "k",
    "l",
    "m",
    "n",
    "i",
    "nodes",
    "cells",
    "elements",
    "mesh",
    "grid",
    "samples",
    "points",
    "resolution",
    "steps",
    "dofs",
    "temps",
    "time",
    "t_wall",
    "cpu",
    "setup",
    "solve",
    "memory",
    "cond",
    "CFL",
    "courant",
    "tol",
    "iterations",
    "its",
    "iter",
    "ms",
    "s",
    "ref",
    "reference",
    "exact",
    "analytical",
    "expected",
    "theory",
    "price",
    "value",
    "limit",
    "computed",
    "numerical",
    "status",
    "result",
    "reason",
    "state",
    "level",
    "cycle",
    "index",
    "row",
    "order",
    "rate",
    "eoc",
    "conv",
    "ratio",
    "slope",
    "p",
    "q",
    "degree",
    "method",
    "Re",
    "residual",
    "resid",
    "function norm",
];

/// Columns that no order 2 fits, with a point in each number.
fn lost() -> Vec<(&'static str, Vec<String>)> {
    let over = |f: fn(f64) -> f64| cells(&LAW.steps().into_iter().map(f).collect::<Vec<f64>>());
    let ends_in = |word: &str| {
        let mut column = over(|h| 0.5 * h * h);
        column[LAW.levels - 1] = word.to_owned();
        column
    };
    let mut same = cells(&LAW.errors());
    same[LAW.levels - 1] = "nan".to_owned();
    vec![
        ("is another error but for nan", same),
        ("falls like h", over(|h| 0.3 * h)),
        ("falls like h^0.5", over(|h| 0.3 * h.sqrt())),
        ("stalls", over(|h| 4.7e-3 + h * h)),
        ("grows", over(|h| 1e-3 * h.powf(-0.2))),
        ("tends to a constant", over(|h| 0.65 + 0.1 * h * h)),
        ("stands still", over(|_| 0.0699)),
        ("ends in nan", ends_in("nan")),
        ("ends in stars", ends_in("******")),
        ("ends in a word", ends_in("diverged")),
    ]
}

#[test]
fn no_name_leaves_out_a_column_that_is_lost() {
    let mut attacks = Attacks::default();
    for form in Form::ALL {
        for name in NAMES {
            for (what, column) in lost() {
                let mut table = Table::new("h", LAW, &[("L2", 2.0)]);
                table.add(name, column);
                attacks.add(&form.write(&table), || format!("{form:?} `{name}` {what}"));
            }
        }
    }
    attacks.none_pass();
}

#[test]
fn no_name_leaves_out_a_table_that_is_lost() {
    let mut attacks = Attacks::default();
    for form in [Form::Csv, Form::JsonRecords] {
        for name in NAMES {
            for (what, column) in lost() {
                let good = form.write(&Table::new("h", LAW, &[("L2", 2.0)]));
                let mut bad = Table::new("h", LAW, &[]);
                bad.add(name, column);
                let bad = form.write(&bad);
                for text in [format!("{good}\n{bad}"), format!("{bad}\n{good}")] {
                    attacks.add(&text, || format!("{form:?} `{name}` {what}"));
                }
            }
        }
    }
    attacks.none_pass();
}

#[test]
fn no_name_leaves_out_a_column_of_a_frame() {
    let column = |name: &str, numbers: Vec<f64>| FrameColumn::of_numbers(name, numbers);
    let claim = Claim::new(2.0, 0.25);
    let passes = |columns: &[FrameColumn]| {
        let table = RateTable::from_columns(columns, "h", &Choice::default());
        table.is_ok_and(|table| {
            let mut judged = table.columns.iter();
            table.doubts.is_empty()
                && judged.all(|column| column.judge(&claim, Floor::NONE).verdict.is_pass())
        })
    };
    let good = [column("h", LAW.steps()), column("L2", LAW.errors())];
    assert!(passes(&good));
    let mut passed = vec![];
    for name in NAMES {
        for (what, cells) in lost() {
            let number = |cell: &String| cell.parse().unwrap_or(f64::NAN);
            let numbers = cells.iter().map(number).collect();
            let columns = [good[0].clone(), good[1].clone(), column(name, numbers)];
            if passes(&columns) {
                passed.push(format!("`{name}` {what}"));
            }
        }
    }
    assert!(passed.is_empty(), "{}", passed.join("\n"));
}

#[test]
fn least_cases_do_not_pass() {
    let column = |cells: &[&str]| cells.iter().map(|cell| (*cell).to_owned()).collect();
    let law = Law { levels: 4, ..LAW };
    for form in Form::ALL {
        for (name, cells) in [
            ("rel_err", ["1", "1", "1", "1"]),
            ("Linf", ["nan", "nan", "nan", "nan"]),
            ("Linf", ["nan", "2.00", "2.00", "2.00"]),
            ("err_v", ["-", "4.0", "4.0", "4.0"]),
            ("nodes", ["4000", "2000", "1000", "500"]),
            ("k", ["4", "3", "2", "1"]),
            ("p", ["1", "2", "3", "4"]),
            ("converged", ["True", "True", "True", "False"]),
            ("converged", ["1", "1", "1", "0"]),
        ] {
            let mut table = Table::new("h", law, &[("L2", 2.0)]);
            table.add(name, column(&cells));
            let text = form.write(&table);
            assert!(!passes(&text), "{form:?} {name}:\n{text}");
        }
    }
}

#[test]
fn what_a_name_and_the_numbers_say_alike_is_left_out() {
    let column = |cells: &[&str]| cells.iter().map(|cell| (*cell).to_owned()).collect();
    for form in Form::ALL {
        for (name, cells) in [
            ("iterations", ["12", "12", "13", "13", "14"]),
            ("time", ["0.11", "0.23", "0.51", "1.20", "3.10"]),
            ("dofs", ["81", "289", "1089", "4225", "16641"]),
            ("level", ["0", "1", "2", "3", "4"]),
            ("threads", ["8", "8", "8", "8", "8"]),
            ("dy", ["0.4", "0.2", "0.1", "0.05", "0.025"]),
        ] {
            let mut table = Table::new("h", LAW, &[("L2", 2.0)]);
            table.add(name, column(&cells));
            let text = form.write(&table);
            let sheet = answer(&text, &["2"]);
            let is_left_out = sheet.is_some_and(|sheet| {
                sheet.verdict.is_pass() && sheet.text.contains(&format!("`{name}` ("))
            });
            assert!(is_left_out, "{form:?} {name}:\n{text}");
        }
    }
}

/// A table over two steps, of which the errors are halved over the first.
fn two_families(space: &str, time: &str, ratio: f64, orders: Option<&str>) -> Table {
    let law = Law { order: 1.0, ..LAW };
    let step = |name: &str, ratio: f64| -> Vec<String> {
        let over = |first: f64, sign: i32| {
            (0..5)
                .map(move |k: i32| first * ratio.powi(sign * k))
                .collect::<Vec<f64>>()
        };
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
        if counts.contains(&name) {
            over(64.0, 1)
                .iter()
                .map(|count| format!("{count:.0}"))
                .collect()
        } else {
            over(0.1, -1)
                .iter()
                .map(|step| format!("{step:.6}"))
                .collect()
        }
    };
    let mut table = Table {
        names: vec![space.to_owned()],
        rows: step(space, 2.0)
            .into_iter()
            .map(|cell| vec![cell])
            .collect(),
    };
    table.add(time, step(time, ratio));
    table.add("L2", cells(&law.errors()));
    if let Some(order) = orders {
        let mut column = vec![order.to_owned(); 5];
        column[0] = "-".to_owned();
        table.add("order", column);
    }
    table
}

#[test]
fn errors_are_not_judged_over_one_of_two_steps_that_vary() {
    let mut attacks = Attacks::default();
    let root = std::f64::consts::SQRT_2;
    for form in Form::ALL {
        for space in ["N", "ny", "nx", "cells", "dofs", "h", "dx", "mesh size"] {
            for time in ["dt", "tau", "time step", "steps", "nt", "time steps"] {
                // Over the step in time, errors that are halved are of order 2.
                for orders in [None, Some("1.00"), Some("2.00"), Some("3.00")] {
                    let is_right = orders == Some("2.00");
                    let text = form.write(&two_families(space, time, root, orders));
                    if !is_right {
                        attacks.add(&text, || {
                            format!("{form:?} {space} {time} {orders:?}\n{text}")
                        });
                    }
                }
            }
        }
    }
    attacks.none_pass();
}

#[test]
fn printed_rates_choose_the_step_of_two_that_vary() {
    let fails_over = |text: &str, label: &str| {
        let sheet = answer(text, &["2"]);
        sheet.is_some_and(|sheet| !sheet.verdict.is_pass() && sheet.text.contains(label))
    };
    // Errors halve with each mesh, and with each second step in time.
    let first = "| N | dt | L2 | order |\n|---|---|---|---|\n\
                 | 20 | 0.2 | 2.0e-02 | |\n| 40 | 0.1414 | 1.0e-02 | 1.00 |\n\
                 | 80 | 0.1 | 5.0e-03 | 1.00 |\n| 160 | 0.0707 | 2.5e-03 | 1.00 |\n";
    assert!(fails_over(first, "step: `1/N`"));
    let counts = "| ny | steps | L2 | order |\n|---|---|---|---|\n\
                  | 10 | 200 | 3.0000e-02 | |\n| 20 | 283 | 1.5000e-02 | 1.00 |\n\
                  | 40 | 400 | 7.5000e-03 | 1.00 |\n| 80 | 566 | 3.7500e-03 | 1.00 |\n";
    assert!(fails_over(counts, "step: `1/ny`"));
    // Errors of order 2 over the mesh, with steps in time that fall like its square.
    let right = "| N | dt | L2 | order |\n|---|---|---|---|\n\
                 | 8 | 4e-2 | 4.0e-02 | |\n| 16 | 1e-2 | 1.0e-02 | 2.00 |\n\
                 | 32 | 2.5e-3 | 2.5e-03 | 2.00 |\n| 64 | 6.25e-4 | 6.25e-04 | 2.00 |\n";
    let sheet = answer(right, &["2"]).expect("a table");
    assert!(sheet.verdict.is_pass(), "{}", sheet.text);
    assert!(
        sheet
            .text
            .contains("left out: `dt` (a step of the other family)"),
        "{}",
        sheet.text
    );
}

#[test]
fn one_ladder_with_steps_of_both_families_is_judged() {
    for form in Form::ALL {
        let text = form.write(&two_families("h", "dt", 2.0, None));
        let sheet = answer(&text, &["1"]);
        assert!(
            sheet.is_some_and(|sheet| sheet.verdict.is_pass()),
            "{form:?}:\n{text}"
        );
    }
}

#[test]
fn a_chosen_step_leaves_out_the_step_of_the_other_family() {
    let text = Form::Csv.write(&two_families("N", "dt", 4.0, None));
    let choice = |step: &str, dim| Choice {
        step: Some(step.to_owned()),
        dim,
        ..Choice::default()
    };
    for (choice, other) in [(choice("dt", None), "N"), (choice("N", Some(1.0)), "dt")] {
        let table = RateTable::parse_with(&text, "f", &choice).expect("a table");
        assert_eq!(table.columns.len(), 1, "{}", table.reading);
        assert_eq!(table.left_out[0].column, other);
    }
    let refusal = RateTable::parse_with(&text, "f", &Choice::default()).unwrap_err();
    assert!(
        refusal
            .to_string()
            .contains("one of the steps, in space or in time, found `N`, `dt`"),
        "{refusal}"
    );
}

#[test]
fn printed_rates_of_another_step_are_a_doubt() {
    for name in ["order", "rate", "EOC"] {
        let mut text = format!("h L2 {name}\n");
        for (k, (h, error)) in LAW.steps().iter().zip(LAW.errors()).enumerate() {
            let rate = if k == 0 { "-" } else { "1.00" };
            text += &format!("{h} {error:e} {rate}\n");
        }
        let sheet = answer(&text, &["2"]).expect("a table");
        let said = format!("`{name}` is named like rates, and fits no error over the step");
        assert!(
            !sheet.verdict.is_pass() && sheet.sentence.contains(&said),
            "{}",
            sheet.sentence
        );
    }
}

#[test]
fn lists_of_rates_below_the_names_of_meshes_are_no_values() {
    let mut text: String = (2..8)
        .map(|k| format!("Now solving {0}x{0}...\n", 1 << k))
        .collect();
    text += "[1.64 1.9 1.974 1.9935 1.9984]\n[0.833 0.9554 0.9886 0.99714 0.99928]\n";
    assert!(answer(&text, &["2"]).is_none_or(|sheet| !sheet.verdict.is_pass()));
}
