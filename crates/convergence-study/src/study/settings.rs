//! What a case says of itself: the leaves of a value.

#[cfg(feature = "files")]
use serde::Serialize;
#[cfg(feature = "files")]
use serde_json::{Map, Value};

/// A leaf: its path, and what stands there in words that can stand alone, such as `heat.rate` and
/// `heat.rate ≠ 0`.
pub(crate) type Setting = (String, String);

/// The leaves of a value, and the parts above them. A number is zero or not: that switches a term
/// on or off, whatever its size.
#[cfg(feature = "files")]
pub(super) fn leaves(value: &impl Serialize) -> Vec<Setting> {
    let mut found = vec![];
    if let Ok(Value::Object(parts)) = serde_json::to_value(value) {
        collect("", &parts, &mut found);
    }
    found
}

#[cfg(feature = "files")]
fn collect(above: &str, parts: &Map<String, Value>, found: &mut Vec<Setting>) {
    for (name, value) in parts {
        let path = format!("{above}{name}");
        let words = match value {
            Value::Null => format!("no {path}"),
            Value::Bool(value) => format!("{path} {value}"),
            Value::Number(number) if number.as_f64() == Some(0.0) => format!("{path} = 0"),
            Value::Number(_) => format!("{path} ≠ 0"),
            Value::String(text) => format!("{path} {text}"),
            Value::Array(_) | Value::Object(_) => path.clone(),
        };
        found.push((path.clone(), words));
        if let Value::Object(parts) = value {
            collect(&format!("{path}."), parts, found);
        }
    }
}
