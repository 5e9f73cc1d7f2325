//! The verdict over a grid of (h, dt): squares of space and time error add, and both orders are fitted at once.

use convergence_study::judge::fit::{Quantiles, SurfaceFit, SurfacePoint, fit_surface};
use convergence_study::judge::verdict::Verdict;
use convergence_study::plots;
use convergence_study::study::levels::{self, Levels};
use convergence_study::study::{Check, Figure, Outcome, Quantity, Table};

use super::Convergence;
use super::judge::Run;
use crate::kinds::tables::{Expectation, Norm, not_finite};

/// Confidence of intervals and of the joint region.
const CONFIDENCE: f64 = 0.95;
/// Root mean square misfit in log e up to which the model is taken for a description of the data.
const MISFIT: f64 = 0.1;
/// Relative change of a fitted order that the baseline tolerates: the fit ends where its steps are that small.
const FIT_TOLERANCE: f64 = 1e-3;

pub(super) fn judge(study: &Convergence, ran: &[Run], levels: &Levels) -> Outcome {
    let mut checks = vec![];
    let mut rows = vec![];
    let mut quantities = vec![];
    for expectation in &study.expect {
        let norm = expectation.norm;
        match fit(study, ran, norm) {
            Ok(fit) => {
                checks.extend(judge_fit(expectation, &fit));
                rows.push(row(norm.name(), &fit));
                for (letter, value) in [("p", fit.p), ("q", fit.q)] {
                    let name = format!("{letter} {}", norm.name());
                    quantities.push(Quantity { name, value, tolerance: FIT_TOLERANCE });
                }
            }
            Err(reason) => checks.push(Check::that(false, format!("{}: the model can be fitted", norm.name()), reason)),
        }
    }
    let summary = checks.iter().map(|check| check.evidence.clone()).collect::<Vec<_>>().join("; ");
    checks.push(levels::completion(ran, not_finite));
    quantities.extend(levels.quantities(&[]));
    Outcome {
        headline: headline(&rows),
        tables: vec![table(rows)],
        figures: study.expect.iter().map(|expectation| surface(study, ran, expectation.norm)).collect(),
        quantities,
        ..Outcome::new(summary, vec![], checks)
    }
}

fn error(run: &Run, norm: Norm) -> f64 {
    run.ok().map_or(f64::NAN, |errors| errors[norm])
}

fn fit(study: &Convergence, ran: &[Run], norm: Norm) -> Result<SurfaceFit, String> {
    let point = |run: &Run| {
        let (elements, steps) = run.case.data;
        SurfacePoint { h: 1.0 / elements as f64, dt: study.refine.dt(steps), error: error(run, norm) }
    };
    let points: Vec<SurfacePoint> = ran.iter().map(point).collect();
    let quantiles = Quantiles::new(CONFIDENCE).ok_or("no quantiles")?;
    fit_surface(&points, &quantiles).map_err(|error| error.to_string())
}

fn table(rows: Vec<Vec<String>>) -> Table {
    let head =
        ["norm", "p", "95 % interval", "q", "95 % interval", "rms misfit", "misfit of the plain sum", "joint region"];
    Table { title: "Fit of e² = (C_h h^p)² + (C_t dt^q)²".to_owned(), head: head.map(str::to_owned).to_vec(), rows }
}

/// The error over the grid of (h, dt).
fn surface(study: &Convergence, ran: &[Run], norm: Norm) -> Figure {
    let refine = &study.refine;
    // The cases run over the steps first, elements being the outer loop.
    let at = |k: usize, j: usize| ran.get(j * refine.steps.len() + k).map_or(f64::NAN, |run| error(run, norm));
    let svg = plots::surface(&plots::Surface {
        x: plots::Axis::log("mesh width h"),
        y: plots::Axis::log("time step dt"),
        z: plots::Axis::log(format!("error, {}", norm.name())),
        x_values: refine.elements.iter().map(|&elements| 1.0 / elements as f64).collect(),
        y_values: refine.steps.iter().map(|&steps| refine.dt(steps)).collect(),
        values: (0..refine.steps.len()).map(|k| (0..refine.elements.len()).map(|j| at(k, j)).collect()).collect(),
        ..plots::Surface::default()
    });
    Figure {
        file: format!("{}-surface-{}.svg", study.header.id, norm.name()),
        caption: format!("Error in the norm `{}` over mesh width and time step.", norm.name()),
        svg,
    }
}

/// The observed orders of each norm.
fn headline(rows: &[Vec<String>]) -> String {
    let one = |row: &Vec<String>| match &row[..] {
        [norm, p, _, q, ..] => format!("{norm}: order {p} in h, {q} in dt"),
        _ => String::new(),
    };
    rows.iter().map(one).collect::<Vec<_>>().join("; ")
}

/// Both orders by equivalence: passes where the interval lies inside the band, fails where it lies outside, else inconclusive.
fn judge_fit(expectation: &Expectation, fit: &SurfaceFit) -> Vec<Check> {
    let Expectation { norm, order, tolerance } = *expectation;
    let norm = norm.name();
    let one = |letter: &str, rate: f64, interval: [f64; 2]| {
        let [low, high] = interval;
        let verdict = if !(low.is_finite() && high.is_finite() && rate.is_finite()) {
            Verdict::Fail
        } else if low >= order - tolerance && high <= order + tolerance {
            Verdict::Pass
        } else if high < order - tolerance || low > order + tolerance {
            Verdict::Fail
        } else {
            Verdict::Inconclusive
        };
        Check {
            claim: format!("{norm}: {letter} = {order} ± {tolerance}"),
            verdict,
            evidence: format!("{norm} {letter} = {rate:.4} in [{low:.4}, {high:.4}]"),
        }
    };
    vec![
        one("p", fit.p, fit.p_interval),
        one("q", fit.q, fit.q_interval),
        Check::that(
            fit.rms <= MISFIT && fit.rms < fit.rms_additive,
            format!("{norm}: the squares of space and time error add"),
            format!("rms misfit {:.4}, of the plain sum {:.4}", fit.rms, fit.rms_additive),
        ),
    ]
}

fn row(norm: &str, fit: &SurfaceFit) -> Vec<String> {
    let interval = |[low, high]: [f64; 2]| format!("[{low:.4}, {high:.4}]");
    let [major, minor] = fit.region.semi_axes;
    vec![
        norm.to_owned(),
        format!("{:.4}", fit.p),
        interval(fit.p_interval),
        format!("{:.4}", fit.q),
        interval(fit.q_interval),
        format!("{:.4}", fit.rms),
        format!("{:.4}", fit.rms_additive),
        format!("semi-axes {major:.4}, {minor:.4} at {:.1}°", fit.region.angle.to_degrees()),
    ]
}
