//! The output of a program, read to its end with bounded memory.

use std::collections::VecDeque;
use std::io::{ErrorKind, Read};

use serde_json::{Map, Value};

use super::answer::{self, STEPS_AND_WORK, object_of_lines};
use super::expectation::Expectation;
use super::lines::{self, NamedText};
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
}

/// What a program has printed.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Printed {
    /// The object of its last line that begins with a brace; without one, that of its lines.
    pub(super) object: Map<String, Value>,
    /// How many objects with errors or values it has printed.
    pub(super) answers: usize,
    /// The first name behind which the last line has no number, with what it has.
    pub(super) no_number: Option<NamedText>,
}

/// What is known of an output so far.
#[derive(Default)]
struct Output {
    /// What the last line that begins with a brace is, or why it is no answer.
    object: Option<Result<Map<String, Value>, String>>,
    answers: usize,
    /// What stands behind the names of the study, after that line.
    texts: Vec<NamedText>,
    /// Some names of other numbers.
    others: Vec<String>,
    last: String,
}

impl Output {
    fn read(&mut self, line: &str, is_whole: bool, names: &[String]) {
        match answer::object(line) {
            Some(read) => {
                let too_long = || Err("longer than 1 MiB".to_owned());
                let read = if is_whole { read } else { too_long() };
                self.answers += usize::from(read.as_ref().is_ok_and(answer::is_answer));
                self.object = Some(read);
                self.texts.clear();
            }
            None if is_whole => {
                lines::note(line, names, &mut self.texts);
                self.note_other(line);
            }
            None => {}
        }
        if !line.trim().is_empty() {
            line.clone_into(&mut self.last);
        }
    }

    /// Notes the name of a line such as `name = 1.5`.
    fn note_other(&mut self, line: &str) {
        let Some((name, text)) = line.split_once(['=', ':']) else {
            return;
        };
        let name = visible(name.trim());
        let has_number = text
            .trim_start()
            .starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c));
        if has_number
            && !name.is_empty()
            && self.others.len() < MOST_OTHERS
            && !self.others.contains(&name)
        {
            self.others.push(name);
        }
    }

    fn answer(self, names: &[String], expected: &[Expectation]) -> Result<Printed, NoAnswer> {
        let last_line = shown(&self.last);
        let quoted = format!("the last line is `{last_line}`");
        let found = match &self.object {
            Some(read) => read.clone().map_err(|error| {
                let what = "its last line that begins with a brace is no JSON object";
                format!("{what} ({error}); {quoted}")
            }),
            None => object_of_lines(&self.texts, expected).ok_or_else(|| match &self.others[..] {
                _ if self.last.is_empty() => "its standard output is empty".to_owned(),
                [] => format!("no line of its standard output is a JSON object; {quoted}"),
                others => {
                    let found: Vec<String> =
                        others.iter().map(|name| format!("`{name}`")).collect();
                    format!(
                        "found {}; the study has {}",
                        found.join(", "),
                        wanted(names)
                    )
                }
            }),
        };
        // Behind an object, other names may be those of anything.
        let is_alone = self.object.is_none();
        let counts = |name: &String| is_alone || expected.iter().any(|one| one.name == *name);
        let mut texts = self.texts.into_iter();
        let no_number = texts.find(|one| one.number.is_none() && counts(&one.name));
        match found {
            Ok(object) => Ok(Printed {
                object,
                answers: self.answers,
                no_number,
            }),
            Err(reason) => Err(NoAnswer { reason, last_line }),
        }
    }
}

