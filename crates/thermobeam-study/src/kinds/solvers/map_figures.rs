//! The maps as figures: what each solver does at every point, and the boundaries.

use convergence_study::internal::plots::{self, Axis, ColouredCells, Series};

use super::{
    map::{MapParameter, MapPoint, NewtonSteps},
    map_judge::MapResults,
};
use crate::kinds::interval::SampledInterval;
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

/// What figures of Newton's method share.
fn of_newton(z: Axis, boundaries: Vec<Series>) -> ColouredCells {
    ColouredCells {
        z,
        marked_label: "operator not definite".to_owned(),
        boundaries,
        ..ColouredCells::default()
    }
}

impl MapResults<'_> {
    /// What figures of the fixed point share.
    fn of_fixed_point(&self, z: &str) -> ColouredCells {
        ColouredCells {
            z: Axis::log(z),
            marked_label: "the fixed point fails".to_owned(),
            boundaries: vec![self.predicted(), self.crossings()],
            ..ColouredCells::default()
        }
    }

    pub(super) fn figures(&self) -> Vec<Figure> {
        let over = self.map.over.name();
        vec![
            self.figure(
                "contraction",
                "The fixed point fails where α reaches 1",
                format!("Contraction factor of the fixed point over dt and {over}; it fails from alpha = 1 on."),
                self.of_fixed_point("contraction per iteration"),
                |point| {
                    let contraction = point.step.contraction.unwrap_or(f64::NAN);
                    point.step.converged.then_some(max_or_nan(contraction, FASTEST))
                },
            ),
            self.figure(
                "iterations",
                "The iterations of the fixed point grow towards α = 1",
                format!("Iterations of the fixed point in a step over dt and {over}."),
                self.of_fixed_point("iterations of the fixed point"),
                |point| {
                    let iterations = point.step.iterations.max(1) as f64;
                    point.step.converged.then_some(iterations)
                },
            ),
            self.figure(
                "newton",
                "Newton's method needs few iterations at every step",
                format!("Most iterations of Newton's method in a step over dt and {over}."),
                of_newton(Axis::linear("most Newton iterations in a step"), self.definite()),
                |point| steps(point, |steps| steps.iterations.max(1) as f64),
            ),
            self.figure(
                "balance",
                "The balance of the energy closes to round-off at every step",
                format!("Largest residual of the energy balance in a step of Newton's method over dt and {over}."),
                of_newton(Axis::log("largest residual / energy"), vec![self.predicted()]),
                |point| steps(point, |steps| max_or_nan(steps.worst.residual, EXACT)),
            ),
        ]
    }

    /// * `surface`: the axis of the values, the label of the hatched part, boundaries.
    /// * `value`: shown at a point; `None` where the solver fails, which is hatched.
    fn figure(
        &self,
        file: &str,
        title: &str,
        caption: String,
        surface: ColouredCells,
        value: fn(&MapPoint) -> Option<f64>,
    ) -> Figure {
        let rows = &self.rows;
        let cells: Vec<Vec<_>> = rows
            .iter()
            .map(|row| row.points.iter().map(value).collect())
            .collect();
        let svg = plots::surface(&ColouredCells {
            title: Some(title.to_owned()),
            x: Axis::log("time step dt"),
            y: self.second_axis(),
            x_values: self.map.time_steps(),
            y_values: rows.iter().map(|row| row.value).collect(),
            values: cells
                .iter()
                .map(|row| row.iter().map(|cell| cell.unwrap_or(f64::NAN)).collect())
                .collect(),
            marked: cells
                .iter()
                .map(|row| row.iter().map(Option::is_none).collect())
                .collect(),
            ..surface
        });
        Figure::new(file, caption, svg)
    }

    fn second_axis(&self) -> Axis {
        match self.map.over {
            MapParameter::Epsilon => Axis::log("compliance ε (dimensionless)"),
            MapParameter::Beta => Axis::linear("axial force at rest β (dimensionless)"),
            MapParameter::Zeta => Axis::log("viscosity ζ (dimensionless)"),
            MapParameter::Width => Axis::log("mesh width h (dimensionless)"),
        }
    }

    /// The boundaries found, line by line.
    fn crossings(&self) -> Series {
        let mut points = vec![];
        for line in &self.lines {
            // A logarithmic axis has no place for 0.
            if self.map.over.is_linear() || line.value > 0.0 {
                points.extend(line.found.map(|step| (step.dt, line.value)));
            }
        }
        let mut series = Series::new("found by bisection", points);
        series.points.sort_by(|a, b| a.1.total_cmp(&b.1));
        series
    }

    /// α = 1, row by row between the two time steps on either side, on logarithmic scales.
    fn predicted(&self) -> Series {
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
        Series::new("predicted: α = 1", points)
    }

    /// For β above this line the operator is definite.
    fn definite(&self) -> Vec<Series> {
        if self.map.over != MapParameter::Beta {
            return vec![];
        }
        let zeta = Beam::default().zeta;
        let SampledInterval { low, high, .. } = self.map.range;
        let points = self
            .map
            .dt
            .values(400)
            .into_iter()
            .map(|dt| (dt, -BUCKLING * (1.0 + 2.0 * zeta / dt)))
            .filter(|(_, beta)| (low..high).contains(beta));
        vec![Series::new("definite above: β = -B (1 + 2ζ/dt)", points)]
    }
}
