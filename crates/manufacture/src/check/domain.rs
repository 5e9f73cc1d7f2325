//! Whether operations have their values: at points of the domain, and where a margin goes to zero.
//!
//! A *margin* is a number that is zero where an operation loses its value: a divisor, the argument
//! of a logarithm or a root, the cosine of the angle of `tan`, 1 - |argument| of `asin` and `acos`.
//! Points are drawn inside, on all faces, edges and corners. Between four pairs of points at which
//! a divisor has different signs the way is halved, along points where its operation is evaluated:
//! a continuous margin has a zero there, to the last digit. From the four points with the smallest
//! margins, a tenth of a side apart, a pattern search goes down, to a zero or to a minimum.
//!
//! What that guarantees. A continuous divisor that has both signs in the sample, and is evaluated
//! between them, has a zero that is found; of several zeros some may stay unseen. A region of the
//! share p of the domain, in which an operation has no value, is missed by N points with the
//! probability (1 - p)^N. The search ends at a point from which no step goes down, near its start:
//! a zero is missed that is in no valley of the smallest margins of the sample, such as one of even
//! order in a needle far narrower than the distance of the points, beside other minima; or at the
//! end of a curved or folded valley, in which 400 sweeps did not suffice. On a level nothing is
//! followed: there only the points count. So nothing found is not "free of poles".
//!
//! A margin that goes to zero matters if a quantity grows without bound there: by a power, or by as
//! much for each factor of ten in distance as a logarithm. It matters less if the quantity jumps
//! there, such as `atan(1/x)`. The quotient `sin(x)/x` does neither.

use super::approach::{self, Approach, largest};
use super::descent::{AtPoint, Descent};
use super::margin::{Margin, Need, margins};
use super::{Finding, Sampled, finding, role_words, singular};
use crate::against::site::Span;
use crate::arithmetic::tape::{Tape, nodes_below};
use crate::arithmetic::{Node, NodeId, Origin};
use crate::derive::{DerivedQuantity, Part, Role};
use crate::model::{Model, TensorRows};
use crate::problem::{Expression, InputError, System};
use crate::sample::{Random, Sampler};

/// Points inside each part; as many lie on its faces, edges and corners together.
const POINTS: usize = 2000;

/// Digits of the distance from a place down to which values are looked at.
const DIGITS: i32 = 8;

/// What was found, and at how many points.
pub(super) struct Examined {
    pub(super) findings: Vec<Finding>,
    pub(super) points: usize,
}

/// Examines all parts of the domain.
///
/// # Errors
/// The solution grows without bound, or has no value; or a source or a datum, but at the boundary.
pub(super) fn examine(model: &Model, seed: u64) -> Result<Examined, InputError> {
    let mut sampler = Sampler::new(model, seed);
    let mut examined = Examined {
        findings: vec![],
        points: 0,
    };
    for (part, quantities) in &model.parts {
        let points = sampler.everywhere(*part, POINTS);
        let nodes = quantities
            .iter()
            .map(|q| nodes_below(&model.graph, &q.tensor.parts));
        let region = Region {
            nodes: nodes.collect(),
            part: *part,
            rows: model.rows(quantities),
            sampler: &sampler,
            quantities,
            model,
        };
        examined.points += points.len();
        examined.findings.extend(region.examine(points)?);
    }
    Ok(examined)
}

/// A part of the domain, and its quantities.
struct Region<'r, 'm> {
    model: &'m Model,
    part: Part,
    quantities: &'m [DerivedQuantity<NodeId>],
    rows: TensorRows<'m>,
    /// Below each quantity.
    nodes: Vec<Vec<NodeId>>,
    sampler: &'r Sampler<'m>,
}

/// What becomes of quantities where a margin is lost, from the least on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Effect {
    /// They have a limit.
    Bounded,
    /// One has other limits from other sides, inside.
    Jumps,
    /// One grows without bound, or ends: a gradient, or at the boundary.
    Noted,
    Refused,
}

