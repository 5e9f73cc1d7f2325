//! The output of a program, read to its end with bounded memory.

use std::collections::VecDeque;
use std::io::{BufRead, BufReader, Read};

use super::answer::{NoAnswer, STEPS_AND_WORK, WrittenAnswer};
use super::expectation::Expectation;
use super::lines::{self, NamedText};
use crate::input::table::failed_run::says_failure;
use crate::text::visible::visible;

/// Longest line that is read whole, in bytes; only the start of a longer line is kept.
const LONGEST_LINE: usize = 1 << 20;

/// Number of lines of standard error that are shown, and of characters of each.
const LAST_LINES: usize = 3;
const LAST_CHARACTERS: usize = 160;

/// Most names that are listed where none of them is expected.
const MOST_OTHERS: usize = 8;

/// What a program has printed.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Printed {
    /// That of its last line that begins with a brace; without one, that of its lines.
    pub(super) answer: WrittenAnswer,
    /// How many answers it has printed as objects.
    pub(super) answers: usize,
    /// The first name behind which the last line has no number, with what it has.
    pub(super) no_number: Option<NamedText>,
    /// The first line behind the answer that says that the run has failed.
    pub(super) failed: Option<String>,
}

/// What is known of an output so far.
#[derive(Default)]
struct Output {
    /// What the last line that begins with a brace is, or why it is no answer.
    object: Option<Result<WrittenAnswer, NoAnswer>>,
    answers: usize,
    /// What stands behind the names of the study, after that line.
    texts: Vec<NamedText>,
    /// Some names of other numbers.
    others: Vec<String>,
    /// The first failure behind an answer.
    failed: Option<Failure>,
    last: String,
}

/// A line that says that the run has failed.
struct Failure {
    line: String,
    /// The errors and values that stand before it. A solver recovers if it prints each again.
    before: Vec<String>,
}

impl Output {
    fn read(&mut self, line: &str, is_whole: bool, names: &[String]) {
        match WrittenAnswer::of_line(line) {
            Some(read) => {
                let too_long = NoAnswer {
                    reason: "longer than 1 MiB".to_owned(),
                    is_object: false,
                };
                let read = if is_whole { read } else { Err(too_long) };
                self.answers += usize::from(read.is_ok());
                self.object = Some(read);
                self.texts.clear();
                self.failed = None;
            }
            None if is_whole => {
                let noted = lines::note(line, names, &mut self.texts);
                if noted > 0 && self.object.is_none() {
                    self.recover(noted);
                } else if self.failed.is_none() {
                    self.note_failure(line);
                }
                self.note_other(line);
            }
            None => {}
        }
        if !line.trim().is_empty() {
            line.clone_into(&mut self.last);
        }
    }

    /// Notes a line that says that the run has failed. Before the answer it does not count, and is
    /// not looked for: logs are long.
    fn note_failure(&mut self, line: &str) {
        let names = self.texts.iter().map(|text| &text.name);
        let errors = names.filter(|name| !STEPS_AND_WORK.contains(&name.as_str()));
        let mut before = errors.peekable();
        if (self.object.is_some() || before.peek().is_some()) && says_failure(line) {
            self.failed = Some(Failure {
                line: line.trim().to_owned(),
                before: before.cloned().collect(),
            });
        }
    }

    /// Forgets a failure if the last names noted are the rest of those before it.
    fn recover(&mut self, noted: usize) {
        let Some(failure) = &mut self.failed else {
            return;
        };
        let again = &self.texts[self.texts.len() - noted..];
        let is_again = |name: &String| again.iter().any(|text| text.name == *name);
        failure.before.retain(|name| !is_again(name));
        if failure.before.is_empty() {
            self.failed = None;
        }
    }

