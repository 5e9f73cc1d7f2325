//! A copy of the work tree, compiled with a mistake in it, and what `verify` then prints.

use std::env;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use convergence_study::cli::exit::Unusable;

/// What the copy leaves out: what is built, what is written by the program, and what is hidden, but for `.cargo`.
fn is_left_out(name: &str) -> bool {
    matches!(name, "target" | "reports") || (name.starts_with('.') && name != ".cargo")
}

/// Profile of `cargo build`: optimised so far that the quick tier takes seconds, and compiled step by step.
const PROFILE: &str = "regressions";

/// Longest time of a case, in seconds: with a mistake in it one may never end.
const CASE_LIMIT: &str = "60";

/// Lines that are shown where a mistake is not noticed by the study named for it.
const SHOWN: usize = 12;

/// A copy of the work tree.
pub(super) struct Copy {
    /// `target/regressions`: the copy is below, in `tree`, and its target folder, in `build`.
    folder: PathBuf,
}

impl Copy {
    /// Copies the work tree as it is, changes that are not committed included.
    ///
    /// # Errors
    /// Those of the operating system.
    pub(super) fn of(root: &Path) -> Result<Self, Unusable> {
        let copy = Self { folder: root.join("target/regressions") };
        made_alike(root, &copy.tree())?;
        Ok(copy)
    }

    fn tree(&self) -> PathBuf {
        self.folder.join("tree")
    }

    /// Complains where `verify` does not pass without a mistake: then it would notice every one.
    pub(super) fn passes_as_it_is(&self) -> Result<(), Unusable> {
        let noticed = self.verify()?;
        if noticed.is_well {
            return Ok(());
        }
        Err(Unusable::because(&format!("without a mistake `verify` does not pass:\n{}", noticed.text())))
    }

    /// What `verify` notices with another text in one file, which is put back afterwards.
    ///
    /// # Errors
    /// A text that does not compile, and errors of the operating system.
    pub(super) fn with(&self, file: &str, text: &str) -> Result<Noticed, Unusable> {
        let path = self.tree().join(file);
        let honest = fs::read(&path)?;
        fs::write(&path, text)?;
        let noticed = self.verify();
        fs::write(&path, honest)?;
        noticed
    }

    fn verify(&self) -> Result<Noticed, Unusable> {
        let build = self.folder.join("build");
        let mut cargo = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
        cargo.args(["build", "--quiet", "--profile", PROFILE, "--package", "xtask", "--target-dir"]).arg(&build);
        let built = cargo.current_dir(self.tree()).output()?;
        if !built.status.success() {
            let why = String::from_utf8_lossy(&built.stderr);
            return Err(Unusable::because(&format!("it does not compile:\n{why}")));
        }
        let program = build.join(format!("{PROFILE}/xtask{}", env::consts::EXE_SUFFIX));
        let mut verify = Command::new(&program);
        verify.args(["verify", "--quiet", "--case-limit", CASE_LIMIT]).current_dir(self.tree());
        verify.env_remove("CARGO_MANIFEST_DIR").env_remove("GITHUB_STEP_SUMMARY").env_remove("GITHUB_ACTIONS");
        let output = verify.output().map_err(|error| Unusable::file(&program, &error))?;
        Ok(Noticed::of(&output))
    }
}

/// Makes a folder a copy of another. A file that is there and the same is not written: cargo compiles what is younger than
/// its last build, and what a mistake was in is younger.
fn made_alike(from: &Path, to: &Path) -> io::Result<()> {
    fs::create_dir_all(to)?;
    for entry in fs::read_dir(from)? {
        let entry = entry?;
        let (name, source) = (entry.file_name(), entry.path());
        let target = to.join(&name);
        if is_left_out(&name.to_string_lossy()) {
            continue;
        }
        if entry.file_type()?.is_dir() {
            made_alike(&source, &target)?;
        } else {
            let text = fs::read(&source)?;
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
        if entry.file_type()?.is_dir() { fs::remove_dir_all(entry.path())? } else { fs::remove_file(entry.path())? }
    }
    Ok(())
}

/// What `verify` says.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Noticed {
    is_well: bool,
    /// Study and line, in the order in which they are printed; of no study where `verify` itself failed.
    lines: Vec<(String, String)>,
}

impl Noticed {
    fn of(output: &Output) -> Self {
        let text = String::from_utf8_lossy(&output.stdout);
        let mut lines = lines(&text);
        if lines.is_empty() && !output.status.success() {
            let why = String::from_utf8_lossy(&output.stderr);
            lines.extend(why.lines().map(|line| (String::new(), line.to_owned())));
        }
        Self { is_well: output.status.success(), lines }
    }

