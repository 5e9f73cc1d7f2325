//! What other programs read: the JSON object of a command, and the fields of CSV.

use serde::Serialize;
use serde_json::{Value, json};

use crate::judge::verdict::Verdict;

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
#[cfg(feature = "reports")]
pub(crate) fn csv_field(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}
