//! The reference page of a project's files in Markdown, made from the keys that the readers allow.

use std::collections::BTreeMap;
use std::fmt::Write;

use super::other_files;
use crate::input::{Form, Key, Keys};
use crate::project::{Project, Term};
use crate::study::{KindRow, STUDY_TABLE};

/// The reference page of the files of a project: each kind of study, then its other files.
pub fn page(project: &Project) -> String {
    let mut page = Page {
        text: format!(
            "# Files of {}\n\nEvery key of every table: what it may be, what holds without it, what it means. \
             `{} schema` prints the same for editors.\n",
            project.name, project.command
        ),
        places: BTreeMap::new(),
    };
    page.chapter("Every study", &[&[&[STUDY_TABLE]]]);
    for row in project.kinds {
        page.kind(row);
    }
    for (name, set) in other_files(project) {
        page.chapter(&format!("Files of `{name}`"), &[set]);
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
        self.keys(&title, row.keys);
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

    fn chapter(&mut self, title: &str, sets: &[Keys]) {
        let _ = writeln!(self.text, "\n## {title}");
        self.keys(title, sets);
    }

    /// The tables of a file with one of these sets.
    fn keys(&mut self, title: &str, sets: &[Keys]) {
        if sets.len() > 1 {
            let _ = writeln!(
                self.text,
                "\nA file has one of these sets of tables: {}.",
                sets_in_words(sets)
            );
        }
        for key in union(sets) {
            self.tables_of(title, key.name, key, key.form, false);
        }
    }

    /// The tables of a key, each with its keys, and then the tables in it.
    ///
    /// * `path`: the dotted name of the key; `is_listed`: whether its tables are in a list.
    fn tables_of(&mut self, title: &str, path: &str, key: &Key, form: Form, is_listed: bool) {
        match form {
            Form::Table(sets) => self.table(title, path, key, sets, is_listed),
            Form::Named(keys, form) => self.named(title, path, key, keys, *form),
            Form::List(form) => self.tables_of(title, path, key, *form, true),
            Form::OneOf(forms) => {
                for form in forms {
                    self.tables_of(title, path, key, *form, is_listed);
                }
            }
            _ => {}
        }
    }

    /// A table with names of the user's, and with values of this form under them. One without keys
    /// is said in the row of its own key, if that is in a table.
    fn named(&mut self, title: &str, path: &str, key: &Key, keys: Keys, form: Form) {
        if !keys.is_empty() {
            self.table(title, path, key, &[keys], false);
            let _ = writeln!(self.text, "\nUnder other names: {}.", values(form));
        } else if path == key.name {
            self.heading(path, key, false);
            let _ = writeln!(self.text, "\nUnder each name: {}.", values(form));
        }
        self.tables_of(title, &format!("{path}{NAME}"), key, form, false);
    }

    /// Writes the heading of a table, and what it means; returns the heading.
    fn heading(&mut self, path: &str, key: &Key, is_listed: bool) -> String {
        let heading = if is_listed {
            format!("[[{path}]]")
        } else {
            format!("[{path}]")
        };
        let _ = writeln!(self.text, "\n### `{heading}`\n");
        // A table under a name of the user's is part of what was said of those above it.
        if !path.ends_with(NAME) {
            let default = match key.default {
                None | Some("") => String::new(),
                Some(_) => format!(" Without it: {}.", default_of(key)),
            };
            let _ = writeln!(self.text, "{}.{default}", capitalized(key.meaning));
        }
        heading
    }

    fn table(&mut self, title: &str, path: &str, key: &Key, sets: &[Keys], is_listed: bool) {
        let heading = self.heading(path, key, is_listed);
        let rows = rows(sets);
        if let Some(place) = self.places.get(&rows) {
            let _ = writeln!(self.text, "Its keys are those under {place}.");
            return;
        }
        let place = format!("`{heading}` of \"{}\"", title.replace('`', ""));
        self.text.push_str(&rows);
        self.places.insert(rows, place);
        for key in union(sets) {
            self.tables_of(title, &format!("{path}.{}", key.name), key, key.form, false);
        }
    }
}

/// The rows of a table's keys, and which of them may stand together.
fn rows(sets: &[Keys]) -> String {
    let mut text = String::new();
    if sets.len() > 1 {
        let _ = writeln!(text, "One of these: {}.", sets_in_words(sets));
    }
    text.push_str("\n| key | value | without it | meaning |\n| --- | --- | --- | --- |\n");
    for key in union(sets) {
        let _ = writeln!(
            text,
            "| `{}` | {} | {} | {} |",
            key.name,
            values(key.form),
            without(key, sets),
            key.meaning
        );
    }
    text
}

/// The keys of all sets, each once.
fn union(sets: &[Keys]) -> Vec<&'static Key> {
    let mut keys: Vec<&Key> = vec![];
    for key in sets.iter().copied().flatten().copied().flatten() {
        if !keys.iter().any(|known| known.name == key.name) {
            keys.push(key);
        }
    }
    keys
}

/// The keys that each set must have.
fn sets_in_words(sets: &[Keys]) -> String {
    let words = |set: &Keys| {
        let keys = set.iter().copied().flatten();
        let names = keys.filter(|key| key.default.is_none());
        let names: Vec<String> = names.map(|key| format!("`{}`", key.name)).collect();
        names.join(", ")
    };
    sets.iter().map(words).collect::<Vec<_>>().join("; or ")
}

/// What holds without a key of a table with these sets.
fn without(key: &Key, sets: &[Keys]) -> String {
    let has_key = |set: &&Keys| {
        set.iter()
            .copied()
            .flatten()
            .any(|own| own.name == key.name)
    };
    if key.default.is_none() && sets.iter().filter(has_key).count() < sets.len() {
        "see above".to_owned()
    } else {
        default_of(key)
    }
}

fn default_of(key: &Key) -> String {
    match key.default {
        None => "required".to_owned(),
        Some("") => "-".to_owned(),
        // What can be written in a file.
        Some(text) if serde_json::from_str::<serde_json::Value>(text).is_ok() => {
            format!("`{text}`")
        }
        Some(words) => words.to_owned(),
    }
}

/// In the path of a table: any name that the user chooses.
const NAME: &str = ".NAME";

/// The values in a list or a table.
fn each(form: Form) -> String {
    match form {
        Form::OneOf(_) => format!("({})", values(form)),
        _ => values(form),
    }
}

fn values(form: Form) -> String {
    match form {
        Form::Text => "a text".to_owned(),
        Form::Count(least) => format!("a whole number >= {least}"),
        Form::Number => "a number".to_owned(),
        Form::Positive => "a number > 0".to_owned(),
        Form::Boolean => "`true` or `false`".to_owned(),
        Form::Named(&[], form) => format!("a table by name, each {}", each(*form)),
        Form::Choice(names) => {
            let names: Vec<String> = names().iter().map(|name| format!("`\"{name}\"`")).collect();
            names.join(", ")
        }
        Form::List(Form::Table(_)) => "tables".to_owned(),
        Form::List(form) => format!("a list, each {}", each(*form)),
        Form::OneOf(forms) => {
            let forms: Vec<String> = forms.iter().map(|form| values(*form)).collect();
            forms.join("; or ")
        }
        Form::Named(..) | Form::Table(_) => "a table".to_owned(),
    }
}

fn capitalized(text: &str) -> String {
    let mut rest = text.chars();
    rest.next().map_or_else(String::new, |first| {
        first.to_uppercase().collect::<String>() + rest.as_str()
    })
}
