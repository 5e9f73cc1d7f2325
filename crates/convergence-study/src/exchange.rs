//! What other programs read: the JSON object of a command, and the fields of CSV.

use serde::Serialize;
use serde_json::{Value, json};

use convergence_judge::verdict::Verdict;

/// Version of the format of [`Printed`]: increased when a key of any command changes its meaning or
/// disappears.
const SCHEMA: u32 = 2;

/// The JSON object of a command: its verdict, then what it found.
#[derive(Serialize)]
pub(crate) struct Printed<'a, T> {
    schema: u32,
    verdict: &'static str,
    #[serde(flatten)]
    found: &'a T,
}

/// How the object of a command begins as text, in every version.
#[cfg(feature = "command-line")]
pub(crate) const BEGINNING: &str = "{\n  \"schema\": ";

impl<'a, T: Serialize> Printed<'a, T> {
    pub(crate) fn new(verdict: Verdict, found: &'a T) -> Self {
        Self {
            schema: SCHEMA,
            verdict: verdict.name(),
            found,
        }
    }
}

/// The JSON object of a command.
pub(crate) fn object(verdict: Verdict, found: &Value) -> Value {
    json!(Printed::new(verdict, found))
}

/// The JSON object of a command that has no result: why.
#[cfg(feature = "command-line")]
pub(crate) fn refused(refusal: &Value) -> Value {
    json!({"schema": SCHEMA, "refused": refusal})
}

/// A field of a CSV line, in quotes if needed (RFC 4180).
///
/// A text that a spreadsheet would run as a formula begins with an apostrophe: spreadsheets run
/// quoted fields, too.
#[cfg(feature = "reports")]
pub(crate) fn csv_field(text: &str) -> String {
    let begins_formula = text.starts_with(['=', '+', '-', '@', '\t', '\r']);
    let is_number = text == "-" || text.parse::<f64>().is_ok();
    if begins_formula && !is_number {
        format!("\"'{}\"", text.replace('"', "\"\""))
    } else if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}

#[cfg(all(test, feature = "reports"))]
mod tests {
    use super::csv_field;

    #[test]
    fn no_field_is_a_formula_and_every_number_stays_one() {
        for number in ["-1.5e-3", "+2", "-", "1.9998", "-inf"] {
            assert_eq!(csv_field(number), number);
        }
        for (text, field) in [
            ("L2", "L2"),
            ("a,b", "\"a,b\""),
            ("=1+1", "\"'=1+1\""),
            ("=HYPERLINK(\"x\")", "\"'=HYPERLINK(\"\"x\"\")\""),
            ("+cmd", "\"'+cmd\""),
            ("-u, v", "\"'-u, v\""),
            ("@SUM(A1)", "\"'@SUM(A1)\""),
        ] {
            assert_eq!(csv_field(text), field);
        }
    }
}
