//! The files of the project, damaged in every way that a program, an editor or a person can: each is read or refused.
//!
//! Every reader of files gets every file. No panic, no hang, and a refusal is one message that begins with the file's
//! name and says where. `THERMOBEAM_FUZZ` sets the number of inputs, `THERMOBEAM_FUZZ_SEED` where they begin; what fails
//! is written beside the corpus, to be kept there.

mod corpus;
mod damage;
mod readers;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::{Duration, Instant};

use damage::{Dice, damaged};
use readers::{Bench, Reading, seeds};

/// Inputs of a test run: about a second.
const INPUTS: u64 = 1_500;

/// An input that takes longer to be read hangs; the largest mesh that is allowed takes about a second.
const PATIENCE: Duration = Duration::from_secs(20);

fn number(name: &str) -> Option<u64> {
    std::env::var(name).ok().map(|text| text.parse().expect("a whole number"))
}

/// Reads one input with every reader it is for.
///
/// # Errors
/// What went wrong, in words.
fn tried(bench: &Bench, reading: Reading, bytes: &[u8]) -> Result<bool, String> {
    let start = Instant::now();
    let outcome = catch_unwind(AssertUnwindSafe(|| bench.read(reading, bytes)));
    if start.elapsed() > PATIENCE {
        return Err(format!("took {:?}", start.elapsed()));
    }
    match outcome {
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
    let (mut read, mut slowest, mut failures) = (0, (Duration::ZERO, 0), vec![]);
    for case in first..first + count {
        let mut dice = Dice::new(case);
        let (reading, text) = &seeds[dice.below(seeds.len())];
        let bytes = damaged(text.as_bytes(), &mut dice);
        let start = Instant::now();
        match tried(&bench, *reading, &bytes) {
            Ok(is_read) => read += u64::from(is_read),
            Err(reason) => {
                let kept = corpus::folder().join(format!("{}-failed-{case}", reading.name()));
                std::fs::write(&kept, &bytes).expect("a writable folder");
                failures.push(format!("{}: {reason}", kept.display()));
            }
        }
        slowest = slowest.max((start.elapsed(), case));
    }
    println!("{count} inputs from {first}: {read} read, {} refused, slowest {slowest:?}", count - read);
    assert!(failures.is_empty(), "{} of {count} failed:\n{}", failures.len(), failures.join("\n"));
    // Were all refused, the readers would not be reached; were none, the files would not be damaged.
    assert!(read > count / 50 && read < count, "{read} of {count} read");
}

#[test]
fn the_corpus_is_read_or_refused_with_its_place() {
    let bench = Bench::new();
    let inputs = corpus::inputs();
    assert!(inputs.len() >= 20, "{}", inputs.len());
    for (path, reading, bytes) in inputs {
        tried(&bench, reading, &bytes).unwrap_or_else(|reason| panic!("{}: {reason}", path.display()));
    }
}

#[test]
fn undamaged_files_are_read() {
    let bench = Bench::new();
    for (reading, text) in seeds() {
        assert_eq!(bench.read(reading, text.as_bytes()), Ok(()), "{}", &text[..text.len().min(200)]);
    }
}

#[test]
fn a_panic_a_refusal_without_a_place_and_one_that_is_empty_are_seen() {
    let bench = Bench::new();
    for message in ["", "no such key", "elsewhere.toml:1:1: x: missing"] {
        assert!(bench.is_located(message).is_err(), "{message}");
    }
    assert!(bench.is_located(&format!("{}:3:1: beam: missing", bench.path().display())).is_ok());
    assert_eq!(tried(&bench, Reading::Panic, b"x"), Err("panicked".to_owned()));
}
