//! Changes of a text: keys left out, keys too many, values of another type.

use std::collections::BTreeMap;

use serde_json::Value;

/// A change of a text, and what it does to which key.
pub(super) struct Mutant {
    pub(super) text: String,
    pub(super) change: String,
}

/// A value of another type.
fn other(is_boolean: bool) -> &'static str {
    if is_boolean { "1.5" } else { "true" }
}

/// Each key left out, each key with a value of another type, a key too many in each table. Each
/// line of the repository's files has one key, or closes a list.
pub(super) fn mutants(text: &str) -> Vec<Mutant> {
    let lines: Vec<&str> = text.lines().collect();
    let mut mutants = vec![];
    let mut table = String::new();
    for (k, line) in lines.iter().enumerate() {
        // The lines from this one to the given one replaced.
        let mut add = |new: &str, until: usize, change: String| {
            let text = [&lines[..k], &[new], &lines[until..]].concat().join("\n");
            mutants.push(Mutant { text, change });
        };
        if line.starts_with('[') {
            table = line.split('#').next().unwrap().trim().to_owned();
            let surplus = format!("{table}\nsurplus = 1");
            add(&surplus, k + 1, format!("{table} has surplus"));
            let next = lines[k + 1..].iter().position(|line| line.starts_with('['));
            let next = next.map_or(lines.len(), |next| k + 1 + next);
            add("", next, format!("{table} is missing"));
        } else if let Some((key, value)) = line.split_once('=')
            && !key.starts_with([' ', '#', '"', '{'])
        {
            let key = key.trim();
            let end = (k + 1..=lines.len())
                .find(|end| toml::from_str::<toml::Table>(&lines[k..*end].join("\n")).is_ok())
                .expect("a value");
            add("", end, format!("{table} without {key}"));
            let other = format!("{key} = {}", other(value.trim().starts_with(['t', 'f'])));
            add(&other, end, format!("{table} with {other}"));
        }
    }
    mutants
}

/// Keys of the tables of a text that are not there, each with a value of another type: a reader
/// that does not read a key which it allows would not refuse that.
pub(super) fn insertions(text: &str, schema: &Value) -> Vec<Mutant> {
    let lines: Vec<&str> = text.lines().collect();
    let mut mutants = vec![];
    for (k, line) in lines.iter().enumerate() {
        if !line.starts_with('[') {
            continue;
        }
        let table = line.split('#').next().unwrap().trim();
        let path = table.trim_matches(['[', ']']);
        let own = lines[k + 1..]
            .iter()
            .take_while(|line| !line.starts_with('['));
        let own: Vec<&str> = own
            .map(|line| line.split('=').next().unwrap().trim())
            .collect();
        let names: Vec<&str> = path.split('.').collect();
        for (name, key) in keys_at(schema, &names) {
            let below = format!("{path}.{name}]");
            if own.contains(&name) || text.contains(&below) {
                continue;
            }
            let added = format!("{name} = {}", other(key["type"] == "boolean"));
            let text = [&lines[..=k], &[&added], &lines[k + 1..]].concat();
            mutants.push(Mutant {
                text: text.join("\n"),
                change: format!("{table} with {added}"),
            });
        }
    }
    mutants
}

/// The keys of the table at a path below a value of this schema; a name may be one of the user's.
fn keys_at<'s>(schema: &'s Value, path: &[&str]) -> BTreeMap<&'s str, &'s Value> {
    let forms = schema["anyOf"].as_array().into_iter().flatten();
    let forms = forms.chain(schema.get("items"));
    let mut found: BTreeMap<_, _> = forms.flat_map(|form| keys_at(form, path)).collect();
    let keys = schema["properties"].as_object();
    match path.split_first() {
        None => {
            let keys = keys.into_iter().flatten();
            found.extend(keys.map(|(name, key)| (name.as_str(), key)));
        }
        Some((name, below)) => {
            let others = schema.get("additionalProperties");
            let others = others.filter(|rule| rule.is_object());
            let own = keys.and_then(|keys| keys.get(*name)).or(others);
            found.extend(own.into_iter().flat_map(|form| keys_at(form, below)));
        }
    }
    found
}
