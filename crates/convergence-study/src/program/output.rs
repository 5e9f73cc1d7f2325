//! The output of a program, read to its end with bounded memory.

use std::collections::VecDeque;
use std::io::{ErrorKind, Read};

use serde_json::{Map, Value};

use super::answer::{self, STEPS_AND_WORK};
use crate::input::error_table::pairs::named_numbers;
use crate::text::named::NamedNumber;
use crate::text::visible::visible;

/// Longest line that is read whole, in bytes; only the start of a longer line is kept.
const LONGEST_LINE: usize = 1 << 20;

/// Number of lines of standard error that are shown, and of characters of each.
const LAST_LINES: usize = 3;
const LAST_CHARACTERS: usize = 160;

/// Most names that are listed where none of them is expected.
const MOST_OTHERS: usize = 8;

/// Why a program has not answered.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct NoAnswer {
    /// In words.
    pub(super) reason: String,
    /// The last line that it printed; empty without one.
    pub(super) last_line: String,
    /// The last number behind each of the names, unless a line looks like an object.
    pub(super) numbers: Vec<NamedNumber>,
}

/// Reads standard output to its end: the last line that is a JSON object, or why there is none, and
/// the numbers behind these names.
pub(super) fn read_output(
    stream: impl Read,
    names: &[String],
) -> Result<Map<String, Value>, NoAnswer> {
    let mut object = None;
    let mut near_miss = None;
    let mut is_broken = false;
    let mut numbers: Vec<NamedNumber> = vec![];
    let mut others: Vec<String> = vec![];
    let mut last = String::new();
    for_each_line(stream, |line, is_whole| {
        match answer::object(line) {
            // It may be the answer, and then no earlier object is.
            Some(_) if !is_whole => {
                is_broken = true;
                (object, near_miss) = (None, Some("longer than 1 MiB".to_owned()));
            }
            Some(Ok(found)) => (object, near_miss) = (Some(found), None),
            Some(Err((reason, is_answer))) => {
                is_broken |= is_answer;
                near_miss = Some(reason);
                // An earlier object is no longer the last.
                object = object.take().filter(|_| !is_answer);
            }
            None if !is_whole => {}
            None => {
                for (name, number) in named_numbers(line) {
                    if names.iter().any(|known| known == name) {
                        numbers.retain(|known| known.name != name);
                        numbers.push(NamedNumber::new(name, number));
                    } else if others.len() < MOST_OTHERS
                        && !others.iter().any(|other| other == name)
                    {
                        others.push(visible(name));
                    }
                }
            }
        }
        if !line.trim().is_empty() {
            line.clone_into(&mut last);
        }
    });
    let last_line = shown(&last);
    let quoted = format!("the last line is `{last_line}`");
    object.ok_or_else(|| NoAnswer {
        reason: match near_miss {
            _ if last.is_empty() => "its standard output is empty".to_owned(),
            None if !others.is_empty() => {
                let found = others.iter().map(|name| format!("`{name}`"));
                format!(
                    "found {}; the study has {}",
                    found.collect::<Vec<_>>().join(", "),
                    wanted(names)
                )
            }
            None => format!("no line of its standard output is a JSON object; {quoted}"),
            Some(error) => {
                let what = "its last line that begins with a brace is no JSON object";
                format!("{what} ({error}); {quoted}")
            }
        },
        last_line,
        numbers: if is_broken { vec![] } else { numbers },
    })
}

/// The names that a study expects, without those of steps and work, which may be absent.
fn wanted(names: &[String]) -> String {
    let names = names
        .iter()
        .filter(|name| !STEPS_AND_WORK.contains(&name.as_str()));
    let names: Vec<String> = names.map(|name| format!("`{name}`")).collect();
    names.join(", ")
}

/// Reads standard error to its end and joins its last lines that are not blank.
pub(super) fn read_last_words(stream: impl Read) -> String {
    let mut last: VecDeque<String> = VecDeque::new();
    for_each_line(stream, |line, _| {
        if !line.trim().is_empty() {
            last.push_back(line.to_owned());
            if last.len() > LAST_LINES {
                last.pop_front();
            }
        }
    });
    last.iter()
        .map(|line| shown(line))
        .collect::<Vec<_>>()
        .join(" | ")
}

/// A line for messages: trimmed, without control characters, its end cut off if it is long.
fn shown(line: &str) -> String {
    let line = visible(line.trim());
    let cut: String = line.chars().take(LAST_CHARACTERS).collect();
    if cut.len() < line.len() {
        cut + "..."
    } else {
        cut
    }
}

