//! Why the number of states between two axial forces is not decided.

use crate::interval::Enclosure;
use thermobeam::contact::Phase;

/// Why a number of states is not decided.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum UndecidedReason {
    /// The maximum of f between two poles cannot be told from 0.
    Fold,
    /// u(1) of a state cannot be told from the position of an obstacle.
    Touch,
    /// A root cannot be told from a buckling value, or the load of its mode from 0.
    Pole,
    /// A state at N = -1 is neither proved nor excluded.
    MinusOne,
    /// β cannot be told from a buckling value.
    Bifurcation,
}

impl UndecidedReason {
    /// The reason in words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Fold => "two states cannot be told from one or none (a fold)",
            Self::Touch => "u(1) cannot be told from the position of an obstacle",
            Self::Pole => "a state cannot be told from a buckling value",
            Self::MinusOne => "a state at N = -1 cannot be told from none",
            Self::Bifurcation => "beta cannot be told from a buckling value",
        }
    }
}

/// Axial forces between which states are not decided.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Undecided {
    /// The state of contact.
    pub contact: Phase,
    /// Encloses N of the states.
    pub n_value: Enclosure,
    /// Why.
    pub reason: UndecidedReason,
    /// The width of the enclosure at which it was given up.
    pub width: f64,
}
