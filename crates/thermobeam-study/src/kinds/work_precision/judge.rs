//! From the runs of all methods to checks, tables and figures.

use super::{
    Target, WorkPrecision,
    compared::{Costed, cheapest, figure},
    method::{Measurement, Trial},
};
use crate::error::ErrorMeasure;
use crate::kinds::prelude::*;
use convergence_judge::text::number::min_or_nan;

/// Allowed relative change of a ratio of work.
const RATIO_TOLERANCE: f64 = 0.05;
/// Allowed relative change of an error.
const ERROR_TOLERANCE: f64 = 1e-2;

/// The work of two methods for the same error.
struct Ratio<'t> {
    target: &'t Target,
    dear: ComparedMethod,
    cheap: ComparedMethod,
    /// At least this ratio is claimed.
    times: f64,
}

/// One of two methods.
struct ComparedMethod {
    name: &'static str,
    /// Work and discretisation of the cheapest run; `None` if no run reaches the error.
    run: Option<Costed>,
}

impl ComparedMethod {
    /// The cheapest run of a method that reaches the error of the target.
    fn new(name: &'static str, target: &Target, runs: &[Costed]) -> Self {
        Self {
            name,
            run: cheapest(runs, name, target.error).cloned(),
        }
    }

    /// NaN if the method does not reach the error.
    fn cost(&self) -> f64 {
        self.run.as_ref().map_or(f64::NAN, |run| run.cost)
    }

    fn words(&self) -> String {
        match &self.run {
            Some(run) => format!("{:.2e} ({})", run.cost, run.resolution),
            None => "not reached".to_owned(),
        }
    }
}

impl Target {
    /// The name of a number about it.
    fn about(&self, name: &str) -> String {
        format!("{name}, {} {:e}", self.measure.name(), self.error)
    }
}

impl Ratio<'_> {
    /// NaN if one of the methods does not reach the error.
    fn value(&self) -> f64 {
        self.dear.cost() / self.cheap.cost()
    }

    fn name(&self) -> String {
        let [dear, cheap] = [self.dear.name, self.cheap.name];
        format!("{}, {dear} over {cheap}", self.target.about("times dearer"))
    }

    /// The work of the dearer method against that of the other, at the error of the target.
    fn measured(&self) -> Measured {
        let ratio = self.value();
        let words = format!(
            "{ratio:.2}: {} against {} node-solves",
            self.dear.words(),
            self.cheap.words()
        );
        measured(self.dear.name, self.name(), ratio)
            .against(self.cheap.name)
            .words(words)
            .must_be(Must::AtLeast(self.times))
            .recorded_as(self.name(), RATIO_TOLERANCE)
    }
}

pub(super) fn judge(study: &WorkPrecision, made: &[Ran<Trial, Measurement>]) -> Outcome {
    let (ran, near): (Vec<_>, Vec<_>) = made
        .iter()
        .cloned()
        .partition(|ran| study.is_listed(&ran.case.data));
    let ran = &ran;
    let ratios: Vec<Ratio<'_>> = study
        .targets
        .iter()
        .flat_map(|target| ratios(target, &costed(ran, target.measure)))
        .collect();
    let summary = study
        .targets
        .iter()
        .map(|target| sentence(target, &costed(ran, target.measure)))
        .collect::<Vec<_>>();
    let measures: Vec<ErrorMeasure> = ErrorMeasure::ALL
        .into_iter()
        .filter(|measure| {
            study
                .targets
                .iter()
                .any(|target| target.measure == *measure)
        })
        .collect();
    let mut numbers: Vec<Measured> = ratios.iter().map(Ratio::measured).collect();
    for target in &study.targets {
        numbers.extend(all_compared(study, target, ran));
        numbers.extend(none_is_cheaper(study, target, ran, &near));
    }
    numbers.extend(smallest_errors(study, &measures, ran));
    let tables = measures.iter();
    let tables = tables.map(|&measure| fastest(study, measure, ran));
    let figures = measures.iter();
    let figures = figures.map(|&measure| drawn(study, measure, ran));
    let completion = Check::completion(made, not_finite);
    Outcome {
        headline: summary.last().cloned().unwrap_or_default().into(),
        tables: tables.collect(),
        figures: figures.collect(),
        ..Outcome::new(summary.join("; "), vec![], vec![completion])
    }
    .with_sheets([all_runs(ran), Sheet::untabled(numbers)])
}

/// All runs that finished, with their counted work.
fn costed(ran: &[Ran<Trial, Measurement>], measure: ErrorMeasure) -> Vec<Costed> {
    let mut runs = vec![];
    for ran in ran {
        let trial = &ran.case.data;
        if let Some(measurement) = ran.ok() {
            runs.push(Costed {
                method: trial.method.name.to_owned(),
                resolution: trial.resolution.to_string(),
                error: measurement.errors.of(measure),
                cost: measurement.spent.node_solves,
            });
        }
    }
    runs
}

fn ratios<'t>(target: &'t Target, runs: &[Costed]) -> Vec<Ratio<'t>> {
    let mut ratios = vec![];
    for (methods, &times) in target.methods.windows(2).zip(&target.times) {
        ratios.push(Ratio {
            target,
            dear: ComparedMethod::new(methods[0].name, target, runs),
            cheap: ComparedMethod::new(methods[1].name, target, runs),
            times,
        });
    }
    ratios
}

