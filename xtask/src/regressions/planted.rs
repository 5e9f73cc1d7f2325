//! A copy of the work tree, compiled with a mistake, and the results of `verify`: they are kept, so
//! that an interrupted run continues where it stopped, and a better diagnosis needs no compilation.

use std::env;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

use convergence_study::{
    Verdict,
    internal::{
        cli::exit::Unusable,
        run::not_passed,
        store::{Record, atomic, content_hash, json},
    },
};
use serde::{Deserialize, Serialize};

use super::list::Regression;

/// What the copy omits: build results, output of the program, and hidden files except `.cargo`.
fn is_left_out(name: &str) -> bool {
    matches!(name, "target" | "reports") || (name.starts_with('.') && name != ".cargo")
}

/// Profile of `cargo build`: optimised enough that the quick tier takes seconds, and compiled
/// incrementally.
const PROFILE: &str = "regressions";

/// Time limit of a case in seconds: with a mistake it may never end.
const TIME_LIMIT: &str = "20";

/// A copy of the work tree.
pub(super) struct Copy {
    /// `target/regressions`: the copy is in `tree`, its target folder in `build`, the results in
    /// `records`.
    folder: PathBuf,
    /// Hash of all files and their names.
    hash: u64,
}

/// The results of `verify`.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct PlantedRun {
    /// Hash of the copy with the mistake.
    key: String,
    /// Its run time in seconds.
    pub(super) seconds: f64,
    /// Number of lines that it printed.
    pub(super) lines: usize,
    pub(super) record: Record,
    /// The line about the failure of the test named for the mistake; `None` if it passed, or if no
    /// test is named.
    #[serde(default)]
    failed_test: Option<String>,
}

impl Copy {
    /// Copies the work tree, including uncommitted changes.
    ///
    /// # Errors
    /// Errors of the operating system.
    pub(super) fn of(root: &Path) -> Result<Self, Unusable> {
        let mut copy = Self {
            folder: root.join("target/regressions"),
            hash: 0,
        };
        made_alike(root, &copy.tree(), &mut copy.hash)?;
        Ok(copy)
    }

    fn tree(&self) -> PathBuf {
        self.folder.join("tree")
    }

    /// Returns the results of `verify` without a mistake; known results are read.
    ///
    /// # Errors
    /// If it does not pass, since it would then seem to notice every mistake.
    pub(super) fn as_it_is(&self, recorded: bool) -> Result<PlantedRun, Unusable> {
        self.passing(recorded, None)
    }

    /// Results without a mistake: of the quick tier, or of a study of the full tier alone.
    fn passing(&self, recorded: bool, full: Option<&str>) -> Result<PlantedRun, Unusable> {
        let name = full.map_or("as-it-is".to_owned(), |study| format!("as-it-is-{study}"));
        let found = self.kept(&name, self.hash, recorded, |key| self.verify(key, "", full))?;
        if found.record.verdict.is_pass() {
            return Ok(found);
        }
        Err(Unusable::because(&format!(
            "without a mistake `verify` does not pass:\n{}",
            found.said().join("\n")
        )))
    }

    /// Results of `verify`, and of the test named for the mistake, with another text in its file,
    /// which is restored afterwards; known results are read.
    ///
    /// * `recorded`: use earlier results, whatever the files were then.
    ///
    /// # Errors
    /// A text that does not compile, a test that fails without the mistake, and errors of the
    /// operating system.
    pub(super) fn with(
        &self,
        regression: &Regression,
        text: &str,
        recorded: bool,
    ) -> Result<PlantedRun, Unusable> {
        let Regression {
            name, file, test, ..
        } = regression;
        let full = regression.full.then_some(regression.study.as_str());
        let hash = self.hash ^ content_hash(format!("{file}\n{text}\n{test}").as_bytes());
        self.kept(name, hash, recorded, |key| {
            if full.is_some() {
                self.passing(recorded, full)?;
            }
            if let Some(failed) = self.failed_test(test)? {
                return Err(Unusable::because(&format!("without the mistake: {failed}")));
            }
            let path = self.tree().join(file);
            let honest = fs::read(&path)?;
            fs::write(&path, text)?;
            let found = self.verify(key, test, full);
            fs::write(&path, honest)?;
            found
        })
    }

