//! The rules of signs, as theorems about real numbers.

use super::interval::Interval;
use crate::language::tree::Relation;

/// The signs that a number may have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Signs {
    pub(super) negative: bool,
    pub(super) zero: bool,
    pub(super) positive: bool,
}

impl Signs {
    pub(super) const ANY: Self = Self::of([true; 3]);
    pub(super) const POSITIVE: Self = Self::of([false, false, true]);
    const NOT_NEGATIVE: Self = Self::of([false, true, true]);
    pub(super) const NOT_ZERO: Self = Self::of([true, false, true]);

    const fn of([negative, zero, positive]: [bool; 3]) -> Self {
        Self {
            negative,
            zero,
            positive,
        }
    }

    pub(super) fn between(range: Interval) -> Self {
        Self::of([range.lo < 0.0, range.contains_zero(), range.hi > 0.0])
    }

    /// Whether only one sign is left, and that is not zero.
    pub(super) fn are_one(self) -> bool {
        !self.zero && self.negative != self.positive
    }

    pub(super) fn opposite(self) -> Self {
        Self::of([self.positive, self.zero, self.negative])
    }

    pub(super) fn and(self, other: Self) -> Self {
        Self::of([
            self.negative && other.negative,
            self.zero && other.zero,
            self.positive && other.positive,
        ])
    }

    pub(super) fn or(self, other: Self) -> Self {
        Self::of([
            self.negative || other.negative,
            self.zero || other.zero,
            self.positive || other.positive,
        ])
    }

    pub(super) fn plus(self, other: Self) -> Self {
        let opposite = (self.negative && other.positive) || (self.positive && other.negative);
        Self::of([
            self.negative || other.negative,
            (self.zero && other.zero) || opposite,
            self.positive || other.positive,
        ])
    }

    pub(super) fn times(self, other: Self) -> Self {
        Self::of([
            (self.negative && other.positive) || (self.positive && other.negative),
            self.zero || other.zero,
            (self.positive && other.positive) || (self.negative && other.negative),
        ])
    }

    /// Of left - right, where their comparison has this result.
    pub(super) fn of_difference(comparison: Relation, holds: bool) -> Self {
        let signs = match comparison {
            Relation::Less => Self::of([true, false, false]),
            Relation::LessOrEqual => Self::of([true, true, false]),
            Relation::Greater => Self::POSITIVE,
            Relation::GreaterOrEqual => Self::NOT_NEGATIVE,
        };
        if holds {
            signs
        } else {
            Self::of([!signs.negative, !signs.zero, !signs.positive])
        }
    }

    /// Of a power that has a value.
    pub(super) fn to_the(self, exponent: Interval) -> Self {
        if !self.negative {
            let zero = self.zero && exponent.hi > 0.0;
            // Zero to the power of zero is one.
            let positive = self.positive || exponent.contains_zero();
            return Self::of([false, zero, positive]);
        }
        let is_even = exponent.lo == exponent.hi && exponent.lo % 2.0 == 0.0;
        Self::of([!is_even, self.zero && exponent.hi >= 0.0, true])
    }
}
