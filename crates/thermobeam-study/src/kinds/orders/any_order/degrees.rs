//! The error over the degree on a fixed mesh, which falls exponentially, down to round-off.

use super::{AnyOrder, AnyOrderRun, JudgedErrors, Runs, SourceResult};
use crate::kinds::prelude::*;
use convergence_study::chart::{self, Chart};

/// Below this error a higher degree gains nothing: round-off of the loads and the initial data, for
/// solutions of the size of 1.
const ROUND_OFF: f64 = 2e-12;

/// How many times as large as round-off the error of the lowest degree is at least. Of a small
/// solution any error soon is as small as round-off, whatever the law by which it falls.
const RANGE: f64 = 1e4;

impl AnyOrder {
    /// The error must fall by the factor claimed, as a geometric mean, from the first degree to the
    /// one that reaches round-off.
    pub(super) fn over_degrees(&self, runs: &Runs<Self>) -> SourceResult {
        let y = chart::Axis::log("L2 error of all fields (dimensionless)");
        let mut chart = Chart::empty(chart::Axis::linear("degree p"), y);
        let mut claims = vec![];
        let mut errors = vec![];
        for (series, runs) in self.by_degree(runs) {
            let points = points(runs);
            let mesh = counted(series.runs[0].elements, "element");
            claims.extend(exponential(&mesh, &points, series.tolerance));
            for &(p, error) in &points {
                let number = measured(format!("{mesh}, p = {p}"), "fields", error).scientific(2);
                // Round-off is not guarded; NaN is.
                errors.push(if error <= ROUND_OFF {
                    number
                } else {
                    number.recorded_as(format!("error fields, p = {p}"), 1e-4)
                });
            }
            let curve = chart.curve(mesh, points);
            *curve = curve.clone().marked();
        }
        let holds = claims.iter().all(|claim| claim.holds() == Some(true));
        let title = "The error falls exponentially with the degree, to round-off";
        let chart = chart.titled_where(holds, title);
        let caption = "Error over the degree p on a fixed mesh: exponential, down to round-off.";
        let title = "Error of all fields at the end over the degree";
        SourceResult {
            summary: in_words(&claims),
            sheets: vec![
                Sheet::untabled(claims),
                Sheet::new(title, "mesh and degree", errors),
            ],
            figures: vec![Figure::of("degrees", caption, chart)],
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

/// What the claims found, but for those that count what must not happen.
fn in_words(claims: &[Measured]) -> String {
    let found = claims
        .iter()
        .filter(|claim| claim.claim != Some(Must::Count(0)));
    found.map(Measured::text).collect::<Vec<_>>().join("; ")
}

/// Errors over the degree fall with every degree, by `factor` on average, until they are round-off,
/// and stay there.
fn exponential(mesh: &str, points: &[(f64, f64)], factor: f64) -> [Measured; 4] {
    let reached = points.iter().position(|(_, error)| *error <= ROUND_OFF);
    let last = reached.unwrap_or(points.len().saturating_sub(1));
    let fall = match (points.first(), points.get(last)) {
        (Some((p0, e0)), Some((p1, e1))) if last > 0 => Some((e0 / e1).powf(1.0 / (p1 - p0))),
        _ => None,
    };
    let falling = points.windows(2).take(last);
    let rises = falling.filter(|pair| !(pair[1].1 < pair[0].1)).count();
    let round_off = largest_of(points[last..].iter().map(|(_, error)| *error));
    let end = points.get(last).map_or(f64::NAN, |(p, _)| *p);
    let nan = f64::NAN;
    let falls = format!("{:.1} times a degree, up to p = {end}", fall.unwrap_or(nan));
    let stays = format!(
        "error at most {:.1e} from p = {end} on",
        round_off.unwrap_or(nan)
    );
    let begins = points
        .first()
        .is_some_and(|(_, error)| *error >= RANGE * ROUND_OFF);
    let number = |name: &str, value| measured("", format!("{name}, {mesh}"), value);
    [
        none_of(
            "",
            &format!("lowest degrees whose error is near round-off, {mesh}"),
            usize::from(!begins),
        ),
        number("fall of the error with a degree, mean factor", fall)
            .words(falls)
            .must_be(Must::AtLeast(factor)),
        none_of(
            "",
            &format!("degrees with which the error does not fall, {mesh}"),
            rises,
        ),
        number("error at round-off, largest", round_off)
            .words(stays)
            .must_be(Must::AtMost(ROUND_OFF)),
    ]
}
