//! No process that a case has started outlives the case or this process.
//!
//! On Unix every case has a guard: this executable again, started with the output and error streams
//! that the program is to have, and with a socket as its standard input. The guard reads what to
//! start from the socket, starts it, and answers with the status that it ended with
//! (`guard/message.rs`). When the program has ended, or when the socket is closed, the guard ends
//! all that is left (`guard/serve.rs`). The operating system closes the socket when this process
//! ends, however it ends.
//!
//! On Linux the guard is a subreaper: every process that the program has started, and that has lost
//! its parent, becomes a child of the guard, whatever group, session or environment it has
//! (`guard/descendants.rs`). On other Unix systems the guard finds the group of the program, and
//! not a process that has left it.
//!
//! On Windows every case has a job object instead, `guard/job.rs`.

use std::env;
use std::ffi::OsString;
use std::io;
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStderr, ChildStdout, Command, ExitStatus, Stdio};
use std::sync::OnceLock;
use std::thread;
use std::time::{Duration, Instant};

#[cfg(target_os = "linux")]
mod descendants;
#[cfg(unix)]
mod group;
#[cfg(unix)]
mod guarded;
#[cfg(windows)]
mod job;
#[cfg(unix)]
mod message;
#[cfg(unix)]
mod serve;

#[cfg(unix)]
use group::ProcessGroup;
#[cfg(unix)]
use guarded::Guarded;
#[cfg(windows)]
use job::ProcessGroup;

/// The argument of a guard, for those who look at a list of processes.
pub(crate) const COMMAND: &str = "guard";

/// Set in guards, which [`serve`] and do nothing else: one that ran studies would start guards
/// without end.
const IS_GUARD: &str = "CONVERGENCE_STUDY_GUARD";

/// The command that starts a guard; empty if there are no guards.
static GUARD: OnceLock<Vec<OsString>> = OnceLock::new();

/// Between the request to end and the signal that cannot be ignored.
const GRACE: Duration = Duration::from_secs(1);

/// Longest pause between two looks at a program without a guard; the first ones are shorter.
const LONGEST_PAUSE: Duration = Duration::from_millis(20);

/// Sets the command that starts a guard, if this executable is an interpreter: the program and its
/// arguments. Of several calls, including those of `enable`, the first counts.
pub(crate) fn enable_by(command: Vec<OsString>) {
    let _ = GUARD.set(command);
}

/// Says that this executable calls [`serve`] if it is started as a guard. The harness's command line
/// does. Without it, as in a program that uses this crate as a library, the group of a program ends
/// with its case, but not if this process is killed, and what has left the group is not found.
pub(crate) fn enable() {
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
pub(crate) fn is_guard() -> bool {
    env::var_os(IS_GUARD).is_some()
}

/// The guard's own work: starts the program that its standard input asks for, and ends all that it
/// has started.
///
/// # Errors
/// Standard input is no request, or the program cannot be waited for.
pub(crate) fn serve() -> io::Result<()> {
    #[cfg(unix)]
    serve::serve()?;
    // A job object needs no guard.
    Ok(())
}

/// Why a program does not run.
#[derive(Debug)]
pub(super) enum NotStarted {
    /// Its guard cannot be started.
    Guard(io::Error),
    /// The program itself cannot.
    Program(io::Error),
}

/// How a program has ended.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ending {
    pub(super) status: ExitStatus,
    /// Whether it ended by itself, within its time limit.
    pub(super) in_time: bool,
}

/// A program that was started, with all that it starts.
#[derive(Debug)]
pub(super) struct Running {
    pub(super) stdout: Option<ChildStdout>,
    pub(super) stderr: Option<ChildStderr>,
    processes: Processes,
}

/// Who ends the processes of a case.
#[derive(Debug)]
enum Processes {
    #[cfg(unix)]
    Guarded(Guarded),
    Alone {
        program: Child,
        group: ProcessGroup,
    },
}

impl Running {
    /// Starts a program, under a guard if this executable has guards.
    ///
    /// * `command`: without standard streams.
    /// * `input`: the program's standard input; may be empty.
    ///
    /// # Errors
    /// The guard or the program cannot be started.
    pub(super) fn start(mut command: Command, input: String) -> Result<Self, NotStarted> {
        #[cfg(unix)]
        if let Some(guard) = GUARD.get() {
            let (guarded, stdout, stderr) = Guarded::start(guard, &command, input)?;
            return Ok(Self {
                stdout,
                stderr,
                processes: Processes::Guarded(guarded),
            });
        }
        command.stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut group = ProcessGroup::new().map_err(NotStarted::Guard)?;
        let mut program = fed(&mut command, input, |command| group.start(command))
            .map_err(NotStarted::Program)?;
        Ok(Self {
            stdout: program.stdout.take(),
            stderr: program.stderr.take(),
            processes: Processes::Alone { program, group },
        })
    }

    /// Waits until the program has ended. After its time limit it is asked to end, and given a
    /// moment to do so. Then all that is left of its processes is ended.
    ///
    /// # Errors
    /// The program cannot be waited for; its guard has ended before it.
    pub(super) fn end(&mut self, time_limit: Duration) -> io::Result<Ending> {
        match &mut self.processes {
            #[cfg(unix)]
            Processes::Guarded(guarded) => guarded.end(time_limit),
            Processes::Alone { program, group } => {
                let ended = end_in_time(program, group, time_limit);
                group.end(program);
                let in_time = ended?;
                let status = program.wait()?;
                Ok(Ending { status, in_time })
            }
        }
    }
}

/// Starts a program with this standard input.
fn fed(
    command: &mut Command,
    input: String,
    start: impl FnOnce(&mut Command) -> io::Result<Child>,
) -> io::Result<Child> {
    use std::io::Write;
    command.stdin(if input.is_empty() {
        Stdio::null()
    } else {
        Stdio::piped()
    });
    let mut program = start(command)?;
    if let Some(mut stdin) = program.stdin.take() {
        // A program may ignore its input: it is written by a thread that nobody waits for. If that
        // cannot be started, the pipe is closed.
        let _ = thread::Builder::new().spawn(move || {
            let _ = stdin.write_all(input.as_bytes());
        });
    }
    Ok(program)
}

/// Whether a program without a guard has ended by itself within its time limit.
fn end_in_time(
    program: &mut Child,
    group: &ProcessGroup,
    time_limit: Duration,
) -> io::Result<bool> {
    let start = Instant::now();
    if has_ended_by(program, start.checked_add(time_limit))? {
        return Ok(true);
    }
    group.ask_to_end(program);
    has_ended_by(program, Instant::now().checked_add(GRACE))?;
    Ok(false)
}

/// Polls the program until it has ended or the time is up; without a limit, until it has ended.
fn has_ended_by(child: &mut Child, end: Option<Instant>) -> io::Result<bool> {
    let mut pause = Duration::from_micros(500);
    loop {
        if child.try_wait()?.is_some() {
            return Ok(true);
        }
        let left = end.map_or(Duration::MAX, |end| {
            end.saturating_duration_since(Instant::now())
        });
        if left.is_zero() {
            return Ok(false);
        }
        thread::sleep(pause.min(left));
        pause = (pause * 2).min(LONGEST_PAUSE);
    }
}
