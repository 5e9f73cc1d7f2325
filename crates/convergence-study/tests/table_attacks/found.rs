//! Texts that passed once, though a column of theirs had lost its order or its numbers.

use convergence_study::{Choice, RateTable};

use super::forms::{Form, Table, cells};
use super::{LAW, answer, passes};

/// A table with one more column.
fn with(name: &str, column: &[&str]) -> Table {
    let mut table = Table::new("h", LAW, &[("L2", 2.0)]);
    let column = column.iter().map(|cell| (*cell).to_owned());
    table.add(name, column.collect());
    table
}

#[test]
fn an_error_that_stands_still_at_one_is_not_the_rate_of_another() {
    let over = |f: fn(f64) -> f64| cells(&LAW.steps().into_iter().map(f).collect::<Vec<f64>>());
    for form in Form::ALL {
        for number in [1.0, 2.0] {
            let mut table = Table::new("h", LAW, &[]);
            table.add("L2", over(|h| 0.7 * h * h));
            table.add("H1", over(|h| 0.3 * h));
            let orders = ["2", "H1=1"];
            let verdict = |table: &Table| {
                answer(&form.write(table), &orders).is_some_and(|answer| answer.verdict.is_pass())
            };
            assert!(verdict(&table), "{form:?}");
            table.add("T", cells(&[number; 5]));
            assert!(!verdict(&table), "{form:?} {number}");
        }
    }
}

#[test]
fn a_column_of_one_whole_number_does_not_count_the_rows() {
    for form in Form::ALL {
        for number in ["0", "1"] {
            let text = form.write(&with("T", &[number; 5]));
            assert!(!passes(&text), "{form:?}:\n{text}");
        }
    }
}

#[test]
fn a_name_with_a_difference_is_that_of_an_error() {
    for name in [
        "u_exact_diff",
        "difference to reference",
        "e_time",
        "time error",
        "memory_err",
    ] {
        for form in Form::ALL {
            let text = form.write(&with(name, &["3e-2", "8e-3", "5e-3", "4.8e-3", "4.75e-3"]));
            assert!(!passes(&text), "{form:?}:\n{text}");
        }
    }
}

#[test]
fn a_word_in_a_list_of_numbers_is_a_level_without_a_result() {
    for word in ["OOM", "lost", "?", "did not converge", "-nan(ind)", "…"] {
        let text = format!(
            "{{\"h\": [0.2, 0.1, 0.05, 0.025],\n\"L2\": [4e-2, 1e-2, 2.5e-3, 6.25e-4],\n\
             \"T\": [4e-2, 1e-2, 2.5e-3, \"{word}\"]}}\n"
        );
        assert!(!passes(&text), "{text}");
    }
}

#[test]
fn a_column_without_any_number_is_named() {
    for word in ["#N/A", "#DIV/0!", "n/c", "lost", "x", "∞", "OOM", "div."] {
        for form in [Form::ALL[0], Form::ALL[1]] {
            let text = form.write(&with("T", &[word; 5]));
            let answer = answer(&text, &["2"]);
            assert!(
                answer.is_none_or(
                    |answer| !answer.verdict.is_pass() || answer.sentence.contains("T (words)")
                ),
                "{form:?}:\n{text}"
            );
        }
    }
}

#[test]
fn a_mark_of_failure_is_read_the_right_way_round() {
    for (name, good, bad) in [
        ("failed", "False", "True"),
        ("diverged", "0", "1"),
        ("converged_reason", "2", "-5"),
    ] {
        for form in Form::ALL {
            let all = form.write(&with(name, &[good; 5]));
            assert!(passes(&all), "{form:?}:\n{all}");
            let one = form.write(&with(name, &[good, good, good, good, bad]));
            assert!(!passes(&one), "{form:?}:\n{one}");
        }
    }
}

