//! Error over seconds, for benchmarks: only measured runs on this machine, without extrapolation.
//!
//! Compares all methods of a work-precision study, and dG with a general integrator on the same elements.

use convergence_study::plots;
use convergence_study::study::{CaseFailure, Table};
use serde::Deserialize;
use thermobeam::parameters::Beam;

use crate::error::ErrorMeasure;
use crate::kinds::work_precision::law::front;
use crate::kinds::work_precision::method::Degrees;
use crate::kinds::work_precision::{Runs, WorkPrecision};
use crate::run::dg::nodal;
use crate::run::family::Family;
use crate::scene::Scene;

/// Errors whose cost is shown if a run reaches them.
const TARGETS: [f64; 9] = [1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9];
/// The same for the comparison with the integrator.
const SMALL: [f64; 7] = [1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12];
/// Number of repetitions; the fastest counts, since other load on the machine only slows a run.
const REPEATS: usize = 3;
/// The same for the comparison with the integrator.
const SHORT_REPEATS: usize = 5;

/// A run with its time.
#[derive(Debug, Clone, PartialEq)]
pub struct Timed {
    /// The method's name.
    pub method: &'static str,
    /// Elements and steps, or degrees and largest step.
    pub resolution: String,
    /// Errors in the order of [`ErrorMeasure::ALL`]; NaN if not measured.
    pub errors: [f64; 3],
    /// Seconds in the solver alone.
    pub seconds: f64,
}

impl Timed {
    fn of_tip(method: &'static str, resolution: String, error: f64, seconds: f64) -> Self {
        Self {
            method,
            resolution,
            errors: [f64::NAN, f64::NAN, error],
            seconds,
        }
    }

    fn cell(&self, places: usize) -> String {
        format!("{:.places$} ({})", 1e3 * self.seconds, self.resolution)
    }
}

/// The fastest run of a method whose error is at most `error`.
fn fastest<'r>(
    runs: &'r [Timed],
    method: &str,
    quantity: ErrorMeasure,
    error: f64,
) -> Option<&'r Timed> {
    let is_good = |run: &&Timed| run.method == method && run.errors[quantity as usize] <= error;
    runs.iter()
        .filter(is_good)
        .min_by(|a, b| a.seconds.total_cmp(&b.seconds))
}

/// All runs of a study with their seconds, one after the other on this thread; no outcome contains them.
///
/// # Errors
/// [`CaseFailure`] of the first run that does not finish.
pub fn timed(study: &WorkPrecision) -> Result<Vec<Timed>, CaseFailure> {
    let mut best: Vec<Timed> = vec![];
    for repeat in 0..REPEATS {
        let mut place = 0;
        for runs in study.runs() {
            for (k, measurement) in study.measure(runs)?.into_iter().enumerate() {
                let (method, resolution) = match runs {
                    Runs::OnMesh(method, _, n) => {
                        (method.name, format!("{n} x {}", study.steps_on(n)[k]))
                    }
                    Runs::Dg(degrees) => ("dg", degrees.to_string()),
                };
                let seconds = measurement.spent.seconds;
                if repeat == 0 {
                    best.push(Timed {
                        method,
                        resolution,
                        errors: measurement.errors,
                        seconds,
                    });
                }
                best[place].seconds = seconds.min(best[place].seconds);
                place += 1;
            }
        }
    }
    Ok(best)
}

