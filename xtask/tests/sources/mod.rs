//! The tests that read the sources as text: links, citations, layers between crates, and calls that
//! are refused.

mod citations;
mod independence;
mod layers;
mod links;
mod tests_run;
mod theory;

pub(crate) use links::pages;

use std::path::{Path, PathBuf};

use convergence_study_tests::files::files_below;

use crate::place::root;

/// The folder of a crate.
fn crate_folder(name: &str) -> PathBuf {
    root().join("crates").join(name)
}

/// All files below a folder with one of these extensions, sorted.
fn files(folder: &Path, extensions: &[&str]) -> Vec<PathBuf> {
    let has_one = |path: &PathBuf| {
        path.extension()
            .is_some_and(|extension| extensions.iter().any(|known| extension == *known))
    };
    let mut files: Vec<PathBuf> = files_below(folder).into_iter().filter(has_one).collect();
    files.sort();
    files
}

/// Source text without line comments: a doc comment may mention what the code must not use.
fn without_comments(text: &str) -> String {
    text.lines()
        .map(|line| line.split("//").next().unwrap_or("").to_owned() + "\n")
        .collect()
}

/// The code of a source without comments and without the module of its tests.
fn code(text: &str) -> String {
    without_comments(text.split("\n#[cfg(test)]").next().unwrap_or(""))
}

/// The paths that follow a word wherever a code has it, the braces after them resolved; an empty
/// one where the word stands alone.
fn paths(code: &str, word: &str) -> Vec<String> {
    let mut found = vec![];
    for (at, _) in code.match_indices(word) {
        let rest = &code[at + word.len()..];
        if code[..at].ends_with(is_of_name) || rest.starts_with(is_of_name) {
            continue;
        }
        let path = rest.strip_prefix("::").unwrap_or("");
        let end = path.find(|c| !(is_of_name(c) || c == ':' || c == '*'));
        let (module, list) = path.split_at(end.unwrap_or(path.len()));
        match list.strip_prefix('{').and_then(|list| list.split_once('}')) {
            Some((list, _)) => {
                let items = list.split(',').map(str::trim);
                found.extend(items.map(|item| format!("{module}{item}")));
            }
            None => found.push(module.to_owned()),
        }
    }
    found.retain(|path| !path.ends_with("::"));
    found
}

fn is_of_name(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}
