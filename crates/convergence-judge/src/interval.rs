//! Two numbers and all between them.

use serde::{Deserialize, Serialize};

/// Two numbers, and all between them. In JSON a list of two, `null` for one that is not finite.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(into = "[f64; 2]", from = "[Option<f64>; 2]")]
pub struct Interval {
    /// The lower end.
    pub low: f64,
    /// The upper end.
    pub high: f64,
}

impl Interval {
    /// `middle` ± `half`.
    pub fn around(middle: f64, half: f64) -> Self {
        Self {
            low: middle - half,
            high: middle + half,
        }
    }

    /// The distance of its ends.
    pub fn width(self) -> f64 {
        self.high - self.low
    }

    /// The least interval that holds both.
    #[must_use]
    pub fn hull(self, other: Self) -> Self {
        Self {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
        }
    }

    /// Whether a number lies in it, the ends included; never with an end that is NaN.
    pub fn holds(self, number: f64) -> bool {
        self.low <= number && number <= self.high
    }

    /// Whether both ends are finite.
    pub fn is_finite(self) -> bool {
        self.low.is_finite() && self.high.is_finite()
    }

    /// The same function of either end; it must grow, or the ends change places.
    #[must_use]
    pub fn map(self, function: impl Fn(f64) -> f64) -> Self {
        Self {
            low: function(self.low),
            high: function(self.high),
        }
    }
}

impl From<Interval> for [f64; 2] {
    fn from(Interval { low, high }: Interval) -> Self {
        [low, high]
    }
}

impl From<[Option<f64>; 2]> for Interval {
    fn from(ends: [Option<f64>; 2]) -> Self {
        let [low, high] = ends.map(|end| end.unwrap_or(f64::NAN));
        Self { low, high }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_interval_is_a_list_of_two_in_json_and_null_is_not_a_number() {
        let one_to_two = Interval::around(1.5, 0.5);
        assert_eq!(<[f64; 2]>::from(one_to_two), [1.0, 2.0]);
        assert_eq!(Interval::from([Some(1.0), Some(2.0)]), one_to_two);
        assert!(one_to_two.holds(1.0) && one_to_two.holds(2.0) && !one_to_two.holds(2.5));
        let open = Interval::from([Some(1.0), None]);
        assert!(open.high.is_nan() && !open.holds(1.5) && !open.is_finite());
    }
}
