//! The answer of a program: the last line of its standard output that begins with a brace; without
//! such a line, numbers behind the names that the study expects: `max = 1.5e-3`.

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use super::expectation::Expectation;
use super::lines::NamedText;
use super::once::Once;
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

/// The object that a line is, or why it is not one; `None` for lines that do not begin with `{`.
///
/// JSON has no NaN, but Python and others print it: `NaN`, `Infinity` and `-Infinity` are read as
/// `null`, which is not a number.
///
/// The reason is in words, with advice.
pub(super) fn object(line: &str) -> Option<Result<Map<String, Value>, String>> {
    let line = line.trim();
    let inside = line.strip_prefix('{')?.trim_start();
    let parsed = |line: &str| serde_json::from_str(line).map(|Once(value)| value);
    let read = parsed(line)
        .or_else(|_| parsed(&with_null_for_nan(line)))
        .and_then(serde_json::from_value);
    let near_miss = |error: serde_json::Error| {
        if inside.starts_with('\'') {
            "single quotes are not those of JSON: print it with json.dumps(...) on one line"
                .to_owned()
        } else if error.is_eof() {
            "it does not end on its line: print it with json.dumps(...) on one line".to_owned()
        } else {
            error.to_string()
        }
    };
    Some(read.map_err(near_miss))
}

/// Whether an object is an answer, be it a bad one.
pub(super) fn is_answer(object: &Map<String, Value>) -> bool {
    ["errors", "values"]
        .iter()
        .any(|key| object.contains_key(*key))
}

/// The answer that lines such as `max = 1.5e-3` are: the last number of each name that the study
/// expects, with the step and the work; `None` if no name is expected.
pub(super) fn object_of_lines(
    texts: &[NamedText],
    expected: &[Expectation],
) -> Option<Map<String, Value>> {
    let mut object = Map::new();
    for NamedText { name, number, .. } in texts {
        for expected in expected.iter().filter(|expected| expected.name == *name) {
            let among = format!("{}s", expected.what());
            let names = object.entry(among).or_insert_with(|| Map::new().into());
            names[name] = (*number).into();
        }
    }
    let has_answer = !object.is_empty();
    for NamedText { name, number, .. } in texts {
        if let Some(number) = number
            && STEPS_AND_WORK.contains(&name.as_str())
        {
            object.insert(name.clone(), (*number).into());
        }
    }
    has_answer.then_some(object)
}

/// Most errors, and most values, of an answer: every level is searched for each name.
const MOST_NAMES: usize = 1000;

/// What an answer has beside errors and values.
pub(super) const STEPS_AND_WORK: [&str; 3] = ["h", "dt", "work"];

/// The text with `null` for every NaN and infinity outside strings.
fn with_null_for_nan(line: &str) -> String {
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
    let mut is_string = false;
    let mut is_escaped = false;
    // Pieces end with a quote that opens or closes a string: every second one is a string.
    let pieces = line.split_inclusive(|c| {
        let is_quote = c == '"' && !is_escaped;
        is_escaped = is_string && c == '\\' && !is_escaped;
        is_string ^= is_quote;
        is_quote
    });
    let null = |piece: &str| {
        TOKENS.iter().fold(piece.to_owned(), |piece, token| {
            piece.replace(token, "null")
        })
    };
    pieces
        .enumerate()
        .map(|(k, piece)| {
            if k % 2 == 1 {
                piece.to_owned()
            } else {
                null(piece)
            }
        })
        .collect()
}

