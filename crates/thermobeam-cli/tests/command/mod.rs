//! The commands as used by scripts: arguments, exit status, standard output and error, files.

mod equilibria;
mod examples;
mod flags;
#[cfg(unix)]
mod full_disk;
#[cfg(unix)]
mod interrupted;
mod killed;
mod refusals;
mod sweep;
mod workspace;

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

use convergence_study_tests::refusals::each_is_refused;
use convergence_study_tests::{Ended, ended, finished, says, started};
use serde_json::Value;
use tempfile::TempDir;
use thermobeam_cli::{GROUPS, PAGES, Thermobeam, project};

use flags::place;
use workspace::{all, quick, set, verify, workspace};

/// A folder for one test, removed at its end.
struct Folder(TempDir);

impl Folder {
    fn new() -> Self {
        Self(tempfile::tempdir().expect("a folder"))
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// Writes a file and returns its path.
    fn file(&self, name: &str, text: &str) -> PathBuf {
        let path = self.path(name);
        fs::write(&path, text).expect("a file");
        path
    }

    /// How a command line ends in this folder; none of its words has a blank.
    fn ended(&self, line: &str) -> Ended {
        ended(&mut command(self.0.path(), line))
    }

    /// The same with `--format json`: how it ends, and the object that it prints.
    fn json(&self, line: &str) -> (Ended, Value) {
        let ended = self.ended(&format!("{line} --format json"));
        let value = serde_json::from_str(&ended.stdout);
        let value = value.unwrap_or_else(|error| panic!("{error}: {ended:?}"));
        (ended, value)
    }
}

/// The program, ready for arguments.
fn thermobeam() -> Command {
    Command::new(env!("CARGO_BIN_EXE_thermobeam"))
}

/// A command line in a folder.
fn command(folder: &Path, line: &str) -> Command {
    let mut command = thermobeam();
    command.args(line.split_whitespace()).current_dir(folder);
    command
}

/// The number at a path of keys.
#[track_caller]
fn number(value: &Value, path: &str) -> f64 {
    let found = value.pointer(path).and_then(Value::as_f64);
    found.unwrap_or_else(|| panic!("no number {path} in {value}"))
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// The paper's first experiment at β = 0 with 20 elements, and the given lines in `[time]`.
fn thrown(time: &str) -> String {
    format!(
        "[obstacles]\n[initial]\nu = \"0.01*x*(x-2)\"\nu_t = \"20*x*(x-1)^2\"\ntheta = \"sin(pi*x)\"\n\
         [mesh]\nelements = 20\n[time]\nt_end = 1.0\n{time}\n"
    )
}
