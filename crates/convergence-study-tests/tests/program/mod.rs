//! Studies of programs: `powers` is the harness, `solver` the program that its studies run.

mod processes;
mod refused;

use crate::command_line::{command, texts};
use convergence_study_tests::{Ended, PATIENCE, started};
use std::fs;
use std::process::{Child, Command};
use std::thread::sleep;
use std::time::{Duration, Instant};
use tempfile::TempDir;

const SOLVER: &str = env!("CARGO_BIN_EXE_solver");

/// A folder with the study `s.toml` of the solver in this mode; the path of the folder marks its
/// processes.
struct Place {
    folder: TempDir,
    /// More keys of `[program]`.
    more: String,
}

impl Place {
    fn new(mode: &str, more: &str) -> Self {
        let place = Self {
            folder: tempfile::tempdir().unwrap(),
            more: more.to_owned(),
        };
        place.write(mode);
        place
    }

    fn write(&self, mode: &str) {
        let command = [SOLVER, self.token(), mode, "{n}"].map(|word| format!("{word:?}"));
        self.write_text(&format!(
            "[study]\nid = \"s\"\nclaim = \"second order\"\ntier = \"quick\"\nkind = \"program\"\n\
             [program]\ncommand = [{}]\n{}\n[refine]\nn = [4, 8, 16, 32, 64]\n\
             [[expect]]\nerror = \"L2\"\norder = 2.0\ntolerance = 0.05\n",
            command.join(", "),
            self.more
        ));
    }

    fn write_text(&self, text: &str) {
        fs::write(self.folder.path().join("s.toml"), text).unwrap();
    }

    fn token(&self) -> &str {
        self.folder.path().to_str().unwrap()
    }

    fn command(&self, line: &str) -> Command {
        let words: Vec<&str> = line.split_whitespace().collect();
        let mut command = command(self.folder.path(), &words);
        command.env_remove("CARGO_MANIFEST_DIR");
        command
    }

    /// Exit status, standard output and standard error of `study s.toml` with these arguments.
    fn study(&self, more: &str) -> Ended {
        texts(&mut self.command(&format!("study s.toml {more}")))
    }

    fn start(&self) -> Child {
        started(&mut self.command("study s.toml --jobs 2"))
    }

    /// Command lines of the running processes of this test.
    fn running(&self) -> Vec<String> {
        let processes = fs::read_dir("/proc").unwrap().flatten();
        let command_line = |entry: fs::DirEntry| {
            let bytes = fs::read(entry.path().join("cmdline")).ok()?;
            Some(String::from_utf8_lossy(&bytes).replace('\0', " "))
        };
        processes
            .filter_map(command_line)
            .filter(|line| line.contains(self.token()))
            .collect()
    }

    /// Waits until the number of running processes satisfies `so_many`.
    fn wait_for(&self, so_many: impl Fn(usize) -> bool) {
        let start = Instant::now();
        while !so_many(self.running().len()) {
            assert!(
                start.elapsed() < PATIENCE,
                "still running: {:#?}",
                self.running()
            );
            sleep(Duration::from_millis(5));
        }
    }
}