/// The cost of each error in milliseconds: for each method that of its fastest run with at most that error.
pub fn table(id: &str, study: &WorkPrecision, quantity: ErrorMeasure, timed: &[Timed]) -> Table {
    let methods: Vec<&str> = study.methods().map(|method| method.name).collect();
    let line = |error: f64| {
        let runs = methods
            .iter()
            .map(|method| fastest(timed, method, quantity, error));
        let winner = runs
            .clone()
            .flatten()
            .min_by(|a, b| a.seconds.total_cmp(&b.seconds))?;
        let cells = runs.map(|run| run.map_or("-".to_owned(), |run| run.cell(3)));
        Some(
            [format!("{error:e}")]
                .into_iter()
                .chain(cells)
                .chain([winner.method.to_owned()])
                .collect(),
        )
    };
    let name = quantity.name();
    let title = format!(
        "{id}: milliseconds (elements x steps) for an error in {name}, the fastest run that is as good"
    );
    let head = ["error"]
        .into_iter()
        .chain(methods.iter().copied())
        .chain(["fastest"]);
    Table::new(title, head, TARGETS.into_iter().filter_map(line))
}

/// Error over seconds: for each method the runs that none of its other runs beats.
pub fn figure(study: &WorkPrecision, quantity: ErrorMeasure, timed: &[Timed]) -> String {
    let series = study.methods().map(|method| {
        let own = timed.iter().filter(|run| run.method == method.name);
        let points = front(own.map(|run| (run.seconds, run.errors[quantity as usize])));
        plots::Series::new(method.name, points)
    });
    plots::work_precision(
        "run time (s)",
        format!("error, {}", quantity.name()),
        &series.collect::<Vec<_>>(),
    )
    .draw()
}

/// Viscosity, nodes, and a degree for which dG's error in space is negligible.
const CASES: [(f64, &[f64], usize); 2] = [(0.1, &[0.0, 1.0], 32), (0.01, &[0.0, 0.8, 1.0], 32)];

/// Runs of dG whose errors fall from 1e-6 to 1e-13.
const RUNS: [(usize, usize, f64); 13] = [
    (8, 1, 0.02),
    (10, 1, 0.02),
    (10, 1, 0.01),
    (12, 2, 0.02),
    (14, 2, 0.02),
    (14, 3, 0.02),
    (16, 2, 0.02),
    (16, 3, 0.02),
    (16, 3, 0.01),
    (20, 3, 0.02),
    (20, 3, 0.01),
    (24, 4, 0.01),
    (24, 5, 0.005),
];

/// The output of `studies/programs/cvode.cpp` for the paper's first experiment.
#[derive(Debug, Deserialize)]
pub struct Rival {
    runs: Vec<RivalRun>,
}

#[derive(Debug, Deserialize)]
struct RivalRun {
    zeta: f64,
    degree: usize,
    tolerance: f64,
    u_tip: f64,
    milliseconds: f64,
}

impl Rival {
    /// Reads the output of the program.
    ///
    /// # Errors
    /// An error with the line and column of unexpected text.
    pub fn parse(text: &str) -> Result<Self, serde_json::Error> {
        serde_json::from_str(text)
    }

    /// Its runs with one viscosity; `exact` is the exact answer.
    fn timed(&self, zeta: f64, exact: f64) -> Vec<Timed> {
        let timed = |run: &RivalRun| {
            let how = format!("p = {}, {:e}", run.degree, run.tolerance);
            Timed::of_tip(
                "CVODE",
                how,
                (run.u_tip - exact).abs(),
                1e-3 * run.milliseconds,
            )
        };
        self.runs
            .iter()
            .filter(|run| run.zeta == zeta)
            .map(timed)
            .collect()
    }
}

/// A table for each viscosity, for the paper's first experiment.
///
/// # Errors
/// [`CaseFailure`] of a run that does not finish.
pub fn beside(scene: &Scene, rival: Option<&Rival>) -> Result<Vec<Table>, CaseFailure> {
    let of_case = |&(zeta, nodes, degree): &(f64, &[f64], usize)| {
        let family = Family::of_scene(&Scene {
            beam: Beam { zeta, ..scene.beam },
            t_end: 1.0,
            ..scene.clone()
        });
        let exact = seconds_and_tip(
            &family,
            nodes,
            Degrees {
                p: degree,
                q: 5,
                dt: 0.002,
            },
        )?
        .1;
        let mut runs = vec![];
        for (p, q, dt) in RUNS {
            let how = Degrees { p, q, dt };
            let (mut best, tip) = seconds_and_tip(&family, nodes, how)?;
            for _ in 1..SHORT_REPEATS {
                best = best.min(seconds_and_tip(&family, nodes, how)?.0);
            }
            runs.push(Timed::of_tip(
                "dg",
                how.to_string(),
                (tip - exact).abs(),
                best,
            ));
        }
        runs.extend(rival.iter().flat_map(|rival| rival.timed(zeta, exact)));
        Ok(against(zeta, nodes.len() - 1, &runs, rival.is_some()))
    };
    CASES.iter().map(of_case).collect()
}

