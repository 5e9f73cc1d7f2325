//! The right values.

use super::Questions;
use super::ask::ForeignQuantity;
use super::whole::Component;
use crate::arithmetic::tape::SizedValue;
use crate::arithmetic::{NodeId, SAME};
use crate::check::Sampled;
use crate::check::second_way::both_ways;
use crate::derive::{DerivedQuantity, Part, Role, components};
use crate::fit::{Column, largest};
use crate::model::{Model, TensorRows};
use crate::problem::InputError;

/// Differences of more than this share of the values must be seen.
const TOO_MUCH: f64 = 0.01;

/// A value of ten roundings, of which a thousand are allowed, may be zero.
const ZERO: f64 = 0.01;

/// Points where the file is evaluated in both ways.
const SPREAD_POINTS: usize = 50;

/// A component of a source or of a datum.
pub(super) struct RightComponent<'m> {
    pub(super) name: String,
    pub(super) quantity: &'m DerivedQuantity<NodeId>,
    /// The place of the quantity among those of its part.
    index: usize,
    /// Its place among the components of the quantity.
    pub(super) place: usize,
    pub(super) values: Vec<SizedValue>,
    /// Of each term; a datum has none.
    pub(super) terms: Vec<Column>,
}

/// All sources, or all data of a face.
pub(super) struct Right<'m> {
    pub(super) model: &'m Model,
    /// What the other program reads.
    pub(super) text: String,
    pub(super) sampled: Sampled<'m>,
    pub(super) components: Vec<RightComponent<'m>>,
}

impl<'m> Right<'m> {
    pub(super) fn new(model: &'m Model, questions: Questions) -> Self {
        let Questions { part, points, text } = questions;
        let role = match part {
            Part::Interior => Role::Source,
            _ => Role::Datum,
        };
        let sampled = Sampled::new(model, part, points);
        let mut all = vec![];
        for (index, quantity) in sampled.quantities.iter().enumerate() {
            if quantity.role != role {
                continue;
            }
            let rows = TensorRows::new(&model.graph, quantity.terms.iter().map(|term| &term.1));
            let points = sampled.points.iter();
            let rows: Vec<_> = points.map(|point| rows.at(point).tensors).collect();
            let names = components(&model.problem, &quantity.name, &quantity.tensor.shape);
            for (place, name) in names.into_iter().enumerate() {
                let terms = (0..quantity.terms.len()).map(|term| {
                    let values = rows.iter().map(|row| without_rounding(row[term][place]));
                    values.collect()
                });
                all.push(RightComponent {
                    name,
                    quantity,
                    index,
                    place,
                    values: sampled.over(index).map(|entry| entry.1[place]).collect(),
                    terms: terms.collect(),
                });
            }
        }
        Self {
            model,
            text,
            sampled,
            components: all,
        }
    }

    /// The largest difference between the two evaluations of the file, by rules of derivatives and
    /// by Taylor series, as a share of the size, of each component. At least one rounding.
    ///
    /// # Errors
    /// An integral without accurate values.
    pub(super) fn spreads(&self) -> Result<Vec<f64>, InputError> {
        let both = both_ways(self.model, &self.sampled, SPREAD_POINTS)?;
        let components = self.components.iter();
        let spreads = components.map(|right| {
            let own = both.iter();
            let own = own.filter(|both| (both.quantity, both.place) == (right.index, right.place));
            own.filter_map(|both| both.share())
                .fold(f64::EPSILON, f64::max)
        });
        Ok(spreads.collect())
    }

    /// Refuses a component whose terms cancel, so that too few digits are left: a wrong source
    /// would pass as one that is rounded.
    pub(super) fn tells(
        &self,
        answer: &ForeignQuantity,
        spreads: &[f64],
    ) -> Result<(), InputError> {
        let component = Component::new(self, spreads, answer);
        let allowed = largest(&component.values.allowed);
        let value = largest(&component.values.right);
        // A value of the size of its rounding is zero.
        let is_zero = value <= ZERO * allowed;
        if is_zero || allowed <= TOO_MUCH * value {
            return Ok(());
        }
        let problem = format!(
            "`{}`: expected terms of which digits are left, found values up to {value:.1e} and rounding of \
             {allowed:.1e}: too few digits to tell",
            answer.name
        );
        Err(component.right.quantity.place.error(problem))
    }

    /// The names of all components.
    pub(super) fn names(&self) -> Vec<String> {
        let components = self.components.iter();
        components.map(|right| right.name.clone()).collect()
    }
}

impl RightComponent<'_> {
    /// The labels of the terms.
    pub(super) fn labels(&self) -> Vec<&str> {
        let terms = self.quantity.terms.iter();
        terms.map(|term| term.0.as_str()).collect()
    }

    pub(super) fn column(&self) -> Column {
        self.values.iter().map(|at| at.value).collect()
    }
}

/// A value; zero where only rounding is left, which is nothing to fit with.
fn without_rounding(at: SizedValue) -> f64 {
    if at.value.abs() <= SAME * at.size {
        0.0
    } else {
        at.value
    }
}
