//! The runs of a study of any order: what is refined, and how a file lists it.

use std::fmt::Display;

use crate::kinds::prelude::*;
use crate::scene::{
    file::{Degree, Formula, OfS, TimeDegree},
    limits::Elements,
};
use convergence_study::file::{Ascending, Choices, Number, Range};

/// Steps of a run: at high degree a few hundred reach round-off.
type StepCount = Count<1, 100_000>;

/// The table `[run]`: what is refined, and what all series share.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct RunTable {
    /// what is refined
    pub(super) over: OneOf<Over>,
    /// final time
    pub(super) t_end: Positive,
    /// a function of s that places the nodes: 0 at 0, 1 at 1; without it s
    pub(super) map: Option<Formula<OfS>>,
    /// over time: degree p of the elements
    degree: Option<Degree>,
    /// over space and degree: degree q in time
    time_degree: Option<TimeDegree>,
    /// over time and degree: number of elements
    elements: Option<Elements>,
    /// over space and degree: number of steps
    steps: Option<StepCount>,
}

/// A table `[[series]]`: runs that are judged together.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct SeriesTable {
    /// over space: degree p of the elements
    degree: Option<Degree>,
    /// over time: degree q in time
    time_degree: Option<TimeDegree>,
    /// over space: numbers of elements
    elements: Option<Ascending<Elements, 3>>,
    /// over time: numbers of steps
    steps: Option<Ascending<StepCount, 3>>,
    /// over degree: degrees p of the elements
    degrees: Option<Ascending<Degree, 3>>,
    /// over space and time: how far a rate may be from the order
    tolerance: Option<Positive>,
    /// over degree: by which the error falls with each degree, above 1
    factor: Option<Number<AboveOne>>,
}

/// The range of the numbers > 1.
#[derive(Debug, Clone, Copy)]
pub(super) enum AboveOne {}

impl Range for AboveOne {
    const ENDS: &'static [(&'static str, f64)] = &[("exclusiveMinimum", 1.0)];
}

impl Choices for Over {
    type Value = Self;

    fn all() -> Vec<(&'static str, Self)> {
        [Over::Space, Over::Time, Over::Degree]
            .map(|over| (over.in_words(), over))
            .to_vec()
    }
}

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

/// A key, whether it is given, and over what it must be: nowhere else may it be.
type Needed = (&'static str, bool, &'static [Over]);

/// Refuses keys of a table that do not belong to what is refined.
fn only(keys: &[Needed], over: Over) -> Result<(), Refusal> {
    for (key, is_given, overs) in keys {
        let name = over.in_words();
        if *is_given && !overs.contains(&over) {
            let found = format!("{key} with over = \"{name}\"");
            let overs: Vec<String> = overs
                .iter()
                .map(|over| format!("\"{}\"", over.in_words()))
                .collect();
            let allowed = format!("{key} only with over = {}", overs.join(" or "));
            return Err(Refusal::new(*key, found, allowed));
        }
        if !is_given && overs.contains(&over) {
            return Err(Refusal::missing(
                *key,
                &format!("it where over = \"{name}\""),
            ));
        }
    }
    Ok(())
}

impl RunTable {
    /// Refuses keys that do not belong to what is refined.
    pub(super) fn check(&self) -> Result<(), Refusal> {
        let keys: [Needed; 4] = [
            ("degree", self.degree.is_some(), &[Over::Time]),
            (
                "time_degree",
                self.time_degree.is_some(),
                &[Over::Space, Over::Degree],
            ),
            (
                "elements",
                self.elements.is_some(),
                &[Over::Time, Over::Degree],
            ),
            ("steps", self.steps.is_some(), &[Over::Space, Over::Degree]),
        ];
        only(&keys, self.over.value)
    }
}

impl SeriesTable {
    /// The runs, with what all series share.
    pub(super) fn runs(&self, run: &RunTable) -> Result<RunsOfDegree, Refusal> {
        let over = run.over.value;
        let keys: [Needed; 7] = [
            ("elements", self.elements.is_some(), &[Over::Space]),
            ("steps", self.steps.is_some(), &[Over::Time]),
            ("degrees", self.degrees.is_some(), &[Over::Degree]),
            ("degree", self.degree.is_some(), &[Over::Space]),
            ("time_degree", self.time_degree.is_some(), &[Over::Time]),
            (
                "tolerance",
                self.tolerance.is_some(),
                &[Over::Space, Over::Time],
            ),
            ("factor", self.factor.is_some(), &[Over::Degree]),
        ];
        only(&keys, over)?;
        let levels = match over {
            Over::Space => counts(&self.elements),
            Over::Time => counts(&self.steps),
            Over::Degree => counts(&self.degrees),
        };
        let degree = self.degree.or(run.degree).map(Count::get);
        let time_degree = self.time_degree.or(run.time_degree).map_or(0, Count::get);
        // What is refined is in neither table.
        let runs = levels.into_iter().map(|level| AnyOrderRun {
            degree: degree.unwrap_or(level),
            time_degree,
            elements: run.elements.map_or(level, Count::get),
            steps: run.steps.map_or(level, Count::get),
        });
        let tolerance = self.tolerance.map(Positive::get);
        Ok(RunsOfDegree {
            runs: runs.collect(),
            tolerance: tolerance
                .or(self.factor.map(Number::get))
                .unwrap_or(f64::NAN),
        })
    }
}

fn counts<T: Copy + Display + Into<usize>>(levels: &Option<Ascending<T, 3>>) -> Vec<usize> {
    levels
        .iter()
        .flat_map(|levels| levels.iter())
        .map(|&level| level.into())
        .collect()
}