/// Reads standard output to its end: the object of the last line that begins with a brace; without
/// such a line, the last numbers behind the names that the study expects.
pub(super) fn read_output(
    stream: impl Read,
    expected: &[Expectation],
) -> Result<Printed, NoAnswer> {
    let names = expected.iter().map(|expected| expected.name.clone());
    let names: Vec<String> = names.chain(STEPS_AND_WORK.map(str::to_owned)).collect();
    let mut output = Output::default();
    for_each_line(stream, |line, is_whole| output.read(line, is_whole, &names));
    output.answer(&names, expected)
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

    /// The object of an output, or why there is none.
    fn object(text: &str) -> Result<Map<String, Value>, String> {
        let printed = read_output(text.as_bytes(), &[]);
        printed
            .map(|printed| printed.object)
            .map_err(|nothing| nothing.reason)
    }

    #[test]
    fn the_last_line_with_a_brace_counts() {
        let found = object("start\n{\"a\": 1}\n{\"b\": 2}\r\niteration {3}\ndone\n\n").unwrap();
        assert_eq!(found.keys().collect::<Vec<_>>(), ["b"]);
        assert_eq!(object("{x}\n{\"c\": 3}").unwrap().len(), 1);
        let none = object("start\n{iteration 3}\ndone\n\n").unwrap_err();
        assert!(
            none.contains("key must be a string") && none.ends_with("; the last line is `done`"),
            "{none}"
        );
        let none = read_output(&b"\xff\n"[..], &[]).unwrap_err();
        assert_eq!(
            none.reason,
            "no line of its standard output is a JSON object; the last line is `\u{fffd}`"
        );
        assert_eq!(object("\n").unwrap_err(), "its standard output is empty");
    }

    #[test]
    fn the_answers_are_counted() {
        let text = "{\"errors\": {\"L2\": 1}}\n{\"log\": 1}\n{\"values\": {\"L2\": 1}}\n";
        assert_eq!(read_output(text.as_bytes(), &[]).unwrap().answers, 2);
    }

    #[test]
    fn a_line_in_braces_that_is_no_object_is_not_replaced_by_an_earlier_one() {
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
            ("{iteration 3}", "key must be a string"),
            ("{iteration 3", "key must be a string"),
        ] {
            let reason = object(&format!("{{\"early\": 1}}\n{last}\n")).unwrap_err();
            assert!(reason.contains(words), "{last}: {reason}");
            let answered = object(&format!("{last}\n{{\"late\": 1}}\n"));
            assert!(
                answered.is_ok_and(|object| object.contains_key("late")),
                "{last}"
            );
        }
        assert!(object("{\"early\": 1}\ndone {\n").is_ok());
    }

    #[test]
    fn a_line_without_end_is_not_kept() {
        let endless = std::io::repeat(b'{').take(10 * LONGEST_LINE as u64);
        let printed = read_output(endless.chain("\n{\"a\": 1}\n".as_bytes()), &[]);
        assert_eq!(printed.unwrap().object.len(), 1);
    }

    #[test]
    fn an_object_that_is_too_long_is_not_replaced_by_an_earlier_one() {
        let long = |start: &str| {
            format!(
                "{{\"early\": 1}}\n{start}{}\"}}\n",
                "x".repeat(LONGEST_LINE)
            )
        };
        let reason = object(&long(" {\"mesh\": \"")).unwrap_err();
        assert!(
            reason.contains("(longer than 1 MiB); the last line is `{\"mesh\": \"xxx"),
            "{reason}"
        );
        let talk = object(&long("mesh: "));
        assert!(talk.is_ok_and(|object| object.contains_key("early")));
        let fits = format!(
            "{{\"early\": 1}}\n{{\"m\": \"{}\"}}\n",
            "x".repeat(LONGEST_LINE - 10)
        );
        assert!(object(&fits).is_ok_and(|object| object.contains_key("m")));
    }

    #[test]
    fn last_words_are_three_lines_made_harmless() {
        let words = read_last_words("one\ntwo\n\n\x1b[31mthree\n  four\x07\n".as_bytes());
        assert_eq!(words, "two | \u{fffd}[31mthree | four\u{fffd}");
        let long = read_last_words("x".repeat(1000).as_bytes());
        assert_eq!(long.len(), LAST_CHARACTERS + 3);
    }
}
