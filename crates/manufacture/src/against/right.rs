//! The right values.

use super::Questions;
use crate::arithmetic::tape::SizedValue;
use crate::arithmetic::{NodeId, SAME};
use crate::derive::{DerivedQuantity, Part, Role, components};
use crate::fit::Column;
use crate::model::{Model, TensorRows};
use crate::problem::InputError;

/// Points where the file is evaluated in both ways.
const SPREAD_POINTS: usize = 50;

/// A component of a source or of a datum.
pub(super) struct RightComponent<'m> {
    pub(super) name: String,
    pub(super) quantity: &'m DerivedQuantity<NodeId>,
    /// Its place among the components of the quantity.
    pub(super) place: usize,
    pub(super) values: Vec<SizedValue>,
    /// Of each term; a datum has none.
    pub(super) terms: Vec<Column>,
}

/// All sources, or all data of a face.
pub(super) struct Right<'m> {
    pub(super) model: &'m Model,
    pub(super) questions: Questions,
    pub(super) components: Vec<RightComponent<'m>>,
}

impl<'m> Right<'m> {
    pub(super) fn new(model: &'m Model, questions: Questions) -> Self {
        let role = match questions.part {
            Part::Interior => Role::Source,
            _ => Role::Datum,
        };
        let mut all = vec![];
        let quantities = model.part(questions.part).iter();
        for quantity in quantities.filter(|quantity| quantity.role == role) {
            let terms = quantity.terms.iter().map(|term| &term.1);
            let tensors = std::iter::once(&quantity.tensor).chain(terms);
            let rows = TensorRows::new(&model.graph, tensors);
            let points = questions.points.iter();
            let rows: Vec<_> = points.map(|point| rows.at(point).tensors).collect();
            let names = components(&model.problem, &quantity.name, &quantity.tensor.shape);
            for (place, name) in names.into_iter().enumerate() {
                let of = |tensor: usize| rows.iter().map(move |row| row[tensor][place]);
                let terms = 1..=quantity.terms.len();
                all.push(RightComponent {
                    name,
                    quantity,
                    place,
                    values: of(0).collect(),
                    terms: terms
                        .map(|term| of(term).map(without_rounding).collect())
                        .collect(),
                });
            }
        }
        Self {
            model,
            questions,
            components: all,
        }
    }

    /// The largest difference between the two evaluations of the file, by rules of derivatives and
    /// by Taylor series, as a share of the size, of each component. At least one rounding.
    ///
    /// # Errors
    /// An integral without accurate values.
    pub(super) fn spreads(&self) -> Result<Vec<f64>, InputError> {
        let jets = self.model.jets();
        let mut spreads = vec![f64::EPSILON; self.components.len()];
        let points = self.questions.points.iter().enumerate();
        for (index, point) in points.take(SPREAD_POINTS) {
            let second = jets.at(self.questions.part, point)?;
            for (right, spread) in self.components.iter().zip(&mut spreads) {
                let of = right.quantity;
                let mut same = second
                    .iter()
                    .filter(|q| q.role == of.role && q.name == of.name);
                let Some(second) = same.next() else { continue };
                let SizedValue { value, size } = right.values[index];
                let share = (value - second.tensor.parts[right.place].value()).abs() / size;
                // A size of zero has no share.
                if share.is_finite() {
                    *spread = spread.max(share);
                }
            }
        }
        Ok(spreads)
    }

    /// The names of all components.
    pub(super) fn names(&self) -> Vec<String> {
        self.components
            .iter()
            .map(|right| right.name.clone())
            .collect()
    }
}

impl RightComponent<'_> {
    /// The labels of the terms.
    pub(super) fn labels(&self) -> Vec<&str> {
        self.quantity
            .terms
            .iter()
            .map(|term| term.0.as_str())
            .collect()
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
