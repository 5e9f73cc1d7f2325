#![doc = include_str!("../README.md")]

// The modules are for the harness; the root has the items for users.
#[doc(hidden)]
pub mod adjoint;
#[doc(hidden)]
pub mod claims;
#[doc(hidden)]
pub mod fit;
#[doc(hidden)]
pub mod grid;
#[doc(hidden)]
pub mod interval;
#[doc(hidden)]
pub mod random;
#[doc(hidden)]
pub mod richardson;
#[doc(hidden)]
pub mod shown;
#[doc(hidden)]
pub mod taylor;
#[cfg(test)]
mod tests;
mod three_values;
#[doc(hidden)]
pub mod time_limit;
#[doc(hidden)]
pub mod verdict;

/// Numbers, columns and names as text, for the harness.
#[doc(hidden)]
pub mod text {
    pub mod columns;
    pub mod json;
    pub mod lists;
    pub mod named;
    #[cfg(feature = "names")]
    pub mod names;
    pub mod number;
    pub mod prose;
    pub mod section;
    pub mod visible;
}

#[doc = include_str!("verdict/RULE.md")]
pub mod rule {}

#[doc(inline)]
pub use crate::{
    claims::{Bound, Claim},
    fit::{LineFit, RateInterval, fit_line, pairwise_rates, rate_interval},
    grid::{Adding, GridErrors, SpaceTime},
    interval::Interval,
    richardson::{Bar, Estimate, Estimator, Gci, NoErrorBar, StepValue},
    text::prose::Prose,
    verdict::{
        Aside, Band, Cause, DEFAULT_TOLERANCE, FEWEST_LEVELS, Floor, JudgeError, Level, Of,
        PowerLaw, RateVerdict, Reading, Reason, Samples, SetAside, Tendency, Verdict,
        WIDEST_TOLERANCE, judge, judge_pairs, observe,
    },
};
