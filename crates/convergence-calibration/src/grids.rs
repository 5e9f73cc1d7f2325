//! Grids of h and dt whose errors do not tend to zero.
//!
//! `e^s = A(h)^s + B(dt)^s`, s = 1 or 2, with ratio 2, coarsest steps 1/8 to 1/2,
//! `A = h^p (1 + a h^r)`, B likewise, p and q from 1/2 to 3, a and b in [-0.8, 2], r in [0.5, 2],
//! and A / B from 1/30 to 30 in the middle. A constant of 10 to 300 % of the finest error, of
//! either sign, is added to the errors; p and q are claimed.

use convergence_judge::{
    grid::{Adding, GridErrors},
    random::SplitMix,
    verdict::Band,
};
use convergence_study::{CaseFailure, SpaceTime};

use crate::draw::Draw;
use crate::sheet::{Sheet, SheetRow};

const ORDERS: [f64; 6] = [0.5, 1.0, 1.5, 2.0, 2.5, 3.0];

/// Tolerance of the claims.
const TOLERANCE: f64 = 0.2;

/// A(h) + B(dt), or the root of the sum of their squares.
struct GridLaw {
    h: Vec<f64>,
    dt: Vec<f64>,
    orders: SpaceTime<f64>,
    pollution: SpaceTime<f64>,
    exponent: f64,
    /// Of B.
    factor: f64,
    power: f64,
}

/// Steps that are halved from level to level; the first is random.
fn halved_steps(levels: usize, random: &mut SplitMix) -> Vec<f64> {
    let first = [0.5, 0.25, 0.125][random.below(3)];
    (0..levels)
        .map(|k| first * 0.5_f64.powi(k as i32))
        .collect()
}

impl GridLaw {
    fn draw(levels: usize, random: &mut SplitMix) -> Self {
        let mut law = Self {
            h: halved_steps(levels, random),
            dt: halved_steps(levels, random),
            orders: SpaceTime {
                space: ORDERS[random.below(ORDERS.len())],
                time: ORDERS[random.below(ORDERS.len())],
            },
            pollution: SpaceTime {
                space: random.within([-0.8, 2.0]),
                time: random.within([-0.8, 2.0]),
            },
            exponent: [1.0, random.within([0.5, 2.0])][random.below(2)],
            factor: 1.0,
            power: [1.0, 2.0][random.below(2)],
        };
        let share = 30.0_f64.powf(random.within([-1.0, 1.0]));
        law.factor = share * law.space(law.h[levels / 2]) / law.time(law.dt[levels / 2]);
        law
    }

    fn space(&self, h: f64) -> f64 {
        h.powf(self.orders.space) * (1.0 + self.pollution.space * h.powf(self.exponent))
    }

    fn time(&self, dt: f64) -> f64 {
        let pollution = self.pollution.time * dt.powf(self.exponent);
        self.factor * dt.powf(self.orders.time) * (1.0 + pollution)
    }

    fn errors(&self) -> Vec<f64> {
        let mut errors = vec![];
        for &h in &self.h {
            for &dt in &self.dt {
                let [space, time] =
                    [self.space(h), self.time(dt)].map(|error| error.powf(self.power));
                errors.push((space + time).powf(1.0 / self.power));
            }
        }
        errors
    }

    /// Whether both orders pass, judged by the way of adding that describes the errors better.
    fn passes(&self, errors: &[f64]) -> Result<bool, CaseFailure> {
        let grid = GridErrors {
            h: &self.h,
            dt: &self.dt,
            errors,
        };
        let adding = if grid.misfit(Adding::Squares) <= grid.misfit(Adding::Plain) {
            Adding::Squares
        } else {
            Adding::Plain
        };
        let claims = self.orders.map(|order| Band {
            order,
            tolerance: TOLERANCE,
        });
        let rates = grid.judge(adding, claims)?;
        Ok(rates.both().iter().all(|rate| rate.verdict.is_pass()))
    }
}

/// The sheet *grids*.
///
/// * `tables`: number of grids for each number of levels.
///
/// # Errors
/// [`CaseFailure`] if the rule cannot be set up as declared, or the time is up.
pub fn of_grids(tables: usize, seed: u64) -> Result<Vec<Sheet>, CaseFailure> {
    let mut rows = vec![];
    for levels in [4, 5, 6, 8] {
        let mut draw = Draw::new(seed);
        let mut row = SheetRow::new(format!("{levels} levels"), true, &["constant passes"]);
        for _ in 0..tables {
            let random = draw.next()?;
            let law = GridLaw::draw(levels, random);
            let sign = [1.0, -1.0][random.below(2)];
            let share = sign * random.within([0.1_f64.ln(), 3.0_f64.ln()]).exp();
            let mut errors = law.errors();
            let constant = share * errors[errors.len() - 1];
            for error in &mut errors {
                *error = (*error + constant).abs();
            }
            row.count("constant passes", law.passes(&errors)?);
        }
        rows.push(row);
    }
    let title = "Grids of h and dt at ±0.2 that pass although a constant of 10 % of the finest error or more is added to their errors";
    Ok(vec![Sheet {
        key: "grids",
        title: title.to_owned(),
        rows,
    }])
}
