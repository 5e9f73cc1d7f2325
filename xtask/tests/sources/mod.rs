//! The tests that read the sources as text: links, citations, layers between crates, and calls that
//! are refused.

mod citations;
mod independence;
mod layers;
mod links;
mod tests_run;
mod theory;

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
