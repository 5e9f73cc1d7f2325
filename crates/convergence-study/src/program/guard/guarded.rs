//! A program under a guard, as the harness sees it.

use std::ffi::OsString;
use std::io::{self, BufReader, ErrorKind};
use std::net::Shutdown;
use std::os::fd::OwnedFd;
use std::os::unix::net::UnixStream;
use std::os::unix::process::{CommandExt, ExitStatusExt};
use std::process::{Child, ChildStderr, ChildStdout, Command, ExitStatus, Stdio};
use std::time::Duration;

use nix::sys::signal::Signal;

use super::message::{Reply, StartRequest, receive, send};
use super::{COMMAND, Ending, IS_GUARD, NotStarted, group};

/// A guard whose program runs. When it is dropped, the guard ends the program.
#[derive(Debug)]
pub(super) struct Guarded {
    guard: Child,
    /// The guard's replies; closed for writing, it asks the guard to end the program.
    socket: BufReader<UnixStream>,
    /// The process group of the program.
    group: i32,
}

impl Guarded {
    /// Starts a guard, and the program by it; returns it with the program's output and error
    /// streams.
    ///
    /// * `guard`: the command that starts a guard.
    ///
    /// # Errors
    /// The guard or the program cannot be started.
    pub(super) fn start(
        guard: &[OsString],
        program: &Command,
        input: String,
    ) -> Result<(Self, Option<ChildStdout>, Option<ChildStderr>), NotStarted> {
        let (own, theirs) = UnixStream::pair().map_err(NotStarted::Guard)?;
        let guard = start_guard(guard, theirs).map_err(NotStarted::Guard)?;
        let mut started = Self {
            guard,
            socket: BufReader::new(own),
            group: 0,
        };
        let _ = send(started.socket.get_ref(), &StartRequest::new(program, input));
        // What is no guard has ended, or answers nothing that is a reply.
        match receive(&mut started.socket) {
            Ok(Some(Reply::Started { group })) => started.group = group,
            Ok(Some(Reply::NotStarted { error })) => {
                return Err(NotStarted::Program(io::Error::other(error)));
            }
            _ => {
                let _ = started.guard.kill();
                let reason = format!("this executable has no command `{COMMAND}`");
                return Err(NotStarted::Guard(io::Error::other(reason)));
            }
        }
        let stdout = started.guard.stdout.take();
        let stderr = started.guard.stderr.take();
        Ok((started, stdout, stderr))
    }

    /// Waits for the status of the program, until the time limit; then asks the guard to end it.
    ///
    /// # Errors
    /// The guard has ended before the program.
    pub(super) fn end(&mut self, time_limit: Duration) -> io::Result<Ending> {
        // A limit of 0 would be none.
        let limit = time_limit.max(Duration::from_micros(1));
        self.socket.get_ref().set_read_timeout(Some(limit))?;
        let (reply, in_time) = match receive(&mut self.socket) {
            Err(error) if is_timeout(&error) => {
                self.socket.get_ref().set_read_timeout(None)?;
                self.socket.get_ref().shutdown(Shutdown::Write)?;
                (receive(&mut self.socket)?, false)
            }
            reply => (reply?, true),
        };
        let guard = self.guard.wait()?;
        if let Some(Reply::Ended { status }) = reply {
            let status = ExitStatus::from_raw(status);
            return Ok(Ending { status, in_time });
        }
        group::signal(self.group, Signal::SIGKILL);
        Err(io::Error::other(format!("its guard has ended: {guard}")))
    }
}

impl Drop for Guarded {
    fn drop(&mut self) {
        let _ = self.socket.get_ref().shutdown(Shutdown::Write);
        let _ = self.guard.wait();
    }
}

fn start_guard(command: &[OsString], socket: UnixStream) -> io::Result<Child> {
    if super::is_guard() {
        return Err(io::Error::other("this process was started as a guard"));
    }
    let Some((program, arguments)) = command.split_first() else {
        return Err(io::Error::other("this executable has no path"));
    };
    // An interruption from the terminal goes to the group of the harness.
    Command::new(program)
        .args(arguments)
        .env(IS_GUARD, "1")
        .process_group(0)
        .stdin(OwnedFd::from(socket))
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
}

/// Systems differ in the error of a read that has reached its time limit.
fn is_timeout(error: &io::Error) -> bool {
    matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut)
}
