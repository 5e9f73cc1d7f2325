//! What is being written is finished before the process ends, when it is asked to end.
//!
//! Whoever writes files holds a [`Writing`] for as long as they are not whole. Whoever ends the process on request calls
//! [`close`] first. A crash needs neither: files have their names only when they are whole.

use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

#[derive(Debug)]
struct Desk {
    writers: usize,
    is_closed: bool,
}

static DESK: Mutex<Desk> = Mutex::new(Desk { writers: 0, is_closed: false });
static CHANGED: Condvar = Condvar::new();

/// Something is being written until this is dropped.
#[derive(Debug)]
#[must_use]
pub struct Writing(());

/// Begins to write; once the desk is closed this never returns, for the process is about to end.
pub fn begin() -> Writing {
    let mut desk = locked();
    while desk.is_closed {
        desk = CHANGED.wait(desk).unwrap_or_else(PoisonError::into_inner);
    }
    desk.writers += 1;
    Writing(())
}

impl Drop for Writing {
    fn drop(&mut self) {
        locked().writers -= 1;
        CHANGED.notify_all();
    }
}

/// Waits until nothing is being written, and lets nobody begin any more. Call it to end the process.
///
/// * `patience`: after this time it returns although something is being written, such as to a disk that hangs.
pub fn close(patience: Duration) {
    let end = Instant::now() + patience;
    let mut desk = locked();
    while desk.writers > 0 {
        let left = end.saturating_duration_since(Instant::now());
        if left.is_zero() {
            break;
        }
        desk = CHANGED.wait_timeout(desk, left).unwrap_or_else(PoisonError::into_inner).0;
    }
    desk.is_closed = true;
}

fn locked() -> MutexGuard<'static, Desk> {
    DESK.lock().unwrap_or_else(PoisonError::into_inner)
}
