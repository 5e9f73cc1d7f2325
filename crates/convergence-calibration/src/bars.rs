//! Error bars of values whose limit is known: how often they hold the error, alongside the grid
//! convergence index.

use convergence_judge::judge::verdict::FEWEST_LEVELS;
use convergence_study::{Estimator, Interval, StepValue};

use crate::draw::{CalibrationError, Draw};
use crate::intervals::{ALL, LEVEL_COUNTS, is_declared, steps};
use crate::laws::LAWS;
use crate::sheet::{HitShare, Sheet, SheetCell, SheetRow};

/// Laws that bars are not made for: chance makes up a tenth of the error or more on every level.
const NO_BAR: [&str; 5] = [
    "h^p |1 - a h^r|, a 1 to 30",
    "h^p (1 ± a), odd and even",
    "h^p (1 + a cos)",
    "noise 30 %",
    "one outlier, up to a factor of 3",
];

/// How often bars and indices hold the true error, and their half-widths in units of it.
#[derive(Debug, Clone, Default)]
struct Bars {
    refused: HitShare,
    bar_holds: HitShare,
    index_holds: HitShare,
    bar_lengths: Vec<f64>,
    index_lengths: Vec<f64>,
}

impl Bars {
    /// * `error`: the true error.
    fn count(&mut self, bar: Option<Interval>, index: Option<f64>, error: f64) {
        self.refused.count(bar.is_none());
        let Some(bar) = bar else { return };
        self.bar_holds.count(bar.holds(error));
        if let Some(half) = index {
            self.index_holds.count(error.abs() <= half);
            self.bar_lengths.push(0.5 * bar.width() / error.abs());
            self.index_lengths.push(half / error.abs());
        }
    }

    fn cells(&self) -> Vec<SheetCell> {
        vec![
            self.refused.cell("refused"),
            self.bar_holds.cell("bar holds it"),
            self.index_holds.cell("index holds it"),
            SheetCell {
                column: "half-width of the bar".to_owned(),
                value: median(&self.bar_lengths),
            },
            SheetCell {
                column: "of the index".to_owned(),
                value: median(&self.index_lengths),
            },
        ]
    }
}

fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied().unwrap_or(f64::NAN)
}

/// The sheets of error bars: *bars*, *noise*. The order claimed is the one that a law shows on
/// coarse levels, with a tolerance of 0.1.
///
/// * `tables`: number of sequences of values for each law.
///
/// # Errors
/// [`CalibrationError`].
pub fn of_the_bars(tables: usize, seed: u64) -> Result<Vec<Sheet>, CalibrationError> {
    let estimator = Estimator::new(0.1)?;
    let mut draw = Draw::new(seed);
    let mut of_laws = vec![Bars::default(); LAWS.len()];
    let mut of_counts = vec![Bars::default(); LEVEL_COUNTS];
    let mut of_all = Bars::default();
    for k in 0..tables * LAWS.len() {
        let (law, random) = (&LAWS[k % LAWS.len()], draw.next()?);
        let count = FEWEST_LEVELS + random.below(LEVEL_COUNTS);
        let table = law.draw_at(&steps(random, count), random);
        let limit = random.within([-1.0, 1.0]);
        let sign = [1.0, -1.0][random.below(2)];
        let mut values = vec![];
        for level in &table.levels {
            values.push(StepValue {
                step: level.step,
                value: limit + sign * level.error,
            });
        }
        let estimate = estimator.estimate(&values, table.shown);
        let bar = estimate.bar.ok().map(|bar| bar.error_interval);
        let index = estimate.gci.ok().map(|gci| gci.half_width);
        let error = sign * table.levels[count - 1].error;
        of_laws[k % LAWS.len()].count(bar, index, error);
        if is_declared(law, &NO_BAR) {
            of_counts[count - FEWEST_LEVELS].count(bar, index, error);
            of_all.count(bar, index, error);
        }
    }
    let title = "Error bars and grid convergence index on values of known limit: how often they hold the true error; half-widths are medians, as shares of it";
    let mut rows = vec![];
    for (law, bars) in LAWS.iter().zip(&of_laws) {
        rows.push(SheetRow::new(
            law.name,
            is_declared(law, &NO_BAR),
            bars.cells(),
        ));
    }
    for (count, bars) in (FEWEST_LEVELS..).zip(&of_counts) {
        rows.push(SheetRow::new(format!("{count} values"), true, bars.cells()));
    }
    rows.push(SheetRow::new(ALL, true, of_all.cells()));
    let bars = Sheet {
        key: "bars",
        title: title.to_owned(),
        rows,
    };
    Ok(vec![bars, noise(&estimator, 10 * tables, &mut draw)?])
}

/// Limits of values whose errors scatter by 2 %.
fn noise(estimator: &Estimator, tables: usize, draw: &mut Draw) -> Result<Sheet, CalibrationError> {
    let mut rows = vec![];
    for count in FEWEST_LEVELS..FEWEST_LEVELS + LEVEL_COUNTS {
        let mut refused = HitShare::default();
        let mut holds = HitShare::default();
        for _ in 0..tables {
            let random = draw.next()?;
            let mut values = vec![];
            for k in 0..count {
                let step = 0.5_f64.powi(k as i32 + 1);
                values.push(StepValue {
                    step,
                    value: 1.0 + step * step * (1.0 + 0.02 * random.normal()),
                });
            }
            let bar = estimator.estimate(&values, 2.0).bar;
            refused.count(bar.is_err());
            if let Ok(bar) = bar {
                holds.count(bar.limit.holds(1.0));
            }
        }
        let cells = vec![
            refused.cell("refused"),
            holds.cell("interval holds the limit"),
        ];
        rows.push(SheetRow::new(format!("{count} values"), true, cells));
    }
    let title = "Limits of values of second order whose errors scatter by 2 %, steps halved";
    Ok(Sheet {
        key: "noise",
        title: title.to_owned(),
        rows,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_median_of_nothing_is_none_and_each_law_that_is_excepted_is_a_law() {
        assert!(median(&[]).is_nan());
        assert_eq!(median(&[4.0, 1.0, 2.0]), 2.0);
        assert!(
            NO_BAR
                .iter()
                .all(|name| LAWS.iter().any(|law| law.name == *name))
        );
    }
}
