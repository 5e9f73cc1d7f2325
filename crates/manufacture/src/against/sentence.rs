//! What is said of each component.

use std::collections::BTreeMap;

use super::Comparison;
use super::ask::ForeignQuantity;
use super::explain::EditSearch;
use super::right::Right;
use super::whole::Component;

/// Explains what another program answers.
///
/// * `spreads`: those of [`Right::spreads`].
/// * `fresh`: points that the program was not asked about.
pub(super) fn explain(
    right: &Right<'_>,
    spreads: &[Vec<f64>],
    answers: &[ForeignQuantity],
    fresh: &[Vec<f64>],
) -> Vec<Comparison> {
    let answers = answers.iter();
    let components: Vec<Component<'_, '_>> = answers
        .map(|answer| Component::new(right, spreads, answer))
        .collect();
    let mut said: Vec<Option<Comparison>> = components.iter().map(Component::of_source).collect();
    let mut open: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (place, said) in said.iter().enumerate() {
        if said.is_none() {
            let quantity = components[place].place.quantity;
            open.entry(quantity).or_default().push(place);
        }
    }
    if !open.is_empty()
        && let Some(mut search) = EditSearch::new(right, &components, fresh)
    {
        for (quantity, wrong) in open {
            for (place, found) in search.explain(quantity, &wrong) {
                said[place] = Some(found);
            }
        }
    }
    let pairs = said.into_iter().zip(&components);
    pairs
        .map(|(said, component)| {
            said.unwrap_or_else(|| component.said("none", "no explanation found"))
        })
        .collect()
}
