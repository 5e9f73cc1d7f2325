//! The reasons for verdicts: one list, with the words that every command, report and file uses.

mod mathematics;

use super::words::Verdict;
use mathematics::{LOST_ORDER, NEXT_TERM, NO_ERROR, OTHER_CONSTANT, PLATEAU, ROUND_OFF, TOO_FAST};

/// The reason for a verdict; each reason has one verdict.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, Hash, Default, serde::Serialize, serde::Deserialize,
)]
#[serde(into = "&'static str", try_from = "String")]
#[non_exhaustive]
pub enum Reason {
    /// The whole interval lies in the band about the order.
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
}

impl From<Reason> for &'static str {
    fn from(reason: Reason) -> Self {
        reason.code()
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
    pub fn code(self) -> &'static str {
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

/// What is said about a reason.
struct ReasonRow {
    reason: Reason,
    verdict: Verdict,
    wants_a_level: bool,
    code: &'static str,
    text: &'static str,
    advice: &'static str,
    mathematics: &'static str,
}

static ROWS: [ReasonRow; 28] = [
    ReasonRow {
        reason: Reason::Agrees,
        verdict: Verdict::Pass,
        wants_a_level: false,
        code: "agrees",
        text: "the rate agrees with the order",
        advice: "The whole interval of the rate lies within the tolerance of the order.",
        mathematics: NEXT_TERM,
    },
    ReasonRow {
        reason: Reason::NoResult,
        verdict: Verdict::Fail,
        wants_a_level: false,
        code: "no-result",
        text: "a level has no result",
        advice: "A case failed, or its answer lacks the error. The rate is that of the levels that have \
              one; it decides nothing. Mend that case.",
        mathematics: NO_ERROR,
    },
    ReasonRow {
        reason: Reason::NonFiniteError,
        verdict: Verdict::Fail,
        wants_a_level: false,
        code: "non-finite",
        text: "an error is NaN or infinite",
        advice: "An error is NaN or infinite: a case broke down, or did not come to its end. Mend that \
              case.",
        mathematics: NO_ERROR,
    },
    ReasonRow {
        reason: Reason::NegativeError,
        verdict: Verdict::Fail,
        wants_a_level: false,
        code: "negative",
        text: "an error is negative",
        advice: "An error is negative, which no norm can be: a sign was lost, or a difference was given.",
        mathematics: NO_ERROR,
    },
    ReasonRow {
        reason: Reason::ErrorGrows,
        verdict: Verdict::Fail,
        wants_a_level: false,
        code: "grows",
        text: "the error does not fall on the finest refinement",
        advice: "Refining does not make the error smaller, though it is above the round-off floor: no \
              convergence. Are the levels those of these errors, and is the exact solution that of the \
              problem?",
        mathematics: LOST_ORDER,
    },
    ReasonRow {
        reason: Reason::FallsAway,
        verdict: Verdict::Fail,
        wants_a_level: false,
        code: "falls-away",
        text: "the rates fall away from the order",
        advice: "The finest rates fall, by more than half an order: the error tends to a limit that is \
              not zero, or to a lower order. Look for what does not change with the step: the \
              reference, the solver's tolerance, round-off (set a floor), the error of the other axis.",
        mathematics: PLATEAU,
    },
    ReasonRow {
        reason: Reason::WrongLimit,
        verdict: Verdict::Fail,
        wants_a_level: false,
        code: "limit",
        text: "the errors tend to a wrong limit",
        advice: "The errors fall with h and dt as claimed, towards a number that is not zero. Look for \
              what changes with neither: the reference, the solver's tolerance, a wrong coefficient, a \
              third step.",
        mathematics: PLATEAU,
    },
    ReasonRow {
        reason: Reason::TooLow,
        verdict: Verdict::Fail,
        wants_a_level: false,
        code: "too-low",
        text: "the rate is too low",
        advice: "The whole interval lies below the band: an order is lost. Look for a term of lower \
              order: boundary or initial data, the quadrature, the first step, a coefficient at the \
              wrong time.",
        mathematics: LOST_ORDER,
    },
    ReasonRow {
        reason: Reason::TooHigh,
        verdict: Verdict::Fail,
        wants_a_level: false,
        code: "too-high",
        text: "the rate is too high",
        advice: "The whole interval lies above the band: the exact solution may be too simple, or the \
              error not the one that was meant.",
        mathematics: TOO_FAST,
    },
    ReasonRow {
        reason: Reason::ConstantOff,
        verdict: Verdict::Fail,
        wants_a_level: false,
        code: "constant",
        text: "the constant is outside its interval",
        advice: "The order agrees, and the error is a multiple of the one claimed: a mistake of the \
              scheme's own order, such as a factor in a term or in the norm.",
        mathematics: OTHER_CONSTANT,
    },
    ReasonRow {
        reason: Reason::ZeroError,
        verdict: Verdict::Inconclusive,
        wants_a_level: false,
        code: "zero",
        text: "an error of exactly zero carries no rate",
        advice: "An error of exactly zero has no logarithm: the solution lies in the discrete space. \
              Choose another one, or claim that it is exact.",
        mathematics: TOO_FAST,
    },
    ReasonRow {
        reason: Reason::StepsNotDecreasing,
        verdict: Verdict::Inconclusive,
        wants_a_level: false,
        code: "steps",
        text: "the step sizes are not positive and decreasing",
        advice: "Levels must be given coarse to fine, each once.",
        mathematics: NEXT_TERM,
    },
    ReasonRow {
        reason: Reason::NotClaimed,
        verdict: Verdict::Inconclusive,
        wants_a_level: false,
        code: "unclaimed",
        text: "no order is claimed",
        advice: "Where no order is claimed, none is confirmed. Claim what theory says.",
        mathematics: NEXT_TERM,
    },
    ReasonRow {
        reason: Reason::ClaimUnusable,
        verdict: Verdict::Inconclusive,
        wants_a_level: false,
        code: "claim",
        text: "the order and the tolerance must be positive numbers",
        advice: "The order and the tolerance must be positive numbers.",
        mathematics: NEXT_TERM,
    },
    ReasonRow {
        reason: Reason::ToleranceTooWide,
        verdict: Verdict::Inconclusive,
        wants_a_level: false,
        code: "tolerance",
        text: "the tolerance is too wide to tell anything",
        advice: "Half an order or more on either side accepts two integer orders. Claim more narrowly.",
        mathematics: NEXT_TERM,
    },
    ReasonRow {
        reason: Reason::TooFewLevels,
        verdict: Verdict::Inconclusive,
        wants_a_level: true,
        code: "levels",
        text: "too few levels",
        advice: "A rate with an interval needs three levels above the round-off floor; four or more make \
              the interval narrow.",
        mathematics: NEXT_TERM,
    },
    ReasonRow {
        reason: Reason::NotAsymptotic,
        verdict: Verdict::Inconclusive,
        wants_a_level: true,
        code: "asymptotic",
        text: "not yet asymptotic",
        advice: "The rates are still changing. Add finer levels; where they scatter, take an error that \
              does not change its sign.",
        mathematics: LOST_ORDER,
    },
    ReasonRow {
        reason: Reason::Departs,
        verdict: Verdict::Inconclusive,
        wants_a_level: true,
        code: "departs",
        text: "the rates move away",
        advice: "The rates change more and more: a term of lower order, or a wrong limit, is about to \
              show. Add a finer level; look for what does not change with the step: the reference, the \
              solver's tolerance, the error of the other axis.",
        mathematics: PLATEAU,
    },
    ReasonRow {
        reason: Reason::LowerOrderLikely,
        verdict: Verdict::Inconclusive,
        wants_a_level: true,
        code: "lower-order",
        text: "a lower order may hide in the scatter",
        advice: "A term of lower order explains the errors five times as well as the order claimed. Add finer \
              levels, where it shows or does not, or take errors that scatter less: a tighter tolerance of \
              the solver, the mean over shifted meshes.",
        mathematics: LOST_ORDER,
    },
    ReasonRow {
        reason: Reason::Jump,
        verdict: Verdict::Inconclusive,
        wants_a_level: false,
        code: "jump",
        text: "a rate does not belong to its neighbours",
        advice: "One rate is far from those before and after it, which agree: another table begins there, the \
              unit changes, or a level is wrong. Judge the parts by themselves, or mend that level.",
        mathematics: NEXT_TERM,
    },
    ReasonRow {
        reason: Reason::RoundOffFloor,
        verdict: Verdict::Inconclusive,
        wants_a_level: false,
        code: "floor",
        text: "at the round-off floor",
        advice: "Errors so small are taken for round-off. Add coarser levels, or set a lower floor where \
              they are known better.",
        mathematics: ROUND_OFF,
    },
    ReasonRow {
        reason: Reason::Digits,
        verdict: Verdict::Inconclusive,
        wants_a_level: false,
        code: "digits",
        text: "too few digits",
        advice: "The errors are given with too few digits for a rate that is known so well. Print more of \
              them.",
        mathematics: ROUND_OFF,
    },
    ReasonRow {
        reason: Reason::ConstantUnsure,
        verdict: Verdict::Inconclusive,
        wants_a_level: true,
        code: "constant-edge",
        text: "the constant may be outside its interval",
        advice: "The order agrees, and the interval of the constant holds an end of the one claimed. Add a finer level, or claim less narrowly.",
        mathematics: OTHER_CONSTANT,
    },
    ReasonRow {
        reason: Reason::Value,
        verdict: Verdict::Inconclusive,
        wants_a_level: false,
        code: "value",
        text: "a value, not an error",
        advice: "The numbers tend to a value: they are no errors. Judge their differences, or subtract \
              the exact value.",
        mathematics: PLATEAU,
    },
    ReasonRow {
        reason: Reason::LeftOver,
        verdict: Verdict::Inconclusive,
        wants_a_level: true,
        code: "left-over",
        text: "h and dt may leave a part of the errors",
        advice: "Both orders agree, and do not explain the finest error. Add finer levels: either it is a \
              limit that is not zero, or the rates are not known well enough.",
        mathematics: PLATEAU,
    },
    ReasonRow {
        reason: Reason::LevelsTooClose,
        verdict: Verdict::Inconclusive,
        wants_a_level: true,
        code: "close",
        text: "the levels are too close to each other",
        advice: "The coarsest step is less than 1.5 times the finest: a term of lower order would not \
              show. Refine further.",
        mathematics: NEXT_TERM,
    },
    ReasonRow {
        reason: Reason::IntervalTooWide,
        verdict: Verdict::Inconclusive,
        wants_a_level: true,
        code: "wide",
        text: "the interval is too wide for the tolerance",
        advice: "The errors leave their order open by more than this tolerance: they scatter, or approach \
              it slowly. Add levels, take an error that does not change its sign, or claim less narrowly.",
        mathematics: NEXT_TERM,
    },
    ReasonRow {
        reason: Reason::AtTheEdge,
        verdict: Verdict::Inconclusive,
        wants_a_level: true,
        code: "edge",
        text: "the interval crosses the edge of the tolerance",
        advice: "The interval is narrow, but holds an end of the band: the claim is neither confirmed nor \
              refuted.",
        mathematics: NEXT_TERM,
    },
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_reason_has_its_row() {
        for (place, reason) in Reason::all().enumerate() {
            assert_eq!(reason as usize, place, "{reason:?}");
            assert_eq!(Reason::try_from(reason.code().to_owned()), Ok(reason));
        }
        assert_eq!(Reason::AtTheEdge as usize + 1, ROWS.len());
    }
}
