//! The answer of a program: the last line of its standard output that begins with a brace; without
//! such a line, numbers behind the names that the study expects: `max = 1.5e-3`.

use std::fmt;

use serde::de::{Deserializer, Error as _, MapAccess, Visitor};
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::expectation::Expectation;
use super::lines::NamedText;
use crate::input::shorten;
use crate::study::CaseFailure;
use crate::text::json;
use crate::text::named::NamedNumber;
use crate::text::visible::visible;

/// The numbers of one case; NaN if that was the answer. Names are sorted, and safe for a terminal.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct Answer {
    /// Errors by name.
    #[serde(with = "json::named")]
    pub errors: Vec<NamedNumber>,
    /// Values without an exact solution, by name.
    #[serde(with = "json::named")]
    pub values: Vec<NamedNumber>,
    /// The mesh width, if it is not the nominal one; > 0.
    pub h: Option<f64>,
    /// The time step, likewise.
    pub dt: Option<f64>,
    /// Unknowns, operations, seconds: whatever the program counts; > 0.
    pub work: Option<f64>,
    /// The time that the program took.
    #[serde(default)]
    pub seconds: f64,
    /// How many objects with errors or values the program has printed; the last one counts.
    #[serde(default)]
    pub printed: usize,
    /// Whether it is that of an earlier run.
    #[serde(skip)]
    pub is_reused: bool,
    /// What differs from an earlier run with the same command and files.
    #[serde(skip)]
    pub differs: Option<String>,
    /// Why the case has failed nevertheless: a number is NaN or missing. The others count.
    #[serde(skip)]
    pub failure: Option<CaseFailure>,
}

/// What a program has written, before its numbers are looked at. An unknown name may say that the
/// case has failed: it is refused.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(super) struct WrittenAnswer {
    errors: Option<Names>,
    values: Option<Names>,
    #[serde(deserialize_with = "is_there")]
    h: Option<Value>,
    #[serde(deserialize_with = "is_there")]
    dt: Option<Value>,
    #[serde(deserialize_with = "is_there")]
    work: Option<Value>,
}

/// Values by name, no name twice: the last would silently win.
#[derive(Debug, Clone, PartialEq, Default)]
struct Names(Vec<(String, Value)>);

/// A value that is there, be it `null`.
fn is_there<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<Value>, D::Error> {
    Value::deserialize(deserializer).map(Some)
}

impl<'de> Deserialize<'de> for Names {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reads;
        impl<'de> Visitor<'de> for Reads {
            type Value = Names;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(r#"an object of names and numbers, such as {"L2": 1.5e-3}"#)
            }

            fn visit_map<A: MapAccess<'de>>(self, mut entries: A) -> Result<Names, A::Error> {
                let mut names = Names::default();
                while let Some((name, value)) = entries.next_entry::<String, Value>()? {
                    if names.0.iter().any(|(known, _)| *known == name) {
                        return Err(A::Error::custom(format!("`{name}` occurs twice")));
                    }
                    if names.0.len() == MOST_NAMES {
                        let most = format!("expected at most {MOST_NAMES} names, found more");
                        return Err(A::Error::custom(most));
                    }
                    names.0.push((name, value));
                }
                Ok(names)
            }
        }
        deserializer.deserialize_map(Reads)
    }
}

/// Why a line that begins with a brace is no answer.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct NoAnswer {
    /// In words, with advice.
    pub(super) reason: String,
    /// Whether it is an object of JSON.
    pub(super) is_object: bool,
}

impl WrittenAnswer {
    /// The answer that a line is, or why it is none; `None` for lines that do not begin with `{`.
    ///
    /// JSON has no NaN, but Python and others print it: `NaN`, `Infinity` and `-Infinity` are read
    /// as `null`, which is not a number.
    pub(super) fn of_line(line: &str) -> Option<Result<Self, NoAnswer>> {
        let line = line.trim();
        let inside = line.strip_prefix('{')?.trim_start();
        let read =
            serde_json::from_str(line).or_else(|_| serde_json::from_str(&with_null_for_nan(line)));
        let answer: Self = match read {
            Ok(answer) => answer,
            Err(error) => {
                let reason = if inside.starts_with('\'') {
                    "single quotes are not those of JSON: print it with json.dumps(...) on one line"
                        .to_owned()
                } else if error.is_eof() {
                    "it does not end on its line: print it with json.dumps(...) on one line"
                        .to_owned()
                } else {
                    without_place(&error)
                };
                let is_object = error.is_data();
                return Some(Err(NoAnswer { reason, is_object }));
            }
        };
        if answer.errors.is_none() && answer.values.is_none() {
            return Some(Err(NoAnswer {
                reason: "expected errors or values, found neither".to_owned(),
                is_object: true,
            }));
        }
        Some(Ok(answer))
    }

