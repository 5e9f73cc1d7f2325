//! The right values, and what they would be after a mistake.

use super::Questions;
use super::ask::ForeignQuantity;
use crate::arithmetic::NodeId;
use crate::arithmetic::jet::Jet;
use crate::arithmetic::tape::SizedValue;
use crate::derive::{DerivedQuantity, Part, Role, Tensor, components};
use crate::fit::Column;
use crate::model::{Model, TensorRows};
use crate::problem::InputError;

/// Points where the file is evaluated in both ways.
const SPREAD_POINTS: usize = 50;

/// A source or a datum at all points.
pub(crate) struct RightQuantity<'m> {
    pub(crate) quantity: &'m DerivedQuantity<NodeId>,
    pub(crate) components: Vec<String>,
    /// For each point, all components.
    pub(crate) values: Vec<Vec<SizedValue>>,
    /// For each term, for each point, all components.
    pub(crate) terms: Vec<Vec<Vec<SizedValue>>>,
}

/// All sources, or all data of a face.
pub(crate) struct Right<'m> {
    pub(crate) model: &'m Model,
    pub(crate) part: Part,
    pub(crate) points: Vec<Vec<f64>>,
    pub(crate) quantities: Vec<RightQuantity<'m>>,
}

/// A component of a quantity.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct ComponentPlace {
    pub(crate) quantity: usize,
    pub(crate) component: usize,
}

impl<'m> Right<'m> {
    pub(crate) fn new(model: &'m Model, questions: &Questions) -> Self {
        let role = if questions.part == Part::Interior {
            Role::Source
        } else {
            Role::Datum
        };
        let points = questions.points.clone();
        let quantities = model.part(questions.part).iter().filter(|q| q.role == role);
        let quantities = quantities.map(|quantity| RightQuantity {
            components: components(&model.problem, &quantity.name, &quantity.tensor.shape),
            values: at(model, &quantity.tensor, &points),
            terms: quantity
                .terms
                .iter()
                .map(|term| at(model, &term.1, &points))
                .collect(),
            quantity,
        });
        Self {
            part: questions.part,
            quantities: quantities.collect(),
            model,
            points,
        }
    }

    /// The largest difference between the two evaluations of the file, by rules of derivatives and
    /// by Taylor series, as a share of the size: for each quantity, for each component. At least
    /// one rounding.
    ///
    /// # Errors
    /// An integral without accurate values.
    pub(crate) fn spreads(&self) -> Result<Vec<Vec<f64>>, InputError> {
        let jets = self.model.jets();
        let rounding = |right: &RightQuantity<'_>| vec![f64::EPSILON; right.components.len()];
        let mut spreads: Vec<Vec<f64>> = self.quantities.iter().map(rounding).collect();
        for (index, point) in self.points.iter().enumerate().take(SPREAD_POINTS) {
            let second = jets.at(self.part, point)?;
            for (right, spreads) in self.quantities.iter().zip(&mut spreads) {
                let same = |q: &&DerivedQuantity<Jet>| {
                    q.role == right.quantity.role && q.name == right.quantity.name
                };
                let Some(second) = second.iter().find(same) else {
                    continue;
                };
                let pairs = right.values[index].iter().zip(&second.tensor.parts);
                for ((first, second), spread) in pairs.zip(spreads) {
                    let share = (first.value - second.value()).abs() / first.size;
                    // A size of zero has no share.
                    if share.is_finite() {
                        *spread = spread.max(share);
                    }
                }
            }
        }
        Ok(spreads)
    }

    /// The names of all components.
    pub(crate) fn names(&self) -> Vec<String> {
        self.quantities
            .iter()
            .flat_map(|q| q.components.clone())
            .collect()
    }

    pub(crate) fn places(&self) -> Vec<ComponentPlace> {
        let mut places = vec![];
        for (quantity, right) in self.quantities.iter().enumerate() {
            places.extend((0..right.components.len()).map(|component| ComponentPlace {
                quantity,
                component,
            }));
        }
        places
    }

    pub(crate) fn name(&self, place: ComponentPlace) -> &str {
        &self.quantities[place.quantity].components[place.component]
    }

    pub(crate) fn place_of(&self, answer: &ForeignQuantity) -> Option<ComponentPlace> {
        self.places()
            .into_iter()
            .find(|place| self.name(*place) == answer.name)
    }

    pub(crate) fn values(&self, place: ComponentPlace) -> Vec<SizedValue> {
        let values = &self.quantities[place.quantity].values;
        values
            .iter()
            .map(|values| values[place.component])
            .collect()
    }

    pub(crate) fn terms(&self, place: ComponentPlace) -> Vec<Column> {
        let terms = self.quantities[place.quantity].terms.iter();
        terms
            .map(|values| without_rounding(values, place.component))
            .collect()
    }

    /// The labels of the terms; a datum has none.
    pub(crate) fn labels(&self, place: ComponentPlace) -> Vec<&str> {
        let terms = self.quantities[place.quantity].quantity.terms.iter();
        terms.map(|term| term.0.as_str()).collect()
    }
}

/// A component, with zeros where only rounding is left: that is no column to fit with.
fn without_rounding(values: &[Vec<SizedValue>], component: usize) -> Column {
    let values = values.iter().map(|values| values[component]);
    values
        .map(|v| {
            if v.value.abs() <= crate::arithmetic::SAME * v.size {
                0.0
            } else {
                v.value
            }
        })
        .collect()
}

fn at(model: &Model, tensor: &Tensor<NodeId>, points: &[Vec<f64>]) -> Vec<Vec<SizedValue>> {
    let rows = TensorRows::new(&model.graph, std::iter::once(tensor));
    points
        .iter()
        .map(|point| rows.at(point).tensors.remove(0))
        .collect()
}
