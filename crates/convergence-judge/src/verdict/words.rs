//! The three verdicts, and why a level is set aside.

use std::fmt;

/// Outcome of a check. Ordered from good to bad: the maximum of several outcomes is the outcome of
/// all. There will be no fourth one.
///
/// ```
/// use convergence_judge::Verdict;
///
/// assert_eq!(Verdict::worst([Verdict::Pass, Verdict::Fail]), Verdict::Fail);
/// assert_eq!(Verdict::worst([]), Verdict::Inconclusive);
/// ```
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize, serde::Deserialize,
)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// The claim holds.
    Pass,
    /// The data cannot tell. Not a pass.
    Inconclusive,
    /// The claim does not hold.
    Fail,
}

impl Verdict {
    /// The worst of several. Without any it is inconclusive: checking nothing proves nothing.
    #[must_use = "a verdict that is not read lets a wrong claim pass"]
    pub fn worst(verdicts: impl IntoIterator<Item = Self>) -> Self {
        verdicts.into_iter().max().unwrap_or(Self::Inconclusive)
    }

    /// Whether the claim holds.
    pub fn is_pass(self) -> bool {
        self == Self::Pass
    }

    /// `pass`, `fail` or `inconclusive`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Pass => "pass",
            Self::Inconclusive => "inconclusive",
            Self::Fail => "fail",
        }
    }
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// A level that is not used for the rate.
///
/// ```
/// use convergence_judge::{Aside, Claim, Floor, JudgeError, Level, SetAside};
///
/// // The finest error is round-off.
/// let errors = [(0.4, 1.6e-9), (0.2, 4e-10), (0.1, 1e-10), (0.05, 2e-11)];
/// let levels = errors.map(|(step, error)| Level { step, error });
/// let rate = Claim::new(2.0, 0.1).judge(&levels, Floor::new(5e-11)?);
/// assert_eq!(rate.set_aside, [SetAside::new(3, Aside::AtFloor)]);
/// # Ok::<(), JudgeError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
#[non_exhaustive]
pub struct SetAside {
    /// Index of the level, 0 the coarsest.
    pub level: usize,
    /// Why.
    pub because: Aside,
}

impl SetAside {
    /// The level of this index, set aside for this reason.
    pub fn new(level: usize, because: Aside) -> Self {
        Self { level, because }
    }
}

/// Why a level was set aside.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Aside {
    /// Coarse: the rates there are still too far from the finest one.
    #[serde(alias = "outlier")]
    PreAsymptotic,
    /// Coarse: five finer levels are used.
    BeyondFive,
    /// Fine: neither this error nor that of any finer level is above the floor.
    AtFloor,
    /// It has no result.
    NoResult,
}

impl Aside {
    /// The reason in words.
    pub fn text(self) -> &'static str {
        match self {
            Self::PreAsymptotic => "not yet asymptotic",
            Self::BeyondFive => "coarser than the five finest",
            Self::AtFloor => "at or below the floor",
            Self::NoResult => "no result",
        }
    }
}
