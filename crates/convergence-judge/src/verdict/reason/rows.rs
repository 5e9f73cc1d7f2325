//! What is said about each reason.

use super::Reason;
use super::mathematics::{
    LOST_ORDER, NEXT_TERM, NO_ERROR, OTHER_CONSTANT, PLATEAU, REPEATED_RUN, ROUND_OFF, TOO_FAST,
};
use crate::verdict::Verdict;

/// What is said about a reason.
pub(super) struct ReasonRow {
    pub(super) reason: Reason,
    pub(super) verdict: Verdict,
    pub(super) wants_a_level: bool,
    pub(super) code: &'static str,
    pub(super) text: &'static str,
    pub(super) advice: &'static str,
    pub(super) mathematics: &'static str,
}

pub(super) static ROWS: [ReasonRow; 36] = [
    ReasonRow {
        reason: Reason::Agrees,
        verdict: Verdict::Pass,
        wants_a_level: false,
        code: "agrees",
        text: "the rate agrees with the order",
        advice: "The whole interval of the rate lies within the tolerance of the order, the rates do not \
                 move away from it, and no lower order explains the errors better.",
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
        reason: Reason::Identical,
        verdict: Verdict::Fail,
        wants_a_level: false,
        code: "identical",
        text: "the errors are identical: does the program use {n}?",
        advice: "The error is the same on all levels, in all digits: refining changes nothing. Does the program use the \
              number of cells or steps that it is given? Is the table that of several runs?",
        mathematics: REPEATED_RUN,
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
        advice: "Half an order or more on either side accepts two integer orders, and as much as the order errors that do not fall. Claim more narrowly.",
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
    ReasonRow {
        reason: Reason::TooGood,
        verdict: Verdict::Inconclusive,
        wants_a_level: false,
        code: "too-good",
        text: "too good: is the reference the solution, are two levels one run?",
        advice: "The whole interval lies more than one order above the order claimed as the least. Superconvergence gains one; \
              more is most often a mistake: the reference is the numerical solution, coarse levels have failed, two levels \
              are one run. Claim the higher order, or '>=P..' where any rate will do.",
        mathematics: TOO_FAST,
    },
    ReasonRow {
        reason: Reason::Repeats,
        verdict: Verdict::Inconclusive,
        wants_a_level: false,
        code: "repeats",
        text: "the level repeats the one before: a stale file, or an argument that is not used?",
        advice: "Two levels have the same error, in all of three or more digits: no two meshes give it. Was the file of one of \
              them written by the other's run? Does the program use the number that it is given, on that level, too?",
        mathematics: REPEATED_RUN,
    },
    ReasonRow {
        reason: Reason::Alternates,
        verdict: Verdict::Inconclusive,
        wants_a_level: false,
        code: "alternates",
        text: "the rates alternate with zero: two levels are one run, or the end time is not met",
        advice: "Every second refinement leaves the error as it is. Is the number of cells or steps rounded, so that two levels \
              are one run? Does each run end at the same time, also where that is no multiple of its step?",
        mathematics: REPEATED_RUN,
    },
    ReasonRow {
        reason: Reason::EqualColumns,
        verdict: Verdict::Inconclusive,
        wants_a_level: false,
        code: "equal-columns",
        text: "equal to another error in all digits",
        advice: "Two errors with claims are equal on all levels, in all digits: one of them is not computed. Is one norm taken \
              for both, or one field? Where theory says that they are equal, claim one.",
        mathematics: REPEATED_RUN,
    },
    ReasonRow {
        reason: Reason::NothingTested,
        verdict: Verdict::Inconclusive,
        wants_a_level: false,
        code: "nothing-tested",
        text: "nothing is tested: the solution lies in the discrete space, if it is of size 1",
        advice: "No error is above a thousand times the round-off of numbers of size 1, and they do not fall. Choose a solution \
              that the discrete space does not hold, or claim that the error is exact; where the solution is much smaller \
              than 1, say its size, or give the errors relative to it.",
        mathematics: ROUND_OFF,
    },
    ReasonRow {
        reason: Reason::RoundOff,
        verdict: Verdict::Inconclusive,
        wants_a_level: false,
        code: "round-off",
        text: "round-off, if the solution is of size 1: with a floor the claim passes",
        advice: "The finest errors are near the round-off of the solution, and without them the rates agree. If its size is as said, \
              set the floor. It is not set by itself: a wrong limit of that size looks the same.",
        mathematics: ROUND_OFF,
    },
    ReasonRow {
        reason: Reason::Samples,
        verdict: Verdict::Inconclusive,
        wants_a_level: false,
        code: "samples",
        text: "a level tells nothing: two standard errors exceed its mean",
        advice: "The scatter of its samples hides the error of a level. Take more samples there, or leave it out: coarser levels have \
              larger errors, and need fewer.",
        mathematics: NEXT_TERM,
    },
];
