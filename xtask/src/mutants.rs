//! `mutants`: `cargo-mutants` on the numerics and the verdicts, with what only this project knows about its mutants.
//!
//! `cargo-mutants` plants one mistake at a time, runs the tests, and leaves out what they have caught before (`--iterate`). This
//! file knows which tests judge which sources, and that what these tests miss is for the quick tier of `verify`. A survivor must be
//! on the list of those that change nothing, each with its reason, or the command fails.

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

use convergence_study::cli::exit::{Ended, Outcome, Unusable};
use convergence_study::cli::{output, workspace};
use serde::Deserialize;

/// Survivors that are accepted.
const ACCEPTED: &str = ".cargo/mutants-accepted.toml";

/// Package, files, package of the tests that judge them, and these tests.
type Target = (&'static str, &'static [&'static str], &'static str, &'static [&'static str]);

/// What is mutated.
const TARGETS: [Target; 3] = [
    ("thermobeam", &["crates/thermobeam/src/**"], "thermobeam", &["--tests"]),
    (
        "thermobeam-exact",
        &["crates/thermobeam-exact/src/**"],
        "thermobeam-study",
        &["--test=manufactured", "--test=input"],
    ),
    (
        "convergence-study",
        &["crates/convergence-study/src/judge/fit*", "crates/convergence-study/src/judge/verdict*"],
        "convergence-study",
        &["--lib", "--test=fit", "--test=verdict_laws", "--test=verdict_rule"],
    ),
];

/// The second judge, of what the first has missed.
const QUICK_TIER: [&str; 2] = ["--test=quick_tier", "--ignored"];

/// Judge the tests: do they notice a mistake in the solver or in the verdicts?
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// Judge the mutants of this package only
    #[arg(long, value_parser = TARGETS.map(|(package, ..)| package))]
    package: Option<String>,
    /// Further arguments of cargo-mutants, such as --file, --jobs or --shard
    #[arg(last = true, value_name = "ARGUMENT")]
    more: Vec<String>,
}

/// The mutants that may survive.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct Accepted {
    #[serde(default)]
    accepted: Vec<Entry>,
}

/// One of them, or several of one line: by what it says, for line numbers change.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Entry {
    file: String,
    /// As cargo-mutants calls it, without the place.
    mutant: String,
    /// The line of the file, without blanks at its ends.
    code: String,
    reason: String,
}

impl Accepted {
    /// Reads the list; without one nothing is accepted.
    fn read(root: &Path) -> Result<Self, Unusable> {
        let path = root.join(ACCEPTED);
        if !path.exists() {
            return Ok(Self::default());
        }
        let text = fs::read_to_string(&path).map_err(|error| Unusable::file(&path, &error))?;
        let list: Self = toml::from_str(&text).map_err(|error| Unusable::file(&path, &error))?;
        match list.accepted.iter().find(|entry| entry.reason.trim().is_empty()) {
            Some(entry) => Err(Unusable::because(&format!("{ACCEPTED}: no reason for `{}`", entry.mutant))),
            None => Ok(list),
        }
    }

    /// Whether a mutant `file:line:column: what` may survive.
    fn has(&self, root: &Path, mutant: &str) -> bool {
        let found = mutant.split_once(": ").and_then(|(place, what)| {
            let mut place = place.split(':');
            let (file, line) = (place.next()?, place.next()?.parse::<usize>().ok()?);
            let text = fs::read_to_string(root.join(file)).ok()?;
            let code = text.lines().nth(line.checked_sub(1)?)?.trim();
            let is = |entry: &Entry| (&*entry.file, &*entry.mutant, &*entry.code) == (file, what, code);
            Some(self.accepted.iter().any(is))
        });
        found == Some(true)
    }

    /// Entries whose line is no longer in their file.
    fn stale(&self, root: &Path) -> Vec<&Entry> {
        let is_there = |entry: &&Entry| {
            let text = fs::read_to_string(root.join(&entry.file)).unwrap_or_default();
            text.lines().any(|line| line.trim() == entry.code)
        };
        self.accepted.iter().filter(|entry| !is_there(entry)).collect()
    }
}

