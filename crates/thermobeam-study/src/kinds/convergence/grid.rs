//! The verdict over a grid of (h, dt): squares of space and time error add, and both orders are fitted at once.

use super::figures;
use crate::kinds::convergence::file::ConvergenceSpec;
use crate::kinds::tables::Expectation;
use convergence_study::judge::fit::{Quantiles, SurfaceFit, SurfacePoint, fit_surface};
use convergence_study::judge::verdict::Verdict;
use convergence_study::study::outcome::{Check, LevelErrors, Outcome, Quantity, Table};

/// Confidence of intervals and of the joint region.
const CONFIDENCE: f64 = 0.95;
/// Root mean square misfit in log e up to which the model is taken for a description of the data.
const MISFIT: f64 = 0.1;

pub(super) fn conclude(spec: &ConvergenceSpec, levels: &[LevelErrors]) -> Outcome {
    let mut checks = vec![];
    let mut rows = vec![];
    let mut quantities = vec![];
    for expectation in &spec.expect {
        let norm = expectation.norm.name();
        let points: Vec<SurfacePoint> = levels
            .iter()
            .map(|level| SurfacePoint {
                h: 1.0 / super::elements_of(level) as f64,
                dt: spec.refine.dt(super::steps_of(level)),
                error: level.error(norm),
            })
            .collect();
        let fit = Quantiles::new(CONFIDENCE).ok_or("no quantiles".to_owned());
        match fit.and_then(|quantiles| fit_surface(&points, &quantiles).map_err(|error| error.to_string())) {
            Ok(fit) => {
                checks.extend(judge(expectation, &fit));
                rows.push(row(norm, &fit));
                for (name, value) in [("p", fit.p), ("q", fit.q)] {
                    quantities.push(Quantity { name: format!("{name} {norm}"), value, tolerance: 1e-3 });
                }
            }
            Err(reason) => checks.push(Check::that(false, format!("{norm}: the model can be fitted"), reason)),
        }
    }
    let summary = checks.iter().map(|check| check.evidence.clone()).collect::<Vec<_>>().join("; ");
    let mut outcome = Outcome { headline: headline(&rows), ..Outcome::new(summary, vec![], checks) };
    outcome.tables.push(Table {
        title: "Fit of e² = (C_h h^p)² + (C_t dt^q)²".to_owned(),
        head: [
            "norm",
            "p",
            "95 % interval",
            "q",
            "95 % interval",
            "rms misfit",
            "misfit of the plain sum",
            "joint region",
        ]
        .map(str::to_owned)
        .to_vec(),
        rows,
    });
    outcome.quantities = quantities;
    outcome.figures = spec.expect.iter().map(|e| figures::surface(spec, levels, e.norm.name())).collect();
    outcome
}

/// The observed orders of each norm.
fn headline(rows: &[Vec<String>]) -> String {
    let one = |row: &Vec<String>| match &row[..] {
        [norm, p, _, q, ..] => format!("{norm}: order {p} in h, {q} in dt"),
        _ => String::new(),
    };
    rows.iter().map(one).collect::<Vec<_>>().join("; ")
}

/// Both orders by equivalence: the interval inside the band passes, outside fails, else nothing is known.
fn judge(expectation: &Expectation, fit: &SurfaceFit) -> Vec<Check> {
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
