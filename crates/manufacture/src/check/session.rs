//! A program that answers question after question: where starting one costs more than answering.

use std::fs::File;
use std::io::{self, BufRead as _, BufReader, Read as _, Write as _};
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{self, Receiver, Sender};
use std::thread;
use std::time::{Duration, Instant};

use serde::Serialize;

use crate::problem::InputError;

/// The pause between two looks at a program that has closed its output.
const PAUSE: Duration = Duration::from_millis(1);

/// What the answering program would find if it were started for one question.
#[derive(Serialize)]
pub(crate) struct Question<'q> {
    /// `MANUFACTURE_VARIANT` of its environment.
    pub(crate) variant: &'q str,
    /// Its arguments.
    pub(crate) arguments: &'q [String],
    /// Its standard input.
    pub(crate) text: &'q str,
}

/// A command that reads a [`Question`] a line, as JSON, and prints what the answering program
/// prints about it, as a text of JSON in a line. It is started for the first question, and again
/// for the next one after it has failed.
pub(crate) struct Session {
    command: Vec<String>,
    limit: Duration,
    running: Option<Running>,
}

/// Dropped, it is stopped.
struct Running {
    child: Child,
    questions: Sender<String>,
    answers: Receiver<io::Result<String>>,
}

impl Session {
    /// * `command`: not empty.
    /// * `limit`: for each answer.
    pub(crate) fn new(command: Vec<String>, limit: Duration) -> Self {
        Self {
            command,
            limit,
            running: None,
        }
    }

    /// What the program prints about a question.
    ///
    /// # Errors
    /// It cannot be started, it fails, or it takes longer than its time limit: then it is stopped.
    pub(crate) fn answer(&mut self, question: &Question<'_>) -> Result<String, InputError> {
        let running = self.running.take().map_or_else(|| start(&self.command), Ok);
        let answer = running.and_then(|mut running| {
            let answer = running.answer(question, self.limit)?;
            self.running = Some(running);
            Ok(answer)
        });
        answer.map_err(|error| InputError::whole(&self.command[0], error.to_string()))
    }
}

/// What a program prints until it ends about the question that a file holds.
///
/// * `command`: not empty.
/// * `variant`: of the solution; empty for that of the file.
///
/// # Errors
/// It cannot be started, it fails, or it takes longer than its time limit: then it is stopped.
pub(crate) fn printed(
    command: &[String],
    question: File,
    variant: &str,
    limit: Duration,
) -> io::Result<String> {
    let mut child = Command::new(&command[0])
        .args(&command[1..])
        .env("MANUFACTURE_VARIANT", variant)
        .stdin(question)
        .stdout(Stdio::piped())
        .spawn()?;
    let (send, receive) = mpsc::channel();
    if let Some(mut output) = child.stdout.take() {
        thread::spawn(move || {
            let mut answer = vec![];
            let read = output.read_to_end(&mut answer);
            send.send(read.map(|_| answer))
        });
    }
    let end = Instant::now().checked_add(limit);
    let answer = receive.recv_timeout(limit);
    // A program may close its output and go on.
    while answer.is_ok() && matches!(child.try_wait(), Ok(None)) {
        if end.is_some_and(|end| Instant::now() >= end) {
            break;
        }
        thread::sleep(PAUSE);
    }
    let is_running = matches!(child.try_wait(), Ok(None));
    // Nothing is left behind; this fails for a program that has ended.
    let _ = child.kill();
    let status = child.wait()?;
    let answer = match answer {
        Ok(answer) if !is_running => answer?,
        _ => return Err(stopped(limit)),
    };
    if !status.success() {
        return Err(io::Error::other(format!(
            "expected exit status 0, found {status}"
        )));
    }
    String::from_utf8(answer).map_err(|_| io::Error::other("expected text, found other bytes"))
}

fn stopped(limit: Duration) -> io::Error {
    let limit = limit.as_secs_f64();
    io::Error::other(format!("was stopped at its time limit of {limit} s"))
}

