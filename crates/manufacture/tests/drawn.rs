//! Edits of one sign, operator, number or word, drawn by a seed in ten problems and in random
//! files: what is named, and that nothing is named falsely.
//!
//! `MANUFACTURE_EDITS=400` draws more, `MANUFACTURE_SEED=7` others.

use std::cmp::Reverse;
use std::ops::Range;

use crate::mistakes::{self, SWIRL};
use crate::prelude::*;
use crate::random::{self, OTHER_POINTS, POINTS, Random, replaced, setting};

/// Ten problems: six of the literature, and four more.
fn problems() -> Vec<&'static str> {
    let [gas, filtered, rubber, torus, interval, coastal] = mistakes::FILES;
    vec![
        gas, filtered, rubber, torus, interval, coastal, HEAT, PFHUB, SWIRL, SOLID,
    ]
}

/// What is edited.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Sign,
    Operator,
    Number,
}

/// A place in a text, and what may stand there instead.
struct Place {
    kind: Kind,
    place: Range<usize>,
    others: Vec<String>,
}

/// The parts between quotes of the tables of definitions and equations.
fn expressions(text: &str) -> Vec<(usize, usize)> {
    let mut found = vec![];
    let mut is_in_table = false;
    let mut start = 0;
    for line in text.split_inclusive('\n') {
        if line.starts_with('[') {
            is_in_table = line.starts_with("[define]") || line.starts_with("[equations");
        } else if is_in_table && !line.starts_with('#') {
            let quotes: Vec<usize> = line.match_indices('"').map(|quote| quote.0).collect();
            let pairs = quotes.chunks_exact(2);
            found.extend(pairs.map(|pair| (start + pair[0] + 1, start + pair[1])));
        }
        start += line.len();
    }
    found
}

/// All signs, operators and numbers of the expressions.
fn places(text: &str) -> Vec<Place> {
    let mut places = vec![];
    for (first, last) in expressions(text) {
        let mut at = first;
        while at < last {
            let c = text.as_bytes()[at];
            let is_name = |at: usize| {
                at > first && {
                    let before = text.as_bytes()[at - 1];
                    before.is_ascii_alphanumeric()
                        || before == b'_'
                        || before == b'.'
                        || before == b'['
                }
            };
            let mut end = at + 1;
            let mut add = |kind: Kind, end: usize, others: &[&str]| {
                let others = others.iter().map(|other| (*other).to_owned()).collect();
                let place = at..end;
                places.push(Place {
                    kind,
                    place,
                    others,
                });
            };
            match c {
                b'+' => add(Kind::Sign, end, &["-"]),
                b'-' if at == first => add(Kind::Sign, end, &[""]),
                b'-' => add(Kind::Sign, end, &["+"]),
                b'*' => add(Kind::Operator, end, &["/", "^"]),
                b'/' => add(Kind::Operator, end, &["*"]),
                b'^' => add(Kind::Operator, end, &["*"]),
                b'0'..=b'9' if !is_name(at) => {
                    let digits = text[at..last].find(|c: char| !c.is_ascii_digit() && c != '.');
                    end = digits.map_or(last, |digits| at + digits);
                    let value: f64 = text[at..end].parse().unwrap();
                    let others = [value + 1.0, 2.0 * value, 0.5 * value];
                    let others = others.map(|other| other.to_string());
                    add(Kind::Number, end, &others.each_ref().map(String::as_str));
                }
                _ => (),
            }
            at = end;
        }
    }
    places
}

/// A text with one edit.
struct Drawn {
    text: String,
    other: String,
    comparisons: Vec<Comparison>,
}

impl Drawn {
    /// `None` if the other text is no file, or has the same values.
    fn new(text: &str, place: &Range<usize>, new: &str) -> Option<Self> {
        let other = replaced(text, place.clone(), new);
        Manufacture::parse(&other, "other.toml").ok()?;
        let comparisons = mistakes::compared(text, &other, &POINTS)?;
        let is_seen = comparisons.iter().any(|c| c.cause != "equal");
        is_seen.then_some(Drawn {
            text: text.to_owned(),
            other,
            comparisons,
        })
    }
}

/// An edit of a sign, an operator or a number in one of the problems.
fn edited(random: &mut Random) -> Option<Drawn> {
    let problems = problems();
    let text = problems[random.below(problems.len())];
    let kind = [Kind::Sign, Kind::Operator, Kind::Number][random.below(3)];
    let mut places = places(text);
    places.retain(|place| place.kind == kind);
    let place = places.get(random.below(places.len().max(1)))?;
    let new = &place.others[random.below(place.others.len())];
    Drawn::new(text, &place.place, new)
}

