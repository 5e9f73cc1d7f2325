//! The page says what the program says.

use convergence_page::{LONGEST_TEXT, judge, read, version};
use serde_json::{Value, json};

/// A table of order 2 in `L2`, of order 1 in `H1`.
const TABLE: &str = "h, L2, H1\n0.1, 1.01e-2, 1.0e-1\n0.05, 2.52e-3, 5.0e-2\n\
     0.025, 6.27e-4, 2.5e-2\n0.0125, 1.565e-4, 1.25e-2\n";

fn answer(of: fn(&str) -> String, question: &Value) -> Value {
    serde_json::from_str(&of(&question.to_string())).expect("JSON")
}

#[test]
fn a_table_has_verdicts_words_figure_and_command() {
    let question = json!({"text": TABLE, "order": ["2", "H1=1"], "tolerance": 0.2});
    let found = answer(judge, &question);
    assert_eq!(found["verdict"], "pass", "{found}");
    let text = found["text"].as_str().expect("text");
    assert!(text.contains("L2: pass"), "{text}");
    assert!(text.ends_with(&format!(
        "pass: {}\n",
        found["sentence"].as_str().expect("text")
    )));
    let table = &found["tables"][0];
    assert!(table["figure"].as_str().expect("SVG").starts_with("<svg"));
    assert_eq!(table["rows"].as_array().expect("rows").len(), 5);
    assert_eq!(table["columns"][1]["verdict"], "pass");
    assert_eq!(
        found["command"],
        "convergence-study rates FILE --order 2 --order H1=1 --tolerance 0.2"
    );
}

#[test]
fn a_lost_order_fails_with_advice() {
    let found = answer(judge, &json!({"text": TABLE, "order": ["2"]}));
    assert_eq!(found["verdict"], "fail");
    let lost = &found["tables"][0]["columns"][1];
    assert_eq!(lost["verdict"], "fail");
    assert_ne!(lost["advice"], "");
}

#[test]
fn without_a_claim_no_column_has_a_verdict() {
    let found = answer(judge, &json!({ "text": TABLE }));
    assert_eq!(found["verdict"], "inconclusive");
    assert_eq!(found["tables"][0]["columns"][0]["verdict"], Value::Null);
}

#[test]
fn how_a_table_is_read_needs_no_claim() {
    let found = answer(read, &json!({ "text": TABLE }));
    let reading = found["tables"][0]["reading"].as_str().expect("text");
    assert_eq!(reading, "step: `h`; errors: `L2`, `H1`");
    assert_eq!(found["tables"][0]["rows"][0][0], "h");
}

#[test]
fn a_refusal_names_the_place_and_the_command() {
    let text = "A study\nn, L2\n10, 1.60e-1\n20, 4.00e-2\n40, 1.00e-2\n";
    let question = json!({"text": text, "order": ["2"]});
    let refused = &answer(judge, &question)["refused"];
    assert_eq!(refused["line"], 2, "{refused}");
    assert_eq!(refused["offers"][0]["settings"], json!({"dim": 1.0}));
}

#[test]
fn what_is_left_out_and_what_is_doubted_is_shown() {
    let text = "h, L2, rate\n0.2, 4.00e-2, -\n0.1, 1.00e-2, 2.00\n0.05, 2.50e-3, 2.00\n\n0.0125\n";
    let found = answer(judge, &json!({"text": text, "order": ["2"]}));
    assert_eq!(found["verdict"], "inconclusive", "{found}");
    let table = &found["tables"][0];
    let reading = table["reading"].as_str().expect("text");
    assert!(
        reading.ends_with("left out: `rate` (the rates of `L2`)"),
        "{reading}"
    );
    let doubt = &table["doubts"][0];
    assert_eq!(doubt["because"], "outside the tables: line 6, `0.0125`");
    assert_eq!(doubt["settings"], json!({"lines": ["1-4"]}));
    let settings = json!({"text": text, "order": ["2"], "lines": ["1-4"]});
    assert_eq!(answer(judge, &settings)["verdict"], "pass");
}

#[test]
fn what_is_no_question_is_refused() {
    let words = |question: &str| -> String {
        let found: Value = serde_json::from_str(&judge(question)).expect("JSON");
        found["refused"]["message"]
            .as_str()
            .expect("words")
            .to_owned()
    };
    assert!(words("{").contains("EOF"));
    assert!(words(r#"{"text": "", "ordr": []}"#).contains("ordr"));
    let long = json!({"text": " ".repeat(LONGEST_TEXT + 1)}).to_string();
    assert!(words(&long).contains("at most 4194304 bytes; found 4194305"));
    let order = json!({"text": TABLE, "order": ["x"]}).to_string();
    assert!(words(&order).starts_with("--order x: expected a number > 0"));
    assert_eq!(version(), env!("CARGO_PKG_VERSION"));
}

#[test]
fn a_factor_round_off_and_samples_are_asked_for_as_on_the_command_line() {
    let falling = "n, error\n4, 1e-2\n5, 2.5e-3\n6, 6.25e-4\n7, 1.5625e-4\n8, 3.90625e-5\n";
    let question = json!({"text": falling, "factor": [">=3.."], "scale": 2.0, "eps": 1.2e-7});
    let found = answer(judge, &question);
    assert_eq!(found["verdict"], "pass", "{found}");
    assert_eq!(
        found["command"],
        "convergence-study rates FILE --factor '>=3..' --scale 2 --eps 1.2e-7"
    );
    let rows: String = [0.1_f64, 0.05, 0.025, 0.0125]
        .iter()
        .flat_map(|h| (0..12).map(move |k| (h, h * h * (1.0 + 0.01 * f64::from(k)))))
        .map(|(h, error)| format!("{h}, {error:e}\n"))
        .collect();
    let text = format!("h, error\n{rows}");
    let question = json!({"text": text, "order": ["2"], "samples": "rms"});
    let found = answer(judge, &question);
    assert_eq!(
        found["command"],
        "convergence-study rates FILE --order 2 --samples --of rms"
    );
    for (key, value, option) in [
        ("floor", json!(1e-9), "--floor"),
        ("factor", json!(["3"]), "--factor"),
    ] {
        let mut question = question.clone();
        question[key] = value;
        let refused = &answer(judge, &question)["refused"]["message"];
        let expected = format!("expected --samples without {option}; found both");
        assert_eq!(refused, expected.as_str());
    }
    for (key, value) in [
        ("order", json!(["2"])),
        ("dim", json!(2.0)),
        ("ratio", json!(2.0)),
    ] {
        let mut question = json!({"text": falling, "factor": ["4"]});
        question[key] = value;
        let refused = &answer(judge, &question)["refused"]["message"];
        let expected = format!("expected --factor without --{key}; found both");
        assert_eq!(refused, expected.as_str());
    }
    let wrong = json!({"text": text, "samples": "median"});
    let message = &answer(judge, &wrong)["refused"]["message"];
    assert_eq!(message, "--of: expected mean, rms or weak");
}

#[test]
fn a_command_that_is_offered_names_no_file() {
    let text = "h, L2\n0.2, 4e-2\n0.1, 1e-2\n0.05, 2.5e-3\n0.025, 6.25e-4\nmean 2.0 nan\n";
    let found = answer(judge, &json!({"text": text, "order": ["2"]}));
    let shown = found["text"].as_str().expect("text");
    assert!(
        shown.contains("convergence-study rates FILE --order 2 --lines 1-5"),
        "{shown}"
    );
}
