//! The tables `[[case]]` of a study: scenes, each with a claim in words and the way its run ends.

use std::collections::BTreeSet;

use crate::kinds::prelude::*;
use crate::{run::RunError, scene::Scene};
use thermobeam::error::{StepError, StepFailure};

/// A scene of a table `[[case]]`.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ClaimedScene {
    pub(crate) name: String,
    /// In words.
    pub(crate) claim: String,
    /// How its run must end.
    pub(crate) end: End,
    pub(crate) scene: Scene,
}

/// The keys of a case, beside those of a scene and [`ENDS`].
pub(crate) const NAMED: [Key; 2] = [
    Key::new("name", Form::Text, "a name that no other case has"),
    Key::new("claim", Form::Text, "the claim in words"),
];

/// The way the run of a case must end.
pub(crate) const ENDS: Key = Key::new(
    "ends",
    Form::Choice(|| End::ALL.map(|(name, _)| name).to_vec()),
    "how its run must end",
);

impl ClaimedScene {
    /// Reads `claim`, `ends` and the tables of a scene.
    pub(crate) fn read(section: &Section<'_>, name: String) -> Result<Self, InputError> {
        let end = section.require("ends", "\"answer\" or an error")?;
        Ok(Self {
            end: end.choice(&End::ALL)?,
            scene: Scene::from_tables(section, name.clone())?,
            claim: section.require("claim", "a text")?.text()?.to_owned(),
            name,
        })
    }
}

/// The tables `[[case]]`, each with a unique name.
pub(crate) fn named_cases<C>(
    root: &Section<'_>,
    read: impl Fn(&Section<'_>, String) -> Result<C, InputError>,
) -> Result<Vec<C>, InputError> {
    let mut names = BTreeSet::new();
    root.tables("case", "", |section| {
        let name = section.require("name", "a text")?.text()?.to_owned();
        let case = read(section, name.clone())?;
        if names.insert(name.clone()) {
            return Ok(case);
        }
        Err(section.refuse(
            "name",
            format!("a second \"{name}\""),
            "a name that no other case has",
        ))
    })
}

/// How a run ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum End {
    /// After its last step.
    #[default]
    Answer,
    /// At a step whose operator is not definite.
    Indefinite,
    /// At a step whose iteration diverges or needs too many iterations.
    IterationLimit,
    /// At a step with numbers that are not finite.
    NotFinite,
    /// After its last step, with a balance of the energy that is open: a study of the energy claims
    /// it.
    Unbalanced,
}

impl End {
    /// Those of a run that a step has ended.
    pub const FAILURES: [End; 3] = [End::Indefinite, End::IterationLimit, End::NotFinite];

    /// All ends, with their names in study files and reports.
    pub const ALL: [(&str, End); 5] = [
        ("answer", End::Answer),
        ("indefinite", End::Indefinite),
        ("iteration-limit", End::IterationLimit),
        ("not-finite", End::NotFinite),
        ("unbalanced", End::Unbalanced),
    ];

    /// The end of a run.
    ///
    /// # Errors
    /// The failure, if it is not a failed step of a one-step scheme.
    pub(crate) fn of(failure: Option<&RunError>) -> Result<Self, RunError> {
        let Some(run) = failure else {
            return Ok(End::Answer);
        };
        let RunError::Step(StepError { failure, .. }) = run else {
            return Err(run.clone());
        };
        match failure {
            StepFailure::Indefinite { .. } => Ok(End::Indefinite),
            StepFailure::Diverged { .. } | StepFailure::IterationLimit { .. } => {
                Ok(End::IterationLimit)
            }
            StepFailure::NonFinite { .. } => Ok(End::NotFinite),
            _ => Err(run.clone()),
        }
    }

    /// Its name in study files and reports.
    pub fn name(self) -> &'static str {
        Self::ALL[self as usize].0
    }
}
