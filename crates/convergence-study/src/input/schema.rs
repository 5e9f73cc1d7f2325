//! JSON schemas of the structs that files are read into, and what they allow in words.

use schemars::{JsonSchema, Schema, generate::SchemaSettings, transform};
use serde_json::{Value, json};

/// The schema of a struct, without references to other schemas.
pub fn of<T: JsonSchema + ?Sized>() -> Value {
    let settings = SchemaSettings::draft07().with(|settings| {
        settings.inline_subschemas = true;
        settings.meta_schema = None;
        let as_in_a_file = transform::RecursiveTransform(as_in_a_file);
        settings.transforms.push(Box::new(as_in_a_file));
    });
    let schema = settings.into_generator().into_root_schema_for::<T>();
    let mut schema = schema.to_value();
    // The name of a type in the sources.
    schema.as_object_mut().map(|schema| schema.remove("title"));
    schema
}

/// TOML has no `null`, and one type of number.
fn as_in_a_file(schema: &mut Schema) {
    schema.remove("format");
    if schema.get("default") == Some(&Value::Null) {
        schema.remove("default");
    }
    if let Some(Value::Array(types)) = schema.get("type")
        && let [only, Value::String(null)] = &types[..]
        && null == "null"
    {
        let only = only.clone();
        schema.insert("type".to_owned(), only);
    }
    if let Some(Value::Array(names)) = schema.get_mut("enum") {
        names.retain(|name| !name.is_null());
    }
    if let Some(Value::Array(forms)) = schema.get_mut("anyOf") {
        forms.retain(|form| *form != json!({ "type": "null" }));
        if let [Value::Object(only)] = &mut forms[..] {
            let only = std::mem::take(only);
            schema.remove("anyOf");
            only.into_iter()
                .for_each(|(word, rule)| drop(schema.insert(word, rule)));
        }
    }
}

/// The schema of a field by its dotted name, such as `expect[0].order`.
pub(super) fn at<'s>(schema: &'s Value, path: &str) -> Option<&'s Value> {
    let names = path.split(['.', '[']).filter(|name| !name.is_empty());
    names.into_iter().try_fold(schema, |schema, name| {
        let alternatives = schema["anyOf"]
            .as_array()
            .map_or(std::slice::from_ref(schema), |all| all);
        alternatives.iter().find_map(|schema| {
            let below = if name.ends_with(']') {
                schema.get("items")
            } else {
                schema["properties"].get(name)
            };
            below.or(schema
                .get("additionalProperties")
                .filter(|rule| rule.is_object()))
        })
    })
}

/// The texts that a schema names: those that it allows, or examples of them.
pub(super) fn texts(schema: &Value) -> Vec<&str> {
    let listed = ["enum", "examples"].into_iter();
    let listed = listed.filter_map(|key| schema[key].as_array()).flatten();
    let own = listed.filter_map(Value::as_str);
    let forms = schema["anyOf"].as_array().into_iter().flatten();
    own.chain(forms.flat_map(texts)).collect()
}

/// What a schema allows, in words.
pub(crate) fn allowed(schema: &Value) -> String {
    if let Some(title) = schema["title"].as_str() {
        return title.to_owned();
    }
    if let Some(forms) = schema["anyOf"].as_array() {
        return forms.iter().map(allowed).collect::<Vec<_>>().join(" or ");
    }
    if let Some(names) = schema["enum"].as_array() {
        return names
            .iter()
            .map(Value::to_string)
            .collect::<Vec<_>>()
            .join(", ");
    }
    let ends = [
        ("exclusiveMinimum", ">"),
        ("minimum", ">="),
        ("exclusiveMaximum", "<"),
        ("maximum", "<="),
    ];
    let ends = ends
        .into_iter()
        .filter_map(|(name, sign)| Some(format!("{sign} {}", schema.get(name)?)));
    let ends = ends.collect::<Vec<_>>().join(" and ").replace(".0", "");
    let range = |kind: &str| format!("{kind} {ends}").trim_end().to_owned();
    match schema["type"].as_str() {
        Some("number") => range("a finite number"),
        Some("integer") => range("a whole number"),
        Some("string") => "a text in quotes".to_owned(),
        Some("boolean") => "true or false".to_owned(),
        Some("array") if schema["items"]["type"] == "object" => "a list of tables".to_owned(),
        Some("array") => format!("a list, each {}", allowed(&schema["items"])),
        _ => "a table".to_owned(),
    }
}