/// No method that reaches a target may be left out of its claims.
fn all_compared(
    study: &WorkPrecision,
    target: &Target,
    ran: &[Ran<Trial, Measurement>],
) -> [Measured; 2] {
    let runs = costed(ran, target.measure);
    let mut left_out = vec![];
    let mut compared = 0;
    for method in study.methods() {
        if cheapest(&runs, method.name, target.error).is_none() {
            continue;
        }
        if target.methods.contains(&method) {
            compared += 1;
        } else {
            left_out.push(method.name);
        }
    }
    [
        none_listed(
            &target.about("methods that reach it and are not compared"),
            &left_out,
        ),
        measured("", target.about("methods compared"), f64::from(compared))
            .fixed(0)
            .must_be(Must::AtLeast(2.0)),
    ]
}

/// No neighbour of a listed run may reach the target for less than the cheapest that is listed.
fn none_is_cheaper(
    study: &WorkPrecision,
    target: &Target,
    listed: &[Ran<Trial, Measurement>],
    near: &[Ran<Trial, Measurement>],
) -> [Measured; 2] {
    let [listed, near] = [listed, near].map(|runs| costed(runs, target.measure));
    let finished = near.iter().filter(|run| run.cost.is_finite()).count();
    let mut cheaper = vec![];
    for method in study.methods() {
        let [listed, near] = [&listed, &near].map(|runs| cheapest(runs, method.name, target.error));
        let Some(near) = near else {
            continue;
        };
        let best = listed.map_or(f64::INFINITY, |listed| listed.cost);
        if near.cost < best {
            cheaper.push(format!(
                "{} by {} for {:.2e} in place of {best:.2e}: add it to the runs",
                method.name, near.resolution, near.cost
            ));
        }
    }
    [
        none_listed(
            &target.about("runs next to a listed one that reach it for less"),
            &cheaper,
        ),
        some_of("", &target.about("runs next to the listed ones"), finished),
    ]
}

/// The dearest method over the cheapest.
fn sentence(target: &Target, runs: &[Costed]) -> String {
    let ends = [
        &target.methods[0],
        &target.methods[target.methods.len() - 1],
    ];
    let [dear, cheap] = ends.map(|method| cheapest(runs, method.name, target.error));
    let ratio = dear
        .zip(cheap)
        .map_or(f64::NAN, |(dear, cheap)| dear.cost / cheap.cost);
    format!(
        "{} {:e}: {} costs {ratio:.1} times the work of {}",
        target.measure.name(),
        target.error,
        ends[0].name,
        ends[1].name
    )
}

/// The numbers that are not finite; none of a neighbour that did not finish.
fn not_finite(run: &Measurement) -> Vec<String> {
    if *run == Measurement::UNFINISHED {
        return vec![];
    }
    Measured::not_finite(&numbers_of("", run))
}

/// The measured errors and the counted work of a run.
fn numbers_of(label: &str, Measurement { errors, spent, .. }: &Measurement) -> Vec<Measured> {
    let one = |name: &str, value: f64| measured(label, name, value).scientific(2);
    vec![
        one(ErrorMeasure::Theorem34.name(), errors.norm),
        one(ErrorMeasure::Tip.name(), errors.tip),
        one("element-steps", spent.node_steps),
        one("node-solves", spent.node_solves),
    ]
}

fn fastest(study: &WorkPrecision, measure: ErrorMeasure, ran: &[Ran<Trial, Measurement>]) -> Table {
    let runs = costed(ran, measure);
    let methods: Vec<&str> = study.methods().map(|method| method.name).collect();
    let mut rows = vec![];
    for target in &study.targets {
        if target.measure != measure {
            continue;
        }
        let mut row = vec![format!("{:e}", target.error)];
        for name in &methods {
            row.push(match cheapest(&runs, name, target.error) {
                Some(run) => format!("{:.2e} ({})", run.cost, run.resolution),
                None => "-".to_owned(),
            });
        }
        rows.push(row);
    }
    let title = format!(
        "Node-solves for an error in {} by the cheapest run (elements x steps, or degrees and step); a dash: no run of this study \
         reaches it",
        measure.in_words()
    );
    let head = ["error"].into_iter().chain(methods.iter().copied());
    Table::new(title, head, rows)
}

fn all_runs(ran: &[Ran<Trial, Measurement>]) -> Sheet {
    let found = ran
        .iter()
        .filter_map(|ran| Some((ran.case.label.as_str(), ran.ok()?)));
    let numbers = found.flat_map(|(label, run)| numbers_of(label, run));
    Sheet::new("Largest errors over time, and counted work", "run", numbers)
}

fn drawn(study: &WorkPrecision, measure: ErrorMeasure, ran: &[Ran<Trial, Measurement>]) -> Figure {
    let title = format!("Error in {} over work, by method", measure.in_words());
    let svg = figure(
        &title,
        "counted work (elements × linear solves)",
        "largest error (dimensionless)",
        &costed(ran, measure),
    );
    let caption = format!(
        "Error in {} over counted work, for each of {} methods the runs that no other run of it beats.",
        measure.in_words(),
        study.methods().count()
    );
    Figure::new(measure.name(), caption, svg)
}

/// The smallest error of each method.
fn smallest_errors(
    study: &WorkPrecision,
    measures: &[ErrorMeasure],
    ran: &[Ran<Trial, Measurement>],
) -> Vec<Measured> {
    let mut numbers = vec![];
    for &measure in measures {
        let runs = costed(ran, measure);
        for method in study.methods() {
            let own = runs.iter().filter(|run| run.method == method.name);
            let smallest = own.map(|run| run.error).reduce(min_or_nan);
            let name = format!("smallest error, {}", measure.name());
            let guarded = format!("{name}, {}", method.name);
            let smallest = measured(method.name, name, smallest);
            numbers.push(smallest.recorded_as(guarded, ERROR_TOLERANCE));
        }
    }
    numbers
}
