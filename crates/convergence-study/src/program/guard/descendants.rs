//! The processes below this one, on Linux: a subreaper is the parent of all whose parent has ended.

use std::collections::HashSet;
use std::fs;
use std::time::{Duration, Instant};

use nix::errno::Errno;
use nix::sys::signal::{Signal, kill};
use nix::sys::wait::{WaitPidFlag, WaitStatus, waitpid};
use nix::unistd::Pid;

/// How long the guard tries to end processes: one of another user, or one that waits for a broken
/// disk, does not end.
const PATIENCE: Duration = Duration::from_secs(5);

/// Between two rounds.
const PAUSE: Duration = Duration::from_micros(200);

/// Kills until no process is left: one may start another while they are listed.
///
/// * `kill`: kills all that are there.
pub(super) fn end(kill: impl Fn()) {
    let start = Instant::now();
    while has_children() && start.elapsed() < PATIENCE {
        kill();
        std::thread::sleep(PAUSE);
    }
}

/// Whether this process has a child, after those that have ended were reaped. Without a child there
/// is no process below this one.
fn has_children() -> bool {
    loop {
        match waitpid(None::<Pid>, Some(WaitPidFlag::WNOHANG)) {
            Ok(WaitStatus::StillAlive) => return true,
            Ok(_) | Err(Errno::EINTR) => {}
            Err(_) => return false,
        }
    }
}

/// Sends a signal to all processes below this one, each as soon as it is seen.
///
/// Numbers of processes grow, and `/proc` has them in order, so that a parent comes before its
/// children. Where they began again from 1, the children are found in the next round.
pub(super) fn signal(signal: Signal) {
    let mut family = HashSet::from([std::process::id().cast_signed()]);
    for entry in fs::read_dir("/proc").into_iter().flatten().flatten() {
        let name = entry.file_name();
        let Some(process) = name.to_str().and_then(|name| name.parse().ok()) else {
            continue;
        };
        if parent(process).is_some_and(|parent| family.contains(&parent)) {
            family.insert(process);
            let _ = kill(Pid::from_raw(process), signal);
        }
    }
}

/// The parent of a process; `None` if it has ended.
fn parent(process: i32) -> Option<i32> {
    parent_in(&fs::read_to_string(format!("/proc/{process}/stat")).ok()?)
}

/// The second field behind the name, which is in parentheses and may hold anything: proc(5).
fn parent_in(stat: &str) -> Option<i32> {
    let (_, fields) = stat.rsplit_once(')')?;
    fields.split_whitespace().nth(1)?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::parent_in;

    #[test]
    fn the_parent_is_found_whatever_the_name() {
        assert_eq!(parent_in("7 (sleep) S 5 7 7 0"), Some(5));
        assert_eq!(parent_in("7 (a) S 9 (b) R 5 7 7 0"), Some(5));
        assert_eq!(parent_in("7 (sleep"), None);
    }
}
