//! Which variants a file has.

use super::Switch;
use crate::language::tree::{Tree, TreeKind};
use crate::problem::{Bubble, Variation, VariationStep};
use crate::problem::{Problem, Surface};

/// A variable that is held takes the value at this share of its interval: no place of symmetry.
pub(super) const MIDDLE: f64 = 0.4;

/// The order that a study claims if the file says nothing.
const USUAL_ORDER: f64 = 2.0;

/// A variant that is to be tried.
#[derive(Debug, Clone)]
pub(super) struct Design {
    pub(super) switch: Switch,
    pub(super) variation: Variation,
}

impl Design {
    /// Whether the fields vanish somewhere.
    pub(super) fn is_flat(&self) -> bool {
        let mut steps = self.variation.steps.iter();
        steps.any(|step| !matches!(step, VariationStep::Fix { .. }))
    }
}

impl Design {
    /// The same flat by a weight: of a field that is its own Taylor polynomial nothing is left
    /// without that.
    pub(super) fn weighed(self, intervals: &[[f64; 2]]) -> Self {
        let steps = self.variation.steps.into_iter().map(|step| match step {
            VariationStep::Flatten {
                variable,
                end,
                degree,
            } => {
                let [low, high] = intervals[variable];
                // One end of the bubble lies behind the other side.
                let behind = 2.0 * (low + high - end) - end;
                VariationStep::Weigh(Bubble {
                    variable,
                    interval: [end.min(behind), end.max(behind)],
                    degree,
                })
            }
            step => step,
        });
        Self {
            variation: Variation {
                steps: steps.collect(),
                ..self.variation
            },
            switch: self.switch,
        }
    }
}

/// A side of the box that has data.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct BoxSide {
    pub(super) coordinate: usize,
    name: String,
    pub(super) at: f64,
}

/// All variants: first the base's coordinates and time, then sides, the first time, parameters,
/// fields.
pub(super) fn designs(problem: &Problem) -> Vec<Design> {
    let mut designs = vec![];
    for (place, name) in problem.coordinates.iter().enumerate() {
        let switch = Switch::Coordinate(name.clone());
        designs.push(steps(switch, vec![fix(problem, place)]));
    }
    let time = problem.coordinates.len();
    if let Some(name) = &problem.time {
        let switch = Switch::Time(name.clone());
        designs.push(steps(switch, vec![fix(problem, time)]));
    }
    let sides = sides(problem);
    for side in &sides {
        let switch = Switch::Face(side.name.clone());
        designs.push(steps(switch, flat(problem, &[side])));
    }
    designs.extend(of_several(problem, &sides));
    // A program may take its initial data from the exact solution, without `[initial]`.
    if problem.time.is_some() {
        let initial = VariationStep::Flatten {
            variable: time,
            end: problem.intervals[time][0],
            degree: degree(problem),
        };
        designs.push(steps(Switch::Initial, vec![initial.clone()]));
        if !sides.is_empty() {
            let all: Vec<&BoxSide> = sides.iter().collect();
            let mut everywhere = flat(problem, &all);
            everywhere.push(initial);
            designs.push(steps(Switch::AllFacesAndInitial, everywhere));
        }
    }
    for name in &problem.switchable {
        designs.push(steps(Switch::Parameter(name.clone()), vec![]));
    }
    designs.extend(of_fields(problem));
    designs
}

/// Variants that are flat at several sides.
fn of_several(problem: &Problem, sides: &[BoxSide]) -> Vec<Design> {
    let mut designs = vec![];
    let mut coordinates = 0;
    for (place, name) in problem.coordinates.iter().enumerate() {
        let of = |side: &&BoxSide| side.coordinate == place;
        let both: Vec<&BoxSide> = sides.iter().filter(of).collect();
        coordinates += usize::from(!both.is_empty());
        if both.len() == 2 {
            let switch = Switch::BothFaces(name.clone());
            designs.push(steps(switch, flat(problem, &both)));
        }
    }
    if coordinates < 2 {
        return designs;
    }
    let all: Vec<&BoxSide> = sides.iter().collect();
    designs.push(steps(Switch::AllFaces, flat(problem, &all)));
    if sides.len() < 3 {
        return designs;
    }
    for side in sides {
        let others: Vec<&BoxSide> = sides.iter().filter(|other| *other != side).collect();
        let switch = Switch::AllFacesBut(side.name.clone());
        designs.push(steps(switch, flat(problem, &others)));
    }
    designs
}

