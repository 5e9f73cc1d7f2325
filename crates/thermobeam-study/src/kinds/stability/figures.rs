//! The maps.

use super::measure::{ALPHA, CONTRACTION, FAILED, ITERATIONS_OF_FIXED_POINT, ITERATIONS_OF_NEWTON, REFUSED, RESIDUAL};
use super::{Parameter, Stability};
use crate::kinds::untyped::Measured;
use convergence_study::plots::{self, Axis, ParameterMap, Series, Surface};
use convergence_study::study::outcome::Figure;
use thermobeam::kirchhoff::BUCKLING;
use thermobeam::parameters::Beam;

/// Contractions below are shown as this: a few iterations tell no more.
const FASTEST: f64 = 1e-6;
/// Residuals below are shown as this, a hundredth of a rounding error.
const EXACT: f64 = 1e-18;

pub(super) fn all(study: &Stability, rows: &[Measured], lines: &[Measured]) -> Vec<Figure> {
    let map = Maps { study, rows };
    let fixed = || vec![map.predicted(), map.found(lines)];
    let over = study.over.name();
    vec![
        map.draw(
            ("contraction", CONTRACTION, FAILED, "the fixed point fails"),
            Axis::log("contraction per iteration"),
            FASTEST,
            fixed(),
            &format!("Contraction factor of the fixed point over dt and {over}; it fails from alpha = 1 on."),
        ),
        map.draw(
            ("iterations", ITERATIONS_OF_FIXED_POINT, FAILED, "the fixed point fails"),
            Axis::log("iterations of the fixed point"),
            1.0,
            fixed(),
            &format!("Iterations of the fixed point in a step over dt and {over}."),
        ),
        map.draw(
            ("newton", ITERATIONS_OF_NEWTON, REFUSED, "operator not definite"),
            Axis::linear("most Newton iterations in a step"),
            1.0,
            map.definite(),
            &format!("Most iterations of Newton's method in a step over dt and {over}."),
        ),
        map.draw(
            ("balance", RESIDUAL, REFUSED, "operator not definite"),
            Axis::log("largest residual / energy"),
            EXACT,
            vec![map.predicted()],
            &format!("Largest residual of the energy balance in a step of Newton's method over dt and {over}."),
        ),
    ]
}

struct Maps<'a> {
    study: &'a Stability,
    rows: &'a [Measured],
}

impl Maps<'_> {
    /// A map of the values of one curve, hatched where another is not zero.
    fn draw(
        &self,
        (what, name, mark, marked_label): (&str, &str, &str, &str),
        z: Axis,
        least: f64,
        boundaries: Vec<Series>,
        caption: &str,
    ) -> Figure {
        let dts = self.study.steps_of_map();
        let at = |row: &Measured, name: &str, dt: f64| {
            row.curve(name).iter().find(|(x, _)| *x == dt).map_or(f64::NAN, |(_, value)| *value)
        };
        let marks = |row: &Measured| dts.iter().map(|&dt| at(row, mark, dt) != 0.0).collect::<Vec<bool>>();
        let value = |row: &Measured, dt: f64| {
            let value = at(row, name, dt);
            // `max` would turn a value that is not there into one that is.
            if at(row, mark, dt) != 0.0 || value.is_nan() { f64::NAN } else { value.max(least) }
        };
        let values = self.rows.iter().map(|row| dts.iter().map(|&dt| value(row, dt)).collect()).collect();
        let cells = Surface {
            title: None,
            x: Axis::log("time step dt (dimensionless)"),
            y: self.second_axis(),
            z,
            x_values: dts.clone(),
            y_values: self.study.rows(),
            values,
        };
        let marked = self.rows.iter().map(marks).collect();
        let map = ParameterMap { cells, marked, marked_label: marked_label.to_owned(), boundaries };
        Figure {
            file: format!("{}-{what}.svg", self.study.header.id),
            caption: caption.to_owned(),
            svg: plots::parameter_map(&map),
        }
    }

    fn second_axis(&self) -> Axis {
        match self.study.over {
            Parameter::Epsilon => Axis::log("compliance ε (dimensionless)"),
            Parameter::Beta => Axis::linear("axial force at rest β (dimensionless)"),
            Parameter::Zeta => Axis::log("viscosity ζ (dimensionless)"),
            Parameter::Width => Axis::log("mesh width h (dimensionless)"),
        }
    }

    /// α = 1, row by row between the two time steps on either side, on logarithmic scales.
    fn predicted(&self) -> Series {
        let crossing = |(value, row): (f64, &Measured)| {
            let alpha = row.curve(ALPHA);
            let pair = alpha.windows(2).find(|pair| pair[0].1 < 1.0 && pair[1].1 >= 1.0)?;
            let [(x0, a0), (x1, a1)] = [pair[0], pair[1]];
            let share = -a0.ln() / (a1 / a0).ln();
            Some((x0 * (x1 / x0).powf(share), value))
        };
        let points = self.study.rows().into_iter().zip(self.rows).filter_map(crossing).collect();
        Series { label: "predicted: α = 1".to_owned(), points }
    }

    /// The boundaries found, line by line.
    fn found(&self, lines: &[Measured]) -> Series {
        let mut points: Vec<(f64, f64)> =
            self.study.lines.iter().zip(lines).map(|(&value, line)| (line.value("found"), value)).collect();
        points.retain(|(dt, value)| dt.is_finite() && (self.study.over.is_linear() || *value > 0.0));
        points.sort_by(|a, b| a.1.total_cmp(&b.1));
        Series { label: "found by bisection".to_owned(), points }
    }

    /// Above this β the operator is definite, whatever comes.
    fn definite(&self) -> Vec<Series> {
        if self.study.over != Parameter::Beta {
            return vec![];
        }
        let zeta = Beam::default().zeta;
        let force = |&dt: &f64| (dt, -BUCKLING * (1.0 + 2.0 * zeta / dt));
        let [low, high] = self.study.range;
        let dts = super::spaced(self.study.dt, 400, false);
        let points = dts.iter().map(force).filter(|(_, beta)| (low..high).contains(beta)).collect();
        vec![Series { label: "definite above: β = -B (1 + 2ζ/dt)".to_owned(), points }]
    }
}
