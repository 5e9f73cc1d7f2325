//! Where the order of a study is lost, as far as variants of its solution show it: plain data.

use serde::{Deserialize, Serialize};

use crate::study::variants::SolverPart;
use convergence_judge::verdict::RateVerdict;

/// What the variants of a study's solution show.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct WhereLost {
    /// The parts in which the order is lost; empty if nothing can be claimed.
    pub named: Vec<SolverPart>,
    /// The conclusion, in words.
    pub conclusion: String,
    /// All variants.
    pub variants: Vec<VariantRates>,
}

/// What became of the order in a variant.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Fate {
    /// It is there.
    Back,
    /// The errors are round-off: the order is not lost, and nothing follows for a name.
    RoundOff,
    /// It is lost there, too.
    Lost,
    /// The levels do not tell, or there is no such variant although the file has the part.
    Unknown,
}

/// A variant of a solution, and the rates with it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct VariantRates {
    /// Its name.
    pub name: String,
    /// What it switches off.
    pub switches_off: SolverPart,
    /// What became of the order, as its rates or those of other variants show.
    pub order: Fate,
    /// The rates of the errors whose order is lost in the study, first the one that decides; none
    /// for a variant that was not run: it cannot be used, or its order follows from others.
    pub rates: Vec<VariantRate>,
    /// Why it cannot be used.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub left_out: Option<String>,
    /// Its next level, such as `n = 128`; none for a variant that was not run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub next: Option<String>,
}

/// The rate of an error with a variant.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct VariantRate {
    /// The error.
    pub error: String,
    /// Its judgement.
    #[serde(flatten)]
    pub rate: RateVerdict,
}