    /// Notes the name of a line such as `name = 1.5`.
    fn note_other(&mut self, line: &str) {
        if self.others.len() == MOST_OTHERS || !lines::has_mark(line) {
            return;
        }
        let Some((name, text)) = line.split_once(lines::MARKS) else {
            return;
        };
        let name = visible(name.trim());
        let has_number = text
            .trim_start()
            .starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c));
        if has_number && !name.is_empty() && !self.others.contains(&name) {
            self.others.push(name);
        }
    }

    fn answer(self, names: &[String], expected: &[Expectation]) -> Result<Printed, String> {
        let quoted = format!("the last line is `{}`", shown(&self.last));
        let found = match &self.object {
            Some(read) => read
                .clone()
                .map_err(|NoAnswer { reason, is_object }| match is_object {
                    true => {
                        format!("its last line that begins with a brace is no answer: {reason}")
                    }
                    false => {
                        let what = "its last line that begins with a brace is no JSON object";
                        format!("{what} ({reason}); {quoted}")
                    }
                }),
            None => {
                WrittenAnswer::of_lines(&self.texts, expected).ok_or_else(|| match &self.others[..]
                {
                    _ if self.last.is_empty() => "its standard output is empty".to_owned(),
                    [] => format!("no line of its standard output is a JSON object; {quoted}"),
                    others => {
                        // Those of steps and work may be absent.
                        let wanted = names
                            .iter()
                            .filter(|name| !STEPS_AND_WORK.contains(&name.as_str()));
                        let [found, wanted] = [in_quotes(others.iter()), in_quotes(wanted)];
                        format!("found {found}; the study has {wanted}")
                    }
                })
            }
        };
        // Behind an object, other names may be those of anything.
        let is_alone = self.object.is_none();
        let counts = |name: &String| is_alone || expected.iter().any(|one| one.name == *name);
        let mut texts = self.texts.into_iter();
        let no_number = texts.find(|one| one.number.is_none() && counts(&one.name));
        Ok(Printed {
            answer: found?,
            answers: self.answers,
            no_number,
            failed: self.failed.map(|failure| failure.line),
        })
    }
}

/// Reads standard output to its end: the object of the last line that begins with a brace; without
/// such a line, the last numbers behind the names that the study expects.
pub(super) fn read_output(stream: impl Read, expected: &[Expectation]) -> Result<Printed, String> {
    let names = expected.iter().map(|expected| expected.name.clone());
    let names: Vec<String> = names.chain(STEPS_AND_WORK.map(str::to_owned)).collect();
    let mut output = Output::default();
    for_each_line(stream, |line, is_whole| output.read(line, is_whole, &names));
    output.answer(&names, expected)
}

