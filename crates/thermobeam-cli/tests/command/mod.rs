//! The commands as used by scripts: arguments, exit status, standard output and error, files.

mod accuracy;
mod any_order;
mod equilibria;
mod examples;
mod failure;
mod first_steps;
mod flags;
#[cfg(unix)]
mod full_disk;
#[cfg(unix)]
mod interrupted;
mod killed;
mod places;
mod refusals;
#[cfg(unix)]
mod run;
mod sweep;
mod time_limit;
mod workspace;

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::atomic::{AtomicUsize, Ordering};

use convergence_study_tests::{Ended, ended};

/// A folder for one test, removed at its end.
struct Folder(PathBuf);

impl Folder {
    fn new() -> Self {
        static COUNT: AtomicUsize = AtomicUsize::new(0);
        let count = COUNT.fetch_add(1, Ordering::Relaxed);
        let path =
            std::env::temp_dir().join(format!("thermobeam-command-{}-{count}", std::process::id()));
        std::fs::create_dir_all(&path).expect("a folder");
        Self(path)
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    /// Writes a file and returns its path.
    fn file(&self, name: &str, text: &str) -> PathBuf {
        let path = self.path(name);
        std::fs::write(&path, text).expect("a file");
        path
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// The program, ready for arguments.
fn thermobeam() -> Command {
    Command::new(env!("CARGO_BIN_EXE_thermobeam"))
}

/// `run SCENE --format json`, parsed.
fn run_json(scene: &Path) -> (Ended, serde_json::Value) {
    let ended = ended(
        thermobeam()
            .arg("run")
            .arg(scene)
            .args(["--format", "json"]),
    );
    let value = serde_json::from_str(&ended.stdout)
        .unwrap_or_else(|e| panic!("{e}: {}{}", ended.stdout, ended.stderr));
    (ended, value)
}

/// The paper's first experiment at β = 0 with 20 elements, and the given lines in `[time]`.
fn thrown(time: &str) -> String {
    format!(
        "[obstacles]\n[initial]\nu = \"0.01*x*(x-2)\"\nu_t = \"20*x*(x-1)^2\"\ntheta = \"sin(pi*x)\"\n\
         [mesh]\nelements = 20\n[time]\nt_end = 1.0\n{time}\n"
    )
}

/// Keys of a JSON text printed one per line, in their order, with those of inner objects indented.
fn keys(json: &str) -> Vec<String> {
    let key = |line: &str| {
        let (name, _) = line.trim_start().strip_prefix('"')?.split_once("\":")?;
        Some(format!(
            "{}{name}",
            " ".repeat((line.len() - line.trim_start().len()) / 2 - 1)
        ))
    };
    json.lines().filter_map(key).collect()
}
