//! The command of a case: its words, with placeholders such as `{n}`, and its run from start to
//! end: no shell, no inherited standard input, a time limit, and nothing left behind.

use std::path::PathBuf;
use std::process::{ChildStdout, Command, ExitStatus};
use std::sync::mpsc::{self, Receiver};
use std::thread;
use std::time::Duration;

use super::answer::Answer;
use super::expectation::Expectation;
use super::guard::{Ending, NotStarted, Running};
use super::launch::CaseParameter;
use super::output::{read_last_words, read_output};
use crate::input::shorten;
use crate::study::CaseFailure;
use crate::text::names::{did_you_mean, nearest};
use crate::text::visible::visible;

/// How long the output of an ended program may stay open: a process that escaped may still hold it.
pub(super) const DRAIN: Duration = Duration::from_secs(5);

/// Why the output of a program that has ended is not known.
pub(super) const HELD_OPEN: &str = "a process that it has started holds its standard output open";

/// A command with its arguments, ready to run.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Invocation {
    /// The program, then its arguments.
    pub(super) words: Vec<String>,
    /// The folder in which it runs.
    pub(super) directory: PathBuf,
    /// Variables of its environment beside those of the harness; the last one of a name counts.
    pub(super) variables: Vec<(String, String)>,
    /// Its standard input; may be empty.
    pub(super) input: String,
    /// Its time limit.
    pub(super) time_limit: Duration,
}

/// A program that has ended with status 0.
pub(super) struct Ended<T> {
    /// What was read of its standard output; it may still be held open.
    pub(super) printed: Receiver<T>,
    /// Its last words on standard error, with what leads to them; may be empty.
    pub(super) words: String,
}

impl Invocation {
    /// Runs the command, and reads its answer.
    ///
    /// * `expected`: what the answer must contain.
    ///
    /// # Errors
    /// The program cannot be started, ended with a status other than 0, took too long, or gave no
    /// answer: in one line that names it.
    pub(super) fn run(&self, expected: &[Expectation]) -> Result<Answer, CaseFailure> {
        let wanted = expected.to_vec();
        let Ended { printed, words } = self.end_of(move |stream| read_output(stream, &wanted))?;
        let printed = printed.recv_timeout(DRAIN);
        let printed = printed.map_err(|_| HELD_OPEN.to_owned()).flatten();
        let printed = printed.map_err(|reason| CaseFailure {
            advice: example(expected),
            ..self.failed(&format!("answered nothing: {reason}{words}"))
        })?;
        let program = visible(&self.words[0]);
        let unusable = |error: String| CaseFailure::new(format!("{program}: {error}{words}"));
        let (mut answer, complaint) = Answer::read(&printed.answer).map_err(unusable)?;
        answer.printed = printed.answers.max(1);
        let no_number = printed.no_number.as_ref().map(|one| {
            let text = shorten(&one.text);
            format!(
                "`{}` is `{}`; expected a finite number",
                visible(&one.name),
                visible(&text)
            )
        });
        let failed = printed.failed.map(|line| {
            let line = visible(&shorten(&line));
            format!(
                "the line `{line}` behind its answer says that it has failed; expected the answer \
                 last, or an exit status other than 0"
            )
        });
        let mut expected = expected.iter();
        let missing = expected.find_map(|expected| answer.require(expected).err());
        answer.failure = no_number.or(failed).or(complaint).or(missing).map(unusable);
        Ok(answer)
    }

    pub(super) fn failed(&self, what: &str) -> CaseFailure {
        CaseFailure::new(format!("{} {what}", visible(&self.words[0])))
    }

    /// Why the program is not there: a relative path is one of its folder.
    fn not_started(&self, reason: &NotStarted) -> CaseFailure {
        match reason {
            NotStarted::Guard(error) => CaseFailure::new(format!(
                "the guard of {} cannot be started: {error}",
                visible(&self.words[0])
            )),
            NotStarted::Program(error) => {
                let folder = visible(&self.directory.display().to_string());
                self.failed(&format!(
                    "cannot be started in the folder {folder}: {error}"
                ))
            }
        }
    }

