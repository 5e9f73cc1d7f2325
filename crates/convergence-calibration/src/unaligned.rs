//! Scatter that does not fade: a kink or an interface that lies somewhere else in its cell on every
//! mesh; and the mean over shifted meshes, which removes it.
//!
//! With θ the position of the kink in its cell, from 0 to 1, and steps h = 1/8 halved:
//!
//! * the midpoint rule for `c f + k |x - x0|`, f smooth and convex, is off by
//!   `h² (c/24 + k g(θ))`, `g = (θ² + (1 - θ)²)/2 - |1/2 - θ|`, from 0 to 1/4: order 2;
//! * linear interpolation of a function whose slope jumps by J at x0 is off in L2 by
//!   `√(c² h⁴ + J² h³ θ² (1 - θ)²/3)`: on its cell the error is a triangle of height J h θ (1 - θ);
//!   order 3/2.
//!
//! On a mesh that is shifted by a part s of a cell, θ + s takes the place of θ. The errors of eight
//! shifts, 0 to 7/8, have a mean (of squares in L2) that depends little on θ.

use convergence_judge::judge::{
    fit::{Level, fit_line},
    random::SplitMix,
    verdict::DEFAULT_TOLERANCE,
};

use crate::draw::{CalibrationError, Draw};
use crate::judge;
use crate::sheet::{HitShare, Sheet, SheetRow};

/// Shifts of a mesh.
const SHIFTS: usize = 8;
/// Numbers of levels.
const LEVELS: [usize; 2] = [5, 8];
/// Cells of the coarsest mesh.
const COARSEST: f64 = 8.0;

/// A computation whose error depends on the position in a cell.
struct Computation {
    name: &'static str,
    order: f64,
    /// The power of the error whose mean over shifts is taken.
    power: f64,
    /// The error for a step, a position in the cell, and the part of the kink.
    error: fn(f64, f64, f64) -> f64,
}

const COMPUTATIONS: [Computation; 2] = [
    Computation {
        name: "kinked quadrature",
        order: 2.0,
        power: 1.0,
        error: quadrature,
    },
    Computation {
        name: "interface in its cell",
        order: 1.5,
        power: 2.0,
        error: interpolation,
    },
];

/// The error of the midpoint rule, the part of the smooth integrand c = 1.
fn quadrature(h: f64, position: f64, kink: f64) -> f64 {
    let rest = 1.0 - position;
    let of_kink = (position * position + rest * rest) / 2.0 - (0.5 - position).abs();
    h * h * (1.0 / 24.0 + kink * of_kink)
}

/// The error of linear interpolation in L2, the smooth part c = 1/8.
fn interpolation(h: f64, position: f64, jump: f64) -> f64 {
    let height = jump * position * (1.0 - position);
    (h.powi(4) / 64.0 + h.powi(3) * height * height / 3.0).sqrt()
}

impl Computation {
    /// Draws a kink, of 0.3 to 3 times the smooth part, and its place.
    fn draw(&self, levels: usize, random: &mut SplitMix) -> Drawn {
        let place = random.within([0.2, 0.8]);
        let kink = random.within([0.3, 3.0]);
        let mut drawn = Drawn::default();
        for k in 0..levels {
            let step = 0.5_f64.powi(k as i32) / COARSEST;
            let error = |shift: usize| {
                let position = (place / step + shift as f64 / SHIFTS as f64).fract();
                (self.error)(step, position, kink)
            };
            let sum: f64 = (0..SHIFTS).map(|shift| error(shift).powf(self.power)).sum();
            let mean = (sum / SHIFTS as f64).powf(1.0 / self.power);
            drawn.one_mesh.push(Level {
                step,
                error: error(0),
            });
            drawn.mean.push(Level { step, error: mean });
        }
        drawn
    }
}

/// Errors on one mesh a step, and their mean over shifted ones.
#[derive(Default)]
struct Drawn {
    one_mesh: Vec<Level>,
    mean: Vec<Level>,
}

/// How often the order passes, by this rule and by the slope of a straight line, and by this rule
/// for the mean over shifted meshes.
///
/// * `tables`: for each computation and number of levels.
pub(crate) fn unaligned(tables: usize, draw: &mut Draw) -> Result<Sheet, CalibrationError> {
    let judge = judge(DEFAULT_TOLERANCE)?;
    let mut rows = vec![];
    for computation in &COMPUTATIONS {
        let order = computation.order;
        for levels in LEVELS {
            let [mut passes, mut line, mut mean_passes, mut wrong] = [HitShare::default(); 4];
            for _ in 0..tables {
                let drawn = computation.draw(levels, draw.next()?);
                let reading = judge.read(&drawn.one_mesh);
                passes.count(judge.decide(&reading, order).is_pass());
                for claim in [order - 0.5, order + 0.5] {
                    wrong.count(judge.decide(&reading, claim).is_pass());
                }
                let slope = fit_line(&drawn.one_mesh).map_or(f64::NAN, |line| line.slope);
                line.count((slope - order).abs() <= DEFAULT_TOLERANCE);
                let mean = judge.read(&drawn.mean);
                mean_passes.count(judge.decide(&mean, order).is_pass());
            }
            let cells = vec![
                passes.cell("true pass"),
                line.cell("true pass of least squares"),
                wrong.cell("wrong pass"),
                mean_passes.cell("true pass, mean over 8 shifts"),
            ];
            let name = format!("{}, {levels} levels", computation.name);
            rows.push(SheetRow::new(name, false, cells));
        }
    }
    Ok(Sheet {
        key: "unaligned",
        title: "Share of claims that pass at ±0.25 where a kink lies somewhere else in its cell on every mesh; wrong claims are \
                half an order off"
            .to_owned(),
        rows,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The midpoint rule and its error for `x²/2 + k |x - x0|` on [0, 1], the second with f'' = 1.
    #[test]
    fn the_error_of_the_midpoint_rule_is_what_the_formula_says() {
        let (place, kink, cells) = (0.37, 1.7, 16);
        let h = 1.0 / f64::from(cells);
        let f = |x: f64| x * x / 2.0 + kink * (x - place).abs();
        let sum: f64 = (0..cells).map(|i| f((f64::from(i) + 0.5) * h)).sum();
        let exact = 1.0 / 6.0 + kink * (place * place + (1.0 - place) * (1.0 - place)) / 2.0;
        let expected = quadrature(h, (place / h).fract(), kink);
        assert!((exact - sum * h - expected).abs() < 1e-14);
    }

    /// The square of the interpolation error of `J (x - x0)+` by a sum over its cell.
    #[test]
    fn the_error_of_an_interface_is_a_triangle_on_its_cell() {
        let (position, jump, h) = (0.3, 2.0, 0.125);
        let error = |y: f64| jump * ((y - position * h).max(0.0) - (1.0 - position) * y);
        let count = 100_000;
        let square = |i: i32| error((f64::from(i) + 0.5) * h / f64::from(count)).powi(2);
        let sum: f64 = (0..count).map(square).sum::<f64>() * h / f64::from(count);
        let smooth = h.powi(4) / 64.0;
        let expected = interpolation(h, position, jump).powi(2) - smooth;
        assert!((sum - expected).abs() < 1e-9 * expected, "{sum} {expected}");
    }
}
