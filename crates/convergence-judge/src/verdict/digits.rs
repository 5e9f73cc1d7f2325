//! Digits of numbers that were printed, and by how much rounding may change a rate.

use super::{RateVerdict, Reason};
use crate::fit::Level;

/// Number of significant digits of a number: of its shortest decimal.
pub fn significant_digits(number: f64) -> usize {
    let text = format!("{number:e}");
    let mantissa = text.split('e').next().unwrap_or_default();
    mantissa.chars().filter(char::is_ascii_digit).count()
}

/// One unit of this significant digit of a number, counted from 1; infinite for 0.
fn place(number: f64, digit: usize) -> f64 {
    if number == 0.0 {
        return f64::INFINITY;
    }
    let text = format!("{number:e}");
    let exponent = text.split_once('e').and_then(|(_, e)| e.parse().ok());
    10_f64.powi(exponent.unwrap_or(0) + 1 - digit as i32)
}

/// One unit of the last digit that any of some numbers has in its shortest decimal: 0.01 of 1.25
/// and 3; infinite if all are 0.
pub fn last_place(numbers: impl IntoIterator<Item = f64>) -> f64 {
    let numbers = numbers.into_iter();
    let places = numbers.map(|number| place(number, significant_digits(number)));
    places.fold(f64::INFINITY, f64::min)
}

/// By how much rounding may change the rate of the two finest levels; 0 where it is not known.
///
/// * `share`: by how much it may change the error at a level, relative to it.
pub fn doubt_of_finest(levels: &[Level], share: impl Fn(usize) -> f64) -> f64 {
    let [.., before, finest] = levels else {
        return 0.0;
    };
    let last = levels.len() - 1;
    let doubt = (share(last - 1) + share(last)) / (before.step / finest.step).ln();
    if doubt.is_finite() { doubt } else { 0.0 }
}

/// What is known of the digits of errors that a program has answered.
pub(crate) struct AnsweredDigits {
    /// The most significant digits that any of the errors has.
    pub(crate) digits: usize,
    /// By how much rounding may change the finest rate.
    pub(crate) doubt: f64,
}

impl AnsweredDigits {
    /// Trailing zeros are lost: all have as many significant digits, or as many decimals, as any of
    /// them, whichever leaves more doubt.
    ///
    /// * `levels`: above the floor, coarsest first.
    pub(crate) fn of(levels: &[Level]) -> Self {
        let errors = levels.iter().map(|level| level.error);
        let digits = errors.clone().map(significant_digits).max().unwrap_or(0);
        let decimals = last_place(errors);
        let share = |k: usize| {
            let error = levels[k].error;
            0.5 * decimals.max(place(error, digits)) / error
        };
        Self {
            digits,
            doubt: doubt_of_finest(levels, share),
        }
    }
}

impl RateVerdict {
    /// The same rate, of numbers that have too few digits for a verdict.
    ///
    /// * `what`: such as `3 digits`.
    pub fn with_few_digits(self, what: &str) -> Self {
        self.with_reason(Reason::Digits, &format!("{what}: print more"))
    }
}