#[test]
fn two_lists_of_json_are_two_tables() {
    let bad =
        "[{\"h\": 3.2, \"L2\": 0.28},\n{\"h\": 1.6, \"L2\": 0.14},\n{\"h\": 0.8, \"L2\": 0.07}]\n";
    let good = "[{\"h\": 0.4, \"L2\": 0.035},\n{\"h\": 0.2, \"L2\": 8.75e-3},\n\
                {\"h\": 0.1, \"L2\": 2.1875e-3},\n{\"h\": 0.05, \"L2\": 5.46875e-4}]\n";
    assert!(passes(good));
    assert!(!passes(&format!("{bad}{good}")));
}

#[test]
fn what_a_text_says_beside_its_tables_is_said() {
    let rows = "0.2 4e-2\n0.1 1e-2\n0.05 2.5e-3\n0.025 6.25e-4\n";
    let text = format!("started at 12:00\nrun on 8 ranks\nh L2\n{rows}");
    let sheet = answer(&text, &["2"]).expect("a table");
    assert!(sheet.verdict.is_pass() && sheet.text.contains("outside the tables: 1 line"));

    // `order` prints what theory says, not what the errors do.
    let text = "h L2 order\n0.2 4e-2 -\n0.1 1e-2 3.00\n0.05 2.5e-3 3.00\n0.025 6.25e-4 3.00\n";
    let sheet = answer(text, &["2"]).expect("a table");
    let said = "order (a rate, but of no column: 3)";
    assert!(sheet.sentence.contains(said), "{}", sheet.sentence);
}

#[test]
fn a_step_in_another_unit_is_said_and_does_not_pass() {
    let steps = ["100", "50", "25", "12.5", "6.25", "0.003125"];
    let mut text = "h L2\n".to_owned();
    for (k, step) in steps.iter().enumerate() {
        text += &format!("{step} {:e}\n", 0.25_f64.powi(k as i32));
    }
    let sheet = answer(&text, &["2"]).expect("a table");
    assert!(!sheet.verdict.is_pass() && sheet.sentence.contains("another unit?"));
    // Errors that follow a real gap are those of one unit.
    let text = "h L2\n0.8 0.64\n0.4 0.16\n0.2 0.04\n0.1 0.01\n0.005 2.5e-5\n0.0025 6.25e-6\n";
    assert!(passes(text));
}

#[test]
fn counts_of_adaptive_meshes_are_said_with_quiet_too() {
    let dofs = [100, 230, 470, 1100, 2300, 5100];
    let mut text = "dofs,L2\n".to_owned();
    for count in dofs {
        text += &format!("{count},{:e}\n", 3.0 / f64::from(count));
    }
    let choice = Choice {
        dim: Some(2.0),
        ..Choice::default()
    };
    let table = RateTable::parse_with(&text, "t", &choice).expect("a table");
    assert!(table.is_guessed && table.reading.contains("grow by 2 to 2.3, as along an edge"));
}

#[test]
fn orders_of_several_methods_are_not_offered_as_levels() {
    for name in ["order", "p", "degree", "FD order", "stencil"] {
        let text = format!(
            "| {name} | 2 | 4 | 6 | 8 |\n|---|---|---|---|---|\n| error | 4e-2 | 1e-2 | 2.5e-3 | 6.25e-4 |\n"
        );
        let error = RateTable::parse_with(&text, "t", &Choice::default()).expect_err("no step");
        assert!(error.offers.is_empty(), "{name}: {error}");
        assert!(
            error.to_string().contains("orders of methods, no steps"),
            "{name}: {error}"
        );
    }
}

