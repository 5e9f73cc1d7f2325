//! Sentences about places where an operation has no value.

use super::{DomainFinding, Trouble};
use crate::arithmetic::NodeId;
use crate::arithmetic::conditions::{Condition, Need};
use crate::check::spot::Spot;
use crate::derive::Part;
use crate::model::Model;

/// A sentence about a trouble.
pub(super) fn words(
    model: &Model,
    part: Part,
    trouble: &Trouble,
    spot: Option<&Spot<'_>>,
) -> String {
    let Condition { need, argument, .. } = trouble.condition;
    let shown = spot.map_or("a part".to_owned(), Spot::argument);
    let at = place_of(model, argument, &trouble.point);
    let part_words = match part {
        Part::Face(index) => format!(" on the face {}", model.problem.faces[index].name),
        Part::Initial => " at the first time".to_owned(),
        Part::Interior => String::new(),
    };
    let expected = match need {
        Need::NonZero => "a divisor that is zero nowhere",
        Need::Positive => "a positive number",
        Need::NonNegative => "a number that is not negative",
        Need::Unit => "a number from -1 to 1",
        Need::Tangent | Need::OneSide => "an angle that is no odd multiple of pi/2",
    };
    let value = match need {
        Need::NonZero => "is zero",
        Need::Positive => "is not positive",
        Need::NonNegative => "is negative",
        Need::Unit => "is not between -1 and 1",
        Need::Tangent | Need::OneSide => "has no tangent",
    };
    let side = if trouble.is_on_boundary {
        "on the boundary of"
    } else {
        "inside"
    };
    match trouble.kind {
        DomainFinding::Missing if need == Need::NonZero => format!(
            "a pole {side} the domain{part_words}: `{shown}` {value} at about {at}; expected {expected}"
        ),
        DomainFinding::Missing => format!(
            "no value {side} the domain{part_words}: `{shown}` {value} at about {at}; expected {expected}"
        ),
        DomainFinding::ZeroOverZero => format!(
            "0/0{part_words} at about {at}, where `{shown}` {value}: a limit is not looked for; expected {expected}"
        ),
        DomainFinding::Touching => format!(
            "`{shown}` reaches the last number that has a value{part_words}, at about {at}: by rounding it may lack one"
        ),
        DomainFinding::Undecided => format!(
            "not decided whether `{shown}` {value}{part_words}, at about {at}, within the work of the search; expected {expected}"
        ),
    }
}

/// A point by the variables that a node changes with.
pub(super) fn place_of(model: &Model, node: NodeId, point: &[f64]) -> String {
    let whole = model.place_in_words(point);
    let parts = whole.split(", ").enumerate();
    let parts = parts.filter(|part| model.graph.depends_on(node, part.0));
    let parts: Vec<&str> = parts.map(|part| part.1).collect();
    if parts.is_empty() {
        "every point".to_owned()
    } else {
        parts.join(", ")
    }
}
