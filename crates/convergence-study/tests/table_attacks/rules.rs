//! Each row of what is set aside: what it sets aside, and what it must not.

use super::forms::{Form, Law, Table, cells};
use super::{LAW, answer, chosen, passes, request};
use convergence_study::rates::{Choice, FrameCell, FrameColumn, Page, RateTable, Request};

/// A table of order 2 in four levels with another column.
fn with(name: &str, column: &[&str]) -> Table {
    let law = Law {
        levels: column.len(),
        ..LAW
    };
    let mut table = Table::new("h", law, &[("L2", 2.0)]);
    table.add(name, column.iter().map(|cell| (*cell).to_owned()).collect());
    table
}

/// A column that is set aside for a reason, and the same column, changed so that it must not be.
struct Row {
    name: &'static str,
    aside: [&'static str; 4],
    because: &'static str,
    judged: [&'static str; 4],
}

const ROWS: [Row; 14] = [
    Row {
        name: "rate",
        aside: ["-", "2.01", "1.99", "2.00"],
        because: "the rates of `L2`",
        judged: ["-", "2.01", "1.99", "1.00"],
    },
    Row {
        name: "rate",
        aside: ["0", "2.01", "1.99", "2.00"],
        because: "the rates of `L2`",
        judged: ["0", "2.01", "-", "2.00"],
    },
    Row {
        name: "ratio",
        aside: ["-", "4.01", "3.98", "4.01"],
        because: "the factors of `L2`",
        judged: ["-", "4.01", "3.98", "3.90"],
    },
    Row {
        name: "dx",
        aside: ["0.4", "0.2", "0.1", "0.05"],
        because: "in proportion to the step",
        judged: ["0.4", "0.2", "0.1", "0.045"],
    },
    Row {
        name: "dofs",
        aside: ["81", "289", "1089", "4225"],
        because: "a count that grows as the step falls",
        judged: ["4225", "1089", "289", "81"],
    },
    Row {
        name: "iterations",
        aside: ["12", "14", "13", "15"],
        because: "whole numbers that do not fall",
        judged: ["15", "14", "13", "12"],
    },
    Row {
        name: "iterations",
        aside: ["12", "14", "13", "15"],
        because: "whole numbers that do not fall",
        judged: ["12.5", "14.5", "13.5", "15.5"],
    },
    Row {
        name: "id",
        aside: ["0", "1", "2", "3"],
        because: "numbers of the rows",
        judged: ["3", "2", "1", "0"],
    },
    Row {
        name: "wall time",
        aside: ["0.11", "0.23", "0.19", "0.22"],
        because: "a cost: at least doubles",
        judged: ["0.11", "0.23", "0.19", "0.21"],
    },
    Row {
        name: "threads",
        aside: ["8", "8", "8", "8"],
        because: "a parameter",
        judged: ["8.5", "8.5", "8.5", "8.5"],
    },
    Row {
        name: "dt",
        aside: ["0.1", "0.1", "0.1", "0.1"],
        because: "a parameter",
        judged: ["-0.1", "-0.1", "-0.1", "-0.1"],
    },
    Row {
        name: "method",
        aside: ["SIPG", "SIPG", "SIPG", "SIPG"],
        because: "labels",
        judged: ["SIPG", "SIPG", "SIPG", "diverged"],
    },
    Row {
        name: "method",
        aside: ["SIPG", "SIPG", "SIPG", "SIPG"],
        because: "labels",
        judged: ["SIPG", "SIPG", "SIPG", "max iterations reached"],
    },
    Row {
        name: "converged",
        aside: ["True", "True", "True", "True"],
        because: "true or false",
        judged: ["True", "True", "True", "False"],
    },
];

#[test]
fn each_row_sets_aside_what_it_says_and_no_more() {
    let mut wrong = vec![];
    for Row {
        name,
        aside,
        because,
        judged,
    } in ROWS
    {
        // A line with a word alone is no part of a log.
        let is_word = because == "labels";
        for form in Form::ALL
            .into_iter()
            .filter(|form| !(is_word && *form == Form::LongLog))
        {
            let text = form.write(&with(name, &aside));
            let said = format!("left out: `{name}` ({because}");
            let sheet = answer(&text, &["2"]);
            let is_said =
                sheet.is_some_and(|sheet| sheet.verdict.is_pass() && sheet.text.contains(&said));
            if !is_said {
                wrong.push(format!("{form:?}: not {said}\n{text}"));
            }
            let text = form.write(&with(name, &judged));
            if passes(&text) {
                wrong.push(format!("{form:?}: {name} {because}: passes\n{text}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn a_word_of_an_error_keeps_a_column() {
    for (name, column) in [
        ("error", ["0", "1", "2", "3"]),
        ("L2 iterations", ["12", "12", "13", "13"]),
        ("time error", ["0.1", "0.2", "0.4", "0.8"]),
        ("error p", ["-", "2.01", "1.99", "2.00"]),
        ("residual", ["1", "1", "1", "1"]),
        // Costs have words of their own: the pressure may grow.
        ("p", ["0.1", "0.2", "0.4", "0.8"]),
        ("k", ["0.1", "0.2", "0.4", "0.8"]),
    ] {
        for form in Form::ALL {
            let text = form.write(&with(name, &column));
            assert!(!passes(&text), "{form:?} {name}\n{text}");
        }
    }
}

#[test]
fn a_level_that_repeats_the_one_before_is_a_doubt() {
    let rows = "h L2\n0.4 1.600e-1\n0.2 4.000e-2\n0.1 1.000e-2\n";
    assert!(passes(rows));
    let sheet = answer(&format!("{rows}0.05 1.000e-2\n"), &["2"]).expect("a table");
    let answer = &sheet.tables[0].columns[0].answer;
    assert!(
        !sheet.verdict.is_pass() && answer.contains("a stale file"),
        "{answer}"
    );
    // Below a floor that the caller knows, errors may repeat.
    let floored = chosen_with_floor(&format!(
        "{rows}0.05 2.500e-3\n0.025 1.234e-9\n0.0125 1.234e-9\n"
    ));
    assert!(floored.verdict.is_pass(), "{}", floored.text);
}

fn chosen_with_floor(text: &str) -> Page {
    let request = Request {
        floor: 1e-8,
        ..request(&["2"], Choice::default())
    };
    request.page("rates", text).expect("a table")
}

#[test]
fn a_unit_that_all_numbers_share_is_no_part_of_them() {
    for unit in ["%", " %", "\\%", " mm", " µm"] {
        let text = format!("h;L2\n0.4;1.600e-1{unit}\n0.2;4.000e-2{unit}\n0.1;1.000e-2{unit}\n");
        assert!(passes(&text), "{text}");
        let some = text.replacen(unit, "", 1);
        assert!(answer(&some, &["2"]).is_none(), "{some}");
    }
    // Words that say something of a number are no units.
    for word in ["*", "?", "!", " (est.)", " nan", " fail", " extrapolated"] {
        let text = format!("h;L2\n0.4;0.16{word}\n0.2;0.04{word}\n0.1;0.01{word}\n");
        assert!(!passes(&text), "{text}");
    }
}

#[test]
fn names_over_several_columns_have_the_rates_of_their_errors_below() {
    let table = |name: &str, rates: [&str; 4]| {
        let row = |k: usize| {
            let h = 0.4 / f64::from(1 << k);
            format!("{h} & {:.3e} & {} \\\\\n", h * h, rates[k])
        };
        format!("h & {name} \\\\ \\hline\n") + &(0..4).map(row).collect::<String>()
    };
    let spanned = r"\multicolumn{2}{|c|}{$L^2$-error}";
    assert!(passes(&table(spanned, ["-", "2.00", "2.00", "2.00"])));
    for other in [["-", "2.00", "2.00", "1.50"], ["-", "1.00", "1.00", "1.00"]] {
        assert!(!passes(&table(spanned, other)));
    }
    // Two lines of names stay refused.
    let two = table(r"$e$ & rate", ["-", "2.00", "2.00", "2.00"]);
    assert!(passes(&two));
    assert!(!passes(&format!(
        r"& {spanned} \\{}",
        "\n".to_owned() + &two
    )));
}

#[test]
fn a_refusal_names_the_row_at_fault() {
    for (rows, line) in [
        ("0.4 0.16\n0.2 0.04*\n0.1 0.01\n", 4),
        ("0.4 0.16\n0.2 0.04\n0.3 0.01\n", 5),
        ("0.4 0.16\n0.4 0.04\n0.1 0.01\n", 4),
    ] {
        let text = format!("# a heading\nh L2\n{rows}");
        let error = RateTable::parse_with(&text, "t", &Choice::default()).expect_err(&text);
        assert_eq!(error.place.map(|place| place.line), Some(line), "{error}");
    }
}

#[test]
fn a_count_of_any_name_is_offered_as_the_step() {
    let text = "panneaux,L2\n8,4.00e-2\n16,1.00e-2\n32,2.50e-3\n";
    let error = RateTable::parse_with(text, "t", &Choice::default()).expect_err(text);
    let first = &error.offers[0].choice;
    assert_eq!(
        (first.step.as_deref(), first.dim),
        (Some("panneaux"), Some(1.0))
    );
    // Numbers of the rows are none.
    let text = "case,L2\n1,4.00e-2\n2,1.00e-2\n3,2.50e-3\n";
    let error = RateTable::parse_with(text, "t", &Choice::default()).expect_err(text);
    assert!(
        error.offers.iter().all(|offer| offer.choice.step.is_none()),
        "{error}"
    );
}

#[test]
fn a_claim_by_name_is_about_its_column_alone() {
    let mut table = Table::new("h", LAW, &[("L2", 2.0), ("H1", 1.0)]);
    table.add("seconds", cells(&[0.1, 0.4, 1.6, 6.4, 25.6]));
    let text = Form::Csv.write(&table);
    assert!(!passes(&text));
    let sheet = answer(&text, &["L2=2"]).expect("a table");
    assert!(sheet.verdict.is_pass(), "{}", sheet.text);
    assert!(sheet.text.contains("\nH1: "), "{}", sheet.text);
    // What is claimed is judged, though it would be set aside.
    let sheet = answer(&text, &["L2=2", "seconds=2"]).expect("a table");
    assert!(!sheet.verdict.is_pass(), "{}", sheet.text);
    let choice = Choice {
        columns: Some(vec!["L2".to_owned()]),
        ..Choice::default()
    };
    let sheet = chosen(&text, &["2"], choice).expect("a table");
    assert!(sheet.verdict.is_pass(), "{}", sheet.text);
}

#[test]
fn counts_need_a_dimension_and_one_family_is_chosen() {
    let counts = "cells,L2\n16,4.00e-2\n64,1.00e-2\n256,2.50e-3\n";
    assert!(answer(counts, &["2"]).is_none());
    let with_dim = |dim| Choice {
        dim: Some(dim),
        ..Choice::default()
    };
    let sheet = |dim| chosen(counts, &["2"], with_dim(dim)).expect("a table");
    assert!(sheet(2.0).verdict.is_pass());
    assert!(!sheet(1.0).verdict.is_pass());
    let edges = "mesh,L2\n16x16,4.00e-2\n32x32,1.00e-2\n64x64,2.50e-3\n";
    assert!(passes(edges));
    assert!(chosen(edges, &["2"], with_dim(2.0)).is_err());
    assert!(answer(&edges.replace("64x64", "64x32"), &["2"]).is_none());
    // The other family may be chosen, and then is no error.
    let both = "N,dt,L2\n16,0.1,4.00e-2\n32,0.05,1.00e-2\n64,0.02,2.50e-3\n";
    assert!(answer(both, &["2"]).is_none());
    let choice = Choice {
        step: Some("N".to_owned()),
        ..with_dim(1.0)
    };
    let sheet = chosen(both, &["2"], choice).expect("a table");
    assert!(
        sheet.verdict.is_pass() && sheet.text.contains("`dt` (a step of the other family)"),
        "{}",
        sheet.text
    );
    // A step is no count.
    assert!(
        chosen(
            "h,L2\n0.4,0.16\n0.2,0.04\n0.1,0.01\n",
            &["2"],
            with_dim(2.0)
        )
        .is_err()
    );
}

/// A refusal offers only what is read, and the first offer does not pass where an expert would not.
#[test]
fn each_offer_of_a_refusal_is_read() {
    for text in [
        "cells,L2\n16,4.00e-2\n64,1.00e-2\n256,2.50e-3\n",
        "N,dt,L2\n16,0.1,4.00e-2\n32,0.05,1.00e-2\n64,0.02,2.50e-3\n",
        "mesh,L2\ncoarse,4.00e-2\nmedium,1.00e-2\nfine,2.50e-3\n",
    ] {
        let error = RateTable::parse_all_with(text, "t", &Choice::default()).expect_err(text);
        assert!(!error.offers.is_empty(), "{error}");
        for offer in error.offers {
            assert!(
                RateTable::parse_all_with(text, "t", &offer.choice).is_ok(),
                "{offer:?}\n{text}"
            );
        }
    }
}

#[test]
fn frames_obey_the_same_rule() {
    let column =
        |name: &str, numbers: &[f64]| FrameColumn::of_numbers(name, numbers.iter().copied());
    let good = [column("h", &LAW.steps()), column("L2", &LAW.errors())];
    let read = |other: FrameColumn| {
        let columns = [good.to_vec(), vec![other]].concat();
        RateTable::from_columns(&columns, "h", &Choice::default())
    };
    let alone = read(column("seconds", &[0.1, 0.4, 1.6, 6.4, 25.6])).expect("a table");
    assert_eq!(alone.columns.len(), 1, "{}", alone.reading);
    assert_eq!(alone.left_out[0].column, "seconds");
    for (name, numbers) in [
        ("nodes", [5e3, 4e3, 3e3, 2e3, 1e3]),
        ("k", [0.5, 0.4, 0.3, 0.2, 0.1]),
    ] {
        let both = read(column(name, &numbers)).expect("a table");
        assert_eq!(both.columns.len(), 2, "{}", both.reading);
    }
    let words = |words: [&str; 5]| FrameColumn {
        name: "status".to_owned(),
        cells: words.map(|word| FrameCell::Word(word.to_owned())).to_vec(),
    };
    let labels = read(words(["ok"; 5])).expect("a table");
    assert_eq!(labels.left_out[0].because, "labels");
    let failed = read(words(["ok", "ok", "ok", "ok", "diverged"])).expect("a table");
    assert_eq!(failed.columns.len(), 2, "{}", failed.reading);
}
