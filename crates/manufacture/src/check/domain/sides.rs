//! Points of a box, whose sides are intervals.

use crate::arithmetic::interval::Interval;

/// The middle of each side.
pub(super) fn middle(sides: &[Interval]) -> Vec<f64> {
    sides.iter().map(|side| side.midpoint()).collect()
}

/// A side that is so short has been halved until it is a number.
const NUMBER: f64 = 1e-9;

/// The middle, but zero in place of a number next to it.
pub(super) fn snapped(sides: &[Interval]) -> Vec<f64> {
    let sides = sides.iter();
    sides
        .map(|side| {
            let is_zero = side.contains_zero() && side.width() <= NUMBER;
            if is_zero { 0.0 } else { side.midpoint() }
        })
        .collect()
}