    /// Whether something is printed about the study that has these words in it.
    pub(super) fn is_named_by(&self, study: &str, says: &str) -> bool {
        !self.is_well && self.lines.iter().any(|(of, line)| of == study && line.contains(says))
    }

    /// How many studies say something.
    pub(super) fn studies(&self) -> usize {
        let mut studies: Vec<&str> = self.lines.iter().map(|(study, _)| study.as_str()).collect();
        studies.sort_unstable();
        studies.dedup();
        studies.len()
    }

    /// The first words that a reader sees.
    pub(super) fn first(&self) -> &str {
        self.lines.first().map_or("nothing", |(_, line)| line)
    }

    /// The first lines of it.
    pub(super) fn text(&self) -> String {
        self.lines.iter().take(SHOWN).map(|(_, line)| format!("  {line}\n")).collect()
    }
}

/// The lines of `verify --quiet` that are about a study: a study that does not pass has its name and a verdict on a line of its
/// own, its reasons stand indented below; a number that has moved has `baseline: ` and the study's name before it.
fn lines(text: &str) -> Vec<(String, String)> {
    let mut found = vec![];
    let mut study = String::new();
    for line in text.lines() {
        if let Some(moved) = line.strip_prefix("baseline: ") {
            let of = moved.split(": ").next().unwrap_or_default().to_owned();
            found.push((of, moved.to_owned()));
        } else if let Some(reason) = line.strip_prefix("  ").filter(|_| !study.is_empty()) {
            found.push((study.clone(), format!("{study}: {reason}")));
        } else {
            let head = line.split_once(": ").filter(|(_, rest)| matches!(*rest, "fail" | "inconclusive"));
            study = head.map(|(id, _)| id.to_owned()).unwrap_or_default();
        }
    }
    found
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
        let younger = |name: &str| fs::metadata(to.join(name)).and_then(|file| file.modified()).expect("a time");
        for (name, text) in [("src/a.rs", "a"), ("b", "b"), ("target/c", "c"), (".git/d", "d")] {
            write(from.join(name), text);
        }
        for (name, text) in [("src/a.rs", "planted"), ("b", "b"), ("src/gone.rs", "e"), ("gone/f", "f")] {
            write(to.join(name), text);
        }
        let before = younger("b");
        made_alike(&from, &to).expect("a copy");
        assert_eq!(fs::read_to_string(to.join("src/a.rs")).expect("a file"), "a");
        assert_eq!(younger("b"), before);
        for name in ["src/gone.rs", "gone", "target", ".git"] {
            assert!(!to.join(name).exists(), "{name}");
        }
    }

    const PRINTED: &str = "theorem-3.4-space: fail\n  velocity: 1.000 (0.999 to 1.001), claimed 2 ± 0.005: too low\n  shear: x\n\n\
                           negative-controls: inconclusive\n  a: b\n\n\
                           baseline: equilibria: u(1) moved from 1 to 2\nbaseline: equilibria: and 7 more; --verbose lists all\n\
                           fail: 2 of 47 studies do not pass\n";

    #[test]
    fn what_is_printed_is_told_apart_by_study() {
        let noticed = Noticed { is_well: false, lines: lines(PRINTED) };
        assert_eq!((noticed.lines.len(), noticed.studies()), (5, 3));
        assert_eq!(noticed.first(), "theorem-3.4-space: velocity: 1.000 (0.999 to 1.001), claimed 2 ± 0.005: too low");
        for (study, says) in
            [("theorem-3.4-space", "shear"), ("equilibria", "u(1) moved"), ("negative-controls", "a: b")]
        {
            assert!(noticed.is_named_by(study, says), "{study}");
        }
        for (study, says) in [("theorem-3.4-space", "u(1)"), ("equilibria", "velocity"), ("theorem", "shear")] {
            assert!(!noticed.is_named_by(study, says), "{study}");
        }
        assert_eq!(lines("pass: all 47 studies pass; all 2035 baseline values unchanged\n"), []);
        let well = Noticed { is_well: true, lines: vec![] };
        assert!(!well.is_named_by("equilibria", "") && well.first() == "nothing");
    }

    #[test]
    fn what_is_built_and_what_is_hidden_is_not_copied() {
        let left_out = ["target", "reports", ".git", ".ci", ".cargo", "crates"].map(is_left_out);
        assert_eq!(left_out, [true, true, true, true, false, false]);
    }
}
