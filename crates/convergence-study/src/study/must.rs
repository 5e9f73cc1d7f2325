//! What a number must be, as data: the baseline keeps it beside the number, so that a claim that is
//! loosened is found.

use std::fmt;

use serde::{Deserialize, Serialize};

use convergence_judge::claims::Claim;
use convergence_judge::verdict::Band;

/// What a number must be.
///
/// ```
/// use convergence_study::Must;
///
/// let before = Must::Near { answer: 2.0, within: 0.002 };
/// assert_eq!(before.to_string(), "2 ± 0.002");
/// assert!(Must::Near { answer: 2.0, within: 0.02 }.is_looser_than(before));
/// assert!(!Must::Near { answer: 2.0, within: 0.001 }.is_looser_than(before));
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
#[non_exhaustive]
pub enum Must {
    /// At most this: `<= 1e-6`.
    AtMost(f64),
    /// At least this: `>= 2`.
    AtLeast(f64),
    /// More than this: `> 0`.
    Above(f64),
    /// So many: `= 3`.
    Count(usize),
    /// This answer, within a distance: `2 ± 0.002`.
    Near {
        /// The answer.
        answer: f64,
        /// The distance allowed.
        within: f64,
    },
}

impl Must {
    /// Whether a number is what it must be. NaN and infinity are not, and no number is where a
    /// bound is not finite.
    pub fn holds(self, value: f64) -> bool {
        let [low, high] = self.ends();
        let is_bounded = low.is_finite() || high.is_finite();
        // The distance to an answer is compared as it is: its ends are rounded.
        let holds = match self {
            Self::Near { answer, within } => (value - answer).abs() <= within,
            _ => low <= value && value <= high,
        };
        is_bounded && value.is_finite() && holds
    }

    /// A number just beyond it.
    pub(super) fn past(self) -> f64 {
        match self {
            Self::AtMost(bound) => bound.next_up(),
            Self::AtLeast(bound) => bound.next_down(),
            Self::Above(bound) => bound,
            Self::Count(count) => count as f64 + 1.0,
            Self::Near { answer, within } => (answer + 1.001 * within).next_up(),
        }
    }

    /// Whether it allows a number that the other one does not.
    pub fn is_looser_than(self, other: Self) -> bool {
        let [own, others] = [self, other].map(Self::ends);
        // Ends that are NaN allow nothing that can be known: that is no tighter claim.
        !(own[0] >= others[0] && own[1] <= others[1])
    }

    /// The least and the largest number allowed.
    fn ends(self) -> [f64; 2] {
        match self {
            Self::AtMost(bound) => [f64::NEG_INFINITY, bound],
            Self::AtLeast(bound) => [bound, f64::INFINITY],
            Self::Above(bound) => [bound.next_up(), f64::INFINITY],
            Self::Count(count) => [count as f64; 2],
            Self::Near { answer, within } => [answer - within, answer + within],
        }
    }
}

impl From<Band> for Must {
    fn from(Band { order, tolerance }: Band) -> Self {
        Self::Near {
            answer: order,
            within: tolerance,
        }
    }
}

impl From<&Claim> for Must {
    /// The rates that a claim accepts.
    fn from(claim: &Claim) -> Self {
        if claim.bound.is_least() {
            Self::AtLeast(claim.order - claim.tolerance)
        } else {
            claim.band().into()
        }
    }
}

/// A number with all its digits.
fn exact(number: f64) -> String {
    if number == 0.0 || (1e-3..1e6).contains(&number.abs()) {
        number.to_string()
    } else {
        format!("{number:e}")
    }
}

impl fmt::Display for Must {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::AtMost(bound) => write!(f, "<= {}", exact(bound)),
            Self::AtLeast(bound) => write!(f, ">= {}", exact(bound)),
            Self::Above(bound) => write!(f, "> {}", exact(bound)),
            Self::Count(count) => write!(f, "= {count}"),
            Self::Near { answer, within } => write!(f, "{} ± {}", exact(answer), exact(within)),
        }
    }
}

impl From<Must> for String {
    fn from(must: Must) -> Self {
        must.to_string()
    }
}