/// Calls `each` for every line, and for the text after the last line end, with whether the line is
/// whole. A failing stream has ended.
fn for_each_line(mut stream: impl Read, mut each: impl FnMut(&str, bool)) {
    let mut buffer = [0; 1 << 16];
    let mut line = Vec::new();
    let mut is_whole = true;
    loop {
        let count = match stream.read(&mut buffer) {
            Ok(0) => break,
            Ok(count) => count,
            Err(error) if error.kind() == ErrorKind::Interrupted => continue,
            Err(_) => break,
        };
        for piece in buffer[..count].split_inclusive(|byte| *byte == b'\n') {
            let room = LONGEST_LINE - line.len();
            is_whole &= piece.len() <= room;
            line.extend_from_slice(&piece[..piece.len().min(room)]);
            if piece.ends_with(b"\n") {
                each(&String::from_utf8_lossy(&line), is_whole);
                line.clear();
                is_whole = true;
            }
        }
    }
    each(&String::from_utf8_lossy(&line), is_whole);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_object_counts_and_talk_does_not() {
        let printed = read_output(
            "start\n{\"a\": 1}\n{\"b\": 2}\r\n{iteration 3}\ndone\n\n".as_bytes(),
            &[],
        );
        assert_eq!(printed.unwrap().keys().collect::<Vec<_>>(), ["b"]);
        let open = read_output("{x}\n{\"c\": 3}".as_bytes(), &[]);
        assert_eq!(open.unwrap().len(), 1);
        let none = read_output("start\n{iteration 3}\ndone\n\n".as_bytes(), &[])
            .unwrap_err()
            .reason;
        assert!(
            none.contains("key must be a string") && none.ends_with("; the last line is `done`"),
            "{none}"
        );
        let none = read_output(&b"\xff\n"[..], &[]).unwrap_err();
        assert_eq!(
            none.reason,
            "no line of its standard output is a JSON object; the last line is `\u{fffd}`"
        );
        assert_eq!(
            read_output(&b"\n"[..], &[]).unwrap_err().reason,
            "its standard output is empty"
        );
    }

    #[test]
    fn an_answer_that_is_no_whole_object_is_not_replaced_by_an_earlier_one() {
        let hint = "print it with json.dumps(...) on one line";
        for (last, words) in [
            ("{\"errors\": {\"L2\": 1e5 }", hint),
            ("{\n  \"errors\": {\n    \"L2\": 1e5\n  }\n}", hint),
            ("  {  \n\"errors\": 1}", hint),
            (
                "{'errors': {'L2': 1e5}}",
                "single quotes are not those of JSON: print it with json.dumps(...)",
            ),
            ("{\"errors\": 1e5 2}", "expected `,` or `}`"),
        ] {
            let reason = read_output(format!("{{\"early\": 1}}\n{last}\n").as_bytes(), &[])
                .unwrap_err()
                .reason;
            assert!(reason.contains(words), "{last}: {reason}");
            let answered = read_output(format!("{last}\n{{\"late\": 1}}\n").as_bytes(), &[]);
            assert!(
                answered.is_ok_and(|object| object.contains_key("late")),
                "{last}"
            );
        }
        for talk in [
            "{iteration 3}",
            "{iteration 3",
            "{'iteration': 3}",
            "done {",
        ] {
            let object = read_output(format!("{{\"early\": 1}}\n{talk}\n").as_bytes(), &[]);
            assert!(
                object.is_ok_and(|object| object.contains_key("early")),
                "{talk}"
            );
        }
    }

    #[test]
    fn a_line_without_end_is_not_kept() {
        let endless = std::io::repeat(b'{').take(10 * LONGEST_LINE as u64);
        assert_eq!(
            read_output(endless.chain("\n{\"a\": 1}\n".as_bytes()), &[])
                .unwrap()
                .len(),
            1
        );
    }

    #[test]
    fn an_object_that_is_too_long_is_not_replaced_by_an_earlier_one() {
        let long = |start: &str| {
            format!(
                "{{\"early\": 1}}\n{start}{}\"}}\n",
                "x".repeat(LONGEST_LINE)
            )
        };
        let reason = read_output(long(" {\"mesh\": \"").as_bytes(), &[])
            .unwrap_err()
            .reason;
        assert!(
            reason.contains("(longer than 1 MiB); the last line is `{\"mesh\": \"xxx"),
            "{reason}"
        );
        let talk = read_output(long("mesh: ").as_bytes(), &[]);
        assert!(talk.is_ok_and(|object| object.contains_key("early")));
        let fits = format!(
            "{{\"early\": 1}}\n{{\"m\": \"{}\"}}\n",
            "x".repeat(LONGEST_LINE - 10)
        );
        assert!(read_output(fits.as_bytes(), &[]).is_ok_and(|object| object.contains_key("m")));
    }

    #[test]
    fn last_words_are_three_lines_made_harmless() {
        let words = read_last_words("one\ntwo\n\n\x1b[31mthree\n  four\x07\n".as_bytes());
        assert_eq!(words, "two | \u{fffd}[31mthree | four\u{fffd}");
        let long = read_last_words("x".repeat(1000).as_bytes());
        assert_eq!(long.len(), LAST_CHARACTERS + 3);
    }
}
