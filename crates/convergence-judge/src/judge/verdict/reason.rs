//! The reasons for verdicts: one list, with the words that every command, report and file uses.

use super::words::Verdict;

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
        // Records of earlier versions have codes of vetoes that the rule no longer has.
        let is_earlier = ["wild", "outlier", "last-pair"].contains(&code.as_str());
        let code = if is_earlier {
            Self::NotAsymptotic.code()
        } else {
            &code
        };
        Self::ALL
            .into_iter()
            .find(|reason| reason.code() == code)
            .ok_or_else(|| format!("unknown reason `{code}`"))
    }
}

impl Reason {
    /// Every reason, for listing.
    pub const ALL: [Self; 28] = [
        Self::Agrees,
        Self::NoResult,
        Self::NonFiniteError,
        Self::NegativeError,
        Self::ErrorGrows,
        Self::FallsAway,
        Self::WrongLimit,
        Self::TooLow,
        Self::TooHigh,
        Self::ConstantOff,
        Self::ZeroError,
        Self::StepsNotDecreasing,
        Self::NotClaimed,
        Self::ClaimUnusable,
        Self::ToleranceTooWide,
        Self::TooFewLevels,
        Self::NotAsymptotic,
        Self::Departs,
        Self::LowerOrderLikely,
        Self::Jump,
        Self::RoundOffFloor,
        Self::Digits,
        Self::ConstantUnsure,
        Self::Value,
        Self::LeftOver,
        Self::LevelsTooClose,
        Self::IntervalTooWide,
        Self::AtTheEdge,
    ];

    /// The verdict that goes with this reason.
    pub fn verdict(self) -> Verdict {
        match self {
            Self::Agrees => Verdict::Pass,
            Self::NoResult
            | Self::NonFiniteError
            | Self::NegativeError
            | Self::ErrorGrows
            | Self::FallsAway
            | Self::WrongLimit
            | Self::TooLow
            | Self::TooHigh
            | Self::ConstantOff => Verdict::Fail,
            Self::ZeroError
            | Self::StepsNotDecreasing
            | Self::NotClaimed
            | Self::ClaimUnusable
            | Self::ToleranceTooWide
            | Self::TooFewLevels
            | Self::NotAsymptotic
            | Self::Departs
            | Self::LowerOrderLikely
            | Self::Jump
            | Self::RoundOffFloor
            | Self::Digits
            | Self::ConstantUnsure
            | Self::Value
            | Self::LeftOver
            | Self::LevelsTooClose
            | Self::IntervalTooWide
            | Self::AtTheEdge => Verdict::Inconclusive,
        }
    }

    /// Whether what the errors tend to says more than the reason: where they do not fall as claimed.
    pub(super) fn is_about_the_errors(self) -> bool {
        self.wants_a_level()
            || matches!(
                self,
                Self::ErrorGrows | Self::FallsAway | Self::TooLow | Self::ZeroError
            )
    }

    /// Whether a finer level would probably decide.
    pub fn wants_a_level(self) -> bool {
        matches!(
            self,
            Self::TooFewLevels
                | Self::NotAsymptotic
                | Self::Departs
                | Self::LowerOrderLikely
                | Self::LeftOver
                | Self::ConstantUnsure
                | Self::LevelsTooClose
                | Self::IntervalTooWide
                | Self::AtTheEdge
        )
    }

    /// Whether a failure for this reason is none of the rule's estimates, so that no finer level can
    /// take it back.
    pub fn is_final(self) -> bool {
        matches!(
            self,
            Self::NoResult | Self::NonFiniteError | Self::NegativeError
        )
    }