    /// Runs the command to its end with status 0.
    ///
    /// * `read`: reads its standard output, in a thread of its own.
    ///
    /// # Errors
    /// The program cannot be started, ended with a status other than 0, or took too long.
    pub(super) fn end_of<T: Send + 'static>(
        &self,
        read: impl FnOnce(ChildStdout) -> T + Send + 'static,
    ) -> Result<Ended<T>, CaseFailure> {
        let running = Running::start(self.command(), self.input.clone());
        let mut running = running.map_err(|reason| self.not_started(&reason))?;
        let printed = in_background(running.stdout.take(), read);
        let words = in_background(running.stderr.take(), read_last_words);
        let ended = running.end(self.time_limit);
        let words = words.recv_timeout(DRAIN).unwrap_or_default();
        let words = if words.is_empty() {
            words
        } else {
            format!("; its last words: {words}")
        };
        let Ending { status, in_time } =
            ended.map_err(|error| self.failed(&format!("cannot be waited for: {error}")))?;
        if !in_time {
            return Err(self.failed(&format!(
                "was stopped at its time limit of {} s{words}",
                self.time_limit.as_secs_f64()
            )));
        }
        if !status.success() {
            return Err(self.failed(&format!("ended with {}{words}", ending(status))));
        }
        Ok(Ended { printed, words })
    }

    /// The program, as the system is asked for it.
    #[cfg(not(windows))]
    fn program(&self) -> &str {
        &self.words[0]
    }

    /// The program, as the system is asked for it: Windows takes a path from the folder of the
    /// harness. In its own folder the program is found by its name, as on the command line there.
    #[cfg(windows)]
    fn program(&self) -> PathBuf {
        let name = &self.words[0];
        let here = self.directory.join(name);
        if here.is_file() || self.directory.join(format!("{name}.exe")).is_file() {
            here
        } else {
            PathBuf::from(name)
        }
    }

    fn command(&self) -> Command {
        let mut command = Command::new(self.program());
        command.args(&self.words[1..]).current_dir(&self.directory);
        let variables = self.variables.iter();
        command.envs(variables.map(|(name, value)| (name, value)));
        command
    }
}

/// Serves a stream in a separate thread: a program that prints must not wait, and one that does not
/// read must not hold up its time limit.
fn in_background<S: Send + 'static, T: Send + 'static>(
    stream: Option<S>,
    serve: impl FnOnce(S) -> T + Send + 'static,
) -> Receiver<T> {
    let (send, receive) = mpsc::channel();
    if let Some(stream) = stream {
        // If the thread cannot be started, the program's pipe is closed and nothing is received.
        let _ = thread::Builder::new().spawn(move || send.send(serve(stream)));
    }
    receive
}

/// An example of an answer.
fn example(expected: &[Expectation]) -> String {
    expected.first().map_or(String::new(), |first| {
        let [what, name] = [first.what(), &first.name];
        format!("expected a last line such as {{\"{what}s\": {{\"{name}\": 1.5e-3}}}}")
    })
}

/// The statuses by which Windows ends a program that has crashed.
const CRASHES: [(u32, &str); 8] = [
    (0xC000_0005, "access violation"),
    (0xC000_001D, "illegal instruction"),
    (0xC000_0094, "integer division by zero"),
    (0xC000_00FD, "stack overflow"),
    (0xC000_0135, "a DLL was not found"),
    (0xC000_013A, "interrupted by Ctrl-C"),
    (0xC000_0142, "a DLL could not be initialized"),
    (0xC000_0409, "stack buffer overrun, or abort"),
];

/// An exit status of Windows; the usual crashes by name.
fn status_of_windows(code: i32) -> String {
    let bits = code.cast_unsigned();
    CRASHES
        .iter()
        .find(|(crash, _)| *crash == bits)
        .map_or_else(
            || format!("exit status {code}"),
            |(_, name)| format!("exit status {bits:#010X} ({name})"),
        )
}

