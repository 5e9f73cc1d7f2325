//! How often the error bars of values without exact solution hold the error, on the laws of [`laws`](super::laws).
//!
//! Each sample is a sequence of values `q_k = Q ± e_k`, Q uniform in [-1, 1], e_k one of the laws, at 3 to 8 steps with ratio 2, 3/2, 3 or drawn anew in
//! [1.4, 2.5] for every level. The order claimed is the one that the law shows on coarse levels, at a tolerance of 0.1.

use super::laws::{Group, LAWS, Law};
use super::{CalibrationError, ELEMENTS_OF_A_SAMPLE, LEVEL_COUNTS, Patience, SplitMix, share, steps};
use crate::judge::richardson::{Estimate, Estimator, Value};
use crate::judge::verdict::FEWEST_LEVELS;

/// Tolerance of the claims.
const TOLERANCE: f64 = 0.1;

/// Counts over a set of samples.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Tally {
    /// What the samples have in common.
    pub name: String,
    /// Whether bars are made for it.
    pub declared: bool,
    /// Samples.
    pub samples: usize,
    /// Bars that were given, and those of them that hold the error.
    pub bars: [usize; 2],
    /// The same of the grid convergence index.
    pub indices: [usize; 2],
    /// Samples with both, and how often bar and index hold the error there.
    pub both: [usize; 3],
    /// Half-widths of the bars, each as a share of the true error.
    widths: Vec<f64>,
    /// The same of the indices where there is a bar, too.
    index_widths: Vec<f64>,
}

impl Tally {
    fn named(name: &str, declared: bool) -> Self {
        Self { name: name.to_owned(), declared, ..Self::default() }
    }

    /// Share of the samples without a bar.
    pub fn refused(&self) -> f64 {
        1.0 - share(self.bars[0], self.samples)
    }

    /// Share of the bars that hold the error.
    pub fn coverage(&self) -> f64 {
        share(self.bars[1], self.bars[0])
    }

    /// Share of all indices that hold the error.
    pub fn index_coverage(&self) -> f64 {
        share(self.indices[1], self.indices[0])
    }

    /// Share of the indices that hold the error where there is a bar, too.
    pub fn index_coverage_beside(&self) -> f64 {
        share(self.both[2], self.both[0])
    }

    /// Median of the half-widths of the bars, in units of the true error.
    pub fn width(&self) -> f64 {
        median(&self.widths)
    }

    /// Median of the indices, in units of the true error.
    pub fn index_width(&self) -> f64 {
        median(&self.index_widths)
    }

    fn count(&mut self, estimate: &Estimate, error: f64) {
        self.samples += 1;
        let bar = estimate.bar.ok().map(|bar| bar.error_interval);
        let index = estimate.gci.ok().map(|gci| gci.half_width);
        let held = bar.map(|[low, high]| low <= error && error <= high);
        let indexed = index.map(|half| error.abs() <= half);
        for (counts, held) in [(&mut self.bars, held), (&mut self.indices, indexed)] {
            counts[0] += usize::from(held.is_some());
            counts[1] += usize::from(held == Some(true));
        }
        if let (Some([low, high]), Some(half)) = (bar, index) {
            self.both[0] += 1;
            self.both[1] += usize::from(held == Some(true));
            self.both[2] += usize::from(indexed == Some(true));
            self.widths.push(0.5 * (high - low) / error.abs());
            self.index_widths.push(half / error.abs());
        }
    }
}

fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied().unwrap_or(f64::NAN)
}

/// Outcome of [`calibrate_bars`].
#[derive(Debug, Clone, PartialEq)]
pub struct Bars {
    /// One tally for each law.
    pub laws: Vec<Tally>,
    /// The declared laws by number of values, 3 to 8.
    pub by_values: Vec<Tally>,
    /// All declared laws.
    pub declared: Tally,
}

/// Draws `samples` sequences of values from each law.
///
/// # Errors
/// [`CalibrationError`].
pub fn calibrate_bars(samples: usize, seed: u64) -> Result<Bars, CalibrationError> {
    let estimator = Estimator::new(TOLERANCE)?;
    let mut random = SplitMix::new(seed);
    let mut patience = Patience::new(ELEMENTS_OF_A_SAMPLE);
    let by_values = (0..LEVEL_COUNTS).map(|k| Tally::named(&format!("{} values", FEWEST_LEVELS + k), true));
    let mut bars = Bars {
        laws: LAWS.iter().map(|law| Tally::named(law.name, declared(law))).collect(),
        by_values: by_values.collect(),
        declared: Tally::named("all declared", true),
    };
    for k in 0..samples * LAWS.len() {
        patience.check(k, || k as f64)?;
        let law = &LAWS[k % LAWS.len()];
        let count = FEWEST_LEVELS + random.below(LEVEL_COUNTS);
        let steps = steps(&mut random, count);
        let table = law.draw_at(&steps, &mut random);
        let (limit, sign) = (random.within([-1.0, 1.0]), [1.0, -1.0][random.below(2)]);
        let value = |level: &super::Level| Value { step: level.step, value: limit + sign * level.error };
        let values: Vec<Value> = table.levels.iter().map(value).collect();
        let estimate = estimator.estimate(&values, table.shown);
        let error = sign * table.levels[count - 1].error;
        bars.laws[k % LAWS.len()].count(&estimate, error);
        if declared(law) {
            bars.by_values[count - FEWEST_LEVELS].count(&estimate, error);
            bars.declared.count(&estimate, error);
        }
    }
    Ok(bars)
}

fn declared(law: &Law) -> bool {
    law.group != Group::Stagnating
}
