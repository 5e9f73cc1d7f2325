//! Whether all operations have their values on the whole domain: free by proof, a pole, undecided.
//!
//! The box is halved until interval arithmetic excludes what an operation cannot have, or until the
//! box is as small as its numbers allow. What is excluded is a theorem. A pole is a place at which
//! floating point cannot tell a divisor from zero, or has both of its signs next to each other.

mod probe;
mod search;
mod sides;
mod words;

use super::spot::{self, Spot};
use super::{Finding, finding, role_words};
use crate::arithmetic::NodeId;
use crate::arithmetic::conditions::{Condition, Need};
use crate::arithmetic::tape::nodes_below;
use crate::derive::{DerivedQuantity, Part, Role};
use crate::model::Model;
use crate::problem::InputError;

use search::DomainSearch;
use words::{place_of, words};

/// What is known of an operation in a part.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum DomainFinding {
    /// It has no value there.
    Missing,
    /// Numerator and divisor are both zero.
    ZeroOverZero,
    /// Rounding may take the argument out of where the operation has a value.
    Touching,
    /// The boxes are as small as they get, or the work is done.
    Undecided,
}

/// An operation that may lack a value, and where.
#[derive(Debug)]
struct Trouble {
    condition: Condition,
    kind: DomainFinding,
    point: Vec<f64>,
    is_on_boundary: bool,
}

impl Trouble {
    /// Whether a function has no derivative there.
    fn is_kink(&self) -> bool {
        self.condition.need == Need::OneSide
    }
}

/// What the search says about a domain: poles inside as an error, all else as notes.
///
/// # Errors
/// An operation without a value inside the domain, with its place in the file.
pub(super) fn examine(model: &Model) -> Result<Vec<Finding>, InputError> {
    let mut notes = vec![];
    for (part, quantities) in &model.parts {
        let search = DomainSearch::new(model, *part, quantities);
        let mut troubles = search.run();
        troubles.sort_by_key(|trouble| trouble.condition.operation);
        for trouble in troubles.iter().filter(|trouble| !trouble.is_kink()) {
            let user = user(model, quantities, trouble.condition.operation);
            let fails = trouble.kind == DomainFinding::Missing
                && match user.map(|quantity| quantity.role) {
                    Some(Role::Exact) => true,
                    Some(Role::Gradient) => false,
                    _ => !trouble.is_on_boundary,
                };
            let spot = spot::find(model, &trouble.condition);
            let words = words(model, *part, trouble, spot.as_ref());
            if fails {
                return Err(refusal(model, user, spot.as_ref(), &words));
            }
            let code = match trouble.kind {
                DomainFinding::Missing => "pole",
                _ => "undecided",
            };
            let Some(user) = user else { continue };
            let text = format!("{} {}: {words}", role_words(user.role), user.name);
            notes.push(finding(code, &user.key, text, None));
        }
        if *part == Part::Interior {
            notes.extend(kinks(model, quantities, &troubles));
        }
    }
    Ok(notes)
}

/// The first quantity that has an operation: the exact solution before others, gradients last.
fn user<'q>(
    model: &Model,
    quantities: &'q [DerivedQuantity<NodeId>],
    operation: NodeId,
) -> Option<&'q DerivedQuantity<NodeId>> {
    let has = |q: &&DerivedQuantity<NodeId>| {
        nodes_below(&model.graph, &q.tensor.parts).contains(&operation)
    };
    let users = quantities.iter().filter(has);
    users.min_by_key(|quantity| match quantity.role {
        Role::Exact => 0,
        Role::Gradient => 2,
        _ => 1,
    })
}

fn refusal(
    model: &Model,
    user: Option<&DerivedQuantity<NodeId>>,
    spot: Option<&Spot<'_>>,
    words: &str,
) -> InputError {
    match spot {
        Some(spot) => spot.error(words),
        None => InputError {
            key: user.map_or(String::new(), |quantity| quantity.key.clone()),
            ..InputError::whole(&model.problem.file, words)
        },
    }
}

/// Switches inside the domain, for each quantity that has some.
fn kinks(
    model: &Model,
    quantities: &[DerivedQuantity<NodeId>],
    troubles: &[Trouble],
) -> Vec<Finding> {
    let mut findings = vec![];
    for quantity in quantities {
        if !matches!(quantity.role, Role::Source | Role::Exact) {
            continue;
        }
        let below = nodes_below(&model.graph, &quantity.tensor.parts);
        let inside: Vec<&Trouble> = troubles
            .iter()
            .filter(|trouble| trouble.is_kink() && !trouble.is_on_boundary)
            .filter(|trouble| below.contains(&trouble.condition.operation))
            .collect();
        let mut troubles = inside.iter();
        let located = troubles.find(|trouble| trouble.kind == DomainFinding::Missing);
        let Some(first) = located.or(inside.first()) else {
            continue;
        };
        let count = inside.len();
        let at = place_of(model, first.condition.argument, &first.point);
        let certainty = if located.is_some() { "" } else { "perhaps " };
        let text = format!(
            "{certainty}{count} switch(es) of abs, min, max, where or heaviside inside the domain, at about {at}: \
             derivatives are taken on each side, and a jump of a flux there is no source"
        );
        findings.push(finding("kink", &quantity.key, text, Some(count as f64)));
    }
    findings
}
