//! The judge of tables for a page in a browser: three functions over JSON, [`version`], [`read`]
//! and [`judge`]. The words, numbers and figures are those of the command `rates`, made by the same
//! code.
//!
//! `memory.rs` is what JavaScript calls: no generator of glue takes part. `page/` has the markup,
//! the style and the script; `.ci/page` makes one file of all.

mod memory;
mod question;
mod refused;

use convergence_study::rates::{NotJudged, Request};
use serde_json::{Value, json};

use question::Question;
use refused::Refused;

/// The program in the commands that the page offers.
const PROGRAM: &str = "convergence-study";
/// The file in these commands, whose name the reader puts in place.
const FILE: &str = "FILE";
/// Longest text that is judged, in bytes: 100,000 rows of forty characters.
pub const LONGEST_TEXT: usize = 4 << 20;

/// The version of the program whose words and numbers these are.
pub fn version() -> &'static str {
    env!("CARGO_PKG_VERSION")
}

/// How the tables of a text are read: a JSON object with `tables`, or with `refused`.
///
/// * `question`: a JSON object with `text`, and the options of the command `rates` under their
///   names.
pub fn read(question: &str) -> String {
    answered(question, |question| {
        let page = page_of(&question.text, &question.request()?)?;
        let tables = page["tables"].as_array().into_iter().flatten();
        let read = tables.map(|table| {
            json!({
                "name": table["name"],
                "reading": table["reading"],
                "rows": table["rows"],
            })
        });
        Ok(json!({ "tables": read.collect::<Vec<_>>() }))
    })
}

/// What is found in the tables of a text: the object of [`Request::page`] with `command`, which
/// finds the same in a file, or an object with `refused`.
///
/// * `question`: a JSON object with `text`, and the options of the command `rates` under their
///   names.
pub fn judge(question: &str) -> String {
    answered(question, |question| {
        let request = question.request()?;
        let mut page = page_of(&question.text, &request)?;
        page["command"] = json!(request.command(PROGRAM, FILE));
        Ok(page)
    })
}

/// # Errors
/// The refusal in the words of the command line.
fn page_of(text: &str, request: &Request) -> Result<Value, Refused> {
    let refused =
        |refusal: NotJudged| Refused::of(refusal.object(&request.command_line(PROGRAM, FILE)));
    request.page(PROGRAM, text).map_err(refused)
}

/// The answer to a question, as text; a question that cannot be read is refused.
fn answered(question: &str, answer: fn(&Question) -> Result<Value, Refused>) -> String {
    let question = Question::of_json(question);
    let answer = question.and_then(|question| answer(&question));
    answer
        .unwrap_or_else(|refused| json!({ "refused": refused }))
        .to_string()
}
