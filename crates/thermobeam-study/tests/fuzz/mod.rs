//! The files of the project, damaged as a program, an editor or a person might damage them: each is
//! read or refused.
//!
//! Every reader of files gets every file. It must not panic or hang, and a refusal is one message
//! that begins with the file's name and states the place. `THERMOBEAM_FUZZ` sets the number of
//! inputs, `THERMOBEAM_FUZZ_SEED` the first seed; failing inputs are written next to the corpus, to
//! be kept there.

mod corpus;
mod damage;
mod readers;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::process;
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::Duration;

use damage::{Dice, damaged};
use readers::{Bench, Reading, seeds};

/// Inputs of a test run: about a second.
const INPUTS: u64 = 1_500;

/// An input that takes longer to read has hung its reader: the largest allowed mesh takes about a
/// second.
const PATIENCE: Duration = Duration::from_secs(120);

/// Reads an input, and ends this program if that hangs: a thread cannot be stopped otherwise.
fn watched<T>(bytes: &[u8], read: impl FnOnce() -> T) -> T {
    let start = String::from_utf8_lossy(&bytes[..bytes.len().min(500)]).into_owned();
    let (sender, receiver) = mpsc::channel::<()>();
    thread::spawn(move || {
        if receiver.recv_timeout(PATIENCE) == Err(RecvTimeoutError::Timeout) {
            eprintln!("a reader hangs on the input that begins with\n{start}");
            process::abort();
        }
    });
    let outcome = read();
    drop(sender);
    outcome
}

fn number(name: &str) -> Option<u64> {
    std::env::var(name)
        .ok()
        .map(|text| text.parse().expect("a whole number"))
}

/// Reads one input with every reader for its kind.
///
/// # Errors
/// A description of the failure.
fn tried(bench: &Bench, reading: Reading, bytes: &[u8]) -> Result<bool, String> {
    match watched(bytes, || {
        catch_unwind(AssertUnwindSafe(|| bench.read(reading, bytes)))
    }) {
        Err(_) => Err("panicked".to_owned()),
        Ok(Ok(())) => Ok(true),
        Ok(Err(message)) => bench.is_located(&message).map(|()| false),
    }
}

#[test]
fn damaged_files_are_read_or_refused_with_their_place() {
    let count = number("THERMOBEAM_FUZZ").unwrap_or(INPUTS);
    let first = number("THERMOBEAM_FUZZ_SEED").unwrap_or(0);
    let (bench, seeds) = (Bench::new(), seeds());
    let (mut read, mut failures) = (0, vec![]);
    for case in first..first + count {
        let mut dice = Dice::new(case);
        let (reading, text) = &seeds[dice.below(seeds.len())];
        let bytes = damaged(text.as_bytes(), &mut dice);
        match tried(&bench, *reading, &bytes) {
            Ok(is_read) => read += u64::from(is_read),
            Err(reason) => {
                let kept = corpus::folder().join(format!("{}-failed-{case}", reading.name()));
                std::fs::write(&kept, &bytes).expect("a writable folder");
                failures.push(format!("{}: {reason}", kept.display()));
            }
        }
    }
    let failed = failures.len();
    assert_eq!(failed, 0, "of {count}:\n{}", failures.join("\n"));
    // If all were refused, the readers would not be reached; if none were, the files would not be
    // damaged.
    assert!(read > count / 50 && read < count, "{read} of {count} read");
}

#[test]
fn the_corpus_is_read_or_refused_with_its_place() {
    let bench = Bench::new();
    let inputs = corpus::inputs();
    assert!(inputs.len() >= 20, "{}", inputs.len());
    for (path, reading, bytes) in inputs {
        tried(&bench, reading, &bytes)
            .unwrap_or_else(|reason| panic!("{}: {reason}", path.display()));
    }
}

#[test]
fn undamaged_files_are_read() {
    let bench = Bench::new();
    for (reading, text) in seeds() {
        assert_eq!(
            bench.read(reading, text.as_bytes()),
            Ok(()),
            "{}",
            &text[..text.len().min(200)]
        );
    }
}

#[test]
fn a_panic_a_refusal_without_a_place_and_one_that_is_empty_are_seen() {
    let bench = Bench::new();
    for message in ["", "no such key", "elsewhere.toml:1:1: x: missing"] {
        assert!(bench.is_located(message).is_err(), "{message}");
    }
    assert!(
        bench
            .is_located(&format!("{}:3:1: beam: missing", bench.path().display()))
            .is_ok()
    );
    assert_eq!(
        tried(&bench, Reading::Panic, b"x"),
        Err("panicked".to_owned())
    );
}