impl Answer {
    /// Reads an answer; refuses unknown keys, which may say that the case has failed. An error or a
    /// value that is not a finite number is NaN.
    ///
    /// * Returns it with the first complaint about such a number, or the reason why it is not an
    ///   answer.
    pub(super) fn read(object: &Map<String, Value>) -> Result<(Self, Option<String>), String> {
        known_keys(object)?;
        let step = |name: &str| {
            let read = |value| number(name, value, "a finite number > 0", |value| value > 0.0);
            object.get(name).map(read).transpose()
        };
        let mut complaint = None;
        let answer = Self {
            errors: table(object, "errors", &mut complaint)?,
            values: table(object, "values", &mut complaint)?,
            h: step("h")?,
            dt: step("dt")?,
            work: step("work")?,
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

/// Refuses an object that has no errors and no values, or anything that is no part of an answer.
fn known_keys(object: &Map<String, Value>) -> Result<(), String> {
    const KEYS: &str = "errors, values, h, dt, work";
    let is_known = |key: &&String| KEYS.split(", ").any(|known| known == key.as_str());
    let Some((key, value)) = object.iter().find(|(key, _)| !is_known(key)) else {
        return match is_answer(object) {
            true => Ok(()),
            false => Err(format!(
                "its answer has neither errors nor values; expected some of {KEYS}"
            )),
        };
    };
    let is_number = value.is_number() || is_number_as_text(value);
    let advice = if is_number {
        let key = Value::from(key.as_str());
        format!(
            "; if it is an error, put the number below `errors`: {{\"errors\": {{{key}: 1.5e-3}}}}"
        )
    } else {
        String::new()
    };
    let key = visible(&shorten(key));
    let value = match value {
        // Without the number: the cases of a study then have one reason, which is said once.
        Value::Number(_) => "a number".to_owned(),
        _ => visible(&written(value)),
    };
    Err(format!(
        "its answer has the unknown key `{key}`, {value}; expected some of {KEYS}{advice}"
    ))
}

fn table(
    object: &Map<String, Value>,
    name: &str,
    complaint: &mut Option<String>,
) -> Result<Vec<NamedNumber>, String> {
    let Some(value) = object.get(name) else {
        return Ok(vec![]);
    };
    let expected = r#"an object of names and numbers, such as {"L2": 1.5e-3}"#;
    let entries = value
        .as_object()
        .ok_or_else(|| format!("`{name}` is {}; expected {expected}", written(value)))?;
    if entries.len() > MOST_NAMES {
        return Err(format!(
            "`{name}` has {} names; expected at most {MOST_NAMES}",
            entries.len()
        ));
    }
    let mut numbers = vec![];
    for (key, value) in entries {
        let key = visible(key);
        let read = number(
            &format!("`{key}` of its {name}"),
            value,
            "a finite number",
            |_| true,
        );
        match read {
            Ok(number) => numbers.push(NamedNumber::new(key, number)),
            Err(error) => {
                complaint.get_or_insert(error);
                // A text or a list is no number that was computed: the number is missing.
                if value.is_null() || value.is_number() {
                    numbers.push(NamedNumber::new(key, f64::NAN));
                }
            }
        }
    }
    Ok(numbers)
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

fn is_number_as_text(value: &Value) -> bool {
    let text = value.as_str().unwrap_or_default();
    text.trim().parse::<f64>().is_ok()
}

fn written(value: &Value) -> String {
    if value.is_null() {
        "NaN, infinite or null".to_owned()
    } else if is_number_as_text(value) {
        // Without the number, as above.
        "a number in quotes, which is text".to_owned()
    } else {
        shorten(&value.to_string())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(line: &str) -> Result<Answer, String> {
        let (answer, complaint) = Answer::read(&object(line).unwrap().unwrap())?;
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
            "`errors` has 10000 names; expected at most 1000"
        );
    }

    #[test]
    fn an_answer_has_errors_values_steps_and_work() {
        let answer =
            read(r#" {"errors": {"L2": 1e-3, "H1": 2}, "values": {"flux": -3.5}, "h": 0.1, "work": 40} "#)
                .unwrap();
        assert_eq!(
            answer.errors,
            [NamedNumber::new("H1", 2.0), NamedNumber::new("L2", 1e-3)]
        );
        assert_eq!(answer.values, [NamedNumber::new("flux", -3.5)]);
        assert_eq!(
            (answer.h, answer.dt, answer.work),
            (Some(0.1), None, Some(40.0))
        );
    }

    #[test]
    fn what_is_no_part_of_an_answer_is_refused() {
        for (line, words) in [
            (
                r#"{"errors": {"L2": 1}, "failed": true}"#,
                "the unknown key `failed`, true; expected some of errors",
            ),
            (
                r#"{"errors": {"L2": 1}, "success": false}"#,
                "the unknown key `success`, false",
            ),
            (
                r#"{"errors": {"L2": 1}, "x": [1]}"#,
                "the unknown key `x`, [1]",
            ),
            (
                r#"{"status": "failed"}"#,
                "the unknown key `status`, \"failed\"",
            ),
            (
                r#"{"L2": 0.01}"#,
                r#"`L2`, a number; expected some of errors, values, h, dt, work; if it is an error, put the number below `errors`: {"errors": {"L2": 1.5e-3}}"#,
            ),
            (
                r#"{"L2": "0.01"}"#,
                "`L2`, a number in quotes, which is text; expected some of errors",
            ),
            (r#"{"h": 0.01}"#, "neither errors nor values"),
            ("{}", "neither errors nor values"),
            (
                r#"{"errors": [{"L2": 1}]}"#,
                "`errors` is [{\"L2\":1}]; expected an object",
            ),
            (
                r#"{"errors": {"L2": [1]}}"#,
                "`L2` of its errors is [1]; expected a finite number",
            ),
        ] {
            let found = read(line).unwrap_err();
            assert!(found.contains(words), "{line}: {found}");
        }
    }

    #[test]
    fn numbers_that_are_none_are_refused_by_name() {
        let not_finite = "is NaN, infinite or null; expected a finite number";
        for (line, message) in [
            (
                r#"{"errors": {"L2": NaN}}"#,
                format!("`L2` of its errors {not_finite}"),
            ),
            (
                r#"{"errors": {"NaN": -Infinity}}"#,
                format!("`NaN` of its errors {not_finite}"),
            ),
            (
                r#"{"values": {"a\"nan": nan}}"#,
                format!("`a\"nan` of its values {not_finite}"),
            ),
            (
                r#"{"errors": {"L2": null}}"#,
                format!("`L2` of its errors {not_finite}"),
            ),
            (
                r#"{"errors": {"L2": "small"}}"#,
                "`L2` of its errors is \"small\"; expected a finite number".to_owned(),
            ),
            (
                r#"{"errors": {"L2": "1e-3"}}"#,
                "`L2` of its errors is a number in quotes, which is text; expected a finite number"
                    .to_owned(),
            ),
            (
                r#"{"errors": [1]}"#,
                "`errors` is [1]; expected an object".to_owned(),
            ),
            (
                r#"{"errors": {}, "h": 0}"#,
                "h is 0; expected a finite number > 0".to_owned(),
            ),
            (
                r#"{"errors": {}, "h": NaN}"#,
                "h is NaN, infinite or null; expected a finite number > 0".to_owned(),
            ),
        ] {
            let found = read(line).unwrap_err();
            assert!(found.contains(&message), "{found}");
        }
    }

    #[test]
    fn a_text_in_place_of_a_number_is_a_missing_number_and_not_one_that_broke_down() {
        let errors = |line: &str| {
            let (answer, complaint) = Answer::read(&object(line).unwrap().unwrap()).unwrap();
            assert!(complaint.is_some(), "{line}");
            answer.errors
        };
        assert_eq!(errors(r#"{"errors": {"L2": "1e-3"}}"#), []);
        let broken = errors(r#"{"errors": {"L2": null}}"#);
        assert!(matches!(&broken[..], [one] if one.value.is_nan()));
    }

    #[test]
    fn a_missing_name_is_told_with_those_that_are_there() {
        let answer = read(r#"{"errors": {"H1": 1}, "values": {"L2": 1}}"#).unwrap();
        let require = |is_value: bool, name: &str| {
            answer.require(&Expectation {
                is_value,
                ..Expectation::of_value(name)
            })
        };
        let missing = |is_value: bool, name: &str| require(is_value, name).unwrap_err();
        assert_eq!(
            missing(false, "L2"),
            "its answer has no error `L2`; it has it among its values"
        );
        assert_eq!(
            missing(false, "max"),
            "its answer has no error `max`; it has H1"
        );
        assert_eq!(
            missing(true, "flux"),
            "its answer has no value `flux`; it has L2"
        );
        assert_eq!(require(false, "H1"), Ok(()));
    }

    #[test]
    fn other_lines_are_no_objects() {
        assert_eq!(object("iteration 3: {ok"), None);
        assert_eq!(object("[1]"), None);
        assert!(object("{not json}").unwrap().is_err());
        assert!(object(r#"{"a": 1e999}"#).unwrap().is_err());
    }
}
