//! dG beside a general integrator on the same elements, for benchmarks: milliseconds for an error of u(1, 1).

use convergence_study::study::{CaseFailure, Table};
use serde::Deserialize;
use thermobeam::parameters::Beam;

use super::method::Degrees;
use crate::run::dg::nodal;
use crate::run::family::Family;
use crate::scene::Scene;

/// Viscosity, nodes, and the degree at which dG's own error in space is gone.
const CASES: [(f64, &[f64], usize); 2] = [(0.1, &[0.0, 1.0], 32), (0.01, &[0.0, 0.8, 1.0], 32)];

/// Runs of dG, the errors of which fall from 1e-6 to 1e-13.
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

/// Errors of which the cost is shown.
const TARGETS: [f64; 7] = [1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12];

/// Runs of which the fastest counts: other load on the machine only makes a run slower.
const REPEATS: usize = 5;

/// What `studies/programs/cvode.cpp` prints, for the paper's first experiment.
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
    /// Reads what the program has printed.
    ///
    /// # Errors
    /// With line and column of what is not as expected.
    pub fn parse(text: &str) -> Result<Self, serde_json::Error> {
        serde_json::from_str(text)
    }
}

/// Milliseconds, error, and how it was done.
type Timed = (f64, f64, String);

/// A table for each viscosity, of the paper's first experiment.
///
/// # Errors
/// [`CaseFailure`] of a run that does not come to its end.
pub fn beside(scene: &Scene, rival: Option<&Rival>) -> Result<Vec<Table>, CaseFailure> {
    CASES
        .iter()
        .map(|&(zeta, nodes, degree)| {
            let family = Family::of_scene(&Scene { beam: Beam { zeta, ..scene.beam }, t_end: 1.0, ..scene.clone() });
            let exact = run(&family, nodes, Degrees { p: degree, q: 5, dt: 0.002 })?.1;
            let mut dg: Vec<Timed> = vec![];
            for (p, q, dt) in RUNS {
                let how = Degrees { p, q, dt };
                let (mut best, tip) = run(&family, nodes, how)?;
                for _ in 1..REPEATS {
                    best = best.min(run(&family, nodes, how)?.0);
                }
                dg.push((1e3 * best, (tip - exact).abs(), how.to_string()));
            }
            let cvode = rival.map(|rival| {
                let runs = rival.runs.iter().filter(|run| run.zeta == zeta);
                let timed = |run: &RivalRun| {
                    (run.milliseconds, (run.u_tip - exact).abs(), format!("p = {}, {:e}", run.degree, run.tolerance))
                };
                runs.map(timed).collect::<Vec<Timed>>()
            });
            Ok(table(zeta, nodes.len() - 1, &dg, cvode.as_deref()))
        })
        .collect()
}

/// Seconds, and u(1) at the end.
fn run(family: &Family, nodes: &[f64], how: Degrees) -> Result<(f64, f64), CaseFailure> {
    let mut tip = f64::NAN;
    let spent = how.run(family, nodes, 1, &mut |space, level, _| tip = nodal(space, level, &[1.0]).u[0])?;
    Ok((spent.seconds, tip))
}

fn table(zeta: f64, elements: usize, dg: &[Timed], cvode: Option<&[Timed]>) -> Table {
    let fastest = |runs: &[Timed], error: f64| -> Option<Timed> {
        let good = runs.iter().filter(|run| run.1 <= error);
        good.min_by(|a, b| a.0.total_cmp(&b.0)).cloned()
    };
    let cell = |run: &Option<Timed>| match run {
        Some((milliseconds, _, how)) => format!("{milliseconds:.2} ({how})"),
        None => "-".to_owned(),
    };
    let line = |error: f64| {
        let (ours, theirs) = (fastest(dg, error), cvode.map(|runs| fastest(runs, error)));
        let ratio = match (&ours, &theirs) {
            (Some(ours), Some(Some(theirs))) => format!("{:.0}", theirs.0 / ours.0),
            _ => "-".to_owned(),
        };
        let theirs = theirs.as_ref().map_or("not measured".to_owned(), cell);
        vec![format!("{error:e}"), cell(&ours), theirs, ratio]
    };
    let smallest = |runs: &[Timed]| format!("{:.1e}", runs.iter().map(|run| run.1).fold(f64::INFINITY, f64::min));
    let last = ["smallest".to_owned(), smallest(dg), cvode.map_or("not measured".to_owned(), smallest), "-".to_owned()];
    Table {
        title: format!(
            "The paper's first experiment to t = 1, zeta = {zeta}, elements: {elements}: milliseconds for an error of u(1, 1)"
        ),
        head: ["error", "dg", "CVODE", "ratio"].map(str::to_owned).to_vec(),
        rows: TARGETS.into_iter().map(line).chain([last.to_vec()]).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_fastest_run_that_is_as_good_counts_and_what_is_not_measured_says_so() {
        let run = |milliseconds: f64, error: f64| (milliseconds, error, format!("{error:e}"));
        let dg = [run(1.0, 1e-7), run(0.5, 2e-7), run(3.0, 1e-13)];
        let row = |cvode: Option<&[Timed]>, k: usize| table(0.1, 1, &dg, cvode).rows[k].join(" | ");
        assert_eq!(row(Some(&[run(10.0, 3e-9)]), 0), "1e-6 | 0.50 (2e-7) | 10.00 (3e-9) | 20");
        assert_eq!(row(Some(&[run(10.0, 3e-9)]), 3), "1e-9 | 3.00 (1e-13) | - | -");
        assert_eq!(row(Some(&[run(10.0, 3e-9)]), 7), "smallest | 1.0e-13 | 3.0e-9 | -");
        assert_eq!(row(None, 1), "1e-7 | 1.00 (1e-7) | not measured | -");
    }
}
