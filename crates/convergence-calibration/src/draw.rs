//! Random numbers for tables, and what is counted of them.

use convergence_judge::{
    random::SplitMix,
    time_limit::{Patience, TimeUp},
};
use convergence_study::CaseFailure;

use crate::sheet::Sheet;

/// Cost of judging a table, in elements advanced by a step: 65 µs against 25 ns.
pub const ELEMENTS_OF_A_TABLE: usize = 2600;

/// What was counted.
pub(crate) type Counted = Result<Sheet, CaseFailure>;

/// Random numbers; the clock is checked for each table.
pub(crate) struct Draw {
    random: SplitMix,
    patience: Patience,
    drawn: usize,
}

impl Draw {
    pub(crate) fn new(seed: u64) -> Self {
        Self {
            random: SplitMix::new(seed),
            patience: Patience::new(ELEMENTS_OF_A_TABLE),
            drawn: 0,
        }
    }

    pub(crate) fn next(&mut self) -> Result<&mut SplitMix, TimeUp> {
        self.patience.check(self.drawn, || self.drawn as f64)?;
        self.drawn += 1;
        Ok(&mut self.random)
    }
}
