//! Changes of a text: keys left out, keys too many, values of another type.

use convergence_study::{Form, Key, Keys};

/// A change of a text, and what it does to which key.
pub(super) struct Mutant {
    pub(super) text: String,
    pub(super) change: String,
}

/// Each key left out, each key with a value of another type, a key too many in each table. Each
/// line of the repository's files has one key, or closes a list.
pub(super) fn mutants(text: &str) -> Vec<Mutant> {
    let lines: Vec<&str> = text.lines().collect();
    let mut mutants = vec![];
    let mut table = String::new();
    for (k, line) in lines.iter().enumerate() {
        let with =
            |new: &str, until: usize| [&lines[..k], &[new], &lines[until..]].concat().join("\n");
        if line.starts_with('[') {
            table = line.split('#').next().unwrap().trim().to_owned();
            let text = with(&format!("{table}\nsurplus = 1"), k + 1);
            mutants.push(Mutant {
                text,
                change: format!("{table} has surplus"),
            });
            let next = lines[k + 1..].iter().position(|line| line.starts_with('['));
            let text = with("", next.map_or(lines.len(), |next| k + 1 + next));
            mutants.push(Mutant {
                text,
                change: format!("{table} is missing"),
            });
        } else if let Some((key, value)) = line.split_once('=')
            && !key.starts_with([' ', '#', '"', '{'])
        {
            let key = key.trim();
            let end = (k + 1..=lines.len())
                .find(|end| toml::from_str::<toml::Table>(&lines[k..*end].join("\n")).is_ok())
                .expect("a value");
            mutants.push(Mutant {
                text: with("", end),
                change: format!("{table} without {key}"),
            });
            let other = if value.trim().starts_with(['t', 'f']) {
                "1.5"
            } else {
                "true"
            };
            let text = with(&format!("{key} = {other}"), end);
            mutants.push(Mutant {
                text,
                change: format!("{table} with {key} = {other}"),
            });
        }
    }
    mutants
}

/// Keys of the tables of a text that are not there, each with a value of another type: a reader
/// that does not read a key which it allows would not refuse that.
pub(super) fn insertions(text: &str, sets: &[Keys]) -> Vec<Mutant> {
    let lines: Vec<&str> = text.lines().collect();
    let mut mutants = vec![];
    for (k, line) in lines
        .iter()
        .enumerate()
        .filter(|(_, line)| line.starts_with('['))
    {
        let table = line.split('#').next().unwrap().trim();
        let path = table.trim_matches(['[', ']']);
        let own = lines[k + 1..]
            .iter()
            .take_while(|line| !line.starts_with('['));
        let own: Vec<&str> = own
            .map(|line| line.split('=').next().unwrap().trim())
            .collect();
        let names: Vec<&str> = path.split('.').collect();
        for key in keys_in(sets, None, &names) {
            let below = format!("{path}.{}]", key.name);
            if own.contains(&key.name) || text.contains(&below) {
                continue;
            }
            let other = if matches!(key.form, Form::Boolean) {
                "1.5"
            } else {
                "true"
            };
            let added = format!("{} = {other}", key.name);
            let text = [&lines[..=k], &[&added], &lines[k + 1..]]
                .concat()
                .join("\n");
            mutants.push(Mutant {
                text,
                change: format!("{table} with {added}"),
            });
        }
    }
    mutants
}

/// The keys of the table at a path below a value of this form; a name may be one of the user's.
fn keys_at(form: Form, path: &[&str]) -> Vec<&'static Key> {
    match form {
        Form::List(form) => keys_at(*form, path),
        Form::OneOf(forms) => forms.iter().flat_map(|form| keys_at(*form, path)).collect(),
        Form::Table(sets) => keys_in(sets, None, path),
        Form::Named(keys, others) => match (keys, path) {
            ([], []) => vec![],
            _ => keys_in(&[keys], Some(others), path),
        },
        _ => vec![],
    }
}

fn keys_in(sets: &[Keys], others: Option<&Form>, path: &[&str]) -> Vec<&'static Key> {
    let keys = sets.iter().copied().flatten().copied().flatten();
    let Some((name, below)) = path.split_first() else {
        return keys.collect();
    };
    let forms: Vec<Form> = keys
        .filter(|key| key.name == *name)
        .map(|key| key.form)
        .collect();
    let others = others.filter(|_| forms.is_empty()).copied();
    forms
        .into_iter()
        .chain(others)
        .flat_map(|form| keys_at(form, below))
        .collect()
}