#[test]
fn a_row_that_cannot_be_read_is_said_by_the_verdict() {
    let rows = "h L2\n0.2 4e-2\n0.1 1e-2\n0.05 2.5e-3\n0.025 6.25e-4\n";
    assert!(
        !answer(rows, &["2"])
            .expect("a table")
            .sentence
            .contains("outside")
    );
    for row in [
        "finest 6e-4",
        "# 0.0125 6e-4",
        "~0.0125 6e-4",
        "(0.0125 6e-4)",
    ] {
        let sheet = answer(&format!("{rows}{row}\n"), &["2"]).expect("a table");
        let said = "outside the tables: 1 line of numbers, from line 6";
        assert!(sheet.sentence.contains(said), "{row}: {}", sheet.sentence);
        assert!(!sheet.verdict.is_pass(), "{row}");
    }
}

/// A table of another form beside one that passes: what is not read may have lost its order.
#[test]
fn rows_of_a_form_that_is_not_read_do_not_pass() {
    let stamped = |k: i32| {
        let [h, error] = [0.5_f64, 0.25].map(|ratio| ratio.powi(k));
        format!("2024-03-01 12:00:0{k},123 INFO h={h} L2={error:e}\n")
    };
    let stamped: String = (2..7).map(stamped).collect();
    let arrays = "array([[0.4, 0.16],\n[0.2, 0.04],\n[0.1, 0.01],\n[0.05, 0.0025]])\n";
    let lists = "{\"h\": [0.4, 0.2, 0.1, 0.05], \"L2\": [0.16, 0.04, 0.01, 0.0025]}\n";
    let turned = "h  0.4  0.2  0.1  0.05\nL2 0.16 0.04 0.01 0.0025\nH1 0.8 0.2 0.05 0.0125\n";
    let bad = [
        "h,L2\n0.2,0.31\n0.1,0.22\n0.05,0.16\n0.025,0.11\n",
        "h = 0.2, L2 = 0.31\nh = 0.1, L2 = 0.22\nh = 0.05, L2 = 0.16\n",
        "{\"h\": [0.2, 0.1, 0.05], \"L2\": [0.31, 0.22, 0.16]}\n",
        "[{\"h\": 0.2, \"L2\": 0.31}, {\"h\": 0.1, \"L2\": 0.22}, {\"h\": 0.05, \"L2\": 0.16}]\n",
        "| h | L2 |\n|---|---|\n| 0.2 | 0.31 |\n| 0.1 | 0.22 |\n| 0.05 | 0.16 |\n",
    ];
    let rows = "h L2\n0.4 0.16\n0.2 0.04\n0.1 0.01\n0.05 0.0025\n";
    for good in [stamped.as_str(), arrays, lists, turned, rows] {
        assert!(passes(good), "{good}");
        for bad in bad {
            for between in ["", "\n", "=====\n", "P2 elements\n"] {
                for text in [[good, between, bad].concat(), [bad, between, good].concat()] {
                    assert!(!passes(&text), "{text}");
                }
            }
        }
    }
}

#[test]
fn a_failure_in_the_first_column_or_the_only_one_is_a_level() {
    for row in ["****", "diverged", "nan"] {
        let text = format!("L2 h\n0.16 0.4\n0.04 0.2\n0.01 0.1\n{row} 0.05\n");
        assert!(!passes(&text), "{text}");
        let text = format!("L2\n0.16\n0.04\n0.01\n{row}\n");
        let choice = Choice {
            ratio: Some(2.0),
            ..Choice::default()
        };
        let table = RateTable::parse_with(&text, "t", &choice).expect("a table");
        assert!(table.columns[0].levels[3].error.is_nan(), "{text}");
    }
}

#[test]
fn a_failed_run_is_quoted_below_a_list_without_names() {
    let text = "[0.4, 0.2, 0.1, 0.05]\n[0.16, 0.04, 0.01, 0.0025]\n";
    assert!(passes(text));
    assert!(!passes(&format!(
        "{text}Traceback (most recent call last):\n"
    )));
}

