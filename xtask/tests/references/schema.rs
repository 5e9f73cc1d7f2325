//! Whether a value satisfies a schema. All words that the schemas use, and no other.

use serde_json::Value;

/// Why a value does not satisfy a schema; `None` if it does.
pub(super) fn complaint(schema: &Value, value: &Value, path: &str) -> Option<String> {
    let mut words = schema.as_object().expect("a schema").iter();
    words.find_map(|(word, rule)| breach(schema, word, rule, value, path))
}

/// Why a value does not satisfy a word of a schema.
fn breach(schema: &Value, word: &str, rule: &Value, value: &Value, path: &str) -> Option<String> {
    let wrong = |is_wrong: bool| is_wrong.then(|| format!("{path}: {word} {rule}: {value}"));
    let (limit, number) = (rule.as_f64(), value.as_f64());
    let length = value.as_array().map(|list| list.len() as f64);
    // Only a number, or a list, may be below a limit.
    let is_below = |found: Option<f64>| found.is_some() && found < limit;
    let rules = || rule.as_array().expect("a list").iter();
    let keys = || value.as_object().into_iter().flatten();
    let is_known = |name: &str| schema["properties"].get(name).is_some();
    match word {
        "$schema" | "title" | "description" | "default" | "examples" | "then" => None,
        "type" => wrong(!has_type(rule.as_str()?, value)),
        "maximum" => wrong(number > limit),
        "exclusiveMaximum" => wrong(number >= limit),
        "minimum" => wrong(is_below(number)),
        "exclusiveMinimum" => wrong(is_below(number) || number == limit),
        "maxItems" => wrong(length > limit),
        "minItems" => wrong(is_below(length)),
        "enum" => wrong(!rules().any(|allowed| allowed == value)),
        "const" => wrong(rule != value),
        "items" => {
            // A list of a fixed length has a rule for each item.
            let rule_of = |k: usize| rule.get(k).unwrap_or(rule);
            let mut items = value.as_array().into_iter().flatten().enumerate();
            items.find_map(|(k, item)| complaint(rule_of(k), item, &format!("{path}[{k}]")))
        }
        "properties" => keys()
            .find_map(|(name, value)| complaint(rule.get(name)?, value, &format!("{path}.{name}"))),
        "required" => {
            let is_missing = |name: &Value| value.get(name.as_str().unwrap()).is_none();
            wrong(value.is_object() && rules().any(is_missing))
        }
        // A table of values by any names.
        "additionalProperties" if rule.is_object() => keys()
            .filter(|(name, _)| !is_known(name))
            .find_map(|(name, value)| complaint(rule, value, &format!("{path}.{name}"))),
        "additionalProperties" => wrong(keys().any(|(name, _)| !is_known(name))),
        "allOf" => rules().find_map(|rule| complaint(rule, value, path)),
        "anyOf" => wrong(rules().all(|rule| complaint(rule, value, path).is_some())),
        "if" if complaint(rule, value, path).is_none() => complaint(&schema["then"], value, path),
        "if" => None,
        _ => panic!("{word}: unknown to this test"),
    }
}

fn has_type(name: &str, value: &Value) -> bool {
    match name {
        "object" => value.is_object(),
        "array" => value.is_array(),
        "string" => value.is_string(),
        "boolean" => value.is_boolean(),
        "integer" => value.is_i64() || value.is_u64(),
        "number" => value.is_number(),
        _ => panic!("{name}: unknown to this test"),
    }
}