    /// The answer that lines such as `max = 1.5e-3` are: the last number of each name that the
    /// study expects, with the step and the work; `None` if no name is expected.
    pub(super) fn of_lines(texts: &[NamedText], expected: &[Expectation]) -> Option<Self> {
        let mut answer = Self::default();
        for NamedText { name, number, .. } in texts {
            for expected in expected.iter().filter(|expected| expected.name == *name) {
                let among = match expected.is_value {
                    true => &mut answer.values,
                    false => &mut answer.errors,
                };
                let names = among.get_or_insert_default();
                names.0.push((name.clone(), (*number).into()));
            }
        }
        if answer == Self::default() {
            return None;
        }
        for NamedText { name, number, .. } in texts {
            let number = number.map(Value::from);
            match name.as_str() {
                "h" => answer.h = number,
                "dt" => answer.dt = number,
                "work" => answer.work = number,
                _ => {}
            }
        }
        Some(answer)
    }
}

/// An error without its place: then the levels of a study have one reason, which is said once.
fn without_place(error: &serde_json::Error) -> String {
    let words = error.to_string();
    let words = words
        .rsplit_once(" at line ")
        .map_or(&*words, |(words, _)| words);
    visible(words)
}

/// Most errors, and most values, of an answer: every level is searched for each name.
const MOST_NAMES: usize = 1000;

/// What an answer has beside errors and values.
pub(super) const STEPS_AND_WORK: [&str; 3] = ["h", "dt", "work"];

/// The text with `null` for every NaN and infinity.
fn with_null(piece: &str) -> String {
    const TOKENS: [&str; 8] = [
        "-Infinity",
        "Infinity",
        "-NaN",
        "NaN",
        "-inf",
        "inf",
        "-nan",
        "nan",
    ];
    TOKENS.iter().fold(piece.to_owned(), |piece, token| {
        piece.replace(token, "null")
    })
}

/// The text with `null` for every NaN and infinity outside strings.
fn with_null_for_nan(line: &str) -> String {
    let mut is_string = false;
    let mut is_escaped = false;
    // Pieces end with a quote that opens or closes a string: every second one is a string.
    let pieces = line.split_inclusive(|c| {
        let is_quote = c == '"' && !is_escaped;
        is_escaped = is_string && c == '\\' && !is_escaped;
        is_string ^= is_quote;
        is_quote
    });
    pieces
        .enumerate()
        .map(|(k, piece)| {
            if k % 2 == 1 {
                piece.to_owned()
            } else {
                with_null(piece)
            }
        })
        .collect()
}

impl Answer {
    /// Reads an answer. An error or a value that is not a finite number is NaN.
    ///
    /// * Returns it with the first complaint about such a number, or the reason why it is not an
    ///   answer.
    pub(super) fn read(written: &WrittenAnswer) -> Result<(Self, Option<String>), String> {
        let mut complaint = None;
        let answer = Self {
            errors: numbers(&written.errors, "errors", &mut complaint),
            values: numbers(&written.values, "values", &mut complaint),
            h: positive("h", &written.h)?,
            dt: positive("dt", &written.dt)?,
            work: positive("work", &written.work)?,
            ..Self::default()
        };
        Ok((answer, complaint))
    }

    /// The number of that name; `None` if it is absent.
    pub(super) fn number(&self, expected: &Expectation) -> Option<f64> {
        let among = if expected.is_value {
            &self.values
        } else {
            &self.errors
        };
        NamedNumber::find(among, &expected.name)
    }