#[test]
fn a_table_without_errors_beside_another_is_said_by_the_verdict() {
    let good = "h L2\n0.2 4e-2\n0.1 1e-2\n0.05 2.5e-3\n\n";
    let costs = format!("{good}h iterations\n0.2 12\n0.1 14\n0.05 14\n");
    let sheet = answer(&costs, &["2"]).expect("a table");
    assert!(
        sheet.verdict.is_pass() && sheet.sentence.contains("(a table without errors)"),
        "{}",
        sheet.sentence
    );
    // What is named like a value may be an error that stalls.
    let values = format!("{good}h value\n0.2 1.5\n0.1 1.2\n0.05 1.1\n");
    let sheet = answer(&values, &["2"]).expect("a table");
    assert!(
        !sheet.verdict.is_pass() && sheet.sentence.contains("a table is not read"),
        "{}",
        sheet.sentence
    );
}

#[test]
fn a_name_with_a_word_on_each_level_is_said() {
    for form in [Form::Log, Form::LongLog, Form::JsonLines, Form::JsonRecords] {
        let sheet = answer(&form.write(&with("T", &["lost"; 5])), &["2"]).expect("a table");
        assert!(
            sheet.sentence.contains("T (words)"),
            "{form:?}: {}",
            sheet.sentence
        );
    }
}

#[test]
fn forms_of_papers_and_codes_are_read() {
    let paper = r"\begin{tabular}{c|cc|cc}
\multirow{2}{*}{$N$} & \multicolumn{2}{c|}{$k=1$} & \multicolumn{2}{c}{$k=2$} \\ \cline{2-5}
 & error & order & error & order \\ \hline
$4\times 4$ & 4.0e-2 & - & 8.0e-3 & - \\
$8\times 8$ & 1.0e-2 & 2.00 & 1.0e-3 & 3.00 \\
$16\times 16$ & 2.5e-3 & 2.00 & 1.25e-4 & 3.00 \\
$32\times 32$ & 6.25e-4 & 2.00 & 1.5625e-5 & 3.00 \\
\end{tabular}
";
    let mesher = |k: i32| {
        let [h, error] = [2.0_f64, 4.0].map(|ratio| ratio.powi(-k));
        format!(
            "Info : Meshing 2D...\nInfo : {} nodes\nInfo : Done meshing 2D (0.1s)\nmesh size: {h}\nerror: {error:e}\n",
            10 << k
        )
    };
    let log: String = (2..7).map(mesher).collect();
    for (text, orders) in [(paper, &["k=1=2", "k=2=3"][..]), (&log, &["2"])] {
        let sheet = answer(text, orders).unwrap_or_else(|| panic!("refused: {text}"));
        assert!(sheet.verdict.is_pass(), "{}", sheet.text);
    }
}

/// A line of nothing but separators between some rows begins another table, as a blank line does;
/// one between all rows parts nothing.
#[test]
fn a_line_of_separators_between_some_rows_cuts() {
    let log = |k: i32| format!("h = {}, L2 = {:e}\n", 0.5_f64.powi(k), 0.25_f64.powi(k));
    let json = |k: i32| {
        let [h, error] = [0.5_f64, 0.25].map(|ratio| ratio.powi(k));
        format!("{{\"h\": {h}, \"L2\": {error:e}}}\n")
    };
    let rows: [&dyn Fn(i32) -> String; 2] = [&log, &json];
    for row in rows {
        let rows: Vec<String> = (2..8).map(row).collect();
        assert!(passes(&rows.concat()));
        for separator in [",\n", ";\n", "\"\"\n", " , \n"] {
            // Of the second table there are too few levels.
            let two = [rows[..4].concat(), separator.to_owned(), rows[4..].concat()];
            assert!(!passes(&two.concat()), "{}", two.concat());
            let all = rows.join(separator);
            assert!(passes(&all), "{all}");
        }
    }
}

