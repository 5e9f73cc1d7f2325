//! Why nothing is judged, as JSON.

use serde::Serialize;
use serde_json::{Value, json};

/// Why nothing is judged: the object of `rates --format json`.
#[derive(Debug, Clone, Serialize)]
#[serde(transparent)]
pub(crate) struct Refused(Value);

impl Refused {
    pub(crate) fn of(object: Value) -> Self {
        Self(object)
    }

    /// A refusal that names no place in the text.
    pub(crate) fn because(message: &str) -> Self {
        Self(json!({ "message": message }))
    }
}
