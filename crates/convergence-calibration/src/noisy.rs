//! A lower order under noise, and the same errors without it: what scatter hides, and what it costs
//! not to be deceived by it.
//!
//! The laws were written, and their numbers fixed, before the rule looked at them.

use convergence_judge::{fit::Level, random::SplitMix, verdict::DEFAULT_TOLERANCE};
use convergence_study::Verdict;

use crate::draw::{Counted, Draw};
use crate::judge;
use crate::sheet::{Sheet, SheetRow};

/// Standard deviations of log e.
const NOISES: [f64; 4] = [0.0, 0.003, 0.01, 0.03];
/// Numbers of levels, steps halved. 6 came last, so that the tables of the others stay as they
/// were.
const LEVELS: [usize; 4] = [4, 5, 8, 6];
/// The part of the finest error that the term of lower order makes up.
const SHARE: f64 = 0.1;

/// Errors `h^p (1 + a h^r) e^(σ N)`: p in [1.5, 4], r in [1, 4], a = 0 in half of the tables and
/// |a| < 0.5 in the other; `lower`: with a term b h^(p-1) of a tenth of the finest error.
struct NoisyErrors {
    p: f64,
    levels: Vec<Level>,
}

fn errors(levels: usize, noise: f64, lower: bool, random: &mut SplitMix) -> NoisyErrors {
    let p = random.within([1.5, 4.0]);
    let r = random.within([1.0, 4.0]);
    let a = [0.0, random.within([-0.5, 0.5])][random.below(2)];
    let main = |h: f64| h.powf(p) * (1.0 + a * h.powf(r));
    let finest = 0.5_f64.powi(levels as i32 - 1);
    let share = if lower { SHARE } else { 0.0 };
    let b = main(finest) * share / (1.0 - share) / finest.powf(p - 1.0);
    let levels = (0..levels).map(|k| {
        let step = 0.5_f64.powi(k as i32);
        let error = (main(step) + b * step.powf(p - 1.0)) * (noise * random.normal()).exp();
        Level { step, error }
    });
    NoisyErrors {
        p,
        levels: levels.collect(),
    }
}

/// How often a hidden order passes, and the true one does, by noise and number of levels, at the
/// default tolerance.
///
/// * `tables`: for each noise and number of levels.
pub(crate) fn noisy(tables: usize, draw: &mut Draw) -> Counted {
    let judge = judge(DEFAULT_TOLERANCE)?;
    let mut rows = vec![];
    for levels in LEVELS {
        for noise in NOISES {
            let name = format!("{levels} levels, noise {} %", 100.0 * noise);
            let columns = ["hidden order passes", "true pass", "true fail"];
            let mut row = SheetRow::new(name, true, &columns);
            for _ in 0..tables {
                let NoisyErrors { p, levels: lower } = errors(levels, noise, true, draw.next()?);
                let hidden = judge.decide(&judge.read(&lower), p);
                row.count("hidden order passes", hidden.is_pass());
                let NoisyErrors { p, levels: plain } = errors(levels, noise, false, draw.next()?);
                let verdict = judge.decide(&judge.read(&plain), p);
                row.count("true pass", verdict.is_pass());
                row.count("true fail", verdict == Verdict::Fail);
            }
            rows.push(row);
        }
    }
    Ok(Sheet {
        key: "noisy",
        title: "Share of tables that pass although a lower order makes up a tenth of the finest error, and of sound ones, by \
                the noise, ±0.25"
            .to_owned(),
        rows,
    })
}
