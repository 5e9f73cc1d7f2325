//! A program that is run, and stopped if it takes too long.

use std::fs::File;
use std::io::{self, Read as _};
use std::process::{Command, Stdio};
use std::sync::mpsc;
use std::thread;
use std::time::{Duration, Instant};

/// The pause between two looks at a program that has closed its output.
const PAUSE: Duration = Duration::from_millis(1);

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

#[cfg(all(test, unix))]
mod tests {
    use super::*;

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
}