impl TryFrom<String> for Must {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        let read = if let Some(bound) = text.strip_prefix("<= ") {
            finite(bound).map(Self::AtMost)
        } else if let Some(bound) = text.strip_prefix(">= ") {
            finite(bound).map(Self::AtLeast)
        } else if let Some(bound) = text.strip_prefix("> ") {
            finite(bound).map(Self::Above)
        } else if let Some(count) = text.strip_prefix("= ") {
            count.parse().ok().map(Self::Count)
        } else {
            text.split_once(" ± ").and_then(|(answer, within)| {
                let within = finite(within).filter(|within| *within >= 0.0)?;
                let answer = finite(answer)?;
                Some(Self::Near { answer, within })
            })
        };
        read.ok_or_else(|| {
            format!("expected a claim such as `<= 1e-6`, `>= 2` or `2 ± 0.002`, found `{text}`")
        })
    }
}

fn finite(text: &str) -> Option<f64> {
    text.parse().ok().filter(|number: &f64| number.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_claim_comes_back_from_its_text_and_no_other_text_is_one() {
        for (must, text) in [
            (Must::AtMost(1e-6), "<= 1e-6"),
            (Must::AtMost(0.1 + 0.2), "<= 0.30000000000000004"),
            (Must::AtLeast(-2.5e9), ">= -2.5e9"),
            (Must::Above(0.0), "> 0"),
            (Must::Count(3), "= 3"),
            (
                Must::Near {
                    answer: 2.0,
                    within: 0.002,
                },
                "2 ± 0.002",
            ),
        ] {
            assert_eq!(must.to_string(), text);
            assert_eq!(Must::try_from(text.to_owned()), Ok(must));
        }
        for text in [
            "", "2", "< 2", "<= NaN", ">= inf", "2 ± -1", "2 ± NaN", "inf ± 1", "2±1", "<= 2 ",
            "> NaN", "= -1", "= 1.5",
        ] {
            let refused = Must::try_from(text.to_owned()).unwrap_err();
            assert!(refused.ends_with(&format!("found `{text}`")), "{refused}");
        }
    }

    #[test]
    fn a_claim_is_looser_where_it_allows_more_at_either_end() {
        let near = |answer, within| Must::Near { answer, within };
        for (from, to) in [
            (Must::AtMost(1e-6), Must::AtMost(1e-5)),
            (Must::AtLeast(2.0), Must::AtLeast(1.9)),
            (near(2.0, 0.1), near(2.0, 0.2)),
            // Moved, which allows other numbers.
            (near(2.0, 0.1), near(2.05, 0.1)),
            (near(2.0, 0.1), Must::AtLeast(1.9)),
            (Must::AtMost(1.0), Must::AtLeast(1.0)),
            (Must::Above(0.0), Must::AtLeast(0.0)),
            (Must::Count(1), Must::Count(2)),
            (near(2.0, 0.1), near(f64::NAN, 0.1)),
            (near(2.0, f64::NAN), near(2.0, 0.1)),
        ] {
            assert!(to.is_looser_than(from), "{from}, {to}");
        }
        for (from, to) in [
            (Must::AtMost(1e-6), Must::AtMost(1e-7)),
            (near(2.0, 0.1), near(2.0, 0.05)),
            (Must::AtLeast(1.9), near(2.0, 0.1)),
            (near(2.0, 0.1), near(2.0, 0.1)),
            (Must::AtLeast(0.0), Must::Above(0.0)),
        ] {
            assert!(!to.is_looser_than(from), "{from}, {to}");
        }
    }

    #[test]
    fn a_claim_holds_up_to_its_bound_and_never_for_what_is_not_finite() {
        let near = Must::Near {
            answer: 2.0,
            within: 0.1,
        };
        for (must, meets) in [
            (Must::AtMost(1.0), 1.0),
            (Must::AtLeast(1.0), 1.0),
            (Must::Above(1.0), 1.0_f64.next_up()),
            (Must::Count(3), 3.0),
            (near, 2.05),
        ] {
            assert!(must.holds(meets) && !must.holds(must.past()), "{must}");
            for broken in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
                assert!(!must.holds(broken), "{must}: {broken}");
            }
        }
        for bound in [f64::NAN, f64::INFINITY] {
            assert!(!Must::AtMost(bound).holds(0.0) && !Must::AtLeast(-bound).holds(0.0));
            let near = Must::Near {
                answer: 0.0,
                within: bound,
            };
            assert!(!near.holds(0.0));
        }
    }
}
