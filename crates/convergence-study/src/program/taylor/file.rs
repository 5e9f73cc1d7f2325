//! Files of the kind `taylor`.

use std::path::Path;

use schemars::JsonSchema;
use serde::Deserialize;

use super::super::launch::LaunchKeys;
use super::{StepCase, Taylor};
use crate::input::{Count, Number, Positive, Range, Refusal};
use crate::taylor::{DIRECTIONS, FARTHEST};
use convergence_judge::taylor::DEFAULT_TO;

/// A test of derivatives that a program computes.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct TaylorFile {
    /// what is run
    program: LaunchKeys,
    /// the steps, and how exact the derivatives must be
    #[serde(default)]
    taylor: TaylorTable,
}

/// The table `[taylor]`.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct TaylorTable {
    /// the coarsest step, a tenth of the size of m for a direction of length 1; without it 0.1
    eps: Option<Positive>,
    /// how many directions are tested; without it 3 if the program receives the seed, otherwise 1
    directions: Option<Count<1, 100>>,
    /// whether the program also answers `d2J`, the second derivative along the direction
    #[serde(default)]
    second: bool,
    /// the part of a derivative by which it may be off; without it 1e-6
    to: Option<Number<Part>>,
}

/// A part of one would allow any derivative.
#[derive(Debug, Clone, Copy)]
enum Part {}

impl Range for Part {
    const ENDS: &'static [(&'static str, f64)] =
        &[("exclusiveMinimum", 0.0), ("exclusiveMaximum", 1.0)];
}

impl TaylorFile {
    /// The study.
    ///
    /// * `folder`: the folder of the file.
    pub(super) fn taylor(self, folder: &Path) -> Result<Taylor, Refusal> {
        let TaylorTable {
            eps,
            directions,
            second,
            to,
        } = self.taylor;
        let values = StepCase {
            seed: 1,
            eps: FARTHEST,
            is_again: false,
        }
        .parameters();
        let launch = self
            .program
            .launch(folder, &values)
            .map_err(Refusal::within("program"))?;
        if !launch.tells("eps", &values) {
            let allowed = "a command with the placeholder {eps}, or without any";
            return Err(Refusal::written("program.command", allowed));
        }
        let has_seed = launch.tells("seed", &values);
        if directions.is_some_and(|count| count.get() > 1) && !has_seed {
            let allowed = "1, or {seed} in the command, by which the program draws the direction";
            return Err(Refusal::written("taylor.directions", allowed));
        }
        let usual = if has_seed { DIRECTIONS } else { 1 };
        Ok(Taylor {
            launch,
            coarsest: eps.map_or(FARTHEST, Positive::get),
            directions: directions.map_or(usual, Count::get),
            has_seed,
            second,
            to: to.map_or(DEFAULT_TO, Number::get),
        })
    }
}
