//! No process that a case has started outlives the case or this process.
//!
//! Every case has a process group, and a guard that leads it: this executable again, started as
//! `COMMAND guard MARK`. The guard waits for the end of a pipe that only this process holds open.
//! When this process ends, however it ends, the operating system closes the pipe, and the guard
//! ends its group: SIGTERM, then SIGKILL. The group exists before the program is started in it, so
//! there is no moment at which the program is unguarded.
//!
//! A process that has left its group, such as a daemon, is found on Linux by the mark in its
//! environment.
//!
//! On Windows every case has a job object instead, `guard/job.rs`.

use std::env;
use std::ffi::OsString;
use std::io;
use std::path::{Path, PathBuf};
#[cfg(unix)]
use std::process::{Child, Command};
use std::sync::OnceLock;

#[cfg(windows)]
mod job;
#[cfg(windows)]
pub(super) use job::Group;

#[cfg(unix)]
use nix::sys::signal::Signal;
#[cfg(unix)]
use unix as system;

/// The name of the command that a guard is started by.
pub const COMMAND: &str = "guard";

/// The variable that marks every process of a case; its value differs from case to case.
const MARK: &str = "CONVERGENCE_STUDY_CASE";

/// Set in guards: a guard that ran studies instead would start guards without end.
const IS_GUARD: &str = "CONVERGENCE_STUDY_GUARD";

/// The command that starts a guard, without its mark; empty if there are no guards.
static GUARD: OnceLock<Vec<OsString>> = OnceLock::new();

/// Sets the command that starts a guard, if this executable is an interpreter: the program and its
/// arguments, to which the mark is appended. Of several calls, including those of [`enable`], the
/// first counts.
pub fn enable_by(command: Vec<OsString>) {
    let _ = GUARD.set(command);
}

/// Says that this executable has the command [`COMMAND`], which calls [`serve`]. The harness's
/// command line has it; without it, as in a program that uses this crate as a library, processes
/// end with their case, but not if this process is killed.
pub fn enable() {
    enable_by(this_executable().map_or(vec![], |own| vec![own.into(), COMMAND.into()]));
}

/// On Linux this works even if the file has since been replaced.
fn this_executable() -> io::Result<PathBuf> {
    let own = Path::new("/proc/self/exe");
    if own.exists() {
        Ok(own.to_owned())
    } else {
        env::current_exe()
    }
}

/// Whether this process was started as a guard.
pub fn is_guard() -> bool {
    env::var_os(IS_GUARD).is_some()
}

/// The guard's own work: waits until its standard input ends, then ends its process group and all
/// processes with that mark.
///
/// * `mark`: the argument that follows [`COMMAND`].
pub fn serve(mark: &str) {
    #[cfg(unix)]
    {
        use std::io::Write;
        system::outlive_signals();
        // The process that started it waits for confirmation that it is a guard.
        let mut out = io::stdout();
        let _ = out.write_all(b"\n").and_then(|()| out.flush());
        let _ = io::copy(&mut io::stdin(), &mut io::sink());
        system::end_own_group(mark);
    }
    // A job object needs no guard.
    #[cfg(windows)]
    let _ = mark;
}

/// The process group of one case.
#[cfg(unix)]
#[derive(Debug)]
pub(super) struct Group {
    mark: String,
    guard: Option<Child>,
    leader: Option<u32>,
}

#[cfg(unix)]
impl Group {
    /// A group, with its guard if this executable has guards.
    pub(super) fn new() -> io::Result<Self> {
        let mark = new_mark();
        let Some(command) = GUARD.get() else {
            return Ok(Self {
                mark,
                guard: None,
                leader: None,
            });
        };
        let guard = system::start_guard(command, &mark)?;
        Ok(Self {
            mark,
            leader: Some(guard.id()),
            guard: Some(guard),
        })
    }

    /// Starts the program in the group.
    pub(super) fn start(&mut self, command: &mut Command) -> io::Result<Child> {
        use std::os::unix::process::CommandExt;
        let child = command
            .env(MARK, &self.mark)
            .process_group(self.leader.map_or(0, |leader| leader as i32))
            .spawn()?;
        self.leader.get_or_insert(child.id());
        Ok(child)
    }

