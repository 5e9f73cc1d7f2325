//! Where a record comes from: machine, tools, revision and times. Everything that varies between
//! two runs is here.

use std::path::Path;
use std::process::Command;
use std::thread;
use std::time::{SystemTime, UNIX_EPOCH};
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
    /// Threads available on the machine.
    pub threads_available: Option<usize>,
    /// Threads used.
    pub jobs: usize,
    /// End of the run, in seconds since 1970.
    pub finished_at: Option<u64>,
    /// Time of each study.
    pub studies: Vec<StudyTime>,
}

/// Time of a study.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct StudyTime {
    /// Its id.
    pub id: String,
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
            git_revision: output_of(
                Command::new("git")
                    .args(["rev-parse", "HEAD"])
                    .current_dir(root),
            ),
            git_modified: output_of(
                Command::new("git")
                    .args(["status", "--porcelain"])
                    .current_dir(root),
            )
            .map(|changes| !changes.is_empty()),
            // A project without Rust was not compiled by what is installed here.
            toolchain: root
                .join("Cargo.toml")
                .exists()
                .then(|| output_of(Command::new(rustc).arg("--version").current_dir(root)))
                .flatten(),
            cpu: processor(),
            platform: format!("{} {}", std::env::consts::OS, std::env::consts::ARCH),
            threads_available: thread::available_parallelism().ok().map(usize::from),
            jobs,
            finished_at: SystemTime::now()
                .duration_since(UNIX_EPOCH)
                .ok()
                .map(|since| since.as_secs()),
            studies: record.studies.iter().map(time).collect(),
        }
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
        let date = self.finished_at.map(|seconds| date(seconds) + ".");
        let threads = match self.threads_available {
            Some(available) => format!("{} of {available} threads", self.jobs),
            None => format!("{} threads", self.jobs),
        };
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

/// Seconds since 1970 as a date with the time of day, in the Gregorian calendar.
///
/// Years begin in March here, so that the day that varies is the last one; the days before month m
/// of such a year are (153 m + 2)/5, rounded down, for m = 0, ..., 11. Four centuries have 146,097
/// days, a century 36,524 or one more, four years 1461 or one less.
fn date(seconds: u64) -> String {
    // Days since 1 March 0.
    let days = seconds / 86_400 + 719_468;
    let (era, day) = (days / 146_097, days % 146_097);
    let year = (day - day / 1460 + day / 36_524 - day / 146_096) / 365;
    let day = day - (365 * year + year / 4 - year / 100);
    let month = (5 * day + 2) / 153;
    let day = day - (153 * month + 2) / 5 + 1;
    let year = 400 * era + year + month / 10;
    let month = (month + 2) % 12 + 1;
    let [hour, minute] = [seconds / 3600 % 24, seconds / 60 % 60];
    format!("{year:04}-{month:02}-{day:02} {hour:02}:{minute:02} UTC")
}

fn time(Finished { header, spent, .. }: &Finished) -> StudyTime {
    StudyTime {
        id: header.id.clone(),
        busy_seconds: spent.busy.as_secs_f64(),
        wall_seconds: spent.wall.as_secs_f64(),
    }
}

/// Trimmed standard output of a command that succeeds.
fn output_of(command: &mut Command) -> Option<String> {
    let output = command
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Every day of 800 years, counted by months: with leap days, and without them in 2100, 2200,
    /// 2300 and 2500.
    #[test]
    fn each_day_has_the_date_of_the_calendar() {
        let mut seconds = 0;
        for year in 1970..2770_u64 {
            let is_leap = year % 4 == 0 && (year % 100 != 0 || year % 400 == 0);
            let february = if is_leap { 29 } else { 28 };
            let lengths = [31, february, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31];
            for (month, length) in (1..).zip(lengths) {
                for day in 1..=length {
                    let expected = format!("{year}-{month:02}-{day:02}");
                    assert_eq!(date(seconds), format!("{expected} 00:00 UTC"));
                    assert_eq!(date(seconds + 86_399), format!("{expected} 23:59 UTC"));
                    seconds += 86_400;
                }
            }
        }
        // `date -u -d @1764283500`.
        assert_eq!(date(1_764_283_500), "2025-11-27 22:45 UTC");
    }
}
