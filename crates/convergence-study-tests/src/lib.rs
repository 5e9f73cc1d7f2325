//! Programs under test: started, interrupted, and waited for with a limit; transcripts of them;
//! tables and files that tests read.

pub mod files;
pub mod refusals;
pub mod rows;
pub mod transcript;

use std::fs;
use std::process::{Child, Command, Output, Stdio};
use std::sync::mpsc;
use std::thread;
use std::time::Duration;

pub use refusals::says;

/// How long a test waits for a process. It only ends a test that would hang for ever: no test
/// compares a time with it.
pub const PATIENCE: Duration = Duration::from_secs(120);

/// Waits for the end of a process.
///
/// # Panics
/// The process runs, or holds its output open, for longer than [`PATIENCE`]; it is killed.
#[track_caller]
pub fn finished(child: Child) -> Output {
    let id = child.id();
    let (sender, receiver) = mpsc::channel();
    // The thread reads the output as well, and may outlive the test if a child of the process holds
    // it open.
    thread::spawn(move || sender.send(child.wait_with_output()));
    match receiver.recv_timeout(PATIENCE) {
        Ok(output) => output.expect("the output of a process"),
        Err(_) => {
            signal(id, "-KILL");
            panic!("process {id} has not ended within {PATIENCE:?}");
        }
    }
}

/// Starts a command, without input, and waits for its end; see [`finished`].
#[track_caller]
pub fn output(command: &mut Command) -> Output {
    finished(started(command))
}

/// Starts a command, without input and with its output kept.
#[track_caller]
pub fn started(command: &mut Command) -> Child {
    command
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped());
    command.spawn().expect("the program starts")
}

/// Sends a signal, in the words of `kill`: `-INT`.
#[track_caller]
pub fn signal(id: u32, name: &str) {
    assert!(
        Command::new("kill")
            .args([name, &id.to_string()])
            .status()
            .expect("kill")
            .success(),
        "{name}"
    );
}

/// The status and the output of a process that has ended.
#[derive(Debug, Clone, PartialEq)]
pub struct Ended {
    /// The exit status; `None` after a signal.
    pub status: Option<i32>,
    /// Standard output.
    pub stdout: String,
    /// Standard error.
    pub stderr: String,
}

impl From<Output> for Ended {
    /// # Panics
    /// The output is not UTF-8.
    fn from(
        Output {
            status,
            stdout,
            stderr,
        }: Output,
    ) -> Self {
        let text = |bytes| String::from_utf8(bytes).expect("UTF-8");
        Self {
            status: status.code(),
            stdout: text(stdout),
            stderr: text(stderr),
        }
    }
}

impl Ended {
    /// What a program printed that ended well, and did not complain.
    #[track_caller]
    pub fn well(&self) -> &str {
        assert!(self.status == Some(0) && self.stderr.is_empty(), "{self:?}");
        &self.stdout
    }

    /// A program that ended with this status, and printed these words.
    #[track_caller]
    pub fn says(&self, status: i32, words: &str) {
        assert_eq!(self.status, Some(status), "{self:?}");
        assert!(says(&self.stdout, words), "{words}: {self:?}");
    }

    /// A program that ended with this status, and said these words on standard error.
    #[track_caller]
    pub fn complains(&self, status: i32, words: &str) {
        assert_eq!(self.status, Some(status), "{self:?}");
        assert!(says(&self.stderr, words), "{words}: {self:?}");
    }

    /// What cannot be used: status 2, these words on standard error, nothing on standard output.
    #[track_caller]
    pub fn refuses(&self, words: &str) {
        self.complains(2, words);
        assert_eq!(self.stdout, "", "{words}");
    }
}

/// Runs a command to its end.
///
/// # Panics
/// The program panics, or runs for too long.
#[track_caller]
pub fn ended(command: &mut Command) -> Ended {
    let ended = Ended::from(output(command));
    assert!(!ended.stderr.contains("panicked"), "{}", ended.stderr);
    ended
}

/// The same command in a process that does not ignore interruption.
///
/// Shells make background jobs ignore it, and processes inherit that: a program started that way
/// rightly ignores it.
pub fn interruptible(command: &Command) -> Command {
    let mut listening = Command::new("env");
    if interruption_is_ignored() {
        listening.arg("--default-signal=INT");
    }
    listening
        .arg(command.get_program())
        .args(command.get_args());
    for (name, value) in command.get_envs() {
        match value {
            Some(value) => listening.env(name, value),
            None => listening.env_remove(name),
        };
    }
    if let Some(folder) = command.get_current_dir() {
        listening.current_dir(folder);
    }
    listening
}

/// Whether this process ignores interruption: bit 1 of the mask reported by Linux.
fn interruption_is_ignored() -> bool {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok())
        .is_some_and(|mask| mask & 2 != 0)
}
