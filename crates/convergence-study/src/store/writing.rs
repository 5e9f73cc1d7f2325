//! Finishes pending writes before the process exits on request.
//!
//! Code that writes files holds the guard of [`begin`] until they are complete; code that ends the process calls [`close`]
//! first. A crash needs neither: files get their names only when they are complete.

use std::mem;
use std::sync::{PoisonError, RwLock, RwLockReadGuard};
use std::thread;
use std::time::{Duration, Instant};

/// Read by pending writes. It is never waited for with `write`: a thread may begin a write within another one.
static PENDING: RwLock<()> = RwLock::new(());

/// Between two looks at the pending writes.
const PAUSE: Duration = Duration::from_millis(1);

/// Registers a write, which is pending until the guard is dropped. After [`close`] it blocks until the process ends.
pub fn begin() -> RwLockReadGuard<'static, ()> {
    PENDING.read().unwrap_or_else(PoisonError::into_inner)
}

/// Waits for pending writes and blocks new ones. Call it right before the process exits.
///
/// * `patience`: it returns after this time even if a write is pending, for example on a disk that hangs; new ones are then
///   not blocked.
pub fn close(patience: Duration) {
    close_of(&PENDING, patience);
}

fn close_of(pending: &'static RwLock<()>, patience: Duration) {
    let end = Instant::now() + patience;
    loop {
        match pending.try_write() {
            Ok(closed) => return mem::forget(closed),
            Err(_) if Instant::now() >= end => return,
            Err(_) => thread::sleep(PAUSE),
        }
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
        static OPEN: RwLock<()> = RwLock::new(());
        let is_whole = AtomicBool::new(false);
        let (begun, begins) = mpsc::channel();
        thread::scope(|scope| {
            scope.spawn(|| {
                let first = OPEN.read();
                begun.send(()).unwrap();
                thread::sleep(SHORT);
                is_whole.store(true, Ordering::SeqCst);
                drop(first);
            });
            begins.recv().unwrap();
            drop(OPEN.read());
            close_of(&OPEN, LONG);
            assert!(is_whole.load(Ordering::SeqCst));
        });
    }

    #[test]
    fn closing_gives_up_on_a_write_that_hangs() {
        static OPEN: RwLock<()> = RwLock::new(());
        let _hanging = OPEN.read();
        let start = Instant::now();
        close_of(&OPEN, SHORT);
        assert!((SHORT..LONG).contains(&start.elapsed()));
    }

    #[test]
    fn no_write_begins_after_closing() {
        static CLOSED: RwLock<()> = RwLock::new(());
        close_of(&CLOSED, Duration::ZERO);
        let (tell, told) = mpsc::channel();
        // It waits for the end of the process.
        thread::spawn(move || {
            drop(CLOSED.read());
            tell.send(())
        });
        assert_eq!(told.recv_timeout(SHORT), Err(mpsc::RecvTimeoutError::Timeout));
    }
}
