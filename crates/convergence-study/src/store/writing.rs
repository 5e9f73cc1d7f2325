//! Finishes pending writes before the process exits on request.
//!
//! Code that writes files holds a [`Writing`] until they are complete; code that ends the process calls [`close`]
//! first. A crash needs neither: files get their names only when they are complete.

use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// The number of pending writes, and whether new ones may begin.
#[derive(Debug)]
struct Register {
    state: Mutex<State>,
    changed: Condvar,
}

#[derive(Debug)]
struct State {
    writers: usize,
    is_closed: bool,
}

/// The register of the process.
static REGISTER: Register = Register::new();

/// A pending write, until this is dropped.
#[derive(Debug)]
#[must_use]
pub struct Writing<'d>(&'d Register);

/// Registers a write. After [`close`] it blocks until the process ends.
pub fn begin() -> Writing<'static> {
    REGISTER.begin()
}

/// Waits for pending writes and blocks new ones. Call it right before the process exits.
///
/// * `patience`: it returns after this time even if a write is pending, for example on a disk that hangs.
pub fn close(patience: Duration) {
    REGISTER.close(patience);
}

impl Drop for Writing<'_> {
    fn drop(&mut self) {
        self.0.locked().writers -= 1;
        self.0.changed.notify_all();
    }
}

impl Register {
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
    fn closing_waits_for_pending_writes() {
        let (register, is_whole) = (Register::new(), AtomicBool::new(false));
        thread::scope(|scope| {
            let (first, second) = (register.begin(), register.begin());
            drop(second);
            scope.spawn(|| {
                thread::sleep(SHORT);
                is_whole.store(true, Ordering::SeqCst);
                drop(first);
            });
            register.close(LONG);
            assert!(is_whole.load(Ordering::SeqCst));
        });
    }

    #[test]
    fn closing_gives_up_on_a_write_that_hangs() {
        let register = Register::new();
        let _hanging = register.begin();
        let start = Instant::now();
        register.close(SHORT);
        assert!((SHORT..LONG).contains(&start.elapsed()));
    }

    #[test]
    fn no_write_begins_after_closing() {
        static CLOSED: Register = Register::new();
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
