#![doc = include_str!("../README.md")]

#[doc(hidden)]
pub mod interval;
#[doc(hidden)]
pub mod time_limit;

/// From steps and errors to a rate with an interval, and from a rate and a claim to a verdict: all
/// items, for the harness; the root of the crate has those for users.
#[doc(hidden)]
pub mod judge {
    pub mod adjoint;
    pub mod claims;
    pub mod fit;
    pub mod grid;
    pub mod random;
    pub mod richardson;
    pub mod shown;
    pub mod taylor;
    mod three_values;
    pub mod verdict;
}

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

#[doc = include_str!("judge/verdict/RULE.md")]
pub mod rule {}

#[doc(inline)]
pub use interval::Interval;
#[doc(inline)]
pub use judge::{
    claims::{Bound, Claim},
    fit::{LineFit, RateInterval, fit_line, pairwise_rates, rate_interval},
    grid::{Adding, GridErrors, SpaceTime},
    richardson::{Bar, Estimate, Estimator, Gci, NoErrorBar, StepValue},
    verdict::{
        Aside, Band, Cause, DEFAULT_TOLERANCE, FEWEST_LEVELS, Floor, JudgeError, Level, Of,
        PowerLaw, RateVerdict, Reading, Reason, Samples, SetAside, Tendency, Verdict,
        WIDEST_TOLERANCE, judge, judge_pairs, observe,
    },
};
#[doc(inline)]
pub use text::prose::Prose;
