//! Random numbers for tables, and why a calibration ends early.

use convergence_judge::{
    random::SplitMix,
    time_limit::{Patience, TimeUp},
};
use convergence_study::JudgeError;
use thiserror::Error;

use crate::sheet::Sheet;

/// Cost of judging a table, in elements advanced by a step: 65 µs against 25 ns.
pub const ELEMENTS_OF_A_TABLE: usize = 2600;

/// Why a calibration was not completed.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum CalibrationError {
    /// The rule cannot be set up as declared.
    #[error(transparent)]
    Judge(#[from] JudgeError),
    /// The case reached its time limit.
    #[error(transparent)]
    TimeUp(#[from] TimeUp),
}

/// What was counted.
pub(crate) type Counted = Result<Sheet, CalibrationError>;

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
