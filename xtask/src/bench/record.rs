//! The runs of the benchmark as JSON, so that it can be made in pieces, and that tables and figures
//! come from what was measured.

use std::collections::BTreeMap;
use std::path::Path;

use convergence_study::{
    Table,
    internal::{cli::exit::Unusable, input, store::atomic},
};
use serde::{Deserialize, Serialize};
use thermobeam_study::error::{ErrorMeasure, Errors};
use thermobeam_study::kinds::work_precision::compared::Costed;

/// The file, in the folder of the benchmark's figures.
pub(super) const FILE: &str = "runs.json";

/// A measured run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Timed {
    /// The study that has the problem.
    pub problem: String,
    /// The method.
    pub method: String,
    /// Elements and steps, or degrees and largest step.
    pub resolution: String,
    /// Largest error in the norm of Theorem 3.4.
    pub norm: f64,
    /// Largest error of u(1, t).
    pub tip: f64,
    /// Counted work; `None` for a library, whose solves are of another kind.
    pub work: Option<f64>,
    /// CPU seconds.
    pub seconds: f64,
}

impl Timed {
    /// The error in a measure.
    pub(super) fn error(&self, measure: ErrorMeasure) -> f64 {
        let errors = Errors {
            norm: self.norm,
            tip: self.tip,
        };
        errors.of(measure)
    }
}

/// The cost of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Cost {
    /// CPU seconds.
    Seconds,
    /// Counted work.
    Work,
}

/// Everything measured so far.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(super) struct Record {
    /// CPU seconds that a run was allowed.
    pub limit: f64,
    /// For each problem, how far apart its two references are: in the norm of Theorem 3.4, and in
    /// u(1, t). Zero: exact solution.
    pub references: BTreeMap<String, [f64; 2]>,
    /// The runs.
    pub runs: Vec<Timed>,
    /// Times of steps.
    pub tables: Vec<Table>,
}

impl Record {
    /// Reads the record in a folder; an empty one if there is none.
    ///
    /// # Errors
    /// [`Unusable`] if the file is no record.
    pub(super) fn read(folder: &Path) -> Result<Self, Unusable> {
        let path = folder.join(FILE);
        if !path.exists() {
            return Ok(Self::default());
        }
        let text = input::read_text(&path)?;
        serde_json::from_str(&text)
            .map_err(|error| Unusable::because(&format!("{}: {error}", path.display())))
    }

    /// Writes the record into a folder.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub(super) fn write(&self, folder: &Path) -> std::io::Result<()> {
        let text = serde_json::to_string_pretty(self).map_err(std::io::Error::other)?;
        atomic::write(&folder.join(FILE), format!("{text}\n"))
    }

    /// Replaces the runs of a method on a problem.
    pub(super) fn replace(&mut self, problem: &str, method: &str, runs: Vec<Timed>) {
        self.runs
            .retain(|run| run.problem != problem || run.method != method);
        self.runs.extend(runs);
    }

    /// The runs on a problem within the limit.
    pub(super) fn costed(&self, problem: &str, measure: ErrorMeasure, cost: Cost) -> Vec<Costed> {
        let mut costed = vec![];
        for run in &self.runs {
            if run.problem != problem || !(run.seconds <= self.limit) {
                continue;
            }
            let cost = match cost {
                Cost::Seconds => Some(run.seconds),
                Cost::Work => run.work,
            };
            if let Some(cost) = cost {
                costed.push(Costed {
                    method: run.method.clone(),
                    resolution: run.resolution.clone(),
                    error: run.error(measure),
                    cost,
                });
            }
        }
        costed
    }
}
