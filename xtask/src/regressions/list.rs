//! The list of mistakes.

use std::fs;
use std::path::Path;

use convergence_study::internal::cli::exit::Unusable;
use serde::Deserialize;

/// The list.
pub(super) const FILE: &str = "xtask/regressions.toml";

/// A mistake of meaning that a person might make.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Regression {
    /// A short description.
    pub(super) name: String,
    /// The source file, relative to the workspace.
    pub(super) file: String,
    /// The changes.
    edits: Vec<Edit>,
    /// The study that must notice it; empty for a mutant, which any study may notice.
    #[serde(default)]
    pub(super) study: String,
    /// Whether that study is of the full tier: it then runs alone, in place of the quick tier.
    #[serde(default)]
    pub(super) full: bool,
    /// The test that must notice it, if no study must: the arguments of `cargo test` that select it
    /// alone.
    #[serde(default)]
    pub(super) test: String,
    /// Words that must appear in the message about that study and lead to the cause.
    #[serde(default)]
    pub(super) says: String,
    /// Methods, one of which must be named, in the words of a setting; `both` if neither must be
    /// named.
    pub(super) method: Vec<String>,
    /// Terms, fields or meshes, one of which must be named; empty if none is wrong.
    #[serde(default)]
    pub(super) about: Vec<String>,
    /// Whether it was drawn at random from all mutants instead of written.
    #[serde(default)]
    pub(super) mutant: bool,
}

/// A replacement of text.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
struct Edit {
    /// A text that must occur exactly once in the file.
    old: String,
    /// Its replacement.
    new: String,
}

/// Reads the list.
///
/// # Errors
/// A list that is missing or unreadable, or two mistakes with the same name.
pub(super) fn read(root: &Path) -> Result<Vec<Regression>, Unusable> {
    #[derive(Deserialize)]
    #[serde(deny_unknown_fields)]
    struct List {
        regression: Vec<Regression>,
    }
    let path = root.join(FILE);
    let text = fs::read_to_string(&path).map_err(|error| Unusable::file(&path, &error))?;
    let List { regression: all } =
        toml::from_str(&text).map_err(|error| Unusable::file(&path, &error))?;
    let second = all
        .iter()
        .enumerate()
        .find(|(k, one)| all[..*k].iter().any(|earlier| earlier.name == one.name));
    match second {
        Some((_, one)) => Err(Unusable::because(&format!(
            "{FILE}: found a second \"{}\"",
            one.name
        ))),
        None => Ok(all),
    }
}

impl Regression {
    /// The study or the test that must notice it, in words.
    pub(super) fn noticed_by(&self) -> &str {
        match (self.study.as_str(), self.test.as_str()) {
            ("", "") => "any",
            ("", test) => test,
            (study, _) => study,
        }
    }

    /// The folder of its file: a module.
    pub(super) fn module(&self) -> &str {
        self.file.rsplit_once('/').map_or("", |(folder, _)| folder)
    }

    /// The text of its file with the mistake.
    ///
    /// # Errors
    /// A file that cannot be read, or an old text that does not occur exactly once or is not
    /// changed.
    pub(super) fn planted(&self, root: &Path) -> Result<String, Unusable> {
        let path = root.join(&self.file);
        let honest = fs::read_to_string(&path).map_err(|error| Unusable::file(&path, &error))?;
        let mut text = honest.clone();
        for Edit { old, new } in &self.edits {
            let count = honest.matches(old).count();
            if count != 1 || old == new {
                return Err(Unusable::because(&format!(
                    "{FILE}: \"{}\": found {count} times in {}; expected once, and another text in its place: {old}",
                    self.name, self.file
                )));
            }
            text = text.replacen(old, new, 1);
        }
        Ok(text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use convergence_study::Tier;
    use convergence_study::internal::cli::workspace;

    /// Whether some source of the package has the test that the last argument names.
    fn has_test(root: &Path, arguments: &str) -> bool {
        let words: Vec<&str> = arguments.split_whitespace().collect();
        let ["--package", package, "--lib" | "--test", .., path] = words[..] else {
            return false;
        };
        let name = path.rsplit("::").next().unwrap_or(path);
        let package = root.join("crates").join(package);
        let sources = ["src", "tests"]
            .into_iter()
            .flat_map(|folder| sources(&package.join(folder)));
        sources
            .into_iter()
            .any(|text| text.contains(&format!("fn {name}(")))
    }

    /// The texts of all files below a folder.
    fn sources(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder)
            .into_iter()
            .flatten()
            .map(|entry| entry.expect("an entry").path());
        let texts = |path: std::path::PathBuf| match path.is_dir() {
            true => sources(&path),
            false => fs::read_to_string(path).into_iter().collect(),
        };
        entries.flat_map(texts).collect()
    }

    #[test]
    fn every_regression_can_be_planted_and_names_a_study_of_its_tier() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        let all = read(&root).unwrap_or_else(|error| panic!("{}", error.message()));
        assert!(all.len() >= 130, "{}", all.len());
        let studies = workspace::studies(&crate::PROJECT, &root)
            .unwrap_or_else(|error| panic!("{}", error.message()));
        let is_study = |id: &str, tier: Tier| {
            studies
                .iter()
                .map(|file| file.study.header())
                .any(|header| header.id == id && header.tier == tier)
        };
        for regression in &all {
            let planted = regression
                .planted(&root)
                .unwrap_or_else(|error| panic!("{}", error.message()));
            let is_there = |edit: &Edit| planted.contains(&edit.new);
            assert!(
                !regression.edits.is_empty() && regression.edits.iter().all(is_there),
                "{}",
                regression.name
            );
            let tier = match regression.full {
                true => Tier::Full,
                false => Tier::Quick,
            };
            assert!(
                regression.study.is_empty() && !regression.full
                    || is_study(&regression.study, tier),
                "{}: {}",
                regression.name,
                regression.study
            );
            assert!(!regression.method.is_empty(), "{}", regression.name);
            assert!(
                regression.test.is_empty() || regression.study.is_empty(),
                "{}: a study and a test",
                regression.name
            );
            assert!(
                regression.test.is_empty() || has_test(&root, &regression.test),
                "{}",
                regression.test
            );
            // Each line about the study begins with its name.
            let head = format!("{}: ", regression.study);
            assert!(
                regression.study.is_empty() || !head.contains(&regression.says),
                "{}",
                regression.name
            );
        }
    }
}
