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

/// Half a unit of the last place that a program has printed of each number, of those that it has
/// answered; 0 where no digit is known.
///
/// Trailing zeros are lost: all have as many significant digits, or as many decimals, as any of
/// them, whichever leaves more doubt.
pub fn halves_of_answers(numbers: &[f64]) -> Vec<f64> {
    let all = numbers.iter().copied();
    let digits = all.clone().map(significant_digits).max().unwrap_or(0);
    let decimals = last_place(all.clone());
    let halves = all.map(|number| match number {
        0.0 => 0.5 * decimals,
        _ => 0.5 * decimals.max(place(number, digits)),
    });
    let known = halves.map(|half| Some(half).filter(|half| half.is_finite()));
    known.map(Option::unwrap_or_default).collect()
}

impl RateVerdict {
    /// The same rate, of numbers that have too few digits for a verdict.
    ///
    /// * `what`: such as `3 digits`.
    pub fn with_few_digits(self, what: &str) -> Self {
        self.with_reason(Reason::Digits, &format!("{what}: print more"))
    }
}