/// Variables in rows, as AMReX prints them, with the steps in the head or the rates of halved
/// steps.
#[test]
fn variables_in_rows_are_no_steps() {
    let with_steps = "L1 errors\n          dx=1/32     dx=1/64     dx=1/128\n\
        density   3.9837e-03  9.9939e-04  2.5004e-04\n\
        xmom      1.2034e-02  3.0295e-03  7.5843e-04\n";
    let with_rates = "Variable  dx=1/32     Rate   dx=1/64     Rate   dx=1/128\n\
        density   3.9837e-03  1.995  9.9939e-04  1.999  2.5004e-04\n\
        xmom      1.2034e-02  1.990  3.0295e-03  1.998  7.5843e-04\n";
    let in_markdown = "| Variable | dx=1/32 | Order | dx=1/64 | Order | dx=1/128 |\n|---|---|---|---|---|---|\n\
        | density | 3.98e-3 | 2.0 | 9.99e-4 | 2.0 | 2.50e-4 |\n\
        | xmom | 1.20e-2 | 2.0 | 3.03e-3 | 2.0 | 7.58e-4 |\n";
    for text in [with_steps, with_rates, in_markdown] {
        let answer = answer(text, &["2"]).expect("a table");
        let table = &answer.tables[0];
        assert!(answer.verdict.is_pass(), "{text}{}", answer.text);
        assert_eq!(table.reading, "step: `dx`; errors: `density`, `xmom`");
        assert_eq!(table.rows[1][0].trim(), "0.03125", "{text}");
    }
    let by_rates = answer(&with_rates.replace("dx=1/", "run"), &["2"]).expect("a table");
    let reading =
        "step: `2^(-row)`, as the rates between the errors say; errors: `density`, `xmom`";
    assert_eq!(by_rates.tables[0].reading, reading);
    // Neither steps nor rates: no variable is the step, or offered as one, and none is skipped.
    let alone = "flux      3.0e-01  1.5e-01  7.5e-02\n\
        density   3.9837e-03  9.9939e-04  2.5004e-04\n";
    let error = RateTable::parse_with(alone, "t", &Choice::default()).unwrap_err();
    let offers = &error.offers;
    assert!(
        offers.iter().all(|offer| offer.choice.step.is_none()),
        "{error}"
    );
    assert!(
        offers.iter().any(|offer| offer.choice.ratio == Some(2.0)),
        "{error}"
    );
    let flux = "flux      3.0e-01     1.5e-01     7.5e-02\ndensity ";
    assert!(!passes(&with_steps.replace("density ", flux)));
    let zero = "flux      0.0  0.0  0.0  0.0  0.0\ndensity ";
    assert!(!passes(&with_rates.replace("density ", zero)));
    let body = with_rates.split_once('\n').expect("a head").1;
    let text = format!("flux  0.0  -  0.0  -  0.0\n{body}");
    let sentence = answer(&text, &["2"]).expect("a table").sentence;
    assert!(
        sentence.contains("1 line of numbers, from line 1"),
        "{sentence}"
    );
}

#[test]
fn a_list_of_words_alone_is_named_or_fails() {
    for (list, words) in [
        (r#"["lost", "lost", "lost", "lost"]"#, "T (words)"),
        (
            "[\n\"no result\",\n\"no result\",\n\"no result\",\n\"lost\"\n]",
            "T (words)",
        ),
        (
            r#"["diverged", "diverged", "diverged", "diverged"]"#,
            "1 of 2",
        ),
        ("[nan, nan, nan, nan]", "1 of 2"),
    ] {
        for last in [false, true] {
            let step = r#""h": [0.4, 0.2, 0.1, 0.05]"#;
            let errors = r#""L2": [0.16, 0.04, 0.01, 0.0025]"#;
            let text = if last {
                format!("{{{step}, {errors}, \"T\": {list}}}")
            } else {
                format!("{{{step}, \"T\": {list}, {errors}}}")
            };
            let answer = answer(&text, &["2"]).expect("a table");
            assert!(
                answer.sentence.contains(words),
                "{text}\n{}",
                answer.sentence
            );
        }
    }
}
