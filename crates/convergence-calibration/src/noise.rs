//! Limits of values whose errors scatter by 2 %: how often their interval holds the limit.

use convergence_judge::verdict::FEWEST_LEVELS;
use convergence_study::{CaseFailure, Estimator, StepValue};

use crate::draw::Draw;
use crate::intervals::LEVEL_COUNTS;
use crate::sheet::{Sheet, SheetRow};

/// The sheet *noise*. Second order is claimed, with a tolerance of 0.1.
///
/// * `tables`: number of sequences of values for each number of values.
///
/// # Errors
/// [`CaseFailure`] if the rule cannot be set up as declared, or the time is up.
pub fn of_noise(tables: usize, seed: u64) -> Result<Vec<Sheet>, CaseFailure> {
    let estimator = Estimator::new(0.1)?;
    let mut draw = Draw::new(seed);
    let mut rows = vec![];
    for count in FEWEST_LEVELS..FEWEST_LEVELS + LEVEL_COUNTS {
        let columns = ["refused", "interval holds the limit"];
        let mut row = SheetRow::new(format!("{count} values"), true, &columns);
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
            row.count("refused", bar.is_err());
            if let Ok(bar) = bar {
                row.count("interval holds the limit", bar.limit.holds(1.0));
            }
        }
        rows.push(row);
    }
    let title = "Limits of values of second order whose errors scatter by 2 %, steps halved";
    Ok(vec![Sheet {
        key: "noise",
        title: title.to_owned(),
        rows,
    }])
}
