//! What becomes of a quantity on the way to a place where an operation loses its value: it grows
//! without bound, jumps from one direction to another, or has a limit.

use crate::arithmetic::SAME;
use crate::arithmetic::tape::SizedValue;

/// The components of a quantity at points from afar to near, along one direction.
///
/// Each distance is the one before by the square root of ten.
pub(super) type Approach = Vec<Vec<SizedValue>>;

/// Whether a quantity grows along one direction, or has no value.
pub(super) fn grows(approaches: &[Approach]) -> bool {
    let sizes: Vec<Vec<SizedValue>> = approaches.iter().map(sure).collect();
    let values = sizes.iter().flatten().map(|at| at.value);
    let least = 1e-9 * values.filter(|value| value.is_finite()).fold(0.0, f64::max);
    sizes.iter().any(|values| is_growing(values, least))
}

/// Whether a quantity that does not grow has one limit from one side of a surface, and another one
/// from the other side.
///
/// How far the values of the sides are apart stays the same then, two powers of ten nearer, while
/// it falls by a hundred for a smooth quantity. Towards a single point, such as that of
/// `x^3/(x^2 + y^2)`, the limit may differ from each direction to the next: that is no surface.
pub(super) fn jumps(approaches: &[Approach]) -> bool {
    const TWO_POWERS_OF_TEN: usize = 4;
    // A direction along the surface has no values.
    let across = approaches.iter().filter(|one| !one.is_empty());
    let across: Vec<&Approach> = across.collect();
    let nearest = across.iter().map(|one| one.len()).min().unwrap_or(0);
    let components = across.first().map_or(0, |one| one[0].len());
    (0..components).any(|component| {
        let mut places = TWO_POWERS_OF_TEN..nearest;
        places.any(|near| {
            let far = Sides::at(&across, near - TWO_POWERS_OF_TEN, component);
            Sides::at(&across, near, component).are_those_of(&far)
        })
    })
}

/// The values of a component at one distance.
struct Sides {
    low: f64,
    high: f64,
    /// Of the terms of the values.
    size: f64,
    /// Whether each value is that of one side.
    are_two: bool,
}

impl Sides {
    /// Values that differ by less than this share of the distance of the sides are the same.
    const SAME_SIDE: f64 = 1e-2;

    fn at(approaches: &[&Approach], distance: usize, component: usize) -> Self {
        let values = approaches.iter().map(|one| one[distance][component]);
        let size = values.clone().map(|at| at.size).fold(0.0, f64::max);
        let values = values.map(|at| at.value);
        let low = values.clone().fold(f64::INFINITY, f64::min);
        let high = values.clone().fold(f64::NEG_INFINITY, f64::max);
        let least = Self::SAME_SIDE * (high - low);
        let mut values = values;
        let are_two = values.all(|value| value - low <= least || high - value <= least);
        Self {
            low,
            high,
            size,
            are_two,
        }
    }

    /// Whether a jump, more than rounding, is as large as it was.
    fn are_those_of(&self, far: &Self) -> bool {
        let [jump, before] = [self, far].map(|sides| sides.high - sides.low);
        let is_sure = self.are_two && jump > SAME * self.size;
        is_sure && (jump - before).abs() <= Self::SAME_SIDE * jump
    }
}

/// The largest absolute values of the components, as far as they are more than rounding.
fn sure(approach: &Approach) -> Vec<SizedValue> {
    let values = approach.iter().map(|components| largest(components));
    let is_sure = |at: &SizedValue| !at.value.is_finite() || 10.0 * SAME * at.size <= at.value;
    values.take_while(is_sure).collect()
}

/// Whether sure values grow without bound, each nearer by the same factor than the one before:
/// those of a power do, and those of a logarithm by as much each time.
///
/// * `least`: growth by less is rounding of the place.
fn is_growing(sure: &[SizedValue], least: f64) -> bool {
    match sure {
        [.., last] if !last.value.is_finite() => true,
        [.., far, near, next] => {
            let before = near.value - far.value;
            let last = next.value - near.value;
            before > 0.0 && last > 0.9 * before && last > least.max(SAME * next.size)
        }
        _ => false,
    }
}

/// The largest absolute value of a quantity's components, and their largest size.
pub(super) fn largest(values: &[SizedValue]) -> SizedValue {
    let zero = SizedValue {
        value: 0.0,
        size: 0.0,
    };
    values.iter().fold(zero, |most, v| SizedValue {
        value: match v.value.is_finite() {
            true => most.value.max(v.value.abs()),
            false => f64::INFINITY,
        },
        size: most.size.max(v.size),
    })
}