/// The limit of a quantity where a margin is lost.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Limit {
    One,
    /// Another one from another side.
    Sides,
    /// It grows without bound from some side, or has no value there nor around.
    None,
}

struct Trouble {
    effect: Effect,
    is_inside: bool,
    quantity: usize,
    point: Vec<f64>,
}

impl<'m> Region<'_, 'm> {
    fn examine(&self, points: Vec<Vec<f64>>) -> Result<Vec<Finding>, InputError> {
        let graph = &self.model.graph;
        let tensors = self.quantities.iter().map(|quantity| &quantity.tensor);
        let roots: Vec<NodeId> = tensors.flat_map(|tensor| tensor.parts.clone()).collect();
        let nodes = nodes_below(graph, &roots);
        let has_choices = nodes
            .iter()
            .any(|id| matches!(graph.node(*id), Node::Choose(..)));
        let mut margins = margins(graph, &roots);
        let positive = self.quantities.iter().filter(|q| q.role == Role::Positive);
        margins.extend(positive.map(|quantity| Margin {
            argument: quantity.tensor.parts[0],
            need: Need::Required,
            operations: vec![],
        }));
        let tape = Tape::new(graph, &roots);
        let mut samples: Vec<Vec<AtPoint<'_>>> = vec![vec![]; margins.len()];
        let mut regular = vec![];
        for point in &points {
            let needed = tape.needed(point);
            let mut is_regular = true;
            for (margin, sample) in margins.iter().zip(&mut samples) {
                if let Some(at) = margin.at(&needed) {
                    sample.push((point, at));
                    is_regular &= !margin.is_lost(at, 0.0);
                }
            }
            regular.extend(is_regular.then(|| point.clone()));
        }
        let mut findings = singular(self.model, &Sampled::new(self.model, self.part, regular));
        for (margin, sample) in margins.iter().zip(&samples) {
            let own = [margin.argument];
            let values = sample.iter().map(|entry| entry.1.value.abs());
            let descent = Descent {
                tape: Tape::new(graph, if has_choices { &roots } else { &own }),
                sampler: self.sampler,
                sides: self.sampler.sides(self.part),
                scale: values.fold(0.0, f64::max),
                margin,
            };
            let places = descent.places(sample);
            if margin.need == Need::Required {
                findings.extend(self.not_positive(&descent, &places));
                continue;
            }
            let places = places.into_iter();
            let troubles = places.filter_map(|point| self.trouble(&descent, point));
            let troubles = troubles.chain(self.on_axis(&descent, sample));
            let Some(worst) = troubles.max_by_key(|trouble| (trouble.effect, trouble.is_inside))
            else {
                continue;
            };
            let found = self.reported(margin, &worst)?;
            if !findings.iter().any(|known| known.is_like(&found)) {
                findings.push(found);
            }
        }
        Ok(findings)
    }

    /// What grows towards the axis, which no other point touches: there 1/r, which each derivative
    /// along theta has, stays bounded for smooth fields.
    fn on_axis(&self, descent: &Descent<'_, 'm>, sample: &[AtPoint<'_>]) -> Vec<Trouble> {
        const PLACES: usize = 4;
        let problem = &self.model.problem;
        let mut sides = descent.sides.clone();
        let is_there = problem.system != System::Cartesian && problem.intervals[0][0] == 0.0;
        match sides.first_mut() {
            Some(radius) if is_there && radius[0] < radius[1] => radius[0] = 0.0,
            _ => return vec![],
        }
        let descent = Descent {
            tape: descent.tape.clone(),
            sides,
            ..*descent
        };
        let places = sample.iter().take(PLACES).map(|(point, _)| {
            let mut place = (*point).clone();
            place[0] = 0.0;
            place
        });
        let lost = places.filter(|place| descent.at(place).is_some_and(|at| descent.is_lost(at)));
        let troubles = lost.filter_map(|place| self.trouble(&descent, place));
        troubles
            .filter(|trouble| trouble.effect != Effect::Bounded)
            .collect()
    }

    /// What must be positive, and is not, where its value is smallest.
    fn not_positive(&self, descent: &Descent<'_, '_>, places: &[Vec<f64>]) -> Option<Finding> {
        let root = descent.margin.argument;
        let mut quantities = self.quantities.iter();
        let quantity =
            quantities.find(|q| q.role == Role::Positive && q.tensor.parts[0] == root)?;
        let values = places
            .iter()
            .filter_map(|point| Some((point, descent.at(point)?.value)));
        let (point, value) = values.min_by(|a, b| a.1.total_cmp(&b.1))?;
        let at = self.model.place_in_words(point);
        let text = format!(
            "`{}` is {value:.3e} at {at}; required to be positive (on {POINTS} samples)",
            quantity.name
        );
        Some(finding(
            "not-positive",
            &quantity.place.key,
            text,
            Some(value),
        ))
    }

    /// What becomes of the quantities that have an operation of a margin where that is lost.
    fn trouble(&self, descent: &Descent<'_, '_>, point: Vec<f64>) -> Option<Trouble> {
        let found = self.around(descent, &point);
        let at = descent.at(&point);
        let is_zero = at.is_none_or(|at| descent.margin.is_lost(at, 0.0));
        let is_inside = !self.sampler.is_on_boundary(self.part, &point);
        let mut worst: Option<(Effect, usize)> = None;
        for (place, quantity) in self.quantities.iter().enumerate() {
            let mut operations = descent.margin.operations.iter();
            if !operations.any(|operation| self.nodes[place].binary_search(operation).is_ok()) {
                continue;
            }
            let effect = match quantity.role {
                _ if found[place] == Limit::Sides && is_inside => Effect::Jumps,
                _ if found[place] != Limit::None && !is_zero => continue,
                _ if found[place] != Limit::None => Effect::Bounded,
                Role::Exact => Effect::Refused,
                Role::Gradient => Effect::Noted,
                _ if is_inside => Effect::Refused,
                _ => Effect::Noted,
            };
            // Of equal effects that of the solution.
            if worst.is_none_or(|worst| effect > worst.0) {
                worst = Some((effect, place));
            }
        }
        worst.map(|(effect, quantity)| Trouble {
            effect,
            is_inside,
            quantity,
            point,
        })
    }

    /// What becomes of each quantity towards a point.
    fn around(&self, descent: &Descent<'_, '_>, point: &[f64]) -> Vec<Limit> {
        let rows = |point: &[f64]| self.rows.at(point).tensors;
        let at = descent.at(point);
        // As small as at the place itself: not on the way to it.
        let least = at.map_or(0.0, |at| 2.0 * at.value.abs());
        let around =
            |half: i32| descent.around(point, 10_f64.powf(-0.5 * f64::from(half)), &mut Random(1));
        let distances: Vec<Vec<Vec<f64>>> = (1..=2 * DIGITS).map(around).collect();
        let mut directions: Vec<Vec<Approach>> = vec![vec![]; self.quantities.len()];
        let mut is_lost = true;
        for direction in 0..distances[0].len() {
            let mut nearer: Vec<Approach> = vec![vec![]; self.quantities.len()];
            for points in &distances {
                let point = &points[direction];
                match descent.at(point) {
                    Some(at) if descent.margin.is_lost(at, least) => break,
                    Some(_) => is_lost = false,
                    None => continue,
                }
                let pairs = nearer.iter_mut().zip(rows(point));
                pairs.for_each(|(nearer, values)| nearer.push(values));
            }
            let pairs = directions.iter_mut().zip(nearer);
            pairs.for_each(|(of_quantity, nearer)| of_quantity.push(nearer));
        }
        if is_lost || at.is_some_and(|at| descent.margin.is_outside(at)) {
            let values = rows(point).into_iter();
            let limits = values.map(|values| match largest(&values).value.is_finite() {
                true => Limit::One,
                false => Limit::None,
            });
            return limits.collect();
        }
        let limits = directions.iter().map(|approaches| {
            if approach::grows(approaches) {
                Limit::None
            } else if approach::jumps(approaches) {
                Limit::Sides
            } else {
                Limit::One
            }
        });
        limits.collect()
    }

    /// A note.
    ///
    /// # Errors
    /// A trouble that is refused, with its place in the file.
    fn reported(&self, margin: &Margin, trouble: &Trouble) -> Result<Finding, InputError> {
        let quantity = &self.quantities[trouble.quantity];
        let nodes = [margin.operations[0], margin.argument].into_iter();
        let mut origins = nodes.filter_map(|node| self.model.graph.origin(node));
        let origin = origins.next();
        let argument = match (origin, self.model.graph.node(margin.argument)) {
            (Some(origin), _) => origin.argument.to_string(),
            (None, Node::Variable(index)) => self.model.problem.variables()[*index].to_owned(),
            (None, _) => "a part".to_owned(),
        };
        let words = self.words(margin, trouble, &argument);
        let text = format!("{} {}: {words}", role_words(quantity.role), quantity.name);
        match (trouble.effect, origin) {
            (Effect::Noted, _) => Ok(finding("pole", &quantity.place.key, text, None)),
            (Effect::Jumps, _) => Ok(finding("surface-source", &quantity.place.key, text, None)),
            (Effect::Bounded, _) => Ok(finding("removable", &quantity.place.key, text, None)),
            (Effect::Refused, Some(Origin { within, argument })) => {
                let Expression {
                    place, text: of, ..
                } = within;
                let is_own = place.key == quantity.place.key;
                let problem = if is_own { &words } else { &text };
                Err(place.error_at(of, Span::of(argument).start, problem))
            }
            (Effect::Refused, None) => Err(quantity.place.error(text)),
        }
    }

    fn words(&self, margin: &Margin, trouble: &Trouble, argument: &str) -> String {
        let graph = &self.model.graph;
        let whole = self.model.place_in_words(&trouble.point);
        let parts = whole.split(", ").enumerate();
        let parts = parts.filter(|(axis, _)| graph.depends_on(margin.argument, *axis));
        let parts: Vec<&str> = parts.map(|part| part.1).collect();
        let at = match parts.is_empty() {
            true => "every point".to_owned(),
            false => parts.join(", "),
        };
        let [is, expected] = match margin.need {
            Need::NonZero => ["is zero", "a divisor that is zero nowhere"],
            Need::Tangent => ["has no tangent", "an angle that is no odd multiple of pi/2"],
            Need::Positive | Need::Required => ["is not positive", "a positive number"],
            Need::NotNegative => ["is negative", "a number that is not negative"],
            Need::Unit => ["is not between -1 and 1", "a number from -1 to 1"],
        };
        let side = match trouble.is_inside {
            true => "inside",
            false => "on the boundary of",
        };
        let part = match self.part {
            Part::Face(index) => format!(" on the face {}", self.model.problem.faces[index].name),
            Part::Initial => " at the first time".to_owned(),
            Part::Interior => String::new(),
        };
        let what = match (trouble.effect, margin.need) {
            (Effect::Jumps, _) => {
                return format!(
                    "`{argument}` {is}{part} at about {at}, where the value jumps: if what is differentiated \
                     jumps there, its derivative is a source on that surface, too, which the values of the \
                     source do not hold"
                );
            }
            (Effect::Bounded, _) => {
                return format!(
                    "`{argument}` {is}{part} at about {at}, where the value stays bounded: it is a \
                     limit there, which a program has to know"
                );
            }
            (_, Need::NonZero) => "a pole",
            _ => "no value",
        };
        format!(
            "{what} {side} the domain{part}: `{argument}` {is} at about {at}; expected {expected}"
        )
    }
}