    /// Runs a test; returns its line if it fails, and `None` if it passes or is not named.
    ///
    /// * `arguments`: of `cargo test`; the last is the whole name of the test.
    ///
    /// # Errors
    /// A test that is not found, that does not compile, or that ends without a result.
    fn failed_test(&self, arguments: &str) -> Result<Option<String>, Unusable> {
        let Some((options, name)) = arguments.rsplit_once(' ') else {
            return Ok(None);
        };
        let mut test = self.cargo("test");
        test.args(options.split(' '))
            .args(["--", "--exact", name])
            .current_dir(self.tree());
        let output = test.output()?;
        let text = String::from_utf8_lossy(&output.stdout);
        let passed = format!("test {name} ... ok");
        let result = text
            .lines()
            .find(|line| line.starts_with(&format!("test {name} ... ")));
        match result {
            Some(line) if line == passed && output.status.success() => Ok(None),
            Some(line) if line.ends_with("FAILED") => Ok(Some(line.to_owned())),
            _ => {
                let why = String::from_utf8_lossy(&output.stderr);
                Err(Unusable::because(&format!(
                    "`cargo test {arguments}` has no result:\n{why}"
                )))
            }
        }
    }

    /// Cargo with a command, for the copy.
    fn cargo(&self, command: &str) -> Command {
        let mut cargo = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
        cargo
            .args([command, "--profile", PROFILE, "--target-dir"])
            .arg(self.folder.join("build"));
        cargo.current_dir(self.tree());
        cargo
    }

    /// Earlier results under this name and hash, or otherwise new ones, which are kept.
    fn kept(
        &self,
        name: &str,
        hash: u64,
        recorded: bool,
        find: impl FnOnce(String) -> Result<PlantedRun, Unusable>,
    ) -> Result<PlantedRun, Unusable> {
        let name = name.replace(|letter: char| !letter.is_ascii_alphanumeric(), "-");
        let path = self.folder.join("records").join(name + ".json");
        let key = format!("{hash:016x}");
        let known = fs::read_to_string(&path)
            .ok()
            .and_then(|text| serde_json::from_str::<PlantedRun>(&text).ok());
        if let Some(known) = known.filter(|known| recorded || known.key == key) {
            return Ok(known);
        }
        if recorded {
            return Err(Unusable::because("nothing was recorded of it"));
        }
        let found = find(key)?;
        atomic::write(&path, json(&found)?)?;
        Ok(found)
    }

    /// Builds the copy and runs the quick tier, or in its place a study of the full tier.
    fn verify(&self, key: String, test: &str, full: Option<&str>) -> Result<PlantedRun, Unusable> {
        let [build, out] = ["build", "out"].map(|name| self.folder.join(name));
        let built = self
            .cargo("build")
            .args(["--quiet", "--package", "xtask"])
            .output()?;
        if !built.status.success() {
            let why = String::from_utf8_lossy(&built.stderr);
            return Err(Unusable::because(&format!("it does not compile:\n{why}")));
        }
        let program = build.join(format!("{PROFILE}/xtask{}", env::consts::EXE_SUFFIX));
        let mut verify = Command::new(&program);
        verify
            .args(["verify", "--time-limit", TIME_LIMIT, "--out"])
            .arg(&out)
            .current_dir(self.tree());
        let mut results = out.join("results.json");
        if let Some(study) = full {
            verify.args(["--tier", "full", study]);
            // The report of a selection is never that of a tier.
            results = out.join("local/partial/results.json");
        }
        verify
            .env_remove("CARGO_MANIFEST_DIR")
            .env_remove("GITHUB_STEP_SUMMARY")
            .env_remove("GITHUB_ACTIONS");
        let started = Instant::now();
        let output = verify
            .output()
            .map_err(|error| Unusable::file(&program, &error))?;
        let seconds = started.elapsed().as_secs_f64();
        let is_judged = output.status.code().is_some_and(|status| status <= 1);
        if !is_judged && test.is_empty() {
            let why = String::from_utf8_lossy(&output.stderr);
            return Err(Unusable::because(&format!("`verify` itself fails:\n{why}")));
        }
        let lines = output.stdout.iter().filter(|byte| **byte == b'\n').count();
        let mut record = if is_judged {
            Record::read(&results)?
        } else {
            // With a mistake in a reader `verify` may refuse the studies; the test decides.
            Record::new("quick", "verify", Verdict::Fail, None, vec![])
        };
        for study in &mut record.studies {
            study.outcome.tables.clear();
            study.outcome.figures.clear();
        }
        Ok(PlantedRun {
            key,
            seconds,
            lines,
            record,
            failed_test: self.failed_test(test)?,
        })
    }
}

impl PlantedRun {
    /// Whether `verify` passes, and the test named for the mistake, if one is.
    pub(super) fn is_unnoticed(&self) -> bool {
        self.record.verdict.is_pass() && self.failed_test.is_none()
    }