    /// Asks the processes of the group to end.
    pub(super) fn ask_to_end(&self, _: &mut Child) {
        self.leader
            .iter()
            .for_each(|leader| system::signal(*leader, Signal::SIGTERM));
    }

    /// Ends the rest of the group, and any process that has left it. The guard, a member of the
    /// group, ends last: if this process is killed meanwhile, the guard carries on.
    pub(super) fn end(&mut self, _: &mut Child) {
        system::kill_marked(&self.mark);
        self.leader
            .iter()
            .for_each(|leader| system::signal(*leader, Signal::SIGKILL));
    }
}

#[cfg(unix)]
impl Drop for Group {
    fn drop(&mut self) {
        if let Some(guard) = &mut self.guard {
            let _ = guard.kill();
            let _ = guard.wait();
        }
    }
}

/// A mark that no other case of this process or another has.
fn new_mark() -> String {
    use std::sync::atomic::{AtomicU64, Ordering};
    use std::time::{SystemTime, UNIX_EPOCH};
    static COUNT: AtomicU64 = AtomicU64::new(0);
    let now = SystemTime::now()
        .duration_since(UNIX_EPOCH)
        .map_or(0, |since| since.as_nanos());
    format!(
        "{}-{now}-{}",
        std::process::id(),
        COUNT.fetch_add(1, Ordering::Relaxed)
    )
}

#[cfg(unix)]
mod unix {
    use std::ffi::OsString;
    use std::io::Read;
    use std::os::unix::process::CommandExt;
    use std::process::{Child, Command, Stdio};
    use std::time::Duration;
    use std::{fs, io, thread};

    use nix::sys::signal::{SigSet, Signal, killpg};
    use nix::unistd::{Pid, getpgrp};

    use super::{COMMAND, IS_GUARD, MARK};

    /// Between SIGTERM and SIGKILL when the harness is gone.
    const GRACE: Duration = Duration::from_secs(1);

    /// A process may start others while the processes are being listed.
    const MOST_ROUNDS: usize = 100;

    pub(super) fn start_guard(command: &[OsString], mark: &str) -> io::Result<Child> {
        if super::is_guard() {
            return Err(io::Error::other("this process was started as a guard"));
        }
        let Some((program, arguments)) = command.split_first() else {
            return Err(io::Error::other("this executable has no path"));
        };
        let mut guard = Command::new(program)
            .args(arguments)
            .arg(mark)
            .env(IS_GUARD, "1")
            .process_group(0)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()?;
        let mut sign = [0];
        let is_ready = guard
            .stdout
            .take()
            .is_some_and(|mut out| out.read_exact(&mut sign).is_ok())
            && sign == *b"\n";
        if !is_ready {
            let _ = guard.kill();
            let _ = guard.wait();
            return Err(io::Error::other(format!(
                "this executable has no command `{COMMAND}`"
            )));
        }
        Ok(guard)
    }

    /// This process has one thread: no other thread may take the signals that this one blocks.
    pub(super) fn outlive_signals() {
        let mut signals = SigSet::empty();
        [Signal::SIGTERM, Signal::SIGINT, Signal::SIGHUP]
            .into_iter()
            .for_each(|signal| signals.add(signal));
        let _ = signals.thread_block();
    }

    pub(super) fn end_own_group(mark: &str) {
        let _ = killpg(getpgrp(), Signal::SIGTERM);
        thread::sleep(GRACE);
        kill_marked(mark);
        let _ = killpg(getpgrp(), Signal::SIGKILL);
    }

    pub(super) fn signal(leader: u32, signal: Signal) {
        let _ = killpg(Pid::from_raw(leader as i32), signal);
    }

    /// Kills every process that has the mark in its environment.
    pub(super) fn kill_marked(mark: &str) {
        let mark = format!("{MARK}={mark}");
        for _ in 0..MOST_ROUNDS {
            let found: Vec<(Pid, Environment)> = processes_but_those_without(mark.as_bytes());
            if found.is_empty() {
                return;
            }
            for (process, _) in found
                .iter()
                .filter(|(_, environment)| *environment == Environment::HasIt)
            {
                let _ = nix::sys::signal::kill(*process, Signal::SIGKILL);
            }
            thread::sleep(Duration::from_millis(1));
        }
    }

