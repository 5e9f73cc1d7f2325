//! The runs of a study of any order: what is refined, and how a file lists it.

use crate::kinds::prelude::*;
use crate::kinds::tables::increasing;

/// Steps of a run: at high degree a few hundred reach round-off.
const MOST_STEPS: usize = 100_000;

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

/// One run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Resolution {
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
    pub(super) runs: Vec<Resolution>,
    /// Tolerance of a rate; for runs over p the factor by which the error falls for each degree.
    pub(super) tolerance: f64,
}

/// Keys of the file that depend on what is refined.
pub(super) struct Keys {
    /// The list of levels, in a table `[[series]]`.
    levels: &'static str,
    /// The degree of a series, there too.
    of_series: Option<&'static str>,
    /// The criterion, there too.
    criterion: &'static str,
    /// What all series share, in `[run]`.
    pub(super) of_run: &'static [&'static str],
}

impl Over {
    pub(super) fn keys(self) -> Keys {
        match self {
            Over::Space => Keys {
                levels: "elements",
                of_series: Some("degree"),
                criterion: "tolerance",
                of_run: &["time_degree", "steps"],
            },
            Over::Time => Keys {
                levels: "steps",
                of_series: Some("time_degree"),
                criterion: "tolerance",
                of_run: &["degree", "elements"],
            },
            Over::Degree => Keys {
                levels: "degrees",
                of_series: None,
                criterion: "factor",
                of_run: &["time_degree", "elements", "steps"],
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
    let mut allowed = vec![keys.levels, keys.criterion];
    allowed.extend(keys.of_series);
    section.allow(&allowed)?;
    let allowed = "a list of at least three increasing whole numbers";
    let levels = increasing(section, keys.levels, allowed, 3, |item| {
        count(keys.levels, item)
    })?;
    let mut runs = vec![];
    for level in levels {
        let number = |key: &str| {
            let table = match keys.of_series {
                Some(own) if own == key => section,
                _ if keys.of_run.contains(&key) => run,
                _ => return Ok(level),
            };
            count(key, &table.require(key, "a whole number")?)
        };
        runs.push(Resolution {
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
