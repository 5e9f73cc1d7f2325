//! Error over seconds, for benchmarks: measured on this machine and only where runs were done, nothing extrapolated.

use super::law::front;
use super::method::Measurement;
use super::{MethodOnMesh, WorkPrecision};
use crate::error::evaluator::ErrorMeasure;
use convergence_study::plots;
use convergence_study::study::{CaseFailure, Table};

/// Errors of which the cost is shown, where a run reaches them.
const TARGETS: [f64; 8] = [1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8];
/// Runs of which the fastest counts: other load on the machine only makes a run slower.
const REPEATS: usize = 3;

/// A run with its seconds.
#[derive(Debug, Clone, PartialEq)]
pub struct Timed {
    /// The method's name.
    pub method: &'static str,
    /// Elements.
    pub elements: usize,
    /// Time steps.
    pub steps: usize,
    /// Errors and cost.
    pub measurement: Measurement,
}

impl Timed {
    fn error(&self, quantity: ErrorMeasure) -> f64 {
        let errors = ErrorMeasure::ALL.into_iter().zip(self.measurement.errors);
        errors.into_iter().find(|(other, _)| *other == quantity).map_or(f64::NAN, |(_, error)| error)
    }

    fn seconds(&self) -> f64 {
        self.measurement.spent.seconds
    }

    fn resolution(&self) -> String {
        format!("{} x {}", self.elements, self.steps)
    }
}

impl WorkPrecision {
    /// All runs with their seconds, on this thread, one after the other; no outcome holds them.
    ///
    /// # Errors
    /// [`CaseFailure`] of the first run that does not come to its end.
    pub fn timed(&self) -> Result<Vec<Timed>, CaseFailure> {
        let mut best: Vec<Timed> = vec![];
        for repeat in 0..REPEATS {
            let mut runs = vec![];
            for on in self.meshes() {
                let MethodOnMesh { method, elements } = on;
                let row = |(&steps, measurement)| Timed { method: method.name, elements, steps, measurement };
                runs.extend(self.steps.iter().zip(self.measure(on)?).map(row));
            }
            if repeat == 0 {
                best = runs;
                continue;
            }
            for (best, run) in best.iter_mut().zip(runs) {
                let seconds = &mut best.measurement.spent.seconds;
                *seconds = seconds.min(run.seconds());
            }
        }
        Ok(best)
    }

    /// What each error costs in milliseconds: for each method the fastest of the runs whose error is at most that.
    pub fn seconds(&self, quantity: ErrorMeasure, timed: &[Timed]) -> Table {
        let methods = methods(timed);
        let fastest = |method: &str, error: f64| -> Option<&Timed> {
            let good = timed.iter().filter(|run| run.method == method && run.error(quantity) <= error);
            good.min_by(|a, b| a.seconds().total_cmp(&b.seconds()))
        };
        let row = |error: f64| {
            let runs: Vec<Option<&Timed>> = methods.iter().map(|method| fastest(method, error)).collect();
            let mut cells = vec![format!("{error:e}")];
            cells.extend(runs.iter().map(|run| run.map_or("-".to_owned(), cell)));
            let winner = runs.iter().flatten().min_by(|a, b| a.seconds().total_cmp(&b.seconds()));
            cells.push(winner.map_or("-".to_owned(), |run| run.method.to_owned()));
            cells
        };
        let head = ["error".to_owned()].into_iter().chain(methods.iter().map(|&name| name.to_owned()));
        Table {
            title: format!(
                "{}: milliseconds (elements x steps) for an error in {}, the fastest run of the grid that is as good",
                self.header.id,
                quantity.name()
            ),
            head: head.chain(["fastest".to_owned()]).collect(),
            rows: TARGETS.into_iter().map(row).filter(|row| row.last().is_some_and(|name| name != "-")).collect(),
        }
    }

    /// Error over seconds: for each method the runs that no other run of it beats.
    pub fn seconds_figure(&self, quantity: ErrorMeasure, timed: &[Timed]) -> String {
        let series = methods(timed).into_iter().map(|method| {
            let own = timed.iter().filter(|run| run.method == method);
            let points = front(own.map(|run| (run.seconds(), run.error(quantity))));
            plots::Series { label: method.to_owned(), points }
        });
        plots::work_precision(&plots::WorkPrecision {
            title: None,
            x_label: None,
            y_label: format!("error, {}", quantity.name()),
            series: series.collect(),
        })
    }
}

fn cell(run: &Timed) -> String {
    format!("{:.3} ({})", 1e3 * run.seconds(), run.resolution())
}

/// The methods, in the order in which they were run.
fn methods(timed: &[Timed]) -> Vec<&'static str> {
    let mut names = vec![];
    for run in timed {
        if !names.contains(&run.method) {
            names.push(run.method);
        }
    }
    names
}
