//! The runs of a study of any order: what is refined, and how a file lists it.

use crate::kinds::prelude::*;
use crate::{
    kinds::tables::{CONTROL, MAP, increasing},
    scene::tables,
};
use thermobeam::dg::{MAX_DEGREE, MAX_TIME_DEGREE};

/// Steps of a run: at high degree a few hundred reach round-off.
const MOST_STEPS: usize = 100_000;

/// The tables of runs.
pub(super) const RUNS: [Key; 3] = [
    Key::new(
        "run",
        Form::Table(&[
            &[&RUN, Over::Space.keys().of_run],
            &[&RUN, Over::Time.keys().of_run],
            &[&RUN, Over::Degree.keys().of_run],
        ]),
        "what is refined, and what all series share",
    ),
    Key::new(
        "series",
        Form::List(&Form::Table(&[
            &[Over::Space.keys().of_series],
            &[Over::Time.keys().of_series],
            &[Over::Degree.keys().of_series],
        ])),
        "runs that are judged together",
    ),
    CONTROL,
];
/// What all series share.
pub(super) const RUN: [Key; 2] = [Key::new("t_end", Form::Positive, "final time"), MAP];

/// What is refined.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Over {
    /// The mesh, for each degree p.
    Space,
    /// The steps, for each degree q.
    Time,
    /// The degree p itself.
    Degree,
}

impl Over {
    /// What is refined, in words.
    pub(super) fn in_words(self) -> &'static str {
        match self {
            Over::Space => "space",
            Over::Time => "time",
            Over::Degree => "degree",
        }
    }
}

/// One run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct AnyOrderRun {
    /// Degree p of the elements.
    pub degree: usize,
    /// Elements n.
    pub elements: usize,
    /// Degree q in time.
    pub time_degree: usize,
    /// Number of steps, all of the same length.
    pub steps: usize,
}

/// Runs that are judged together.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct RunsOfDegree {
    /// The runs, coarse to fine.
    pub(super) runs: Vec<AnyOrderRun>,
    /// Tolerance of a rate; for runs over p the factor by which the error falls for each degree.
    pub(super) tolerance: f64,
}

const OVER_SPACE: Key = Key::new("over", Form::Choice(|| vec!["space"]), "what is refined");
const OVER_TIME: Key = Key::new("over", Form::Choice(|| vec!["time"]), "what is refined");
const OVER_DEGREE: Key = Key::new("over", Form::Choice(|| vec!["degree"]), "what is refined");
const LEVELS: Form = Form::List(&Form::Count(1));
const DEGREE: Key = Key::new("degree", Form::Count(1), "degree p of the elements");
const TIME_DEGREE: Key = Key::new("time_degree", Form::Count(0), "degree q in time");
const ELEMENTS: Key = Key::new("elements", Form::Count(1), "number of elements");
const STEPS: Key = Key::new("steps", Form::Count(1), "number of steps");
const MESHES: Key = Key::new("elements", LEVELS, "numbers of elements, at least three");
const STEP_COUNTS: Key = Key::new("steps", LEVELS, "numbers of steps, at least three");
const DEGREES: Key = Key::new(
    "degrees",
    LEVELS,
    "degrees p of the elements, at least three",
);
const TOLERANCE: Key = Key::new(
    "tolerance",
    Form::Positive,
    "how far a rate may be from the order",
);
const FACTOR: Key = Key::new(
    "factor",
    Form::Number,
    "by which the error falls with each degree, above 1",
);

/// Keys of the file that depend on what is refined.
pub(super) struct LevelKeys {
    /// The list of levels, in a table `[[series]]`.
    levels: &'static str,
    /// The criterion, there too.
    criterion: &'static str,
    /// The keys of that table.
    pub(super) of_series: &'static [Key],
    /// What all series share, in `[run]`.
    pub(super) of_run: &'static [Key],
}

impl Over {
    pub(super) const fn keys(self) -> LevelKeys {
        match self {
            Over::Space => LevelKeys {
                levels: "elements",
                criterion: "tolerance",
                of_series: &[MESHES, DEGREE, TOLERANCE],
                of_run: &[OVER_SPACE, TIME_DEGREE, STEPS],
            },
            Over::Time => LevelKeys {
                levels: "steps",
                criterion: "tolerance",
                of_series: &[STEP_COUNTS, TIME_DEGREE, TOLERANCE],
                of_run: &[OVER_TIME, DEGREE, ELEMENTS],
            },
            Over::Degree => LevelKeys {
                levels: "degrees",
                criterion: "factor",
                of_series: &[DEGREES, FACTOR],
                of_run: &[OVER_DEGREE, TIME_DEGREE, ELEMENTS, STEPS],
            },
        }
    }
}

/// A table `[[series]]`, and the settings that all series share.
pub(super) fn series(
    run: &Section<'_>,
    over: Over,
    section: &Section<'_>,
) -> Result<RunsOfDegree, InputError> {
    let keys = over.keys();
    section.allow(&convergence_keys::names(&[keys.of_series]))?;
    let allowed = "a list of at least three increasing whole numbers";
    let levels = increasing(section, keys.levels, allowed, 3, |item| {
        count(keys.levels, item)
    })?;
    let mut runs = vec![];
    for level in levels {
        let number = |key: &str| {
            let is_one_of = |keys: &[Key]| keys.iter().any(|known| known.name == key);
            let table = if is_one_of(keys.of_run) {
                run
            } else if is_one_of(keys.of_series) && key != keys.levels {
                section
            } else {
                return Ok(level);
            };
            count(key, &table.require(key, "a whole number")?)
        };
        runs.push(AnyOrderRun {
            degree: number("degree")?,
            time_degree: number("time_degree")?,
            elements: number("elements")?,
            steps: number("steps")?,
        });
    }
    let least = if over == Over::Degree { 1.0 } else { 0.0 };
    let allowed = format!("a finite number > {least}");
    let tolerance = section
        .require(keys.criterion, &allowed)?
        .number_where(&allowed, |value| value > least)?;
    Ok(RunsOfDegree { runs, tolerance })
}

fn count(key: &str, field: &Field<'_>) -> Result<usize, InputError> {
    match key {
        "elements" => tables::elements(field),
        "steps" => field.count(1..=MOST_STEPS),
        "time_degree" => field.count(0..=MAX_TIME_DEGREE),
        _ => field.count(1..=MAX_DEGREE),
    }
}
