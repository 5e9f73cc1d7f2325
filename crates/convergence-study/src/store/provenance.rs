//! Where a record comes from: machine, tools, revision and times. Everything that varies between
//! two runs is here.

use std::ffi::OsStr;
use std::path::Path;
use std::process::Command;
use std::time::{Duration, SystemTime, UNIX_EPOCH};
use std::{fs, io};

use serde::{Deserialize, Serialize};

use crate::project::Project;
use crate::run::{Finished, available};
use crate::store::{Record, SCHEMA, read_if_there};
use convergence_judge::verdict::Verdict;

/// Origin of a run. Unknown values are `null`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Provenance {
    /// `SCHEMA`.
    pub schema: u32,
    /// Version of this crate.
    pub crate_version: String,
    /// The command that was run.
    pub command: String,
    /// Git revision of the working tree.
    pub git_revision: Option<String>,
    /// Whether the working tree differs from that revision.
    pub git_modified: Option<bool>,
    /// The output of `rustc --version`, in a project of Rust.
    pub toolchain: Option<String>,
    /// Model of the processor.
    pub cpu: Option<String>,
    /// Operating system and architecture.
    pub platform: String,
    /// Threads available on the machine; 1 if unknown.
    pub threads_available: usize,
    /// Threads used.
    pub jobs: usize,
    /// End of the run, in seconds since 1970.
    pub finished_at: Option<u64>,
    /// The last run of each study.
    pub studies: Vec<LastRun>,
}

/// The last run of a study on this machine.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct LastRun {
    /// Its id.
    pub id: String,
    /// What it found; unknown in older files.
    #[serde(default)]
    pub verdict: Option<Verdict>,
    /// Sum over all cases, on all threads.
    pub busy_seconds: f64,
    /// From the start of the first case to the end of the last one.
    pub wall_seconds: f64,
}

impl Project {
    /// The machine, the tools and the revision of what runs here, in sentences.
    ///
    /// * `root`: a folder of the working tree.
    pub fn provenance(root: &Path) -> Vec<String> {
        let record = Record::new("", "", Verdict::Pass, None, vec![]);
        Provenance::collect(root, &record, available().get()).sentences()
    }
}

impl Provenance {
    /// Collects machine, tools, revision and times of a run.
    ///
    /// * `root`: a folder of the working tree.
    /// * `jobs`: number of threads.
    pub(crate) fn collect(root: &Path, record: &Record, jobs: usize) -> Self {
        let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
        Self {
            schema: SCHEMA,
            crate_version: env!("CARGO_PKG_VERSION").to_owned(),
            command: record.command.clone(),
            git_revision: output_of(root, "git", &["rev-parse", "HEAD"]),
            git_modified: output_of(root, "git", &["status", "--porcelain"])
                .map(|changes| !changes.is_empty()),
            // A project without Rust was not compiled by what is installed here.
            toolchain: root
                .join("Cargo.toml")
                .exists()
                .then(|| output_of(root, rustc, &["--version"]))
                .flatten(),
            cpu: processor(),
            platform: format!("{} {}", std::env::consts::OS, std::env::consts::ARCH),
            threads_available: available().get(),
            jobs,
            finished_at: SystemTime::now()
                .duration_since(UNIX_EPOCH)
                .ok()
                .map(|since| since.as_secs()),
            studies: record.studies.iter().map(last_run).collect(),
        }
    }

    /// Keeps the last runs of studies that are not among its own.
    pub(crate) fn keep(&mut self, earlier: Option<Self>) {
        let mut others = earlier.map(|earlier| earlier.studies).unwrap_or_default();
        others.retain(|one| self.studies.iter().all(|own| own.id != one.id));
        self.studies.append(&mut others);
    }

    /// Reads the origin of a run; `None` if there is no file.
    pub(crate) fn read(path: &Path) -> io::Result<Option<Self>> {
        read_if_there(path, None, ["remove it: `verify` writes it anew"; 2])
    }

    /// Commit, date, machine and tools in a sentence each, as far as known.
    pub(crate) fn sentences(&self) -> Vec<String> {
        let changed = if self.git_modified == Some(true) {
            ", with changes that are not committed"
        } else {
            ""
        };
        let commit = self
            .git_revision
            .as_ref()
            .map(|revision| format!("Commit {revision}{changed}."));
        let ended = self
            .finished_at
            .map(|seconds| UNIX_EPOCH + Duration::from_secs(seconds));
        let date = ended.map(|ended| format!("{}.", humantime::format_rfc3339_seconds(ended)));
        let threads = format!("{} of {} threads", self.jobs, self.threads_available);
        let cpu = self.cpu.as_deref().unwrap_or("an unknown processor");
        let machine = Some(format!("{cpu}, {}, {threads}.", self.platform));
        let toolchain = self
            .toolchain
            .as_ref()
            .map(|toolchain| format!("{toolchain}."));
        [commit, date, machine, toolchain]
            .into_iter()
            .flatten()
            .collect()
    }
}

fn last_run(
    Finished {
        header,
        outcome,
        spent,
        ..
    }: &Finished,
) -> LastRun {
    LastRun {
        id: header.id.clone(),
        verdict: Some(outcome.verdict),
        busy_seconds: spent.busy.as_secs_f64(),
        wall_seconds: spent.wall.as_secs_f64(),
    }
}

/// Trimmed standard output of a program that succeeds in this folder.
fn output_of(folder: &Path, program: impl AsRef<OsStr>, arguments: &[&str]) -> Option<String> {
    let output = Command::new(program)
        .args(arguments)
        .current_dir(folder)
        .output()
        .ok()
        .filter(|output| output.status.success())?;
    String::from_utf8(output.stdout)
        .ok()
        .map(|text| text.trim().to_owned())
}

/// The model of the processor, on Linux.
fn processor() -> Option<String> {
    let text = fs::read_to_string("/proc/cpuinfo").ok()?;
    let line = text.lines().find(|line| line.starts_with("model name"))?;
    line.split_once(':')
        .map(|(_, model)| model.trim().to_owned())
}