fn start(command: &[String]) -> io::Result<Running> {
    let mut child = Command::new(&command[0])
        .args(&command[1..])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()?;
    let (questions, lines) = mpsc::channel::<String>();
    let (send, answers) = mpsc::channel();
    if let (Some(mut input), Some(output)) = (child.stdin.take(), child.stdout.take()) {
        let mut output = BufReader::new(output);
        // The program reads a whole line before it prints one: neither waits for the other.
        thread::spawn(move || {
            for line in lines {
                let mut answer = String::new();
                let read = input
                    .write_all(line.as_bytes())
                    .and_then(|()| output.read_line(&mut answer));
                if send.send(read.map(|_| answer)).is_err() {
                    break;
                }
            }
        });
    }
    Ok(Running {
        child,
        questions,
        answers,
    })
}

impl Running {
    fn answer(&mut self, question: &Question<'_>, limit: Duration) -> io::Result<String> {
        // If the thread has ended, so have the answers.
        let _ = self.questions.send(serde_json::to_string(question)? + "\n");
        let answer = self.answers.recv_timeout(limit);
        let answer = answer.map_err(|_| stopped(limit))?;
        match answer {
            Ok(answer) if !answer.is_empty() => Ok(serde_json::from_str(&answer)?),
            // A program that ends has closed its output, and may not have read the question.
            _ => Err(io::Error::other("ended without an answer")),
        }
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        // This fails for a program that has ended.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    /// Prints the variant; fails on one, ends on another, hangs on a third.
    const PROGRAM: &str = "import json, os, sys, time
for line in sys.stdin:
    variant = json.loads(line)['variant']
    if variant == 'fails':
        sys.exit(1)
    if variant == 'hangs':
        time.sleep(600)
    print(json.dumps(variant + ' of ' + str(os.getpid())), flush=True)
";

    fn answer(session: &mut Session, variant: &str) -> Result<String, String> {
        let question = Question {
            variant,
            arguments: &[],
            text: "",
        };
        let answer = session.answer(&question);
        answer.map_err(|error| error.to_string())
    }

    fn session(limit: Duration) -> Session {
        Session::new(["python3", "-c", PROGRAM].map(str::to_owned).into(), limit)
    }

    #[test]
    fn one_program_answers_until_it_fails_and_then_another_one() {
        if !foreign_tools::are_here(&[foreign_tools::PYTHON]) {
            return;
        }
        let mut session = session(Duration::from_secs(600));
        let process = |answer: Result<String, String>| answer.unwrap().split_off("one of ".len());
        let first = process(answer(&mut session, "one"));
        assert_eq!(process(answer(&mut session, "two")), first);
        let failed = answer(&mut session, "fails").unwrap_err();
        assert!(failed.ends_with("ended without an answer"), "{failed}");
        assert_ne!(process(answer(&mut session, "six")), first);
    }

    /// Both forms: one that never ends its output, and one that has ended it.
    #[test]
    fn a_program_that_is_started_for_a_question_is_stopped_at_its_limit() {
        if !foreign_tools::are_here(&[foreign_tools::SHELL]) {
            return;
        }
        let run = |script: &str, limit: u64| {
            let command = ["sh", "-c", script].map(str::to_owned);
            let question = File::open("/dev/null").unwrap();
            let answer = printed(&command, question, "x_max", Duration::from_secs(limit));
            answer.map_err(|error| error.to_string())
        };
        for script in ["exec sleep 600", "exec >&- 2>&-; exec sleep 600"] {
            let failed = run(script, 1).unwrap_err();
            assert!(failed.ends_with("time limit of 1 s"), "{script}: {failed}");
        }
        let variant = "printf %s $MANUFACTURE_VARIANT";
        assert_eq!(run(variant, 600).as_deref(), Ok("x_max"));
        let failed = run("exit 3", 600).unwrap_err();
        assert!(failed.starts_with("expected exit status 0"), "{failed}");
    }

    #[test]
    fn a_program_that_hangs_is_stopped() {
        if !foreign_tools::are_here(&[foreign_tools::PYTHON]) {
            return;
        }
        let mut session = session(Duration::from_secs(1));
        let failed = answer(&mut session, "hangs").unwrap_err();
        assert!(failed.ends_with("time limit of 1 s"), "{failed}");
        assert!(session.running.is_none());
    }
}
