//! Error over seconds, for benchmarks: measured on this machine and only where runs were done, nothing extrapolated.

use super::law::front;
use super::method::Measurement;
use super::{Runs, WorkPrecision};
use crate::error::evaluator::ErrorMeasure;
use convergence_study::plots;
use convergence_study::study::{CaseFailure, Table};

/// Errors of which the cost is shown, where a run reaches them.
const TARGETS: [f64; 9] = [1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9];
/// Runs of which the fastest counts: other load on the machine only makes a run slower.
const REPEATS: usize = 3;

/// A run with its seconds.
#[derive(Debug, Clone, PartialEq)]
pub struct Timed {
    /// The method's name.
    pub method: &'static str,
    /// Elements and steps, or degrees and largest step.
    pub resolution: String,
    /// Errors and cost.
    pub measurement: Measurement,
}

impl Timed {
    fn seconds(&self) -> f64 {
        self.measurement.spent.seconds
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
            let mut place = 0;
            for runs in self.runs() {
                for (k, measurement) in self.measure(runs)?.into_iter().enumerate() {
                    let (method, resolution) = match runs {
                        Runs::OnMesh(method, _, n) => (method.name, format!("{n} x {}", self.steps_on(n)[k])),
                        Runs::Dg(degrees) => ("dg", degrees.to_string()),
                    };
                    let run = Timed { method, resolution, measurement };
                    if repeat == 0 {
                        best.push(run);
                    } else if run.seconds() < best[place].seconds() {
                        best[place] = run;
                    }
                    place += 1;
                }
            }
        }
        Ok(best)
    }

    /// What each error costs in milliseconds: for each method the fastest of the runs whose error is at most that.
    pub fn seconds(&self, quantity: ErrorMeasure, timed: &[Timed]) -> Table {
        let fastest = |method: &str, error: f64| -> Option<&Timed> {
            let is_good = |run: &&Timed| run.method == method && run.measurement.errors[quantity as usize] <= error;
            timed.iter().filter(is_good).min_by(|a, b| a.seconds().total_cmp(&b.seconds()))
        };
        let methods: Vec<&str> = self.methods().map(|method| method.name).collect();
        let line = |error: f64| {
            let runs = methods.iter().map(|method| fastest(method, error));
            let winner = runs.clone().flatten().min_by(|a, b| a.seconds().total_cmp(&b.seconds()))?;
            let cell = |run: &Timed| format!("{:.3} ({})", 1e3 * run.seconds(), run.resolution);
            let cells = runs.map(|run| run.map_or("-".to_owned(), cell));
            Some([format!("{error:e}")].into_iter().chain(cells).chain([winner.method.to_owned()]).collect())
        };
        Table {
            title: format!(
                "{}: milliseconds (elements x steps) for an error in {}, the fastest run that is as good",
                self.header.id,
                quantity.name()
            ),
            head: ["error"].iter().chain(&methods).chain(&["fastest"]).map(|&name| name.to_owned()).collect(),
            rows: TARGETS.into_iter().filter_map(line).collect(),
        }
    }

    /// Error over seconds: for each method the runs that no other run of it beats.
    pub fn seconds_figure(&self, quantity: ErrorMeasure, timed: &[Timed]) -> String {
        let series = self.methods().map(|method| {
            let own = timed.iter().filter(|run| run.method == method.name);
            let points = front(own.map(|run| (run.seconds(), run.measurement.errors[quantity as usize])));
            plots::Series { label: method.name.to_owned(), points }
        });
        plots::work_precision(&plots::History {
            y: plots::Axis::log(format!("error, {}", quantity.name())),
            series: series.collect(),
            ..plots::History::default()
        })
    }
}
