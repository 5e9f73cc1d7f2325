//! Edits of one sign, operator or number, drawn by a seed in ten problems: what is named, and that
//! nothing is named falsely.
//!
//! `MANUFACTURE_EDITS=400` draws more, `MANUFACTURE_SEED=7` others.

use manufacture::{Comparison, Manufacture};

use crate::files::{HEAT, PFHUB, read};
use crate::mistakes::{self, SWIRL};
use crate::random::{OTHER_POINTS, POINTS, Random, setting};

/// An elastic solid at large strains.
const SOLID: &str = include_str!("files/solid.toml");

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
    start: usize,
    end: usize,
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
                places.push(Place {
                    kind,
                    start: at,
                    end,
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

/// A text with one edit; `None` if it is no file, or has the same values.
struct Drawn {
    text: &'static str,
    other: String,
    kind: Kind,
    comparisons: Vec<Comparison>,
}

fn drawn(random: &mut Random) -> Option<Drawn> {
    let problems = problems();
    let text = problems[random.below(problems.len())];
    let places = places(text);
    let kind = [Kind::Sign, Kind::Operator, Kind::Number][random.below(3)];
    let places: Vec<&Place> = places.iter().filter(|place| place.kind == kind).collect();
    let place = *places.get(random.below(places.len().max(1)))?;
    let new = &place.others[random.below(place.others.len())];
    let other = format!("{}{new}{}", &text[..place.start], &text[place.end..]);
    Manufacture::parse(&other, "other.toml").ok()?;
    let comparisons = mistakes::compared(text, &other, &POINTS)?;
    let is_seen = comparisons.iter().any(|c| c.cause != "equal");
    is_seen.then_some(Drawn {
        text,
        other,
        kind,
        comparisons,
    })
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
        let edits = comparison.edits.iter().filter(|_| is_text);
        let corrected = edits.fold(drawn.text.to_owned(), |text, edit| {
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

#[test]
fn of_forty_drawn_edits_at_least_34_are_named_and_none_falsely() {
    for text in problems() {
        read(text);
    }
    let edits = setting("MANUFACTURE_EDITS", 40) as usize;
    let seed = setting("MANUFACTURE_SEED", 1);
    let mut random = Random::new(seed * 3_000_017);
    let [mut drawn_edits, mut named, mut false_names] = [0; 3];
    while drawn_edits < edits {
        let Some(drawn) = drawn(&mut random) else {
            continue;
        };
        drawn_edits += 1;
        let outcome = outcome(&drawn);
        named += usize::from(outcome == Outcome::Named);
        false_names += usize::from(outcome == Outcome::False);
        let pairs = drawn.text.lines().zip(drawn.other.lines());
        for (old, new) in pairs.filter(|(old, new)| old != new) {
            println!("{outcome:?} {:?}: {old} -> {new}", drawn.kind);
        }
        if outcome != Outcome::Named {
            for comparison in &drawn.comparisons {
                println!("    {}", comparison.sentence);
            }
        }
    }
    println!("{named} of {edits} named");
    assert_eq!(false_names, 0);
    assert!(named * 40 >= 34 * edits, "{named} of {edits}");
}
