//! The work of a guard: it starts a program, and ends all that the program has started.

use std::io::{self, BufReader, Read};
use std::os::fd::AsFd;
use std::os::unix::net::UnixStream;
use std::os::unix::process::{CommandExt, ExitStatusExt};
use std::process::Child;
use std::thread;

use nix::sys::signal::{SigSet, Signal};

#[cfg(target_os = "linux")]
use super::descendants;
use super::message::{Reply, StartRequest, receive, send};
use super::{GRACE, fed, group};

/// Starts the program that the harness asks for, and answers when it has ended and nothing of it is
/// left.
///
/// # Errors
/// Standard input is no request, or the program cannot be waited for.
pub(super) fn serve() -> io::Result<()> {
    let signals = outlived();
    signals.thread_block()?;
    #[cfg(target_os = "linux")]
    nix::sys::prctl::set_child_subreaper(true)?;
    let socket = UnixStream::from(io::stdin().as_fd().try_clone_to_owned()?);
    let mut from_harness = BufReader::new(socket.try_clone()?);
    let Some(request) = receive::<StartRequest>(&mut from_harness)? else {
        return Ok(());
    };
    let mut program = match start(request, &signals) {
        Ok(program) => program,
        Err(error) => {
            let error = error.to_string();
            return send(&socket, &Reply::NotStarted { error });
        }
    };
    let group = group::leader(&program);
    // If nobody listens any more, the thread finds the socket closed.
    let _ = send(&socket, &Reply::Started { group });
    thread::Builder::new().spawn(move || end_when_closed(from_harness, group))?;
    let status = program.wait()?.into_raw();
    end_rest(group);
    let _ = send(&socket, &Reply::Ended { status });
    Ok(())
}

/// Signals that are sent to every process of this name must not end the guard before the program.
fn outlived() -> SigSet {
    [Signal::SIGTERM, Signal::SIGINT, Signal::SIGHUP]
        .into_iter()
        .collect()
}

/// Starts the program in a group of its own: what it sends to its group does not reach the guard.
///
/// * `signals`: blocked by this thread; a program would inherit that.
fn start(request: StartRequest, signals: &SigSet) -> io::Result<Child> {
    let mut command = request.command();
    command.process_group(0);
    signals.thread_unblock()?;
    let program = fed(&mut command, request.input, |command| command.spawn());
    signals.thread_block()?;
    program
}

/// Waits until the harness has closed its socket, or has ended; then ends the program.
fn end_when_closed(mut from_harness: impl Read, group: i32) {
    let _ = io::copy(&mut from_harness, &mut io::sink());
    signal(group, Signal::SIGTERM);
    thread::sleep(GRACE);
    signal(group, Signal::SIGKILL);
}

/// Sends a signal to all that the program has started.
fn signal(group: i32, signal: Signal) {
    group::signal(group, signal);
    #[cfg(target_os = "linux")]
    descendants::signal(signal);
}

/// Ends what the program has left behind.
fn end_rest(group: i32) {
    #[cfg(target_os = "linux")]
    descendants::end(|| signal(group, Signal::SIGKILL));
    #[cfg(not(target_os = "linux"))]
    signal(group, Signal::SIGKILL);
}
