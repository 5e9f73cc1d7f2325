//! The error over the degree on a fixed mesh, which falls exponentially, down to round-off.

use super::{AnyOrder, AnyOrderRun, JudgedErrors, Runs, SourceResult};
use crate::kinds::prelude::*;
use convergence_study::chart::{self, Chart};

/// Below this error a higher degree gains nothing: round-off of the loads and the initial data.
const ROUND_OFF: f64 = 2e-12;

impl AnyOrder {
    /// The error must fall by the factor claimed, as a geometric mean, from the first degree to the
    /// one that reaches round-off.
    pub(super) fn over_degrees(&self, runs: &Runs<Self>) -> SourceResult {
        let y = chart::Axis::log("L2 error of all fields (dimensionless)");
        let mut chart = Chart::empty(chart::Axis::linear("degree p"), y);
        let mut checks = vec![];
        let mut quantities = vec![];
        let mut rows = vec![];
        for (series, runs) in self.by_degree(runs) {
            let points = points(runs);
            checks.extend(exponential(&points, series.tolerance));
            let mesh = counted(series.runs[0].elements, "element");
            for &(p, error) in &points {
                rows.push(vec![mesh.clone(), p.to_string(), format!("{error:.2e}")]);
                // Round-off is not guarded; NaN is.
                if !(error <= ROUND_OFF) {
                    quantities.push(
                        Quantity::new(format!("error fields, p = {p}"), error, 1e-4)
                            .about(Subject::of("fields").in_case(format!("p = {p}")))
                            .as_error(),
                    );
                }
            }
            let curve = chart.curve(mesh, points);
            *curve = curve.clone().marked();
        }
        let holds = checks.iter().all(|check: &Check| check.verdict.is_pass());
        let title = "The error falls exponentially with the degree, to round-off";
        let svg = chart.titled_where(holds, title).svg();
        let caption = "Error over the degree p on a fixed mesh: exponential, down to round-off.";
        let title = "Error of all fields at the end over the degree";
        let evidence: Vec<String> = checks
            .iter()
            .map(|check: &Check| check.evidence.to_string())
            .collect();
        SourceResult {
            summary: evidence.join("; "),
            checks,
            tables: vec![Table::new(title, ["mesh", "degree p", "error"], rows)],
            figures: vec![Figure::new("degrees", caption, svg)],
            quantities,
            ..SourceResult::default()
        }
    }
}

/// The error in the fields over the degree; NaN if the run failed.
fn points(runs: &[Ran<AnyOrderRun, JudgedErrors>]) -> Vec<(f64, f64)> {
    let mut points = vec![];
    for run in runs {
        let error = run.ok().and_then(|errors| errors.of("fields"));
        points.push((run.case.data.degree as f64, error.unwrap_or(f64::NAN)));
    }
    points
}

/// Whether errors over the degree fall by `factor` on average until they are round-off.
fn exponential(points: &[(f64, f64)], factor: f64) -> [Check; 2] {
    let reached = points.iter().position(|(_, error)| *error <= ROUND_OFF);
    let last = reached.unwrap_or(points.len().saturating_sub(1));
    let fall = match (points.first(), points.get(last)) {
        (Some((p0, e0)), Some((p1, e1))) if last > 0 => (e0 / e1).powf(1.0 / (p1 - p0)),
        _ => f64::NAN,
    };
    let is_monotone = points
        .windows(2)
        .take(last)
        .all(|pair| pair[1].1 < pair[0].1);
    let stays = points
        .iter()
        .skip(last)
        .all(|(_, error)| *error <= ROUND_OFF);
    let end = points.get(last).map_or(f64::NAN, |(p, _)| *p);
    let steep = Check::that(
        fall >= factor && is_monotone,
        format!("the error falls with every degree, {factor} times on average"),
        format!("{fall:.1} times a degree, up to p = {end}"),
    );
    let exact = Check::that(
        reached.is_some() && stays,
        format!("it reaches round-off, {ROUND_OFF:e}, and stays there"),
        format!("error at most {ROUND_OFF:e} from p = {end} on"),
    );
    [
        steep.about(Subject::of("error over the degree")),
        exact.about(Subject::of("round-off")),
    ]
}
