//! What a program prints, read to its end with bounded memory.

use std::collections::VecDeque;
use std::io::{ErrorKind, Read};

use serde_json::{Map, Value};

use super::answer;
use crate::text::visible::visible;

/// Longest line that is looked at, in bytes; of a longer one nothing is kept.
const LONGEST_LINE: usize = 1 << 20;

/// Lines of standard error that are told, and the characters of each.
const LAST_LINES: usize = 3;
const LAST_CHARACTERS: usize = 160;

/// What is kept of standard output.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Printed {
    /// The last line that is a JSON object.
    pub(super) object: Option<Map<String, Value>>,
    /// Why a later line in braces is no object.
    pub(super) near_miss: Option<String>,
    /// The last line that is not blank, as it can be shown.
    pub(super) last: Option<String>,
}

/// Reads standard output to its end.
pub(super) fn read_output(stream: impl Read) -> Printed {
    let mut printed = Printed::default();
    let mut last = String::new();
    for_each_line(stream, |line| {
        match answer::object(line) {
            Some(Ok(object)) => (printed.object, printed.near_miss) = (Some(object), None),
            Some(Err(reason)) => printed.near_miss = Some(reason),
            None => {}
        }
        if !line.trim().is_empty() {
            line.clone_into(&mut last);
        }
    });
    printed.last = (!last.is_empty()).then(|| shown(&last));
    printed
}

/// Reads standard error to its end and keeps its last lines that are not blank, on one line.
pub(super) fn read_last_words(stream: impl Read) -> String {
    let mut last: VecDeque<String> = VecDeque::new();
    for_each_line(stream, |line| {
        if !line.trim().is_empty() {
            last.push_back(line.to_owned());
            if last.len() > LAST_LINES {
                last.pop_front();
            }
        }
    });
    last.iter().map(|line| shown(line)).collect::<Vec<_>>().join(" | ")
}

/// A line as messages show it: trimmed, without control characters, its end cut off where it is long.
fn shown(line: &str) -> String {
    let line = visible(line.trim());
    let cut: String = line.chars().take(LAST_CHARACTERS).collect();
    if cut.len() < line.len() { cut + "..." } else { cut }
}

/// Calls `each` for every line, and for what follows the last line end. A stream that fails has ended.
fn for_each_line(mut stream: impl Read, mut each: impl FnMut(&str)) {
    let mut buffer = [0; 1 << 16];
    let mut line = Vec::new();
    let mut is_too_long = false;
    loop {
        let count = match stream.read(&mut buffer) {
            Ok(0) => break,
            Ok(count) => count,
            Err(error) if error.kind() == ErrorKind::Interrupted => continue,
            Err(_) => break,
        };
        for piece in buffer[..count].split_inclusive(|byte| *byte == b'\n') {
            is_too_long |= line.len() + piece.len() > LONGEST_LINE;
            if is_too_long {
                line.clear();
            } else {
                line.extend_from_slice(piece);
            }
            if piece.ends_with(b"\n") {
                each(&String::from_utf8_lossy(&line));
                line.clear();
                is_too_long = false;
            }
        }
    }
    each(&String::from_utf8_lossy(&line));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_object_counts_and_talk_does_not() {
        let printed = read_output("start\n{\"a\": 1}\n{\"b\": 2}\r\n{iteration 3}\ndone\n\n".as_bytes());
        assert_eq!(printed.object.unwrap().keys().collect::<Vec<_>>(), ["b"]);
        assert!(printed.near_miss.unwrap().contains("key must be a string"));
        assert_eq!(printed.last.as_deref(), Some("done"));
        let open = read_output("{x}\n{\"c\": 3}".as_bytes());
        assert_eq!((open.object.unwrap().len(), open.near_miss), (1, None));
        assert_eq!(read_output(&b"\xff\n"[..]).last.as_deref(), Some("\u{fffd}"));
    }

    #[test]
    fn a_line_without_end_is_not_kept() {
        let endless = std::io::repeat(b'{').take(10 * LONGEST_LINE as u64);
        let printed = read_output(endless.chain("\n{\"a\": 1}\n".as_bytes()));
        assert_eq!(printed.object.unwrap().len(), 1);
    }

    #[test]
    fn last_words_are_three_lines_made_harmless() {
        let words = read_last_words("one\ntwo\n\n\x1b[31mthree\n  four\x07\n".as_bytes());
        assert_eq!(words, "two | \u{fffd}[31mthree | four\u{fffd}");
        let long = read_last_words("x".repeat(1000).as_bytes());
        assert_eq!(long.len(), LAST_CHARACTERS + 3);
    }
}
