//! Grids of h and dt with known orders: what the rule says about them, and about grids whose errors
//! do not tend to zero.
//!
//! `e^s = A(h)^s + B(dt)^s`, s = 1 or 2, with ratio 2, coarsest steps 1/8 to 1/2,
//! `A = h^p (1 + a h^r)`, B likewise, p and q from 1/2 to 3, a and b in [-0.8, 2], r in [0.5, 2],
//! and A / B from 1/30 to 30 in the middle. Where a lower order hides, `A = h^(p+1) + f h^p` with f
//! from 0.01 to 1, and p + 1 is claimed. A constant is 10 to 300 % of the finest error, and is
//! added to the errors, of either sign, or its square to their squares.

use convergence_judge::judge::{
    grid::{Adding, GridErrors},
    random::SplitMix,
};
use convergence_study::{RateVerdict, SpaceTime, Verdict};

use crate::draw::{CalibrationError, Draw};
use crate::sheet::{HitShare, Sheet, SheetCell, SheetRow};

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
    /// f of h^(p + 1) + f h^p; `None` if the grid is smooth.
    hidden: Option<f64>,
    constant: f64,
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
    fn draw(levels: usize, hidden: bool, random: &mut SplitMix) -> Self {
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
            hidden: hidden.then(|| 10.0_f64.powf(random.within([-2.0, 0.0]))),
            constant: 1.0,
            power: [1.0, 2.0][random.below(2)],
        };
        let share = 30.0_f64.powf(random.within([-1.0, 1.0]));
        law.constant = share * law.space(law.h[levels / 2]) / law.time(law.dt[levels / 2]);
        law
    }

    fn space(&self, h: f64) -> f64 {
        let p = self.orders.space;
        match self.hidden {
            Some(share) => h.powf(p + 1.0) + share * h.powf(p),
            None => h.powf(p) * (1.0 + self.pollution.space * h.powf(self.exponent)),
        }
    }

    fn time(&self, dt: f64) -> f64 {
        self.constant
            * dt.powf(self.orders.time)
            * (1.0 + self.pollution.time * dt.powf(self.exponent))
    }

    /// The errors, each of them changed.
    fn errors(&self, mut change: impl FnMut(f64) -> f64) -> Vec<f64> {
        let mut errors = vec![];
        for &h in &self.h {
            for &dt in &self.dt {
                let [space, time] =
                    [self.space(h), self.time(dt)].map(|error| error.powf(self.power));
                errors.push(change((space + time).powf(1.0 / self.power)));
            }
        }
        errors
    }

    /// Both orders, judged by the way of adding that describes the errors better.
    fn judge(&self, errors: &[f64]) -> Result<SpaceTime<RateVerdict>, CalibrationError> {
        let grid = GridErrors {
            h: &self.h,
            dt: &self.dt,
            errors,
        };
        let squares = grid.misfit(Adding::Squares) <= grid.misfit(Adding::Plain);
        let claims = SpaceTime {
            space: self.orders.space + if self.hidden.is_some() { 1.0 } else { 0.0 },
            time: self.orders.time,
        };
        Ok(grid.judge(
            if squares {
                Adding::Squares
            } else {
                Adding::Plain
            },
            claims,
            TOLERANCE,
        )?)
    }
}

fn both_pass(rates: &SpaceTime<RateVerdict>) -> bool {
    rates.both().iter().all(|rate| rate.verdict.is_pass())
}

/// Verdicts on both orders of a grid, and how often an interval holds its order.
#[derive(Debug, Clone, Copy, Default)]
struct OrderVerdicts {
    pass: HitShare,
    fail: HitShare,
    interval_holds: HitShare,
}

impl OrderVerdicts {
    fn count(&mut self, rates: &SpaceTime<RateVerdict>, orders: SpaceTime<f64>) {
        self.pass.count(both_pass(rates));
        for (rate, order) in rates.both().into_iter().zip(orders.both()) {
            self.fail.count(rate.verdict == Verdict::Fail);
            if let Some(interval) = rate.interval {
                self.interval_holds.count(interval.holds(*order));
            }
        }
    }
}

/// What is counted for one number of levels.
#[derive(Debug, Clone, Copy, Default)]
struct Grids {
    sound: OrderVerdicts,
    hidden_order_passes: HitShare,
    constant_passes: HitShare,
    constant_in_squares_passes: HitShare,
    noisy: OrderVerdicts,
}

impl Grids {
    fn count(&mut self, levels: usize, random: &mut SplitMix) -> Result<(), CalibrationError> {
        let law = GridLaw::draw(levels, false, random);
        let hidden = GridLaw::draw(levels, true, random);
        let size = random.within([0.1_f64.ln(), 3.0_f64.ln()]).exp() * [1.0, -1.0][random.below(2)];
        let sound = law.errors(|error| error);
        let constant = size * sound[sound.len() - 1];
        self.sound.count(&law.judge(&sound)?, law.orders);
        let rates = hidden.judge(&hidden.errors(|error| error))?;
        self.hidden_order_passes
            .count(rates.space.verdict.is_pass());
        let shifted = law.errors(|error| (error + constant).abs());
        self.constant_passes.count(both_pass(&law.judge(&shifted)?));
        let in_squares = law.errors(|error| error.hypot(constant));
        self.constant_in_squares_passes
            .count(both_pass(&law.judge(&in_squares)?));
        let noisy = law.errors(|error| error * (0.01 * random.normal()).exp());
        self.noisy.count(&law.judge(&noisy)?, law.orders);
        Ok(())
    }

    fn cells(&self) -> Vec<SheetCell> {
        vec![
            self.sound.pass.cell("sound pass"),
            self.sound.fail.cell("sound orders fail"),
            self.sound.interval_holds.cell("interval holds the order"),
            self.hidden_order_passes.cell("hidden order passes"),
            self.constant_passes.cell("constant passes"),
            self.constant_in_squares_passes
                .cell("constant in squares passes"),
            self.noisy.pass.cell("sound pass, noise 1 %"),
            self.noisy.fail.cell("sound orders fail, noise 1 %"),
            self.noisy
                .interval_holds
                .cell("interval holds the order, noise 1 %"),
        ]
    }
}

/// The sheet *grids*.
///
/// * `tables`: number of grids for each number of levels.
///
/// # Errors
/// [`CalibrationError`].
pub fn of_grids(tables: usize, seed: u64) -> Result<Vec<Sheet>, CalibrationError> {
    let mut rows = vec![];
    for levels in [4, 5, 6, 8] {
        let mut draw = Draw::new(seed);
        let mut counted = Grids::default();
        for _ in 0..tables {
            counted.count(levels, draw.next()?)?;
        }
        rows.push(SheetRow::new(
            format!("{levels} levels"),
            true,
            counted.cells(),
        ));
    }
    let title = "Grids of h and dt at ±0.2: both orders of sound grids, a lower order that hides, a constant of 10 % of the finest error or more";
    Ok(vec![Sheet {
        key: "grids",
        title: title.to_owned(),
        rows,
    }])
}
