//! The maps as figures: what each solver does at every point, and the boundaries.

use convergence_study::chart::{self, Mark};

use super::{
    map::{MapParameter, MapPoint, NewtonSteps},
    map_judge::MapResults,
};
use crate::figures;
use crate::kinds::prelude::*;
use thermobeam::{kirchhoff::BUCKLING, parameters::Beam};

/// Smaller contractions are shown as this value: after a few iterations the ratio is no longer
/// meaningful.
const FASTEST: f64 = 1e-6;
/// Smaller residuals are shown as this value, a hundredth of a rounding error.
const EXACT: f64 = 1e-18;

/// A number of the completed steps by Newton's method.
fn steps(point: &MapPoint, number: fn(&NewtonSteps) -> f64) -> Option<f64> {
    let completes = point.newton_completes;
    completes.then(|| point.newton.as_ref().map_or(f64::NAN, number))
}

/// What a figure of a map shows.
struct Shown {
    file: &'static str,
    /// What one sees if the study passes.
    title: &'static str,
    caption: String,
    /// What the colours measure, and what a hatched cell is.
    colours: chart::Axis,
    hatched: &'static str,
    /// The value at a point; `None` where the solver fails, which is hatched.
    value: fn(&MapPoint) -> Option<f64>,
    boundaries: Vec<Boundary>,
}

/// A line between two regions, as `(dt, value)`.
struct Boundary {
    label: &'static str,
    points: Vec<(f64, f64)>,
}

const FAILS: &str = "the fixed point fails";
const INDEFINITE: &str = "operator not definite";
/// A boundary with fewer points is drawn as points.
const FEWEST_FOR_A_LINE: usize = 6;
/// The style of the boundary predicted, in ink, and that of the one found.
const STYLES: [usize; 2] = [5, 1];

impl MapResults<'_> {
    pub(super) fn figures(&self) -> Vec<Figure> {
        let over = self.map.over.name;
        let shown = [
            Shown {
                file: "contraction",
                title: "The fixed point fails where α reaches 1",
                caption: format!(
                    "Contraction factor of the fixed point over dt and {over}; it fails from alpha = 1 on."
                ),
                colours: chart::Axis::log("contraction per iteration"),
                hatched: FAILS,
                value: |point| {
                    let contraction = point.step.contraction.unwrap_or(f64::NAN);
                    point
                        .step
                        .converged
                        .then_some(max_or_nan(contraction, FASTEST))
                },
                boundaries: vec![self.predicted(), self.crossings()],
            },
            Shown {
                file: "iterations",
                title: "The iterations of the fixed point grow towards α = 1",
                caption: format!("Iterations of the fixed point in a step over dt and {over}."),
                colours: chart::Axis::log("iterations of the fixed point"),
                hatched: FAILS,
                value: |point| {
                    let iterations = point.step.iterations.max(1) as f64;
                    point.step.converged.then_some(iterations)
                },
                boundaries: vec![self.predicted(), self.crossings()],
            },
            Shown {
                file: "newton",
                title: "Newton's method needs few iterations at every step",
                caption: format!(
                    "Most iterations of Newton's method in a step over dt and {over}."
                ),
                colours: chart::Axis::linear("most Newton iterations in a step"),
                hatched: INDEFINITE,
                value: |point| steps(point, |steps| steps.iterations.max(1) as f64),
                boundaries: self.definite(),
            },
            Shown {
                file: "balance",
                title: "The balance of the energy closes to round-off at every step",
                caption: format!(
                    "Largest residual of the energy balance in a step of Newton's method over dt and {over}."
                ),
                colours: chart::Axis::log("largest residual / energy"),
                hatched: INDEFINITE,
                value: |point| steps(point, |steps| max_or_nan(steps.worst.residual, EXACT)),
                boundaries: vec![self.predicted()],
            },
        ];
        shown.into_iter().map(|shown| self.figure(shown)).collect()
    }

    /// A cell for each point of the map.
    fn figure(&self, shown: Shown) -> Figure {
        let mut cells = vec![];
        for row in &self.rows {
            let steps = self.map.time_steps(self.map.points.get());
            for (dt, point) in steps.into_iter().zip(&row.points) {
                let value = (shown.value)(point).unwrap_or(f64::NAN);
                cells.push([dt, row.value, value]);
            }
        }
        let axes = [
            chart::Axis::log("time step dt"),
            self.second_axis(),
            shown.colours,
        ];
        let mut chart = figures::cells(&cells, axes, shown.hatched).titled(shown.title);
        for (Boundary { label, points }, style) in shown.boundaries.into_iter().zip(STYLES) {
            let is_sparse = points.len() < FEWEST_FOR_A_LINE;
            let curve = chart.curve(label, points);
            curve.style = Some(style);
            curve.width = 3.0;
            // A line between few points would suggest points that were not computed.
            if is_sparse {
                *curve = curve.clone().scattered();
                curve.mark = Mark::Open;
            }
        }
        Figure::of(shown.file, shown.caption, chart)
    }

    fn second_axis(&self) -> chart::Axis {
        match self.map.over.value {
            MapParameter::Epsilon => chart::Axis::log("compliance ε (dimensionless)"),
            MapParameter::Beta => chart::Axis::linear("axial force at rest β (dimensionless)"),
            MapParameter::Zeta => chart::Axis::log("viscosity ζ (dimensionless)"),
            MapParameter::Width => chart::Axis::log("mesh width h (dimensionless)"),
        }
    }

    /// The boundaries found, line by line.
    fn crossings(&self) -> Boundary {
        let mut points = vec![];
        for line in &self.lines {
            // A logarithmic axis has no place for 0.
            if self.map.over.value.is_linear() || line.value > 0.0 {
                points.extend(line.found.map(|step| (step.dt, line.value)));
            }
        }
        points.sort_by(|a, b| a.1.total_cmp(&b.1));
        Boundary {
            label: "found by bisection",
            points,
        }
    }

    /// α = 1, row by row between the two time steps on either side, on logarithmic scales.
    fn predicted(&self) -> Boundary {
        let mut points = vec![];
        for row in &self.rows {
            let finite: Vec<_> = row
                .points
                .iter()
                .map(|point| point.step)
                .filter(|step| step.alpha.is_finite())
                .collect();
            let crossing = finite
                .windows(2)
                .find(|pair| pair[0].alpha < 1.0 && pair[1].alpha >= 1.0);
            if let Some([below, above]) = crossing {
                let share = -below.alpha.ln() / (above.alpha / below.alpha).ln();
                points.push((below.dt * (above.dt / below.dt).powf(share), row.value));
            }
        }
        Boundary {
            label: "predicted: α = 1",
            points,
        }
    }

    /// For β above this line the operator is definite.
    fn definite(&self) -> Vec<Boundary> {
        if self.map.over.value != MapParameter::Beta {
            return vec![];
        }
        let zeta = Beam::default().zeta;
        let steps = self.map.time_steps(400).into_iter();
        let limit = steps.map(|dt| (dt, -BUCKLING * (1.0 + 2.0 * zeta / dt)));
        let points = limit.filter(|(_, beta)| self.map.has(*beta));
        vec![Boundary {
            label: "definite above: β = -B (1 + 2ζ/dt)",
            points: points.collect(),
        }]
    }
}
