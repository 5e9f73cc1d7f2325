//! The keys of a case.

use convergence_study::NamedNumber;

use super::{
    CHOSEN, IndependentAnswer, Most, Whole,
    shown::{NUMBERS, PAIRS, listed},
};
use crate::kinds::prelude::*;
use crate::{
    kinds::runs::cases::{ClaimedScene, End, NAMED},
    scene::{self, Scene},
};

/// The keys of a case.
pub(super) const CASE: &[Keys] = &[
    &[&NAMED, &[ANSWERS, ANSWER, MOST.or("none")], &scene::KEYS],
    &[&NAMED, &[ANSWERS, MOST], &scene::KEYS],
    &[&NAMED, &[FAILS], &scene::KEYS],
];
// Not a plain choice, by which a table's keys are chosen: the reader says why a case that ends with
// an error has no answer.
const ANSWERS: Key = Key::new(
    "ends",
    Form::OneOf(&[Form::Choice(|| vec![End::Answer.name()])]),
    "how its run must end",
);
const FAILS: Key = Key::new(
    "ends",
    Form::Choice(|| End::FAILURES.map(End::name).to_vec()),
    "how its run must end",
);
const ANSWER: Key = Key::new(
    "answer",
    Form::Table(&[&[
        &[Key::new(
            "within",
            Form::Positive,
            "distance allowed to each number",
        )],
        &all(NUMBERS, Form::Number, "what the run must give for it"),
        &all(
            [CHOSEN],
            Form::Number,
            "u(1) at the end of the run for an error of `within`",
        ),
        &all(
            PAIRS,
            Form::List(&Form::List(&Form::Number)),
            "pairs that the run must give",
        ),
    ]]),
    "numbers of the answer",
);
const MOST: Key = Key::new(
    "most",
    Form::Table(&[&[&[ITERATIONS, UNSOLVED.or("none")]], &[&[UNSOLVED]]]),
    "upper bounds on what a run takes",
);
const ITERATIONS: Key = Key::new(
    "iterations_per_step",
    Form::Positive,
    "on the mean number of iterations",
);
const UNSOLVED: Key = Key::new(
    "unsolved",
    Form::Positive,
    "on the distance of a step to the same step solved to round-off, in units of the tolerance",
);

/// Keys of these names, none of which must be there.
const fn all<const N: usize>(
    names: [&'static str; N],
    form: Form,
    meaning: &'static str,
) -> [Key; N] {
    let mut keys = [Key::new("", form, meaning).or("not compared"); N];
    let mut place = 0;
    while place < N {
        keys[place].name = names[place];
        place += 1;
    }
    keys
}

impl Whole {
    pub(super) fn read(section: &Section<'_>, name: String) -> Result<Self, InputError> {
        let case = ClaimedScene::read(section, name)?;
        let answers = case.end == End::Answer;
        let none = "none, where a case ends with an error";
        let answer = section.section("answer")?;
        let most = section.section("most")?;
        if answer.is_some() && !answers {
            return Err(section.refuse("answer", "an answer", none));
        }
        if most.is_some() && !answers {
            return Err(section.refuse("most", "bounds", none));
        }
        if answers && answer.is_none() && most.is_none() {
            return Err(section.missing(
                "answer",
                "a table with numbers, where a case ends with its answer",
            ));
        }
        Ok(Self {
            answer: answer.map_or(Ok(IndependentAnswer::default()), |section| {
                IndependentAnswer::read(&section)
            })?,
            most: most.map_or(Ok(Most::default()), |section| {
                Most::read(&section, &case.scene)
            })?,
            case,
        })
    }
}

impl Most {
    fn read(section: &Section<'_>, scene: &Scene) -> Result<Self, InputError> {
        let [iterations, unsolved] = ["iterations_per_step", "unsolved"];
        let bound = |key: &str| section.get(key).map(|field| field.positive()).transpose();
        let most = Self {
            iterations: bound(iterations)?,
            unsolved: bound(unsolved)?,
        };
        if most == Self::default() {
            return Err(section.missing(iterations, "at least one bound"));
        }
        if most.unsolved.is_some() {
            scene
                .one_step()
                .map_err(|error| section.refuse(unsolved, "a bound for dg", error.to_string()))?;
        }
        Ok(most)
    }
}

impl IndependentAnswer {
    fn read(section: &Section<'_>) -> Result<Self, InputError> {
        let within = section.positive("within")?;
        let mut numbers = vec![];
        for name in NUMBERS.into_iter().chain([CHOSEN]) {
            if let Some(field) = section.get(name) {
                numbers.push(NamedNumber::new(name, field.number()?));
            }
        }
        for key in PAIRS {
            if let Some(field) = section.get(key) {
                numbers.extend(listed(key, pairs(&field)?));
            }
        }
        if numbers.is_empty() {
            return Err(section.missing(NUMBERS[0], "at least one number of the answer"));
        }
        Ok(Self { numbers, within })
    }
}

fn pairs(field: &Field<'_>) -> Result<Vec<[f64; 2]>, InputError> {
    let allowed = "a list of pairs of numbers";
    let pair = |item: &Field<'_>| match item.items(allowed)?.as_slice() {
        [one, other] => Ok([one.number()?, other.number()?]),
        _ => Err(item.refuse_as_written("two numbers")),
    };
    field.items(allowed)?.iter().map(pair).collect()
}
