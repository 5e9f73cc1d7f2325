//! The runs of an experiment, and the experiments of a group.

use super::{Experiment, Experiments, Found, Measured, PaperRun, SectionGroup, Task, Trace};
use crate::kinds::prelude::*;

/// An experiment and its runs.
#[derive(Debug, Clone, Copy)]
pub(super) struct Runs<'r> {
    pub(super) experiment: &'r Experiment,
    /// By the first discretisation.
    pub(super) first: &'r Measured,
    /// By the second, which shows the error of the first.
    pub(super) second: &'r Measured,
    /// By the paper's algorithm, if the study runs that.
    pub(super) paper: Option<&'r PaperRun>,
}

impl<'r> Runs<'r> {
    /// `None` if a run is missing.
    pub(super) fn of(
        study: &'r Experiments,
        ran: &'r [Ran<Task, Found>],
        experiment: usize,
    ) -> Option<Self> {
        let any_order = |discretisation: usize| {
            let task = Task::AnyOrder {
                experiment,
                discretisation,
            };
            match found(ran, &task) {
                Some(Found::Run(run)) => Some(&**run),
                _ => None,
            }
        };
        let paper = match found(ran, &Task::FixedPoint(experiment)) {
            Some(Found::FixedPoint(run)) => Some(&**run),
            _ => None,
        };
        let is_complete = paper.is_some() || study.fixed_point.is_none();
        is_complete.then_some(Self {
            experiment: &study.experiments[experiment],
            first: any_order(0)?,
            second: any_order(1)?,
            paper,
        })
    }

    /// The motion by which statements are judged: that of the paper's algorithm, if the study runs
    /// that.
    pub(super) fn trace(&self) -> &'r Trace {
        self.paper.map_or(&self.first.trace, |paper| &paper.trace)
    }
}

/// The experiments of a group that completed.
pub(super) struct OfGroup<'r> {
    pub(super) runs: Vec<Runs<'r>>,
    /// Whether all of them completed: otherwise no claim holds.
    pub(super) complete: bool,
}

impl<'r> OfGroup<'r> {
    /// The experiments that belong to the group.
    pub(super) fn of(
        study: &'r Experiments,
        ran: &'r [Ran<Task, Found>],
        belongs: impl Fn(SectionGroup) -> bool,
    ) -> Self {
        let places: Vec<usize> = (0..study.experiments.len())
            .filter(|&place| belongs(study.experiments[place].group))
            .collect();
        let runs: Vec<_> = places
            .iter()
            .filter_map(|&place| Runs::of(study, ran, place))
            .collect();
        Self {
            complete: runs.len() == places.len() && !runs.is_empty(),
            runs,
        }
    }

    pub(super) fn all(&self, holds: impl Fn(&Runs<'r>) -> bool) -> bool {
        self.complete && self.runs.iter().all(holds)
    }

    pub(super) fn list(&self, text: impl Fn(&Runs<'r>) -> String) -> String {
        let one =
            |runs: &Runs<'r>| format!("β = {}: {}", runs.experiment.scene.beam.beta, text(runs));
        self.runs.iter().map(one).collect::<Vec<_>>().join("; ")
    }
}