    /// The short code for looking up the reason: the same in every output.
    pub fn code(self) -> &'static str {
        self.words()[0]
    }

    /// The reason in words.
    pub fn text(self) -> &'static str {
        self.words()[1]
    }

    /// What the reason means, and what to do next.
    pub fn advice(self) -> &'static str {
        self.words()[2]
    }

    /// The mathematics of the reason, and what to try, most promising first.
    pub fn mathematics(self) -> &'static str {
        match self {
            Self::TooLow | Self::ErrorGrows | Self::NotAsymptotic | Self::LowerOrderLikely => {
                "The error is e(h) = C h^p + D h^q + ...; the rate between two steps tends to the smallest exponent with a coefficient \
                 that is not zero. What is lost tells what is wrong. Half an order: a singular solution, a boundary or initial layer, \
                 data that do not match at a corner, a maximum norm. One order: a term at the wrong time level or point, a one-sided \
                 difference at the boundary, a rule that is too weak for the load, a derivative measured in place of the function, a \
                 first step of lower order repeated at every restart. All of it, a rate of 0: a term is missing or has the wrong sign or \
                 coefficient, so that e tends to a constant. A rate below 0: the scheme is unstable. To try, in this order: one level \
                 coarser and one finer; the other errors of the same run, for the field that lost most is next to the cause; terms \
                 switched off one by one, until the order is back; a solution that is a polynomial in the discrete space, whose error \
                 must be round-off; the residual of the exact solution in the discrete equations."
            }
            Self::FallsAway | Self::Departs | Self::WrongLimit | Self::LeftOver | Self::Value => {
                "A plateau: e(h) = |E + C h^p| with E that does not depend on h. The rates are p - log2 of something that doubles 2^p \
                 times as fast as the error falls: they leave p within one or two levels, then are 0. E is what does not change with the \
                 step. To try, in this order: a tenth of the solver's tolerance (E falls with it); the other step halved (E falls by its \
                 order: isolate the axis, or couple the steps); a finer reference; double precision, where the plateau rises again as \
                 h falls, like 1/h or 1/h^2: round-off. If nothing moves E, it is a wrong coefficient: e(h) - e(h/2) still has order p."
            }
            Self::TooHigh | Self::ZeroError => {
                "A scheme converges faster than its order only where the leading coefficient C vanishes: by symmetry, on an equidistant \
                 mesh, at points of superconvergence, for a polynomial, or before the coarse levels resolve the solution (D h^q with \
                 q > p is still larger). To try: a solution without symmetry; a mapped or perturbed mesh; a norm that is not taken at \
                 nodes; finer levels, until C h^p is the larger one. If it stays, claim the higher order."
            }
            Self::ConstantOff | Self::ConstantUnsure => {
                "e(h) = C h^p with the right p: what is wrong is itself of order p. A factor 2 in C is a weight of a quadrature or a half \
                 of a coefficient; a factor 2^p a step taken for its half; anything else a norm that is another one. To try: the same \
                 level by hand, or by an independent program; the local truncation error, term by term."
            }
            Self::NoResult | Self::NonFiniteError | Self::NegativeError => {
                "No rate can be had from what is no error. A run that breaks down on coarse levels alone meets a step restriction \
                 (dt <= C h or C h^2); on fine ones alone a lost pivot, a Jacobian that is not the derivative, or a tolerance below \
                 round-off; on all levels an instability or missing data. To try: the first step of the coarsest failing level; the same \
                 with a tenth of dt; the energy step by step, which shows the step at which it begins."
            }
            Self::RoundOffFloor | Self::Digits => {
                "Subtraction leaves an error of about 1e-16 times the condition of the problem, which grows like 1/h or 1/h^2: the sum \
                 C h^p + eps/h^k has a minimum, and levels beyond it say nothing. To try: coarser levels; a larger solution error by \
                 a less smooth solution; more digits in the output."
            }
            _ => {
                "From levels h_1 > h_2 > ... the rate at h -> 0 is fitted, with the next term of e(h) = C h^p (1 + a h^r) unknown: the \
                 interval holds every p that some such law gives. It narrows like the finest h^r, and with the number of levels. To \
                 try: a finer level, which is worth more than three coarse ones; steps in one fixed ratio; an error without changes \
                 of sign; then a wider tolerance, below half an order."
            }
        }
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

    /// Code, reason and advice.
    #[expect(clippy::too_many_lines, reason = "a table")]
    fn words(self) -> [&'static str; 3] {
        match self {
            Self::Agrees => [
                "agrees",
                "the rate agrees with the order",
                "The whole interval of the rate lies within the tolerance of the order.",
            ],
            Self::NoResult => [
                "no-result",
                "a level has no result",
                "A case failed, or its answer lacks the error. The rate is that of the levels that have \
                 one; it decides nothing. Mend that case.",
            ],
            Self::NonFiniteError => [
                "non-finite",
                "an error is NaN or infinite",
                "An error is NaN or infinite: a case broke down, or did not come to its end. Mend that \
                 case.",
            ],
            Self::NegativeError => [
                "negative",
                "an error is negative",
                "An error is negative, which no norm can be: a sign was lost, or a difference was given.",
            ],
            Self::ErrorGrows => [
                "grows",
                "the error does not fall on the finest refinement",
                "Refining does not make the error smaller, though it is above the round-off floor: no \
                 convergence. Are the levels those of these errors, and is the exact solution that of the \
                 problem?",
            ],
            Self::FallsAway => [
                "falls-away",
                "the rates fall away from the order",
                "The finest rates fall, by more than half an order: the error tends to a limit that is \
                 not zero, or to a lower order. Look for what does not change with the step: the \
                 reference, the solver's tolerance, round-off (set a floor), the error of the other axis.",
            ],
            Self::WrongLimit => [
                "limit",
                "the errors tend to a wrong limit",
                "The errors fall with h and dt as claimed, towards a number that is not zero. Look for \
                 what changes with neither: the reference, the solver's tolerance, a wrong coefficient, a \
                 third step.",
            ],
            Self::TooLow => [
                "too-low",
                "the rate is too low",
                "The whole interval lies below the band: an order is lost. Look for a term of lower \
                 order: boundary or initial data, the quadrature, the first step, a coefficient at the \
                 wrong time.",
            ],
            Self::TooHigh => [
                "too-high",
                "the rate is too high",
                "The whole interval lies above the band: the exact solution may be too simple, or the \
                 error not the one that was meant.",
            ],
            Self::ConstantOff => [
                "constant",
                "the constant is outside its interval",
                "The order agrees, and the error is a multiple of the one claimed: a mistake of the \
                 scheme's own order, such as a factor in a term or in the norm.",
            ],
            Self::ZeroError => [
                "zero",
                "an error of exactly zero carries no rate",
                "An error of exactly zero has no logarithm: the solution lies in the discrete space. \
                 Choose another one, or claim that it is exact.",
            ],
            Self::StepsNotDecreasing => [
                "steps",
                "the step sizes are not positive and decreasing",
                "Levels must be given coarse to fine, each once.",
            ],
            Self::NotClaimed => [
                "unclaimed",
                "no order is claimed",
                "Where no order is claimed, none is confirmed. Claim what theory says.",
            ],
            Self::ClaimUnusable => [
                "claim",
                "the order and the tolerance must be positive numbers",
                "The order and the tolerance must be positive numbers.",
            ],
            Self::ToleranceTooWide => [
                "tolerance",
                "the tolerance is too wide to tell anything",
                "Half an order or more on either side accepts two integer orders. Claim more narrowly.",
            ],
            Self::TooFewLevels => [
                "levels",
                "too few levels",
                "A rate with an interval needs three levels above the round-off floor; four or more make \
                 the interval narrow.",
            ],
            Self::NotAsymptotic => [
                "asymptotic",
                "not yet asymptotic",
                "The rates are still changing. Add finer levels; where they scatter, take an error that \
                 does not change its sign.",
            ],
            Self::Departs => [
                "departs",
                "the rates move away",
                "The rates change more and more: a term of lower order, or a wrong limit, is about to \
                 show. Add a finer level; look for what does not change with the step: the reference, the \
                 solver's tolerance, the error of the other axis.",
            ],
            Self::LowerOrderLikely => [
                "lower-order",
                "a lower order may hide in the scatter",
                "A term of lower order explains the errors five times as well as the order claimed. Add finer \
                 levels, where it shows or does not, or take errors that scatter less: a tighter tolerance of \
                 the solver, the mean over shifted meshes.",
            ],
            Self::Jump => [
                "jump",
                "a rate does not belong to its neighbours",
                "One rate is far from those before and after it, which agree: another table begins there, the \
                 unit changes, or a level is wrong. Judge the parts by themselves, or mend that level.",
            ],
            Self::RoundOffFloor => [
                "floor",
                "at the round-off floor",
                "Errors so small are taken for round-off. Add coarser levels, or set a lower floor where \
                 they are known better.",
            ],
            Self::Digits => [
                "digits",
                "too few digits",
                "The errors are given with too few digits for a rate that is known so well. Print more of \
                 them.",
            ],
            Self::ConstantUnsure => [
                "constant-edge",
                "the constant may be outside its interval",
                "The order agrees, and the interval of the constant holds an end of the one claimed. Add a finer level, or claim less narrowly.",
            ],
            Self::Value => [
                "value",
                "a value, not an error",
                "The numbers tend to a value: they are no errors. Judge their differences, or subtract \
                 the exact value.",
            ],
            Self::LeftOver => [
                "left-over",
                "h and dt may leave a part of the errors",
                "Both orders agree, and do not explain the finest error. Add finer levels: either it is a \
                 limit that is not zero, or the rates are not known well enough.",
            ],
            Self::LevelsTooClose => [
                "close",
                "the levels are too close to each other",
                "The coarsest step is less than 1.5 times the finest: a term of lower order would not \
                 show. Refine further.",
            ],
            Self::IntervalTooWide => [
                "wide",
                "the interval is too wide for the tolerance",
                "The errors leave their order open by more than this tolerance: they scatter, or approach \
                 it slowly. Add levels, take an error that does not change its sign, or claim less narrowly.",
            ],
            Self::AtTheEdge => [
                "edge",
                "the interval crosses the edge of the tolerance",
                "The interval is narrow, but holds an end of the band: the claim is neither confirmed nor \
                 refuted.",
            ],
        }
    }
}