    /// Refuses an answer that lacks a number that the study expects.
    pub(super) fn require(&self, expected: &Expectation) -> Result<(), String> {
        if self.number(expected).is_some() {
            return Ok(());
        }
        let (own, other) = if expected.is_value {
            (&self.values, "errors")
        } else {
            (&self.errors, "values")
        };
        let is_other = self
            .number(&Expectation {
                is_value: !expected.is_value,
                ..expected.clone()
            })
            .is_some();
        let there = match own[..] {
            _ if is_other => format!("it among its {other}"),
            [] => "none".to_owned(),
            _ => own
                .iter()
                .map(|known| known.name.as_str())
                .collect::<Vec<_>>()
                .join(", "),
        };
        Err(format!(
            "its answer has no {} `{}`; it has {there}",
            expected.what(),
            expected.name
        ))
    }
}

/// The numbers of an answer, sorted by their names.
fn numbers(names: &Option<Names>, among: &str, complaint: &mut Option<String>) -> Vec<NamedNumber> {
    let mut numbers = vec![];
    for (name, value) in names.iter().flat_map(|names| &names.0) {
        let name = visible(name);
        let of_name = format!("`{name}` of its {among}");
        match number(&of_name, value, "a finite number", |_| true) {
            Ok(number) => numbers.push(NamedNumber::new(name, number)),
            Err(error) => {
                complaint.get_or_insert(error);
                // A text or a list is no number that was computed: the number is missing.
                if value.is_null() || value.is_number() {
                    numbers.push(NamedNumber::new(name, f64::NAN));
                }
            }
        }
    }
    numbers.sort_by(|one, other| one.name.cmp(&other.name));
    numbers
}

/// A step or the work, if it is there.
fn positive(name: &str, value: &Option<Value>) -> Result<Option<f64>, String> {
    let Some(value) = value else {
        return Ok(None);
    };
    number(name, value, "a finite number > 0", |value| value > 0.0).map(Some)
}

fn number(
    name: &str,
    value: &Value,
    expected: &str,
    ok: impl Fn(f64) -> bool,
) -> Result<f64, String> {
    let found = value
        .as_f64()
        .filter(|value| value.is_finite() && ok(*value));
    found.ok_or_else(|| format!("{name} is {}; expected {expected}", written(value)))
}

fn written(value: &Value) -> String {
    let text = value.as_str().unwrap_or_default();
    if value.is_null() {
        "NaN, infinite or null".to_owned()
    } else if text.trim().parse::<f64>().is_ok() {
        // Without the number: then the levels have one reason.
        "a number in quotes, which is text".to_owned()
    } else {
        shorten(&value.to_string())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::refused::each_is_refused;

    fn read(line: &str) -> Result<Answer, String> {
        let written = WrittenAnswer::of_line(line).unwrap();
        let (answer, complaint) = Answer::read(&written.map_err(|none| none.reason)?)?;
        complaint.map_or(Ok(answer), Err)
    }

    #[test]
    fn an_answer_has_at_most_so_many_names() {
        let answer = |count: usize| {
            let errors = (0..count).map(|k| format!("\"e{k}\": 1"));
            let errors = errors.collect::<Vec<_>>().join(", ");
            read(&format!("{{\"errors\": {{{errors}}}}}"))
        };
        assert_eq!(answer(MOST_NAMES).unwrap().errors.len(), MOST_NAMES);
        assert_eq!(
            answer(10_000).unwrap_err(),
            "expected at most 1000 names, found more"
        );
    }

    #[test]
    fn what_is_no_answer_is_refused_by_name() {
        each_is_refused(include_str!("answer/refused.txt"), |case| {
            read(&case.new).unwrap_err()
        });
    }

    #[test]
    fn a_text_in_place_of_a_number_is_a_missing_number_and_not_one_that_broke_down() {
        let errors = |line: &str| {
            let written = WrittenAnswer::of_line(line).unwrap().unwrap();
            let (answer, complaint) = Answer::read(&written).unwrap();
            assert!(complaint.is_some(), "{line}");
            answer.errors
        };
        assert_eq!(errors(r#"{"errors": {"L2": "1e-3"}}"#), []);
        let broken = errors(r#"{"errors": {"L2": null}}"#);
        assert!(matches!(&broken[..], [one] if one.value.is_nan()));
    }

    #[test]
    fn other_lines_are_no_objects() {
        let read = WrittenAnswer::of_line;
        assert_eq!(read("iteration 3: {ok"), None);
        assert_eq!(read("[1]"), None);
        assert!(read("{not json}").unwrap().is_err());
        assert!(read(r#"{"errors": {"a": 1e999}}"#).unwrap().is_err());
    }
}
