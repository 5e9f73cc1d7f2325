//! The page says what the program says.

use convergence_page::{LONGEST_TEXT, judge, read, version};
use serde_json::{Value, json};

use crate::rows::rows;

fn answer(of: fn(&str) -> String, question: &Value) -> Value {
    serde_json::from_str(&of(&question.to_string())).expect("JSON")
}

/// What an answer has at a path: a text as it is, all else as JSON.
fn at(answer: &Value, path: &str) -> String {
    let value = answer.pointer(path).unwrap_or(&Value::Null);
    let text = value.as_str().map(str::to_owned);
    text.unwrap_or_else(|| value.to_string())
}

/// Each section has a text, and questions about it with what is answered at some paths.
#[test]
fn the_judge_answers_as_the_program_does() {
    for section in include_str!("answers.md").split("\n## ").skip(1) {
        let (heading, rest) = section.split_once("\n\n```text\n").expect("a text");
        let (text, questions) = rest.split_once("```").expect("its end");
        for part in questions.split("```json\n").skip(1) {
            let (question, answers) = part.split_once("```").expect("its end");
            let mut question: Value = serde_json::from_str(question).expect("JSON");
            question["text"] = text.into();
            let found = answer(judge, &question);
            for [path, expected] in rows(answers) {
                let is = at(&found, path);
                let piece = expected.trim_matches('…');
                let is_met = is == expected || piece != expected && is.contains(piece);
                assert!(is_met, "{heading}: {path} is {is}, not {expected}");
            }
        }
    }
}

#[test]
fn how_a_table_is_read_needs_no_claim() {
    let found = answer(
        read,
        &json!({ "text": "h, L2, H1\n0.1, 1e-2, 0.1\n0.05, 2.5e-3, 0.05\n" }),
    );
    let reading = "step: `h`; errors: `L2`, `H1`";
    assert_eq!(at(&found, "/tables/0/reading"), reading);
    assert_eq!(at(&found, "/tables/0/rows/0/0"), "h");
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
    assert_eq!(version(), env!("CARGO_PKG_VERSION"));
}

#[test]
fn samples_are_asked_for_as_on_the_command_line() {
    let rows: String = [0.1_f64, 0.05, 0.025, 0.0125]
        .iter()
        .flat_map(|h| (0..12).map(move |k| (h, h * h * (1.0 + 0.01 * f64::from(k)))))
        .map(|(h, error)| format!("{h}, {error:e}\n"))
        .collect();
    let text = format!("h, error\n{rows}");
    let question = json!({"text": text, "order": ["2"], "samples": "rms"});
    assert_eq!(
        answer(judge, &question)["command"],
        "convergence-study rates FILE --order 2 --samples --of rms"
    );
}
