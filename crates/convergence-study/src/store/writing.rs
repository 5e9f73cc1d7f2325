//! What is being written is finished before the process ends, when it is asked to end.
//!
//! Whoever writes files holds a [`Writing`] for as long as they are not whole. Whoever ends the process on request calls
//! [`close`] first. A crash needs neither: files have their names only when they are whole.

use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Where writers report.
#[derive(Debug)]
struct Desk {
    state: Mutex<State>,
    changed: Condvar,
}

#[derive(Debug)]
struct State {
    writers: usize,
    is_closed: bool,
}

/// That of the process.
static DESK: Desk = Desk::new();

/// Something is being written until this is dropped.
#[derive(Debug)]
#[must_use]
pub struct Writing<'d>(&'d Desk);

/// Begins to write; once the process is about to end this never returns.
pub fn begin() -> Writing<'static> {
    DESK.begin()
}

/// Waits until nothing is being written, and lets nobody begin any more. Call it to end the process.
///
/// * `patience`: after this time it returns although something is being written, such as to a disk that hangs.
pub fn close(patience: Duration) {
    DESK.close(patience);
}

impl Drop for Writing<'_> {
    fn drop(&mut self) {
        self.0.locked().writers -= 1;
        self.0.changed.notify_all();
    }
}

impl Desk {
    const fn new() -> Self {
        Self { state: Mutex::new(State { writers: 0, is_closed: false }), changed: Condvar::new() }
    }

    fn begin(&self) -> Writing<'_> {
        let mut state = self.locked();
        while state.is_closed {
            state = self.changed.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
        state.writers += 1;
        Writing(self)
    }

    fn close(&self, patience: Duration) {
        let end = Instant::now() + patience;
        let mut state = self.locked();
        while state.writers > 0 {
            let left = end.saturating_duration_since(Instant::now());
            if left.is_zero() {
                break;
            }
            state = self.changed.wait_timeout(state, left).unwrap_or_else(PoisonError::into_inner).0;
        }
        state.is_closed = true;
    }

    fn locked(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicBool, Ordering};
    use std::sync::mpsc;
    use std::thread;

    use super::*;

    const LONG: Duration = Duration::from_secs(60);
    const SHORT: Duration = Duration::from_millis(50);

    #[test]
    fn what_is_being_written_is_waited_for() {
        let (desk, is_whole) = (Desk::new(), AtomicBool::new(false));
        thread::scope(|scope| {
            let (first, second) = (desk.begin(), desk.begin());
            drop(second);
            scope.spawn(|| {
                thread::sleep(SHORT);
                is_whole.store(true, Ordering::SeqCst);
                drop(first);
            });
            desk.close(LONG);
            assert!(is_whole.load(Ordering::SeqCst));
        });
    }

    #[test]
    fn a_writer_that_hangs_is_waited_for_as_long_as_patience_lasts() {
        let desk = Desk::new();
        let _hanging = desk.begin();
        let start = Instant::now();
        desk.close(SHORT);
        assert!((SHORT..LONG).contains(&start.elapsed()));
    }

    #[test]
    fn nobody_begins_at_a_closed_desk() {
        static CLOSED: Desk = Desk::new();
        CLOSED.close(Duration::ZERO);
        let (tell, told) = mpsc::channel();
        // It waits for the end of the process.
        thread::spawn(move || {
            drop(CLOSED.begin());
            tell.send(())
        });
        assert_eq!(told.recv_timeout(SHORT), Err(mpsc::RecvTimeoutError::Timeout));
    }
}
