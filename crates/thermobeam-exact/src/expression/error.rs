//! The errors of an expression in its values. Those in its text are the parser's.

use thiserror::Error;

use super::Variable;

/// A point at which a function or one of its derivatives is infinite or NaN.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[error(
    "{} is {found} at {} = {at}; expected a finite value on all of [0, {end}]",
    ["the value", "the first derivative", "the second derivative"][*.order],
    .variable.name()
)]
pub struct NotFinite {
    /// The variable.
    pub variable: Variable,
    /// The point.
    pub at: f64,
    /// The interval that was checked is [0, end].
    pub end: f64,
    /// Order of the derivative: 0, 1 or 2.
    pub order: usize,
    /// The value there.
    pub found: f64,
}