/// Texts of equations and definitions, each with what a mistake makes of it.
const EDITS: &str = include_str!("edits.json");

/// A mistake in the definitions or equations of a problem of the literature or of a random file.
fn mistaken(random: &mut Random) -> Option<Drawn> {
    let fixed = mistakes::FILES.get(random.below(2 * mistakes::FILES.len()));
    let text = fixed.map_or_else(|| random.file(), |text| (*text).to_owned());
    let starts = ["[define]", "[equations"].map(|table| text.find(table));
    let start = starts.into_iter().flatten().min()?;
    let end = ["[boundary", "[require]"].map(|table| text.find(table));
    let end = end.into_iter().flatten().min().unwrap_or(text.len());
    // A rare text is drawn as often as a common one.
    let mut kinds = vec![];
    for [old, new] in serde_json::from_str::<Vec<[String; 2]>>(EDITS).unwrap() {
        let places = random::places(&text[start..end], &old, start);
        if !places.is_empty() {
            kinds.push((old, new, places));
        }
    }
    let (old, new, places) = &kinds[random.below(kinds.len())];
    let place = places[random.below(places.len())];
    Drawn::new(&text, &(place..place + old.len()), new)
}

/// What became of an edit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Outcome {
    Named,
    Unnamed,
    False,
}

/// Whether the edits that are named have the values of the edited file at other points, too.
fn outcome(drawn: &Drawn) -> Outcome {
    let wrong = drawn.comparisons.iter().filter(|c| c.cause != "equal");
    let mut outcome = Outcome::Named;
    for comparison in wrong {
        if comparison.cause == "none" {
            outcome = Outcome::Unnamed;
            continue;
        }
        let is_text =
            !comparison.edits.is_empty() && comparison.edits.iter().all(mistakes::is_text);
        let expected = if is_text { "equal" } else { comparison.cause };
        let mut edits: Vec<_> = comparison.edits.iter().filter(|_| is_text).collect();
        // From the last to the first: an edit moves what is behind it.
        edits.sort_by_key(|edit| Reverse((edit.line, edit.column)));
        let corrected = edits.into_iter().fold(drawn.text.clone(), |text, edit| {
            mistakes::applied(&text, edit)
        });
        let again = mistakes::compared(&corrected, &drawn.other, &OTHER_POINTS).unwrap();
        let again = again.iter().find(|c| c.quantity == comparison.quantity);
        if again.unwrap().cause != expected {
            println!("false: {}", comparison.sentence);
            return Outcome::False;
        }
    }
    outcome
}

/// How many of so many edits are named; none may be named falsely.
fn named(edits: u64, seed: u64, draw: impl Fn(&mut Random) -> Option<Drawn>) -> u64 {
    let mut random = Random::new(setting("MANUFACTURE_SEED", 1) * seed);
    let drawn = std::iter::repeat_with(|| draw(&mut random)).flatten();
    let mut named = 0;
    for drawn in drawn.take(edits as usize) {
        let outcome = outcome(&drawn);
        named += u64::from(outcome == Outcome::Named);
        let pairs = drawn.text.lines().zip(drawn.other.lines());
        for (old, new) in pairs.filter(|(old, new)| old != new) {
            println!("{outcome:?}: {old} -> {new}");
        }
        let sentences = drawn.comparisons.iter().map(|c| c.sentence.as_str());
        let sentences: Vec<&str> = sentences.collect();
        assert_ne!(outcome, Outcome::False, "{}", sentences.join("\n"));
        if outcome == Outcome::Unnamed {
            println!("    {}", sentences.join("\n    "));
        }
    }
    println!("{named} of {edits} named");
    named
}

#[test]
fn of_forty_drawn_edits_at_least_34_are_named_and_none_falsely() {
    for text in problems() {
        read(text);
    }
    let edits = setting("MANUFACTURE_EDITS", 40);
    assert!(named(edits, 3_000_017, edited) * 40 >= 34 * edits);
}

/// What is named is what was done, or an edit that has the same values at other points.
#[test]
fn no_edit_is_named_that_was_not_made() {
    let edits = setting("MANUFACTURE_FILES", 12);
    assert!(named(edits, 2_000_003, mistaken) * 5 > 4 * edits);
}