fn in_quotes<'n>(names: impl Iterator<Item = &'n String>) -> String {
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
fn for_each_line(stream: impl Read, mut each: impl FnMut(&str, bool)) {
    let mut stream = BufReader::with_capacity(1 << 16, stream);
    let mut line = vec![];
    loop {
        line.clear();
        let mut start = stream.by_ref().take(LONGEST_LINE as u64);
        let _ = start.read_until(b'\n', &mut line);
        let has_end = line.ends_with(b"\n");
        let is_cut = !has_end && line.len() == LONGEST_LINE;
        let rest = if is_cut {
            stream.skip_until(b'\n')
        } else {
            Ok(0)
        };
        each(
            &String::from_utf8_lossy(&line),
            rest.is_ok_and(|rest| rest == 0),
        );
        if !has_end && !is_cut {
            break;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::answer::Answer;
    use super::*;
    use crate::refused::each_is_refused;

    /// An answer with one error.
    fn line(name: &str) -> String {
        format!("{{\"errors\": {{\"{name}\": 1}}}}\n")
    }

    /// The name of the error that an output answers, or why there is none.
    fn answered(text: &str) -> Result<String, String> {
        let printed = read_output(text.as_bytes(), &[])?;
        let (mut answer, _) = Answer::read(&printed.answer)?;
        Ok(answer.errors.remove(0).name)
    }

    #[test]
    fn the_last_line_with_a_brace_counts() {
        let [a, b] = ["a", "b"].map(line);
        let b = b.trim_end();
        let text = format!("start\n{a}{b}\r\niteration {{3}}\ndone\n\n");
        assert_eq!(answered(&text).unwrap(), "b");
        assert_eq!(answered(&format!("{{x}}\n{a}")).unwrap(), "a");
        let none = answered("start\n{iteration 3}\ndone\n\n").unwrap_err();
        assert!(
            none.contains("key must be a string") && none.ends_with("; the last line is `done`"),
            "{none}"
        );
        let none = read_output(&b"\xff\n"[..], &[]).unwrap_err();
        assert_eq!(
            none,
            "no line of its standard output is a JSON object; the last line is `\u{fffd}`"
        );
        assert_eq!(answered("\n").unwrap_err(), "its standard output is empty");
    }

    #[test]
    fn a_line_in_braces_that_is_no_object_is_not_replaced_by_an_earlier_one() {
        each_is_refused(include_str!("output/refused.txt"), |case| {
            let last = &case.new;
            let found = answered(&format!("{last}\n{}", line("late")));
            assert_eq!(found.unwrap(), "late", "{last}");
            answered(&format!("{}{last}\n", line("early"))).unwrap_err()
        });
        assert!(answered(&(line("early") + "done {\n")).is_ok());
    }

    #[test]
    fn a_failed_run_is_told_by_a_line_behind_the_answer_and_by_none_before() {
        let failed = |text: &str| {
            let expected = ["a", "b"].map(Expectation::of_value);
            let printed = read_output(text.as_bytes(), &expected);
            printed.unwrap().failed
        };
        let [object, name] = [line("a"), "a = 1\n".to_owned()];
        for answer in [&object, &name] {
            assert_eq!(failed(&format!("Killed\n{answer}done\n")), None);
            let behind = failed(&format!("{answer}done\n  Killed\nAborted\n"));
            assert_eq!(behind.as_deref(), Some("Killed"));
        }
        // The step, the work or another error is no new answer; each error once more is one.
        let [a, b] = [name.as_str(), "b = 1\n"];
        for rest in ["work = 64\n", "h = 0.1\n", b] {
            assert!(failed(&format!("{a}Killed\n{rest}")).is_some(), "{rest}");
        }
        assert!(failed(&format!("{a}{b}Killed\n{a}")).is_some());
        assert_eq!(failed(&format!("{a}{b}Killed\n{b}{a}")), None);
        // Another name behind an object is no answer, and a name that a failure takes is none.
        assert!(failed(&format!("{object}Killed\n{name}")).is_some());
        assert_eq!(failed(&format!("{name}error: a = 2\n")), None);
    }

    #[test]
    fn a_line_without_end_is_not_kept() {
        let endless = std::io::repeat(b'{').take(10 * LONGEST_LINE as u64);
        let last = "\n".to_owned() + &line("a");
        let printed = read_output(endless.chain(last.as_bytes()), &[]);
        assert_eq!(printed.unwrap().answers, 1);
    }

    #[test]
    fn an_object_that_is_too_long_is_not_replaced_by_an_earlier_one() {
        let long = |start: &str| {
            let rest = "x".repeat(LONGEST_LINE);
            format!("{}{start}{rest}\"}}\n", line("early"))
        };
        let reason = answered(&long(" {\"mesh\": \"")).unwrap_err();
        assert!(
            reason.contains("(longer than 1 MiB); the last line is `{\"mesh\": \"xxx"),
            "{reason}"
        );
        assert_eq!(answered(&long("mesh: ")).unwrap(), "early");
        let name = "x".repeat(LONGEST_LINE - 30);
        assert_eq!(answered(&(line("early") + &line(&name))).unwrap(), name);
    }

    #[test]
    fn last_words_are_three_lines_made_harmless() {
        let words = read_last_words("one\ntwo\n\n\x1b[31mthree\n  four\x07\n".as_bytes());
        assert_eq!(words, "two | \u{fffd}[31mthree | four\u{fffd}");
        let long = read_last_words("x".repeat(1000).as_bytes());
        assert_eq!(long.len(), LAST_CHARACTERS + 3);
    }
}