/// Seconds, and u(1) at the end.
fn seconds_and_tip(
    family: &Family,
    nodes: &[f64],
    how: Degrees,
) -> Result<(f64, f64), CaseFailure> {
    let mut tip = f64::NAN;
    let spent = how.run(family, nodes, 1, &mut |space, level, _| {
        tip = nodal(space, level, &[1.0]).u[0];
    })?;
    Ok((spent.seconds, tip))
}

/// * `is_measured`: whether the runs include those of the integrator.
fn against(zeta: f64, elements: usize, runs: &[Timed], is_measured: bool) -> Table {
    let theirs = |text: String| {
        if is_measured {
            text
        } else {
            "not measured".to_owned()
        }
    };
    let cell = |run: Option<&Timed>| run.map_or("-".to_owned(), |run| run.cell(2));
    let line = |error: f64| {
        let [dg, cvode] =
            ["dg", "CVODE"].map(|method| fastest(runs, method, ErrorMeasure::Tip, error));
        let ratio = dg.zip(cvode).map_or("-".to_owned(), |(dg, cvode)| {
            format!("{:.0}", cvode.seconds / dg.seconds)
        });
        vec![format!("{error:e}"), cell(dg), theirs(cell(cvode)), ratio]
    };
    let smallest = |method: &str| {
        let errors = runs
            .iter()
            .filter(|run| run.method == method)
            .map(|run| run.errors[ErrorMeasure::Tip as usize]);
        format!("{:.1e}", errors.fold(f64::INFINITY, f64::min))
    };
    let last = vec![
        "smallest".to_owned(),
        smallest("dg"),
        theirs(smallest("CVODE")),
        "-".to_owned(),
    ];
    let title = format!(
        "The paper's first experiment to t = 1, zeta = {zeta}, elements: {elements}: milliseconds for an error of u(1, 1)"
    );
    Table::new(
        title,
        ["error", "dg", "CVODE", "ratio"],
        SMALL.into_iter().map(line).chain([last]),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_fastest_run_that_is_as_good_counts_and_what_is_not_measured_says_so() {
        let run = |method, milliseconds: f64, error: f64| {
            Timed::of_tip(method, format!("{error:e}"), error, 1e-3 * milliseconds)
        };
        let dg = [
            run("dg", 1.0, 1e-7),
            run("dg", 0.5, 2e-7),
            run("dg", 3.0, 1e-13),
        ];
        let with = |other: Timed| [&dg[..], &[other]].concat();
        let row = |runs: &[Timed], k: usize| {
            against(0.1, 1, runs, runs.len() > dg.len()).rows[k].join(" | ")
        };
        assert_eq!(
            row(&with(run("CVODE", 10.0, 3e-9)), 0),
            "1e-6 | 0.50 (2e-7) | 10.00 (3e-9) | 20"
        );
        assert_eq!(
            row(&with(run("CVODE", 10.0, 3e-9)), 3),
            "1e-9 | 3.00 (1e-13) | - | -"
        );
        assert_eq!(
            row(&with(run("CVODE", 10.0, 3e-9)), 7),
            "smallest | 1.0e-13 | 3.0e-9 | -"
        );
        assert_eq!(row(&dg, 1), "1e-7 | 1.00 (1e-7) | not measured | -");
    }
}