/// Runs the command.
pub(crate) fn run(arguments: &Arguments) -> Outcome {
    let root = workspace::root()?;
    let accepted = Accepted::read(&root)?;
    let version = Command::new("cargo").args(["mutants", "--version"]).stdin(Stdio::null()).output();
    if !version.is_ok_and(|output| output.status.success()) {
        let how = "cargo-mutants is not installed; `cargo install --locked cargo-mutants` does it";
        return Err(Unusable::because(how));
    }
    let mut survivors = vec![];
    for target in TARGETS.iter().filter(|(name, ..)| arguments.package.as_ref().is_none_or(|package| package == name)) {
        let (package, files, of_tests, tests) = *target;
        let files = files.iter().flat_map(|file| ["--file", file]).map(str::to_owned);
        let first = missed(&root, package, [of_tests, package], tests, files.chain(arguments.more.clone()).collect())?;
        let open: Vec<String> = first.into_iter().filter(|mutant| !accepted.has(&root, mutant)).collect();
        if !open.is_empty() {
            let those = open.iter().flat_map(|mutant| ["--re".to_owned(), format!("^{}$", escaped(mutant))]).collect();
            survivors.extend(missed(&root, package, ["xtask", "quick-tier"], &QUICK_TIER, those)?);
        }
    }
    survivors.iter().for_each(|mutant| output::complain(&format!("missed: {mutant}")));
    let stale = accepted.stale(&root);
    for Entry { file, mutant, code, .. } in &stale {
        output::complain(&format!("{ACCEPTED}: no such line: {file}: {mutant} in `{code}`"));
    }
    output::print(&format!("{} mutants missed that {ACCEPTED} does not have\n", survivors.len()))?;
    Ok(if survivors.is_empty() && stale.is_empty() { Ended::Well } else { Ended::Badly })
}

/// The mutants of a package that these tests miss, by what cargo-mutants writes to `target/mutants`.
///
/// * `of`: the package of the tests, and the folder.
/// * `tests`: which are compiled, and `--ignored`, which is for the tests themselves.
fn missed(
    root: &Path,
    package: &str,
    of: [&str; 2],
    tests: &[&str],
    more: Vec<String>,
) -> Result<Vec<String>, Unusable> {
    let folder = root.join("target/mutants").join(of[1]);
    let (own, compiled): (Vec<&str>, Vec<&str>) = tests.iter().partition(|test| **test == "--ignored");
    let mut command = Command::new("cargo");
    command.args(["mutants", "--iterate", "--colors=never", "--package", package, "--test-package", of[0], "--output"]);
    command.arg(&folder).args(more);
    if of[0] != package {
        // cargo-mutants would look for these tests in the package of the mutants, where there are none of that name.
        pass_without_a_mutant(root, of[0], &[&compiled[..], &["--"], &own].concat())?;
        command.args(["--baseline=skip", "--timeout=900"]);
    }
    command.args(compiled.iter().map(|test| format!("--cargo-arg={test}"))).args(["--", "--"]).args(own);
    fs::create_dir_all(&folder)?;
    let status = command.current_dir(root).stdout(Stdio::null()).status()?;
    // 0: all caught, 2: some missed, 3: some did not end.
    match (status.code(), fs::read_to_string(folder.join("mutants.out/missed.txt"))) {
        (Some(0 | 2 | 3), Ok(missed)) => Ok(missed.lines().map(str::to_owned).collect()),
        _ => Err(Unusable::because(&format!(
            "cargo mutants ended with {status}: do the tests pass without a mutant? see {}",
            folder.join("mutants.out").display()
        ))),
    }
}

/// Complains where the tests fail although nothing is planted: every mutant would seem to be caught.
fn pass_without_a_mutant(root: &Path, package: &str, tests: &[&str]) -> Result<(), Unusable> {
    let arguments = [&["test", "--quiet", "--profile=mutants", "--package", package], tests].concat();
    let status = Command::new("cargo").args(&arguments).current_dir(root).stdout(Stdio::null()).status()?;
    let why = format!("without a mutant this fails: cargo {}", arguments.join(" "));
    if status.success() { Ok(()) } else { Err(Unusable::because(&why)) }
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
