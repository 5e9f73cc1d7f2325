//! The tests that judge, run by cargo-mutants.

use std::num::NonZeroUsize;
use std::path::Path;
use std::process::{Command, Stdio};

use super::list::{Mutant, Target};
use convergence_study::cli::exit::Unusable;

/// What the tests make of a mutant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Judged {
    /// A test failed.
    Caught,
    /// No test noticed.
    Missed,
    /// The tests did not end.
    Timeout,
    /// It does not compile.
    Unviable,
}

impl Judged {
    /// With the names of cargo-mutants' lists.
    pub(super) const ALL: [(&str, Judged); 4] = [
        ("caught", Judged::Caught),
        ("missed", Judged::Missed),
        ("timeout", Judged::Timeout),
        ("unviable", Judged::Unviable),
    ];

    pub(super) fn name(self) -> &'static str {
        Self::ALL.iter().find(|(_, judged)| *judged == self).map_or("", |(name, _)| name)
    }
}

/// Tests that judge.
pub(super) struct Judge {
    pub(super) name: &'static str,
    tests: fn(&Target) -> Tests,
}

/// What a judge has `cargo test` do for a mutant of a target.
struct Tests {
    package: &'static str,
    /// Which tests are compiled.
    targets: Vec<&'static str>,
    /// Their arguments.
    arguments: Vec<&'static str>,
}

/// The cheapest first; each judges what those before it have missed.
pub(super) const JUDGES: [Judge; 3] = [
    Judge { name: "own tests that notice most", tests: first_tests },
    Judge { name: "all tests about it", tests: own_tests },
    Judge { name: "quick tier", tests: quick_tier },
];

fn first_tests(target: &Target) -> Tests {
    let arguments = target.slow.iter().flat_map(|test| ["--skip", test]).collect();
    Tests { package: target.package, targets: target.first.to_vec(), arguments }
}

fn own_tests(target: &Target) -> Tests {
    let (package, tests) = target.tests;
    Tests { package, targets: tests.to_vec(), arguments: vec![] }
}

fn quick_tier(_: &Target) -> Tests {
    Tests { package: "xtask", targets: vec!["--test=quick_tier"], arguments: vec!["--ignored"] }
}

/// Complains where cargo-mutants is not there.
pub(super) fn is_installed() -> Result<(), Unusable> {
    let mut command = Command::new("cargo");
    command.args(["mutants", "--version"]).stdin(Stdio::null());
    let found = command.output().is_ok_and(|output| output.status.success());
    let how = "cargo-mutants is not installed; `cargo install --locked cargo-mutants` does it";
    if found { Ok(()) } else { Err(Unusable::because(how)) }
}

impl Judge {
    /// Judges mutants of one package.
    pub(super) fn judge<'m>(
        &self,
        root: &Path,
        mutants: &[&'m Mutant],
        jobs: NonZeroUsize,
    ) -> Result<Vec<(&'m Mutant, Judged)>, Unusable> {
        let Some(first) = mutants.first() else { return Ok(vec![]) };
        let folder = root.join("target/mutants");
        let Tests { package, targets, arguments } = (self.tests)(first.target);
        let mut command = Command::new("cargo");
        command.args(["mutants", "--colors=never", "--package", first.target.package, "--test-package", package]);
        command.arg("--output").arg(&folder).arg("--jobs").arg(jobs.to_string());
        for mutant in mutants {
            // By file, too: fields deleted from a struct are mutants whatever the expression says.
            command.arg("--file").arg(&mutant.file).arg("--re").arg(format!("^{}$", escaped(&mutant.name)));
        }
        // Compiled is only what judges: what stands behind `--` counts when the tests are run, not when they are built.
        command.args(targets.iter().map(|target| format!("--cargo-arg={target}")));
        let build = folder.join("build");
        if package != first.target.package {
            // cargo-mutants would look for these tests in the package of the mutants, where there are none of that name.
            pass_without_a_mutant(root, &build, package, &[&targets[..], &["--"], &arguments].concat())?;
            command.args(["--baseline=skip", "--timeout=900"]);
        }
        if jobs == NonZeroUsize::MIN {
            // The packages of others are then compiled once for all batches.
            command.env("CARGO_TARGET_DIR", &build);
        }
        let status = command.args(["--", "--"]).args(arguments).current_dir(root).stdout(Stdio::null()).status()?;
        let judged = judged(&folder.join("mutants.out"), mutants);
        // 0: all caught, 2: some missed, 3: some did not end.
        match status.code() {
            Some(0 | 2 | 3) if !judged.is_empty() => Ok(judged),
            _ => Err(Unusable::because(&format!(
                "cargo mutants ended with {status}: do the tests pass without a mutant? see target/mutants/mutants.out"
            ))),
        }
    }
}

/// Complains where the tests fail although nothing is planted: every mutant would seem to be caught.
fn pass_without_a_mutant(root: &Path, build: &Path, package: &str, tests: &[&str]) -> Result<(), Unusable> {
    let mut command = Command::new("cargo");
    command.args(["test", "--quiet", "--profile=mutants", "--package", package]).args(tests);
    let status = command.env("CARGO_TARGET_DIR", build).current_dir(root).stdout(Stdio::null()).status()?;
    let shown = format!("cargo test --profile=mutants --package {package} {}", tests.join(" "));
    if status.success() { Ok(()) } else { Err(Unusable::because(&format!("without a mutant this fails: {shown}"))) }
}

/// What the lists say of these mutants.
fn judged<'m>(folder: &Path, mutants: &[&'m Mutant]) -> Vec<(&'m Mutant, Judged)> {
    let read = |(name, judged)| {
        let text = std::fs::read_to_string(folder.join(format!("{name}.txt"))).unwrap_or_default();
        let of = |line: &str| mutants.iter().find(|mutant| mutant.name == line).map(|mutant| (*mutant, judged));
        text.lines().filter_map(of).collect::<Vec<_>>()
    };
    Judged::ALL.into_iter().flat_map(read).collect()
}

/// A text as a regular expression that matches it alone. Only what means something there may be escaped: not a dash of a
/// typesetter's, nor angle brackets, which escaped are the edges of words.
fn escaped(text: &str) -> String {
    let special = |c: char| c.is_ascii_punctuation() && !"_/<>".contains(c);
    text.chars().flat_map(|c| special(c).then_some('\\').into_iter().chain([c])).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_means_something_in_an_expression_is_escaped() {
        let name = "src/a.rs:3:9: replace f -> Vec<f64> with vec![]";
        assert_eq!(escaped(name), r"src/a\.rs\:3\:9\: replace f \-> Vec<f64> with vec\!\[\]");
        assert_eq!(escaped("delete match arm \"−\" | 'φ_1'"), "delete match arm \\\"−\\\" \\| \\'φ_1\\'");
    }
}
