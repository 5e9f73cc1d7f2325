//! What a search goes through: the components of an answer, and the edits that may explain them.

use super::bench::{Alteration, Bench};
use super::candidates::{self, Candidate};
use super::cause::Named;
use super::right::Right;
use super::text;
use super::trial::cost;
use super::whole::Component;
use crate::derive::Role;
use crate::problem;

/// A search over the edits of the quantities of a question.
pub(super) struct EditSearch<'a, 'm> {
    pub(super) right: &'a Right<'m>,
    pub(super) components: &'a [Component<'a, 'm>],
    pub(super) bench: Bench,
    pub(super) candidates: Vec<Candidate>,
    /// Points of the same part that nobody was asked about.
    pub(super) fresh: Vec<Vec<f64>>,
}

impl<'a, 'm> EditSearch<'a, 'm> {
    /// * `fresh`: points of the same part that nobody was asked about.
    pub(super) fn new(
        right: &'a Right<'m>,
        components: &'a [Component<'a, 'm>],
        fresh: Vec<Vec<f64>>,
    ) -> Option<Self> {
        let bench = Bench::new(right.model, right.part)?;
        let candidates = candidates::all(&right.model.problem, right.part);
        Some(Self {
            right,
            components,
            bench,
            candidates,
            fresh,
        })
    }

    pub(super) fn name(&self, quantity: usize) -> &'m str {
        &self.right.quantities[quantity].quantity.name
    }

    /// The components of a quantity that the other program answers.
    pub(super) fn of_quantity(&self, quantity: usize) -> Vec<&'a Component<'a, 'm>> {
        let components = self.components.iter();
        components
            .filter(|component| component.place.quantity == quantity)
            .collect()
    }

    pub(super) fn named(&self, quantity: usize, candidate: usize, factor: f64) -> Named {
        let problem = &self.right.model.problem;
        let whole = self.place(quantity);
        text::named(problem, &whole, &self.candidates[candidate], factor)
    }

    /// The size of an edit, then how far it is from a term: the smaller, the more likely.
    pub(super) fn size(&self, candidate: usize, factor: f64) -> (usize, usize) {
        let candidate = &self.candidates[candidate];
        (cost(candidate, factor), candidate.depth)
    }

    /// Where a quantity stands in the file.
    pub(super) fn place(&self, quantity: usize) -> problem::Location {
        place_of(self.right, quantity)
    }

    /// Whether an altered component has the foreign values at all points.
    pub(super) fn fits_everywhere(
        &mut self,
        component: &Component<'a, 'm>,
        alteration: &Alteration,
        factor: f64,
    ) -> bool {
        let name = self.name(component.place.quantity);
        let points = &self.right.points;
        let fits = self.bench.altered(Some(alteration), name, |altered| {
            let evaluation = altered.evaluation();
            points.iter().enumerate().all(|(place, point)| {
                let value = evaluation.at(point, factor)[component.place.component].value;
                (component.foreign[place] - value).abs() <= component.allowed[place]
            })
        });
        fits == Some(true)
    }
}

pub(super) fn place_of(right: &Right<'_>, quantity: usize) -> problem::Location {
    let quantity = right.quantities[quantity].quantity;
    let problem = &right.model.problem;
    let mut equations = problem.equations.iter();
    let is_source = quantity.role == Role::Source;
    if let Some(equation) = equations.find(|e| is_source && e.name == quantity.name) {
        return equation.place.clone();
    }
    let mut data = problem.faces.iter().flat_map(|face| &face.data);
    let datum = data.find(|datum| datum.value.place().key.starts_with(&quantity.key));
    datum.map_or_else(
        || problem.equations[0].place.clone(),
        |d| d.value.place().clone(),
    )
}
