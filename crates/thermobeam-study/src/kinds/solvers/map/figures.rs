//! The maps.

use convergence_study::plots::{Axis, Series, Surface};

use super::{Lines, Map, MapRows, Parameter, Point};
use crate::kinds::prelude::*;

/// Contractions below are shown as this: after a few iterations the ratio tells no more.
const FASTEST: f64 = 1e-6;
/// Residuals below are shown as this, a hundredth of a rounding error.
const EXACT: f64 = 1e-18;

/// What a map shows at each point; where the solver fails it is hatched instead.
struct MapPicture {
    file: &'static str,
    caption: String,
    z: Axis,
    /// Smaller values are shown as this.
    least: f64,
    /// A number of Newton's method; else one of the fixed point.
    of_newton: bool,
    value: fn(&Point) -> Option<f64>,
    boundaries: Vec<Series>,
}

pub(super) fn all(map: &Map, id: &str, rows: &MapRows<'_>, lines: &Lines<'_>) -> Vec<Figure> {
    let over = map.over.name();
    let shown = [
        MapPicture {
            file: "contraction",
            caption: format!("Contraction factor of the fixed point over dt and {over}; it fails from alpha = 1 on."),
            z: Axis::log("contraction per iteration"),
            least: FASTEST,
            of_newton: false,
            value: |point| point.fixed_point.contraction,
            boundaries: vec![predicted(rows), map.found(lines)],
        },
        MapPicture {
            file: "iterations",
            caption: format!("Iterations of the fixed point in a step over dt and {over}."),
            z: Axis::log("iterations of the fixed point"),
            least: 1.0,
            of_newton: false,
            value: |point| Some(point.fixed_point.iterations as f64),
            boundaries: vec![predicted(rows), map.found(lines)],
        },
        MapPicture {
            file: "newton",
            caption: format!("Most iterations of Newton's method in a step over dt and {over}."),
            z: Axis::linear("most Newton iterations in a step"),
            least: 1.0,
            of_newton: true,
            value: |point| Some(point.newton?.iterations as f64),
            boundaries: map.definite(),
        },
        MapPicture {
            file: "balance",
            caption: format!("Largest residual of the energy balance in a step of Newton's method over dt and {over}."),
            z: Axis::log("largest residual / energy"),
            least: EXACT,
            of_newton: true,
            value: |point| Some(point.newton?.worst.residual),
            boundaries: vec![predicted(rows)],
        },
    ];
    shown.into_iter().map(|shown| map.draw(id, rows, shown)).collect()
}

impl Map {
    fn draw(&self, id: &str, rows: &MapRows<'_>, shown: MapPicture) -> Figure {
        let MapPicture { file, caption, z, least, of_newton, value, boundaries } = shown;
        let fails = if of_newton { "operator not definite" } else { "the fixed point fails" };
        let hatched = |point: &Point| if of_newton { !point.newton_completes } else { !point.fixed_point.converged };
        let cell = |point: &Point| match value(point).filter(|_| !hatched(point)) {
            // `max` would replace NaN by the least value.
            Some(value) if !value.is_nan() => value.max(least),
            _ => f64::NAN,
        };
        let map = Surface {
            title: None,
            x: Axis::log("time step dt"),
            y: self.second_axis(),
            z,
            x_values: self.time_steps(),
            y_values: rows.iter().map(|(value, _)| *value).collect(),
            values: rows.iter().map(|(_, row)| row.iter().map(cell).collect()).collect(),
            marked: rows.iter().map(|(_, row)| row.iter().map(hatched).collect()).collect(),
            marked_label: fails.to_owned(),
            boundaries,
        };
        Figure::new(id, file, caption, plots::parameter_map(&map))
    }

    fn second_axis(&self) -> Axis {
        match self.over {
            Parameter::Epsilon => Axis::log("compliance ε (dimensionless)"),
            Parameter::Beta => Axis::linear("axial force at rest β (dimensionless)"),
            Parameter::Zeta => Axis::log("viscosity ζ (dimensionless)"),
            Parameter::Width => Axis::log("mesh width h (dimensionless)"),
        }
    }

    /// The boundaries found, line by line.
    fn found(&self, lines: &Lines<'_>) -> Series {
        let mut points: Vec<(f64, f64)> =
            lines.iter().filter_map(|(value, line)| Some((line.found?.dt, *value))).collect();
        points.retain(|(_, value)| self.over.is_linear() || *value > 0.0);
        points.sort_by(|a, b| a.1.total_cmp(&b.1));
        Series { label: "found by bisection".to_owned(), points }
    }

    /// For β above this line the operator is definite.
    fn definite(&self) -> Vec<Series> {
        if self.over != Parameter::Beta {
            return vec![];
        }
        let zeta = Beam::default().zeta;
        let force = |&dt: &f64| (dt, -BUCKLING * (1.0 + 2.0 * zeta / dt));
        let [low, high] = self.range;
        let dts = super::spaced(self.dt, 400, false);
        let points = dts.iter().map(force).filter(|(_, beta)| (low..high).contains(beta)).collect();
        vec![Series { label: "definite above: β = -B (1 + 2ζ/dt)".to_owned(), points }]
    }
}

/// α = 1, row by row between the two time steps on either side, on logarithmic scales.
fn predicted(rows: &MapRows<'_>) -> Series {
    let crossing = |(value, row): &(f64, &[Point])| {
        let finite: Vec<&Point> = row.iter().filter(|point| point.alpha.is_finite()).collect();
        let pair = finite.windows(2).find(|pair| pair[0].alpha < 1.0 && pair[1].alpha >= 1.0)?;
        let [below, above] = [pair[0], pair[1]];
        let share = -below.alpha.ln() / (above.alpha / below.alpha).ln();
        Some((below.dt * (above.dt / below.dt).powf(share), *value))
    };
    Series { label: "predicted: α = 1".to_owned(), points: rows.iter().filter_map(crossing).collect() }
}