    /// Whether a variable is in the environment of a process.
    #[derive(Debug, Clone, Copy, PartialEq)]
    enum Environment {
        HasIt,
        LacksIt,
        /// The process is just changing programs: the old environment is gone and the new one is
        /// not yet there.
        NotKnownYet,
    }

    /// The running processes that have, or may have, this variable in their environment; empty
    /// without `/proc`.
    fn processes_but_those_without(variable: &[u8]) -> Vec<(Pid, Environment)> {
        let entries = fs::read_dir("/proc").into_iter().flatten().flatten();
        let number = |entry: fs::DirEntry| entry.file_name().to_str()?.parse().ok();
        let looked_at = entries
            .filter_map(number)
            .map(|process: i32| (Pid::from_raw(process), look(process, variable)));
        looked_at
            .filter(|(_, environment)| *environment != Environment::LacksIt)
            .collect()
    }

    fn look(process: i32, variable: &[u8]) -> Environment {
        // The environment of another user's process cannot be read.
        let Ok(environment) = fs::read(format!("/proc/{process}/environ")) else {
            return Environment::LacksIt;
        };
        if environment
            .split(|byte| *byte == 0)
            .any(|entry| entry == variable)
        {
            return Environment::HasIt;
        }
        let stat = || fs::read_to_string(format!("/proc/{process}/stat")).unwrap_or_default();
        let may_have_it = environment.is_empty() && !is_empty_for_good(&stat());
        if may_have_it {
            Environment::NotKnownYet
        } else {
            Environment::LacksIt
        }
    }

    /// Whether a process whose environment was read as empty really has none: it has ended, has no
    /// memory of its own, or was started without one. While a program is being started, the bounds
    /// of its environment are 0.
    ///
    /// * `stat`: the line of `/proc/PID/stat`; empty when the process is gone.
    fn is_empty_for_good(stat: &str) -> bool {
        // The name, in parentheses, may hold anything; the state after it is field 3 in proc(5).
        let fields: Vec<&str> = stat
            .rsplit(')')
            .next()
            .unwrap_or_default()
            .split_whitespace()
            .collect();
        let field = |number: usize| {
            fields
                .get(number - 3)
                .and_then(|field| field.parse::<u64>().ok())
                .unwrap_or(0)
        };
        let [memory, start, end] = [23, 50, 51].map(field);
        memory == 0 || (end != 0 && start == end)
    }

    #[cfg(test)]
    mod tests {
        use super::super::{MARK, new_mark};
        use super::{is_empty_for_good, kill_marked};
        use std::os::unix::process::{CommandExt, ExitStatusExt};
        use std::process::Command;

        /// The moment between two programs is short: some of these processes are caught in it.
        #[test]
        #[cfg(target_os = "linux")]
        fn a_process_is_found_from_the_moment_that_it_is_started() {
            for _ in 0..50 {
                let mark = new_mark();
                let mut child = Command::new("sleep")
                    .arg("5")
                    .env(MARK, &mark)
                    .process_group(0)
                    .spawn()
                    .expect("a process");
                kill_marked(&mark);
                let status = child.wait().expect("its end");
                assert_eq!(status.signal(), Some(9), "{status}");
            }
        }

        #[test]
        fn an_environment_is_empty_for_good_where_a_program_has_none() {
            let stat = |memory: u64, start: u64, end: u64| {
                let zeros = |count: usize| vec!["0"; count].join(" ");
                format!(
                    "7 (a) b) R {} {memory} {} {start} {end} 0\n",
                    zeros(19),
                    zeros(26)
                )
            };
            for (memory, start, end, is_empty) in [
                (4096, 0, 0, false),
                (4096, 70, 90, false),
                (4096, 70, 70, true),
                (0, 0, 0, true),
            ] {
                assert_eq!(
                    is_empty_for_good(&stat(memory, start, end)),
                    is_empty,
                    "{memory} {start} {end}"
                );
            }
            assert!(is_empty_for_good(""));
        }
    }
}
