//! Floating-point values at the points of a smallest box.

use super::DomainFinding;
use super::sides::{middle, snapped};
use crate::arithmetic::Node;
use crate::arithmetic::conditions::{Condition, Need};
use crate::arithmetic::enclosure::Over;
use crate::arithmetic::interval::Interval;
use crate::arithmetic::tape::{SizedValue, Tape};
use crate::model::Model;

/// A value so small against its size is zero but for rounding.
const ZERO: f64 = 64.0 * f64::EPSILON;

/// What the points of a smallest box say about a condition that is open over it.
pub(super) fn kind(
    model: &Model,
    condition: Condition,
    over: &Over<'_, '_>,
    sides: &[Interval],
) -> DomainFinding {
    let probe = Probe::new(model, condition);
    let is_guarded = over.is_guarded(condition.operation);
    let mut values = vec![];
    let mut touches = false;
    for point in candidates(sides) {
        // Behind a choice only points count at which the operation is used for sure.
        let is_used = !is_guarded || {
            let at = over.at(&point);
            let is_open = at.open(&[condition]).is_some();
            let is_sure = !at.is_guarded(condition.operation);
            touches |= is_open && !is_sure;
            is_open && is_sure
        };
        if is_used {
            values.push(probe.at(&point));
        }
    }
    let zero = values.iter().find(|v| is_zero(&v.argument));
    let has = |test: fn(f64) -> bool| values.iter().any(|v| test(v.argument.value));
    let changes_sign = has(|v| v > 0.0) && has(|v| v < 0.0);
    let is_missing = match condition.need {
        Need::OneSide => zero.is_some() || changes_sign,
        Need::NonZero | Need::Tangent => {
            let is_whole = !is_guarded && over.is_continuous(condition.argument);
            zero.is_some() || (changes_sign && is_whole)
        }
        Need::Positive => zero.is_some() || has(|v| v <= 0.0),
        Need::NonNegative | Need::Unit => values
            .iter()
            .any(|v| v.argument.value < -ZERO * v.argument.size),
    };
    // A numerator that is zero wherever the divisor is.
    let zeros = values.iter().filter(|v| is_zero(&v.argument));
    let mut numerators = zeros.map(|v| v.numerator.as_ref().is_some_and(is_zero));
    match (is_missing, zero) {
        (true, Some(_)) if numerators.all(|is_zero| is_zero) => DomainFinding::ZeroOverZero,
        (true, _) => DomainFinding::Missing,
        (false, Some(_)) => DomainFinding::Touching,
        (false, None) if touches => DomainFinding::Touching,
        (false, None) => DomainFinding::Undecided,
    }
}

/// What a condition is about, at points.
struct Probe<'m> {
    need: Need,
    tape: Tape<'m>,
}

struct Probed {
    /// Zero, or less, where the condition fails.
    argument: SizedValue,
    numerator: Option<SizedValue>,
}

impl<'m> Probe<'m> {
    fn new(model: &'m Model, condition: Condition) -> Self {
        let mut roots = vec![condition.argument];
        match model.graph.node(condition.argument) {
            Node::Choose(_, [left, right, ..]) if condition.need == Need::OneSide => {
                roots = vec![*left, *right];
            }
            _ => roots.extend(condition.numerator),
        }
        Self {
            need: condition.need,
            tape: Tape::new(&model.graph, &roots),
        }
    }

    fn at(&self, point: &[f64]) -> Probed {
        let values = self.tape.at(point).roots;
        let first = values[0];
        let argument = match self.need {
            Need::OneSide => SizedValue {
                value: first.value - values[1].value,
                size: first.size + values[1].size,
            },
            Need::Unit => SizedValue {
                value: 1.0 - first.value.abs(),
                size: 1.0 + first.size,
            },
            Need::Tangent => SizedValue {
                value: first.value.cos(),
                size: first.size.max(1.0),
            },
            _ => first,
        };
        let numerator = values.get(1).copied();
        Probed {
            argument,
            numerator: numerator.filter(|_| self.need == Need::NonZero),
        }
    }
}

/// The middle of a box, its zeros, and its corners.
fn candidates(sides: &[Interval]) -> Vec<Vec<f64>> {
    let mut corners = vec![vec![]];
    for side in sides {
        let mut next = vec![];
        for corner in &corners {
            for end in [side.lo, side.hi] {
                next.push([corner.as_slice(), &[end]].concat());
            }
        }
        corners = next;
    }
    corners.extend([middle(sides), snapped(sides)]);
    corners
}

/// Whether a value is zero but for rounding.
fn is_zero(value: &SizedValue) -> bool {
    value.value.abs() <= ZERO * value.size
}
