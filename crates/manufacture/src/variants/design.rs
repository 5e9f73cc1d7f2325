//! Which variants a file has.

use super::Switch;
use crate::against::candidates::trees::number;
use crate::problem::{Bubble, Problem, Surface, Variation, VariationStep};

/// A variable that is held takes the value at this share of its interval: no place of symmetry.
pub(super) const MIDDLE: f64 = 0.4;

/// The order that a study claims if the file says nothing.
const USUAL_ORDER: f64 = 2.0;

/// An end of the interval of a variable: a side of the box, or the first time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct End {
    pub(super) variable: usize,
    is_upper: bool,
}

impl End {
    pub(super) fn at(self, problem: &Problem) -> f64 {
        problem.intervals[self.variable][usize::from(self.is_upper)]
    }
}

/// A variant that is to be tried.
#[derive(Debug, Clone)]
pub(super) struct Design {
    pub(super) switch: Switch,
    /// The variables in which the fields are constant.
    constant: Vec<usize>,
    /// The ends at which the fields are flat.
    flat: Vec<End>,
}

impl Design {
    fn constant(switch: Switch, variables: impl IntoIterator<Item = usize>) -> Self {
        Self {
            switch,
            constant: variables.into_iter().collect(),
            flat: vec![],
        }
    }

    fn flat(switch: Switch, ends: &[End]) -> Self {
        Self {
            switch,
            constant: vec![],
            flat: ends.to_vec(),
        }
    }

    /// Whether the fields vanish somewhere.
    pub(super) fn is_flat(&self) -> bool {
        !self.flat.is_empty()
    }

    /// What it does to the fields.
    ///
    /// * `is_weighed`: whether fields are flat by a weight also at one end: of a field that is its
    ///   own Taylor polynomial nothing is left without that.
    pub(super) fn variation(&self, problem: &Problem, is_weighed: bool) -> Variation {
        let degree = degree(problem);
        let mut steps = vec![];
        for (variable, [low, high]) in problem.intervals.iter().copied().enumerate() {
            if self.constant.contains(&variable) {
                let at = low + MIDDLE * (high - low);
                steps.push(VariationStep::Fix { variable, at });
            }
            let ends: Vec<&End> = self
                .flat
                .iter()
                .filter(|end| end.variable == variable)
                .collect();
            let interval = match ends.as_slice() {
                [] => continue,
                [end] if !is_weighed => {
                    steps.push(VariationStep::Flatten {
                        variable,
                        end: end.at(problem),
                        degree,
                    });
                    continue;
                }
                // The other end of the bubble lies behind the other side.
                [end] if end.is_upper => [2.0 * low - high, high],
                [_] => [low, 2.0 * high - low],
                _ => [low, high],
            };
            steps.push(VariationStep::Weigh(Bubble {
                variable,
                interval,
                degree,
            }));
        }
        let field = match &self.switch {
            Switch::Field(name) => Some(name.clone()),
            _ => None,
        };
        Variation {
            steps,
            field,
            ..Variation::default()
        }
    }
}

/// A side of the box that has data, by their names.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct BoxSide {
    pub(super) name: String,
    pub(super) end: End,
    pub(super) data: Vec<String>,
}

/// All variants: first the base's coordinates and time, then sides, the first time, parameters,
/// fields.
pub(super) fn designs(problem: &Problem) -> Vec<Design> {
    let mut designs = vec![];
    let coordinates = problem.coordinates.iter().enumerate();
    for (place, name) in coordinates.clone() {
        designs.push(Design::constant(Switch::Coordinate(name.clone()), [place]));
    }
    let time = problem.coordinates.len();
    if let Some(name) = &problem.time {
        designs.push(Design::constant(Switch::Time(name.clone()), [time]));
    }
    let sides = sides(problem);
    let ends: Vec<End> = sides.iter().map(|side| side.end).collect();
    for side in &sides {
        designs.push(Design::flat(Switch::Face(side.name.clone()), &[side.end]));
    }
    for (place, name) in coordinates {
        let both: Vec<End> = ends
            .iter()
            .copied()
            .filter(|end| end.variable == place)
            .collect();
        if both.len() == 2 {
            designs.push(Design::flat(Switch::BothFaces(name.clone()), &both));
        }
    }
    // Sides of one coordinate alone have their variants already.
    if ends.iter().any(|end| end.variable != ends[0].variable) {
        designs.push(Design::flat(Switch::AllFaces, &ends));
        for side in sides.iter().filter(|_| sides.len() > 2) {
            let mut others = ends.clone();
            others.retain(|end| *end != side.end);
            designs.push(Design::flat(
                Switch::AllFacesBut(side.name.clone()),
                &others,
            ));
        }
    }
    // A program may take its initial data from the exact solution, without `[initial]`.
    if problem.time.is_some() {
        let first = End {
            variable: time,
            is_upper: false,
        };
        designs.push(Design::flat(Switch::Initial, &[first]));
        if !ends.is_empty() {
            let all = [ends.as_slice(), &[first]].concat();
            designs.push(Design::flat(Switch::AllFacesAndInitial, &all));
        }
    }
    for name in &problem.switchable {
        designs.push(Design::constant(Switch::Parameter(name.clone()), []));
    }
    if problem.exact_fields().count() > 1 {
        for name in problem.exact_fields() {
            let variables = 0..problem.intervals.len();
            designs.push(Design::constant(Switch::Field(name.to_owned()), variables));
        }
    }
    designs
}

/// One more than the largest order that is claimed.
fn degree(problem: &Problem) -> usize {
    let study = problem.study.iter();
    let orders = study.flat_map(|study| study.order.values());
    let largest = orders.map(|order| order.get()).fold(0.0, f64::max);
    let order = if largest > 0.0 { largest } else { USUAL_ORDER };
    order.ceil() as usize + 1
}

/// The sides that have data, in the order of the coordinates.
pub(super) fn sides(problem: &Problem) -> Vec<BoxSide> {
    let mut sides = vec![];
    for (variable, coordinate) in problem.coordinates.iter().enumerate() {
        for (is_upper, ending) in [(false, "min"), (true, "max")] {
            let side = Surface::Side {
                coordinate: variable,
                is_upper,
            };
            let faces = problem.faces.iter().filter(|face| face.surface == side);
            let data = faces.flat_map(|face| &face.data);
            let data: Vec<String> = data.map(|datum| datum.name.clone()).collect();
            if !data.is_empty() {
                sides.push(BoxSide {
                    name: format!("{coordinate}_{ending}"),
                    end: End { variable, is_upper },
                    data,
                });
            }
        }
    }
    sides
}

/// The name of a face on a level that has data.
pub(super) fn on_a_level(problem: &Problem) -> Option<&str> {
    let mut faces = problem.faces.iter();
    let face =
        faces.find(|face| matches!(face.surface, Surface::Level(_)) && !face.data.is_empty())?;
    Some(&face.name)
}

/// A parameter is zero; those made of it follow.
pub(super) fn set_to_zero(problem: &mut Problem, name: &str) {
    let mut parameters = problem.parameters.iter_mut();
    if let Some(parameter) = parameters.find(|parameter| parameter.name == name) {
        "0".clone_into(&mut parameter.expression.text);
        parameter.expression.tree = number("0", 0.0);
    }
}