/// One field of several that is constant.
fn of_fields(problem: &Problem) -> Vec<Design> {
    let exact = problem.definitions.iter().filter(|entry| entry.1.is_exact);
    let fields: Vec<&String> = exact.map(|entry| entry.0).collect();
    if fields.len() < 2 {
        return vec![];
    }
    let all: Vec<VariationStep> = (0..problem.intervals.len())
        .map(|variable| fix(problem, variable))
        .collect();
    let design = |field: &&String| {
        let mut design = steps(Switch::Field((*field).clone()), all.clone());
        design.variation.field = Some((*field).clone());
        design
    };
    fields.iter().map(design).collect()
}

fn steps(switch: Switch, steps: Vec<VariationStep>) -> Design {
    Design {
        switch,
        variation: Variation {
            steps,
            ..Variation::default()
        },
    }
}

fn fix(problem: &Problem, variable: usize) -> VariationStep {
    let [low, high] = problem.intervals[variable];
    VariationStep::Fix {
        variable,
        at: low + MIDDLE * (high - low),
    }
}

/// One more than the largest order that is claimed.
fn degree(problem: &Problem) -> usize {
    let study = problem.study.iter();
    let orders = study.flat_map(|study| &study.orders);
    let largest = orders.map(|order| order.1).fold(0.0, f64::max);
    let order = if largest > 0.0 { largest } else { USUAL_ORDER };
    order.ceil() as usize + 1
}

/// Flat at these sides: one step for each coordinate.
fn flat(problem: &Problem, sides: &[&BoxSide]) -> Vec<VariationStep> {
    let degree = degree(problem);
    let mut steps = vec![];
    for (variable, interval) in problem.intervals.iter().enumerate() {
        let mut of_variable = sides.iter().filter(|side| side.coordinate == variable);
        steps.extend(match (of_variable.next(), of_variable.next()) {
            (None, _) => None,
            (Some(side), None) => Some(VariationStep::Flatten {
                variable,
                end: side.at,
                degree,
            }),
            (Some(_), Some(_)) => Some(VariationStep::Weigh(Bubble {
                variable,
                interval: *interval,
                degree,
            })),
        });
    }
    steps
}

/// The sides that have data, in the order of the coordinates.
pub(super) fn sides(problem: &Problem) -> Vec<BoxSide> {
    let mut sides = vec![];
    for (place, name) in problem.coordinates.iter().enumerate() {
        for (upper, ending) in [(false, "min"), (true, "max")] {
            let has_data = problem.faces.iter().any(|face| {
                let side = Surface::Side {
                    coordinate: place,
                    is_upper: upper,
                };
                face.surface == side && !face.data.is_empty()
            });
            if has_data {
                sides.push(BoxSide {
                    coordinate: place,
                    name: format!("{name}_{ending}"),
                    at: problem.intervals[place][usize::from(upper)],
                });
            }
        }
    }
    sides
}

/// The names of the data of a side of the box.
pub(super) fn data_at<'p>(problem: &'p Problem, name: &str) -> Vec<&'p str> {
    let sides = sides(problem);
    let side = sides.iter().find(|side| side.name == name);
    let faces = problem.faces.iter().filter(|face| match face.surface {
        Surface::Side {
            coordinate,
            is_upper,
        } => side.is_some_and(|side| {
            side.coordinate == coordinate
                && side.at == problem.intervals[coordinate][usize::from(is_upper)]
        }),
        Surface::Level(_) => false,
    });
    faces
        .flat_map(|face| face.data.iter().map(|datum| datum.name.as_str()))
        .collect()
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
        parameter.expression.tree = Tree {
            kind: TreeKind::Number(0.0, "0".to_owned()),
            at: 0,
        };
    }
}
