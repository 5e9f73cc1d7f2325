//! The process group of a program that has no guard.

use std::io;
use std::os::unix::process::CommandExt;
use std::process::{Child, Command};

use nix::sys::signal::{Signal, killpg};
use nix::unistd::Pid;

/// The group, which the program leads.
#[derive(Debug)]
pub(super) struct ProcessGroup;

impl ProcessGroup {
    /// A group is made by the program that leads it: this cannot fail, as the job of Windows can.
    #[expect(clippy::unnecessary_wraps, reason = "as on Windows")]
    pub(super) fn new() -> io::Result<Self> {
        Ok(Self)
    }

    /// Starts the program in the group.
    pub(super) fn start(&mut self, command: &mut Command) -> io::Result<Child> {
        command.process_group(0).spawn()
    }

    /// Asks the processes of the group to end.
    pub(super) fn ask_to_end(&self, program: &mut Child) {
        signal(leader(program), Signal::SIGTERM);
    }

    /// Ends the rest of the group.
    pub(super) fn end(&mut self, program: &mut Child) {
        signal(leader(program), Signal::SIGKILL);
    }
}

/// The number of the group that this program leads.
pub(super) fn leader(program: &Child) -> i32 {
    // The numbers of processes are positive `i32` on every Unix system.
    program.id() as i32
}

/// Sends a signal to a process group, which may have ended.
pub(super) fn signal(group: i32, signal: Signal) {
    let _ = killpg(Pid::from_raw(group), signal);
}
