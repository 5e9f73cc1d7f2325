//! The reasons for verdicts: one list, with the words that every command, report and file uses.

mod mathematics;
mod rows;

use super::words::Verdict;
use rows::{ROWS, ReasonRow};

/// Where an error may come from that is that of the level before.
pub(super) const REPEATED: &str = "a stale file, or an argument that is not used?";

/// The reason for a verdict; each reason has one verdict.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, Hash, Default, serde::Serialize, serde::Deserialize,
)]
#[serde(into = "&'static str", try_from = "String")]
#[non_exhaustive]
pub enum Reason {
    /// The whole interval lies in the band about the order, the rates do not move away from it, and
    /// no lower order explains the errors better.
    #[default]
    Agrees,
    /// A level has no result: its case failed, or lacks this error.
    NoResult,
    /// An error is NaN or infinite.
    NonFiniteError,
    /// An error is negative, which no norm can be.
    NegativeError,
    /// The error does not fall on the finest refinement above the round-off floor.
    ErrorGrows,
    /// The rates fall away from the order on the finest refinements, and are still falling.
    FallsAway,
    /// The errors of a grid contain a part that does not tend to zero with h and dt.
    WrongLimit,
    /// The whole interval lies below the band.
    TooLow,
    /// The whole interval lies above the band: as suspicious as below.
    TooHigh,
    /// The order agrees, but the constant in front of it is outside its interval.
    ConstantOff,
    /// All errors are equal, in all digits.
    Identical,
    /// An error is exactly zero.
    ZeroError,
    /// The steps are not positive, finite and decreasing.
    StepsNotDecreasing,
    /// Nothing is claimed, so nothing is confirmed.
    NotClaimed,
    /// The order or the tolerance is not a positive number.
    ClaimUnusable,
    /// The tolerance accepts neighbouring orders.
    ToleranceTooWide,
    /// Fewer levels than a rate needs.
    TooFewLevels,
    /// The rates are still changing.
    NotAsymptotic,
    /// The rates move away, faster and faster.
    Departs,
    /// A term of lower order explains the errors far better than the order claimed.
    LowerOrderLikely,
    /// A rate is far from both its neighbours, which agree.
    Jump,
    /// Too few levels are left above the round-off floor.
    RoundOffFloor,
    /// Too few digits of the errors are known.
    Digits,
    /// The order agrees, but the constant in front of it may be outside its interval.
    ConstantUnsure,
    /// The numbers tend to a value that is not zero, by smaller and smaller differences.
    Value,
    /// It is too uncertain whether the errors of a grid tend to zero.
    LeftOver,
    /// All steps are nearly the same.
    LevelsTooClose,
    /// The interval is wider than the band and overlaps it, or the rates scatter so much that a
    /// growing error proves nothing.
    IntervalTooWide,
    /// The interval is narrow enough, but holds an end of the band.
    AtTheEdge,
    /// The whole interval lies more than an order above the order that is a lower bound.
    TooGood,
    /// An error is that of the level before, in all digits.
    Repeats,
    /// Every second rate is zero.
    Alternates,
    /// The errors are those of another column with a claim, in all digits.
    EqualColumns,
    /// No error is above round-off, if the solution is of size 1, and they do not fall.
    NothingTested,
    /// The finest errors are near the round-off of the solution: with a floor the claim passes.
    RoundOff,
    /// The scatter of its samples hides the error of a level.
    Samples,
}

impl From<Reason> for &'static str {
    fn from(reason: Reason) -> Self {
        reason.name()
    }
}

impl TryFrom<String> for Reason {
    type Error = String;

    fn try_from(code: String) -> Result<Self, String> {
        let row = ROWS.iter().find(|row| row.code == code);
        row.map(|row| row.reason)
            .ok_or_else(|| format!("unknown reason `{code}`"))
    }
}

impl Reason {
    /// Every reason, in the order of the enumeration.
    pub fn all() -> impl Iterator<Item = Self> {
        ROWS.iter().map(|row| row.reason)
    }

    /// The verdict that goes with this reason.
    pub fn verdict(self) -> Verdict {
        self.row().verdict
    }

    /// Whether what the errors tend to says more than the reason: where they do not fall as
    /// claimed.
    pub(super) fn is_about_the_errors(self) -> bool {
        self.wants_a_level()
            || matches!(
                self,
                Self::ErrorGrows | Self::FallsAway | Self::TooLow | Self::ZeroError
            )
    }

    /// Whether a finer level may decide.
    pub fn wants_a_level(self) -> bool {
        self.row().wants_a_level
    }

    /// Whether a failure for this reason is none of the rule's estimates, so that no finer level
    /// can take it back.
    pub fn is_final(self) -> bool {
        matches!(
            self,
            Self::NoResult | Self::NonFiniteError | Self::NegativeError
        )
    }

    /// The short code for looking up the reason: the same in every output.
    pub fn name(self) -> &'static str {
        self.row().code
    }

    /// The reason in words.
    pub fn text(self) -> &'static str {
        self.row().text
    }

    /// The reason in brief, as after a rate and its claim:
    /// `1.50 (1.48 to 1.52), claimed 2 ± 0.05: too low`.
    pub fn brief(self) -> &'static str {
        match self {
            Self::TooLow => "too low",
            Self::TooHigh => "too high",
            other => other.text(),
        }
    }

    /// What the reason means, and what to do next.
    pub fn advice(self) -> &'static str {
        self.row().advice
    }

    /// The mathematics of the reason, and what to try, most promising first.
    pub fn mathematics(self) -> &'static str {
        self.row().mathematics
    }

    /// The rows are in the order of the enumeration.
    fn row(self) -> &'static ReasonRow {
        &ROWS[self as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_reason_has_its_row() {
        for (place, reason) in Reason::all().enumerate() {
            assert_eq!(reason as usize, place, "{reason:?}");
            assert_eq!(Reason::try_from(reason.name().to_owned()), Ok(reason));
        }
        assert_eq!(Reason::Samples as usize + 1, ROWS.len());
    }
}
