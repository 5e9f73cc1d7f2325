//! Runs one command to its end: no shell, no inherited standard input, a time limit, and nothing left behind.

use std::io::{self, Write};
use std::path::PathBuf;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError};
use std::thread;
use std::time::{Duration, Instant};

use thiserror::Error;

use super::answer::{Answer, AnswerError, Expected};
use super::guard::Group;
use super::output::{Printed, read_last_words, read_output};

/// Between the request to end and the signal that cannot be ignored.
const GRACE: Duration = Duration::from_secs(1);

/// How long the output of a program that has ended may stay open: a process that escaped may still hold it.
const DRAIN: Duration = Duration::from_secs(5);

/// Longest pause between two looks at a program; the first ones are shorter.
const LONGEST_PAUSE: Duration = Duration::from_millis(20);

/// A command with its arguments, ready to run.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Invocation {
    /// The program, then its arguments.
    pub(super) words: Vec<String>,
    /// Where it runs.
    pub(super) directory: PathBuf,
    /// What it reads from standard input; empty for nothing.
    pub(super) input: String,
    /// The longest time that it may take.
    pub(super) timeout: Duration,
}

/// Why a program has no answer. Each is one line that names the program.
#[derive(Debug, Error)]
pub(super) enum Failure {
    /// It is not there, or cannot be executed.
    #[error("{program} cannot be started: {error}")]
    NotStarted { program: String, error: io::Error },
    /// The operating system refuses the process that would watch over it.
    #[error("the guard of {program} cannot be started: {error}")]
    NoGuard { program: String, error: io::Error },
    /// It can be started, but not waited for.
    #[error("{program} cannot be waited for: {error}")]
    NotWaited { program: String, error: io::Error },
    /// It ended with another status than 0, or by a signal.
    #[error("{program} ended with {ending}{words}")]
    Ended { program: String, ending: String, words: LastWords },
    /// It took too long.
    #[error("{program} was stopped at the limit of {} s{words}", .limit.as_secs_f64())]
    TimedOut { program: String, limit: Duration, words: LastWords },
    /// No line is a JSON object.
    #[error("{program} answered nothing: {reason}{words}")]
    NoAnswer { program: String, reason: String, words: LastWords },
    /// The object is no answer.
    #[error("{program}: {error}{words}")]
    Unusable { program: String, error: AnswerError, words: LastWords },
}

/// What a program said last on standard error.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct LastWords(String);

impl std::fmt::Display for LastWords {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        if self.0.is_empty() { Ok(()) } else { write!(f, "; its last words: {}", self.0) }
    }
}

impl Invocation {
    /// Runs it, and reads its answer.
    ///
    /// * `expected`: what the answer must have.
    ///
    /// # Errors
    /// [`Failure`].
    pub(super) fn run(&self, expected: &[Expected]) -> Result<Answer, Failure> {
        let program = || crate::text::visible::visible(&self.words[0]);
        let mut group = Group::new().map_err(|error| Failure::NoGuard { program: program(), error })?;
        let mut child =
            group.start(&mut self.command()).map_err(|error| Failure::NotStarted { program: program(), error })?;
        let printed = in_background(child.stdout.take(), read_output);
        let words = in_background(child.stderr.take(), read_last_words);
        feed(&mut child, &self.input);
        let ended = self.wait(&mut child, &group);
        group.end(&mut child);
        let ended = ended.and_then(|in_time| Ok((child.wait()?, in_time)));
        let words = LastWords(words.recv_timeout(DRAIN).unwrap_or_default());
        let (status, in_time) = ended.map_err(|error| Failure::NotWaited { program: program(), error })?;
        if !in_time {
            return Err(Failure::TimedOut { program: program(), limit: self.timeout, words });
        }
        if !status.success() {
            return Err(Failure::Ended { program: program(), ending: ending(status), words });
        }
        let printed = match printed.recv_timeout(DRAIN) {
            Ok(printed) => printed,
            Err(RecvTimeoutError::Timeout | RecvTimeoutError::Disconnected) => {
                let reason = "a process that it has started holds its standard output open".to_owned();
                return Err(Failure::NoAnswer { program: program(), reason, words });
            }
        };
        let Some(object) = &printed.object else {
            return Err(Failure::NoAnswer { program: program(), reason: no_object(&printed), words });
        };
        let unusable = |error| Failure::Unusable { program: program(), error, words };
        let (mut answer, complaint) = match Answer::read(object) {
            Ok(read) => read,
            Err(error) => return Err(unusable(error)),
        };
        let missing = || expected.iter().find_map(|expected| answer.require(expected).err());
        answer.failure = complaint.or_else(missing).map(|error| unusable(error).into());
        Ok(answer)
    }

    fn command(&self) -> Command {
        let mut command = Command::new(&self.words[0]);
        let input = if self.input.is_empty() { Stdio::null() } else { Stdio::piped() };
        command.args(&self.words[1..]).current_dir(&self.directory);
        command.stdin(input).stdout(Stdio::piped()).stderr(Stdio::piped());
        command
    }

    /// Waits until the program has ended; returns whether it did so in time. One that did not is asked to end and given a moment for it.
    fn wait(&self, child: &mut Child, group: &Group) -> io::Result<bool> {
        let start = Instant::now();
        if has_ended_by(child, start.checked_add(self.timeout))? {
            return Ok(true);
        }
        group.ask_to_end(child);
        has_ended_by(child, Instant::now().checked_add(GRACE))?;
        Ok(false)
    }
}

/// Looks at the program until it has ended or the time has come; without a time, until it has ended.
fn has_ended_by(child: &mut Child, end: Option<Instant>) -> io::Result<bool> {
    let mut pause = Duration::from_micros(500);
    loop {
        if child.try_wait()?.is_some() {
            return Ok(true);
        }
        let left = end.map_or(Duration::MAX, |end| end.saturating_duration_since(Instant::now()));
        if left.is_zero() {
            return Ok(false);
        }
        thread::sleep(pause.min(left));
        pause = (pause * 2).min(LONGEST_PAUSE);
    }
}

/// Writes the case to standard input and closes it. A program that does not read it is none the worse.
fn feed(child: &mut Child, input: &str) {
    if let Some(mut stdin) = child.stdin.take() {
        let _ = stdin.write_all(input.as_bytes());
    }
}

/// Reads a stream in a thread of its own: a program that prints must not wait.
fn in_background<S: Send + 'static, T: Send + 'static>(stream: Option<S>, read: fn(S) -> T) -> Receiver<T> {
    let (send, receive) = mpsc::channel();
    if let Some(stream) = stream {
        // Where the thread cannot be started, the program's pipe is closed and nothing is received.
        let _ = thread::Builder::new().spawn(move || send.send(read(stream)));
    }
    receive
}

fn no_object(Printed { near_miss, last, .. }: &Printed) -> String {
    let last = match last {
        None => return "its standard output is empty".to_owned(),
        Some(last) => format!("the last line is `{last}`"),
    };
    match near_miss {
        Some(reason) => format!("its last line that begins with a brace is no JSON object ({reason}); {last}"),
        None => format!("no line of its standard output is a JSON object; {last}"),
    }
}

/// Exit status or signal, in words.
fn ending(status: ExitStatus) -> String {
    #[cfg(unix)]
    {
        use std::os::unix::process::ExitStatusExt;
        if let Some(number) = status.signal() {
            let name =
                nix::sys::signal::Signal::try_from(number).map_or(String::new(), |signal| format!(" ({signal})"));
            return format!("signal {number}{name}");
        }
    }
    status.code().map_or_else(|| "no exit status".to_owned(), |code| format!("exit status {code}"))
}
