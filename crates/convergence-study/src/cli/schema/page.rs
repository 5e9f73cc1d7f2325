//! The reference page of a project's files in Markdown, made from their schemas.

use std::collections::BTreeMap;
use std::fmt::Write;

use serde_json::Value;

use super::{STUDY, other_files, study_schema};
use crate::input::schema::allowed;
use crate::project::{Project, Term};
use crate::study::KindRow;
use crate::text::prose::capitalized;

/// The reference page of the files of a project: each kind of study, then its other files.
pub(super) fn page(project: &Project) -> String {
    let mut page = Page {
        text: format!(
            "# Files of {}\n\nEvery key of every table: what it may be, what holds without it, what it means. \
             `{} schema` prints the same for editors.\n",
            project.name, project.command
        ),
        places: BTreeMap::new(),
    };
    page.text.push_str("\n## Every study\n");
    page.table("Every study", STUDY, &study_schema(), false);
    for row in project.kinds {
        page.kind(row);
    }
    for (name, schema) in other_files(project) {
        let title = format!("Files of `{name}`");
        let _ = writeln!(page.text, "\n## {title}");
        page.tables(&title, "", &schema);
    }
    page.terms(project.terms);
    page.text
}

struct Page {
    text: String,
    /// The tables shown so far, each with the title of its chapter.
    places: BTreeMap<String, String>,
}

impl Page {
    /// What a kind of study is about, and its keys.
    fn kind(&mut self, row: &KindRow) {
        let title = format!("Kind `{}`", row.name);
        let _ = writeln!(self.text, "\n## {title}\n");
        for (what, text) in [
            ("Why the claim should hold", row.why),
            ("How it is judged", row.judged),
            ("What a failure would mean", row.failure),
        ] {
            let _ = writeln!(self.text, "- {what}: {text}");
        }
        self.tables(&title, "", &(row.schema)());
    }

    /// The words of a project.
    fn terms(&mut self, terms: &[Term]) {
        if terms.is_empty() {
            return;
        }
        self.text
            .push_str("\n## Words\n\n| word | is | means |\n| --- | --- | --- |\n");
        for Term { name, what, text } in terms {
            let _ = writeln!(self.text, "| `{name}` | {what} | {text} |");
        }
    }

    /// The tables in a value, each with its keys.
    ///
    /// * `path`: the dotted name of the value; empty for a file.
    fn tables(&mut self, title: &str, path: &str, schema: &Value) {
        for (name, value) in keys(schema) {
            let path = if path.is_empty() {
                name.to_owned()
            } else {
                format!("{path}.{name}")
            };
            for form in forms(value) {
                let (form, is_listed) = match form.get("items") {
                    Some(items) => (items, true),
                    None => (form, false),
                };
                if forms(form).iter().any(|form| form["type"] == "object") {
                    self.table(title, &path, &with_meaning(form, value), is_listed);
                }
            }
        }
    }

    fn table(&mut self, title: &str, path: &str, schema: &Value, is_listed: bool) {
        let heading = if is_listed {
            format!("[[{path}]]")
        } else {
            format!("[{path}]")
        };
        let meaning = schema["description"].as_str().unwrap_or_default();
        let _ = writeln!(self.text, "\n### `{heading}`\n\n{}", capitalized(meaning));
        let others = schema["additionalProperties"].as_object();
        if others.is_some() {
            let each = allowed(&schema["additionalProperties"]);
            let _ = writeln!(self.text, "\nUnder each name of yours: {each}.");
        }
        if keys(schema).is_empty() {
            return;
        }
        let rows = rows(schema);
        if let Some(place) = self.places.get(&rows) {
            let _ = writeln!(self.text, "Its keys are those under {place}.");
            return;
        }
        let place = format!("`{heading}` of \"{}\"", title.replace('`', ""));
        self.text.push_str(&rows);
        self.places.insert(rows, place);
        self.tables(title, path, schema);
    }
}

/// A schema with what is said of its key.
fn with_meaning(schema: &Value, key: &Value) -> Value {
    let mut schema = schema.clone();
    schema["description"] = key["description"].clone();
    schema
}

/// The alternatives of a schema; itself if it has none.
fn forms(schema: &Value) -> &[Value] {
    schema["anyOf"]
        .as_array()
        .map_or(std::slice::from_ref(schema), |forms| forms)
}

/// The keys of a table, each once.
fn keys(schema: &Value) -> BTreeMap<&str, &Value> {
    let tables = forms(schema)
        .iter()
        .filter_map(|table| table["properties"].as_object());
    let keys = tables.flatten().map(|(name, value)| (name.as_str(), value));
    keys.collect()
}

/// The rows of a table's keys.
fn rows(schema: &Value) -> String {
    let mut text =
        "\n| key | value | without it | meaning |\n| --- | --- | --- | --- |\n".to_owned();
    for (name, key) in keys(schema) {
        let is_required = |table: &Value| {
            table["required"]
                .as_array()
                .is_some_and(|names| names.iter().any(|own| own == name))
        };
        let without = match key.get("default") {
            Some(default) => format!("`{default}`"),
            None if forms(schema).iter().all(is_required) => "required".to_owned(),
            None => "-".to_owned(),
        };
        let meaning = key["description"]
            .as_str()
            .unwrap_or_default()
            .replace('\n', " ");
        let value = allowed(key);
        let _ = writeln!(text, "| `{name}` | {value} | {without} | {meaning} |");
    }
    text
}