/// Exit status or signal, in words.
fn ending(status: ExitStatus) -> String {
    #[cfg(unix)]
    {
        use std::os::unix::process::ExitStatusExt;
        if let Some(number) = status.signal() {
            let name = nix::sys::signal::Signal::try_from(number)
                .map_or(String::new(), |signal| format!(" ({signal})"));
            return format!("signal {number}{name}");
        }
    }
    match status.code() {
        Some(code) if cfg!(windows) => status_of_windows(code),
        Some(code) => format!("exit status {code}"),
        None => "no exit status".to_owned(),
    }
}

/// A placeholder without a value.
#[derive(Debug)]
pub(super) struct Unfilled {
    /// The byte of the text at which it begins.
    pub(super) offset: usize,
    /// What is wrong, in words.
    pub(super) reason: String,
}

/// A word of a command with these values, in the shortest notation that reads back as the same
/// number. A name in braces is a placeholder, `{{name}}` the text `{name}`, any other brace a
/// brace.
///
/// # Errors
/// A placeholder without a value, with its place in the text.
pub(super) fn filled(text: &str, values: &[CaseParameter]) -> Result<String, Unfilled> {
    let mut filled = String::new();
    let mut rest = text;
    while let Some(at) = rest.find('{') {
        filled += &rest[..at];
        rest = &rest[at..];
        let quoted = rest
            .strip_prefix('{')
            .and_then(name_in_braces)
            .filter(|name| rest[name.len() + 3..].starts_with('}'));
        if let Some(name) = quoted {
            filled += &format!("{{{name}}}");
            rest = &rest[name.len() + 4..];
        } else if let Some(name) = name_in_braces(rest) {
            let Some((_, value)) = values.iter().find(|(known, _)| *known == name) else {
                return Err(Unfilled {
                    offset: text.len() - rest.len(),
                    reason: unknown(name, values),
                });
            };
            filled += &value.to_string();
            rest = &rest[name.len() + 2..];
        } else {
            filled.push('{');
            rest = &rest[1..];
        }
    }
    Ok(filled + rest)
}

/// The name between the brace that the text begins with and the next one: a letter or `_`, then
/// letters, digits and `_`.
fn name_in_braces(text: &str) -> Option<&str> {
    let (name, _) = text.strip_prefix('{')?.split_once('}')?;
    let is_name = name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
    (is_name && name.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_')).then_some(name)
}

fn unknown(name: &str, values: &[CaseParameter]) -> String {
    let known = values.iter().map(|(name, _)| *name);
    let hint = did_you_mean(&nearest(name, known.clone()).map(str::to_owned));
    let known: Vec<String> = known.map(|name| format!("{{{name}}}")).collect();
    format!(
        "found the placeholder {{{name}}}{hint}; expected one that `refine` gives a value, {}, or {{{{{name}}}}} for the text {{{name}}}",
        known.join(", ")
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rows::rows;

    const KNOWN: [CaseParameter; 2] = [("n", 8.0), ("h", 0.125)];

    #[test]
    fn the_crashes_of_windows_have_names() {
        for (code, words) in [
            (-1_073_741_819, "exit status 0xC0000005 (access violation)"),
            (-1_073_741_571, "exit status 0xC00000FD (stack overflow)"),
            (-1, "exit status -1"),
            (3, "exit status 3"),
        ] {
            assert_eq!(status_of_windows(code), words);
        }
    }

    #[test]
    fn placeholders_are_filled_and_other_braces_stay() {
        for [text, expected] in rows(include_str!("command/filled.md")) {
            assert_eq!(filled(text, &KNOWN).unwrap(), expected, "{text}");
        }
    }

    #[test]
    fn an_unknown_placeholder_is_refused_at_its_place() {
        let unfilled = filled("--dt={dt}", &KNOWN).unwrap_err();
        assert_eq!(unfilled.offset, 5);
        let message = "found the placeholder {dt}; expected one that `refine` gives a value, {n}, {h}, or {{dt}} for the text {dt}";
        assert_eq!(unfilled.reason, message);
        assert!(
            filled("{N}", &KNOWN)
                .unwrap_err()
                .reason
                .contains("did you mean `n`?")
        );
    }
}
