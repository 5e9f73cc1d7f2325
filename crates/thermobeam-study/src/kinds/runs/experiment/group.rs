//! The runs of an experiment, the experiments of a group, and all groups together.

use super::{
    AtRest, Experiment, ExperimentResult, Experiments, MeasuredRun, PaperRun, SectionGroup, Task,
    Trace,
};
use crate::kinds::prelude::*;
use crate::kinds::runs::Results;
use thermobeam::parameters::Beam;

/// An experiment and its runs.
#[derive(Debug, Clone, Copy)]
pub(super) struct OfExperiment<'r> {
    pub(super) experiment: &'r Experiment,
    /// By the first discretisation.
    pub(super) first: &'r MeasuredRun,
    /// By the second, which shows the error of the first.
    pub(super) second: &'r MeasuredRun,
    /// By the paper's algorithm, if the study runs that.
    pub(super) paper: Option<&'r PaperRun>,
}

impl<'r> OfExperiment<'r> {
    fn of(study: &'r Experiments, results: &Results<'r, Experiments>, experiment: usize) -> Self {
        let paper = results.optional(&Task::FixedPoint(experiment));
        Self {
            experiment: &study.experiments[experiment],
            first: run_by_dg(results, experiment, 0),
            second: run_by_dg(results, experiment, 1),
            paper: paper.map(ExperimentResult::paper_run),
        }
    }

    /// The motion by which statements are judged: that of the paper's algorithm, if the study runs
    /// that.
    pub(super) fn trace(&self) -> &'r Trace {
        self.paper.map_or(&self.first.trace, |paper| &paper.trace)
    }

    pub(super) fn name(&self) -> &'r str {
        &self.experiment.scene.name
    }

    pub(super) fn beam(&self) -> &'r Beam {
        &self.experiment.scene.beam
    }
}

/// The run of an experiment with a discretisation of dG.
fn run_by_dg<'r>(
    results: &Results<'r, Experiments>,
    experiment: usize,
    discretisation: usize,
) -> &'r MeasuredRun {
    let task = Task::AnyOrder {
        experiment,
        discretisation,
    };
    results.of(&task).run()
}

/// The experiments of a group.
pub(super) struct OfGroup<'r> {
    pub(super) runs: Vec<OfExperiment<'r>>,
}

impl<'r> OfGroup<'r> {
    /// The experiments that belong to the group.
    fn of(
        study: &'r Experiments,
        results: &Results<'r, Experiments>,
        belongs: impl Fn(SectionGroup) -> bool,
    ) -> Self {
        let mut runs = vec![];
        for (place, experiment) in study.experiments.iter().enumerate() {
            if belongs(experiment.group) {
                runs.push(OfExperiment::of(study, results, place));
            }
        }
        Self { runs }
    }

    pub(super) fn all(&self, holds: impl Fn(&OfExperiment<'r>) -> bool) -> bool {
        !self.runs.is_empty() && self.runs.iter().all(holds)
    }

    /// A number of each experiment.
    pub(super) fn numbers(&self, number: impl Fn(&OfExperiment<'r>) -> f64) -> Vec<f64> {
        self.runs.iter().map(number).collect()
    }

    /// The largest of these; NaN without an experiment.
    pub(super) fn largest(&self, number: impl Fn(&OfExperiment<'r>) -> f64) -> f64 {
        largest_of(self.numbers(number)).unwrap_or(f64::NAN)
    }

    /// Words about each experiment, by its β.
    pub(super) fn list(&self, text: impl Fn(&OfExperiment<'r>) -> String) -> String {
        self.joined("; ", |runs| {
            format!("β = {}: {}", runs.beam().beta, text(runs))
        })
    }

    pub(super) fn joined(
        &self,
        separator: &str,
        text: impl Fn(&OfExperiment<'r>) -> String,
    ) -> String {
        self.runs
            .iter()
            .map(text)
            .collect::<Vec<_>>()
            .join(separator)
    }
}

/// All runs of the study.
pub(super) struct SectionFive<'r> {
    pub(super) all: OfGroup<'r>,
    pub(super) first: OfGroup<'r>,
    pub(super) second: OfGroup<'r>,
    pub(super) third: OfGroup<'r>,
    /// The runs to rest, each with its β.
    pub(super) rests: Vec<(f64, &'r AtRest)>,
}

impl<'r> SectionFive<'r> {
    pub(super) fn of(study: &'r Experiments, results: &Results<'r, Experiments>) -> Self {
        let mut rests = vec![];
        for (place, &beta) in study.rest.betas.iter().enumerate() {
            rests.push((beta, results.of(&Task::Rest(place)).rest()));
        }
        Self {
            all: OfGroup::of(study, results, |_| true),
            first: OfGroup::of(study, results, |group| group == SectionGroup::First),
            second: OfGroup::of(study, results, |group| {
                matches!(group, SectionGroup::Second(_))
            }),
            third: OfGroup::of(study, results, |group| group == SectionGroup::Third),
            rests,
        }
    }
}