    /// The output, with a line for each reason of a study and each changed number; the study comes
    /// before a colon. The line of the test comes first.
    pub(super) fn said(&self) -> Vec<String> {
        let mut reasons = vec![];
        for study in not_passed(&self.record.studies) {
            let lines = study
                .items
                .iter()
                .map(|item| format!("{}: {item}", study.id()));
            reasons.extend(lines);
        }
        self.failed_test
            .iter()
            .cloned()
            .chain(reasons)
            .chain(self.record.baseline_changes.iter().cloned())
            .collect()
    }

    /// Whether the test named for the mistake fails; otherwise, whether `verify` fails and its
    /// output about the study contains the expected words; about any study if none is named.
    pub(super) fn is_named_by(
        &self,
        Regression {
            study, test, says, ..
        }: &Regression,
    ) -> bool {
        if !test.is_empty() {
            return self.failed_test.is_some();
        }
        let head = if study.is_empty() {
            String::new()
        } else {
            format!("{study}: ")
        };
        !self.record.verdict.is_pass()
            && self
                .said()
                .iter()
                .any(|line| line.starts_with(&head) && line.contains(says.as_str()))
    }
}

/// Makes a folder a copy of another. Unchanged files are not rewritten: cargo compiles files newer
/// than its last build, which includes any file that had a mistake.
///
/// * `hash`: hash of all files and their names, independent of their order.
fn made_alike(from: &Path, to: &Path, hash: &mut u64) -> io::Result<()> {
    fs::create_dir_all(to)?;
    for entry in fs::read_dir(from)? {
        let entry = entry?;
        let (name, source) = (entry.file_name(), entry.path());
        let target = to.join(&name);
        if is_left_out(&name.to_string_lossy()) {
            continue;
        }
        if entry.file_type()?.is_dir() {
            made_alike(&source, &target, hash)?;
        } else {
            let text = fs::read(&source)?;
            let named = [target.as_os_str().as_encoded_bytes(), &text].concat();
            *hash = hash.wrapping_add(content_hash(&named));
            if fs::read(&target).ok().as_ref() != Some(&text) {
                fs::write(&target, text)?;
            }
        }
    }
    for entry in fs::read_dir(to)? {
        let entry = entry?;
        let name = entry.file_name();
        if from.join(&name).exists() || is_left_out(&name.to_string_lossy()) {
            continue;
        }
        if entry.file_type()?.is_dir() {
            fs::remove_dir_all(entry.path())?;
        } else {
            fs::remove_file(entry.path())?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_copy_is_made_alike_and_what_is_the_same_is_not_written() {
        let folder = tempfile::tempdir().expect("a folder");
        let [from, to] = ["from", "to"].map(|name| folder.path().join(name));
        let write = |path: PathBuf, text: &str| {
            fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
            fs::write(path, text).expect("a file");
        };
        let younger = |name: &str| {
            fs::metadata(to.join(name))
                .and_then(|file| file.modified())
                .expect("a time")
        };
        for (name, text) in [
            ("src/a.rs", "a"),
            ("b", "b"),
            ("target/c", "c"),
            (".git/d", "d"),
        ] {
            write(from.join(name), text);
        }
        for (name, text) in [
            ("src/a.rs", "planted"),
            ("b", "b"),
            ("src/gone.rs", "e"),
            ("gone/f", "f"),
        ] {
            write(to.join(name), text);
        }
        let before = younger("b");
        let mut hashes = [0, 0, 0];
        made_alike(&from, &to, &mut hashes[0]).expect("a copy");
        assert_eq!(
            fs::read_to_string(to.join("src/a.rs")).expect("a file"),
            "a"
        );
        assert_eq!(younger("b"), before);
        made_alike(&from, &to, &mut hashes[1]).expect("a copy");
        write(from.join("b"), "c");
        made_alike(&from, &to, &mut hashes[2]).expect("a copy");
        assert!(
            hashes[0] == hashes[1] && hashes[1] != hashes[2],
            "{hashes:?}"
        );
        for name in ["src/gone.rs", "gone", "target", ".git"] {
            assert!(!to.join(name).exists(), "{name}");
        }
    }

    #[test]
    fn what_is_built_and_what_is_hidden_is_not_copied() {
        for name in ["target", "reports", ".git", ".ci"] {
            assert!(is_left_out(name), "{name}");
        }
        for name in [".cargo", "crates", "xtask", "regressions.toml"] {
            assert!(!is_left_out(name), "{name}");
        }
    }
}
