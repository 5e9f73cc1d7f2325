//! Whether a value satisfies a schema. All words that the schemas use, and no other.

use serde_json::Value;

/// Why a value does not satisfy a schema; `None` if it does.
pub(super) fn complaint(schema: &Value, value: &Value, path: &str) -> Option<String> {
    let wrong = |what: &str| Some(format!("{path}: {what}: {value}"));
    for (word, rule) in schema.as_object().expect("a schema") {
        let found = match word.as_str() {
            "$schema" | "title" | "description" | "default" | "examples" | "then" => None,
            "type" if !has_type(rule.as_str().unwrap(), value) => wrong(&format!("no {rule}")),
            "maximum" if value.as_f64().is_some_and(|x| x > rule.as_f64().unwrap()) => wrong(word),
            "exclusiveMaximum" if value.as_f64().is_some_and(|x| x >= rule.as_f64().unwrap()) => {
                wrong(word)
            }
            "minItems"
                if value
                    .as_array()
                    .is_some_and(|list| (list.len() as u64) < rule.as_u64().unwrap()) =>
            {
                wrong(word)
            }
            "maxItems"
                if value
                    .as_array()
                    .is_some_and(|list| list.len() as u64 > rule.as_u64().unwrap()) =>
            {
                wrong(word)
            }
            "minimum" if value.as_f64().is_some_and(|x| x < rule.as_f64().unwrap()) => wrong(word),
            "exclusiveMinimum" if value.as_f64().is_some_and(|x| x <= rule.as_f64().unwrap()) => {
                wrong(word)
            }
            "enum" if !rule.as_array().unwrap().contains(value) => {
                wrong(&format!("none of {rule}"))
            }
            "const" if rule != value => wrong(&format!("not {rule}")),
            "type" | "minimum" | "exclusiveMinimum" | "maximum" | "exclusiveMaximum"
            | "minItems" | "maxItems" | "enum" | "const" => None,
            "items" => in_list(rule, value, path),
            "properties" => in_table(rule, value, path),
            "required" => {
                let names = rule
                    .as_array()
                    .unwrap()
                    .iter()
                    .map(|name| name.as_str().unwrap());
                let missing = names
                    .into_iter()
                    .find(|name| value.is_object() && value.get(name).is_none());
                missing.map(|name| format!("{path}.{name}: missing"))
            }
            // A table of values by any names.
            "additionalProperties" if rule.is_object() => {
                let known = schema.get("properties").and_then(Value::as_object);
                let is_known = |name: &str| known.is_some_and(|known| known.contains_key(name));
                let values = value.as_object().into_iter().flatten();
                let values = values.filter(|(name, _)| !is_known(name));
                let mut values = values.map(|(name, value)| (format!("{path}.{name}"), value));
                values.find_map(|(path, value)| complaint(rule, value, &path))
            }
            "additionalProperties" => {
                let known = schema["properties"].as_object().unwrap();
                let names = value
                    .as_object()
                    .into_iter()
                    .flatten()
                    .map(|(name, _)| name);
                let other = names.into_iter().find(|name| !known.contains_key(*name));
                other.map(|name| format!("{path}.{name}: unknown"))
            }
            "allOf" => rule
                .as_array()
                .unwrap()
                .iter()
                .find_map(|rule| complaint(rule, value, path)),
            "anyOf" => {
                let complaints = rule
                    .as_array()
                    .unwrap()
                    .iter()
                    .map(|rule| complaint(rule, value, path));
                let complaints: Option<Vec<String>> = complaints.collect();
                complaints.map(|complaints| complaints.join("; or "))
            }
            "if" if complaint(rule, value, path).is_none() => {
                complaint(&schema["then"], value, path)
            }
            "if" => None,
            _ => panic!("{word}: unknown to this test"),
        };
        if found.is_some() {
            return found;
        }
    }
    None
}

fn in_list(rule: &Value, value: &Value, path: &str) -> Option<String> {
    // A list of a fixed length has a rule for each item.
    let rule_of = |k: usize| rule.get(k).unwrap_or(rule);
    let items = value.as_array().into_iter().flatten().enumerate();
    items
        .into_iter()
        .find_map(|(k, item)| complaint(rule_of(k), item, &format!("{path}[{k}]")))
}

fn in_table(rules: &Value, value: &Value, path: &str) -> Option<String> {
    let rules = rules.as_object().unwrap().iter();
    let mut known = rules.filter_map(|(name, rule)| Some((name, rule, value.get(name)?)));
    known.find_map(|(name, rule, value)| complaint(rule, value, &format!("{path}.{name}")))
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
