//! Nodes of a graph over a box: what their values lie between, and which operations may lack one.
//!
//! Each node has its value at the middle m of the box, its slopes g over the box, and its range:
//! the rule of its operation, and f(m) + Σ gᵢ (xᵢ - mᵢ), which holds where f is defined and
//! continuous with bounded slopes (the mean value theorem; R. E. Moore, Interval Analysis, 1966).
//! An operation that may lack a value has unbounded slopes.

use std::collections::HashMap;

use super::branches::Branches;
use super::conditions::{Condition, conditions_of, needs_of};
use super::graph::Graph;
use super::interval::Interval;
use super::node::{Node, NodeId};
use super::tape::nodes_below;
use crate::language::names::Function;
use crate::language::tree::{Binary, Relation};

/// Coordinates and time.
pub(crate) const MOST_VARIABLES: usize = 4;

/// An integral is enclosed by the sum over so many pieces.
const PIECES: usize = 16;

/// A node over a box.
#[derive(Debug, Clone, Copy)]
struct Enclosed {
    middle: Interval,
    range: Interval,
    slopes: [Interval; MOST_VARIABLES],
}

/// An integral, as an enclosure of its body.
#[derive(Debug)]
struct Inner<'g> {
    body: Enclosure<'g>,
    variable: usize,
}

/// The nodes below some roots, to be enclosed over boxes.
#[derive(Debug)]
pub(crate) struct Enclosure<'g> {
    graph: &'g Graph,
    steps: Vec<NodeId>,
    places: Vec<u32>,
    roots: Vec<NodeId>,
    integrals: Vec<Inner<'g>>,
    /// Those with the same need of the same argument stand together: all hold, or none does,
    /// wherever their operations are used.
    pub(crate) conditions: Vec<Vec<Condition>>,
}

/// The nodes over one box.
#[derive(Debug)]
pub(crate) struct Over<'e, 'g> {
    enclosure: &'e Enclosure<'g>,
    values: Vec<Enclosed>,
    /// Choices that take both branches in the box.
    undecided: Vec<NodeId>,
    /// The first choice of each comparison of these.
    comparisons: Vec<NodeId>,
    /// Whether the value of a step takes part in a root somewhere in the box: the branches of
    /// undecided choices that all ways to it go through.
    uses: Vec<Option<Branches>>,
}

impl<'g> Enclosure<'g> {
    pub(crate) fn new(graph: &'g Graph, roots: &[NodeId]) -> Self {
        let steps = nodes_below(graph, roots);
        let mut places = vec![u32::MAX; steps.last().map_or(0, |last| last.0 as usize + 1)];
        let mut integrals = vec![];
        let mut conditions: Vec<Vec<Condition>> = vec![];
        let mut known = HashMap::new();
        for (place, id) in steps.iter().enumerate() {
            places[id.0 as usize] = place as u32;
            if let Node::Integral { body, variable, .. } = *graph.node(*id) {
                let body = Enclosure::new(graph, &[body]);
                integrals.push(Inner { body, variable });
            }
            for condition in conditions_of(graph, *id) {
                let number = *known
                    .entry((condition.argument, condition.need))
                    .or_insert(conditions.len());
                if number == conditions.len() {
                    conditions.push(vec![]);
                }
                conditions[number].push(condition);
            }
        }
        Self {
            graph,
            steps,
            places,
            roots: roots.to_vec(),
            integrals,
            conditions,
        }
    }

    /// The number of nodes that a box takes.
    pub(crate) fn work(&self) -> usize {
        let inner = self.integrals.iter();
        self.steps.len()
            + inner
                .map(|inner| 2 * PIECES * inner.body.work())
                .sum::<usize>()
    }

    fn place(&self, id: NodeId) -> usize {
        self.places[id.0 as usize] as usize
    }

    pub(crate) fn over(&self, cell: &[Interval]) -> Over<'_, 'g> {
        let mut over = Over {
            enclosure: self,
            values: Vec::with_capacity(self.steps.len()),
            undecided: vec![],
            comparisons: vec![],
            uses: vec![],
        };
        let mut integrals = self.integrals.iter();
        for id in &self.steps {
            let value = match self.graph.node(*id) {
                Node::Integral { .. } => match integrals.next() {
                    Some(inner) => integral(self.graph, inner, cell),
                    None => unknown(),
                },
                node => over.value(node, cell),
            };
            over.values.push(narrowed(value, cell));
        }
        over.uses = over.uses();
        over
    }
}

impl Over<'_, '_> {
    fn of(&self, id: NodeId) -> &Enclosed {
        &self.values[self.enclosure.place(id)]
    }

    pub(crate) fn range(&self, id: NodeId) -> Interval {
        self.of(id).range
    }

    /// The value in the middle of the box.
    pub(crate) fn middle(&self, id: NodeId) -> Interval {
        self.of(id).middle
    }

    /// The result of the comparison of a choice, if it is the same all over the box.
    pub(super) fn result(&self, node: &Node) -> Option<bool> {
        let Node::Choose(comparison, [left, right, ..]) = node else {
            return None;
        };
        result(*comparison, self.range(*left) - self.range(*right))
    }

    pub(crate) fn node(&self, id: NodeId) -> &Node {
        self.enclosure.graph.node(id)
    }

    /// Whether an operation takes part in a root somewhere in the box: the branches of undecided
    /// choices that all ways to it go through.
    pub(super) fn uses_of(&self, operation: NodeId) -> Option<Branches> {
        self.uses[self.enclosure.place(operation)]
    }

    /// The first choice of each comparison without one result in the box, by its number.
    pub(super) fn comparisons(&self) -> &[NodeId] {
        &self.comparisons
    }

    /// What a choice is the absolute value of.
    pub(super) fn absolute_of(&self, choice: NodeId) -> Option<NodeId> {
        match *self.node(choice) {
            Node::Choose(Relation::Less, operands) => {
                is_opposite(self.enclosure.graph, operands).then_some(operands[0])
            }
            _ => None,
        }
    }

    /// The same nodes at a point of the box.
    pub(crate) fn at(&self, point: &[f64]) -> Self {
        let cell: Vec<Interval> = point.iter().map(|x| Interval::point(*x)).collect();
        self.enclosure.over(&cell)
    }

    /// Whether choices that take both branches in the box decide about the use of an operation.
    pub(crate) fn is_guarded(&self, operation: NodeId) -> bool {
        self.uses_of(operation)
            .is_some_and(|uses| uses != Branches::NONE)
    }

    /// Whether the slopes of a node are bounded: its values have no jump.
    pub(crate) fn is_continuous(&self, id: NodeId) -> bool {
        let slopes = self.of(id).slopes;
        slopes.iter().all(|s| s.lo.is_finite() && s.hi.is_finite())
    }

    /// Choices that take both branches in the box.
    pub(crate) fn undecided(&self) -> &[NodeId] {
        &self.undecided
    }

    fn uses(&mut self) -> Vec<Option<Branches>> {
        let enclosure = self.enclosure;
        let mut uses: Vec<Option<Branches>> = vec![None; enclosure.steps.len()];
        for root in &enclosure.roots {
            uses[enclosure.place(*root)] = Some(Branches::NONE);
        }
        for (place, id) in enclosure.steps.iter().enumerate().rev() {
            let Some(own) = uses[place] else { continue };
            let node = enclosure.graph.node(*id);
            let is_choice = matches!(node, Node::Choose(..));
            let result = self.result(node);
            let number = if is_choice && result.is_none() {
                self.undecided.push(*id);
                self.number_of(node, *id)
            } else {
                0
            };
            for (position, operand) in node.operands().iter().enumerate() {
                let is_first = position == 2;
                let is_branch = is_choice && position >= 2;
                if is_branch && result.is_some_and(|holds| holds != is_first) {
                    continue;
                }
                let way = if is_branch && result.is_none() {
                    own.with(number, is_first)
                } else {
                    own
                };
                let known = &mut uses[enclosure.place(*operand)];
                *known = Some(known.map_or(way, |known| known.common(way)));
            }
        }
        uses
    }

    /// The number of the comparison of a choice; choices with the same comparison share it.
    fn number_of(&mut self, node: &Node, id: NodeId) -> usize {
        let graph = self.enclosure.graph;
        let mut known = self.comparisons.iter();
        let same = known.position(|known| compared(graph.node(*known)) == compared(node));
        same.unwrap_or_else(|| {
            self.comparisons.push(id);
            self.comparisons.len() - 1
        })
    }

    fn value(&self, node: &Node, cell: &[Interval]) -> Enclosed {
        match node {
            Node::Number(bits) => constant(f64::from_bits(*bits)),
            Node::Parameter(index) => constant(self.enclosure.graph.parameters[*index]),
            Node::Variable(index) => {
                let mut slopes = [Interval::point(0.0); MOST_VARIABLES];
                slopes[*index] = Interval::point(1.0);
                Enclosed {
                    middle: Interval::point(cell[*index].midpoint()),
                    range: cell[*index],
                    slopes,
                }
            }
            Node::Held(operand) => *self.of(*operand),
            Node::Negate(operand) => {
                let of = self.of(*operand);
                Enclosed {
                    middle: -of.middle,
                    range: -of.range,
                    slopes: of.slopes.map(|slope| -slope),
                }
            }
            // A square is not negative, which the product of two ranges does not know.
            Node::Binary(Binary::Multiply, [left, right]) if left == right => {
                binary(Binary::Power, self.of(*left), &constant(2.0))
            }
            Node::Binary(operator, [left, right]) => {
                binary(*operator, self.of(*left), self.of(*right))
            }
            Node::Call(function, argument) => call(*function, self.of(*argument)),
            Node::Choose(comparison, operands) => self.choice(*comparison, *operands),
            Node::Integral { .. } => unknown(),
        }
    }

    fn choice(&self, comparison: Relation, operands: [NodeId; 4]) -> Enclosed {
        let [left, right, then, otherwise] = operands.map(|id| *self.of(id));
        let difference = left.range - right.range;
        if let Some(holds) = result(comparison, difference) {
            return if holds { then } else { otherwise };
        }
        let middle = match result(comparison, left.middle - right.middle) {
            Some(true) => then.middle,
            Some(false) => otherwise.middle,
            None => then.middle.hull(otherwise.middle),
        };
        let pairs = std::array::from_fn(|i| then.slopes[i].hull(otherwise.slopes[i]));
        let graph = self.enclosure.graph;
        let is_left = operands[2] == operands[0] || operands[3] == operands[0];
        let kept = match comparison {
            Relation::Less if is_left && is_opposite(graph, operands) => Some(left.range.abs()),
            Relation::LessOrEqual if operands[..2] == operands[2..] => {
                Some(left.range.min(right.range))
            }
            Relation::GreaterOrEqual if operands[..2] == operands[2..] => {
                Some(left.range.max(right.range))
            }
            _ => None,
        };
        Enclosed {
            middle,
            range: kept.unwrap_or(then.range.hull(otherwise.range)),
            // Other choices may jump.
            slopes: if kept.is_some() {
                pairs
            } else {
                [Interval::ENTIRE; MOST_VARIABLES]
            },
        }
    }
}

/// What a choice compares.
fn compared(node: &Node) -> Option<(Relation, [NodeId; 2])> {
    match *node {
        Node::Choose(comparison, [left, right, ..]) => Some((comparison, [left, right])),
        _ => None,
    }
}

/// Whether a choice is the absolute value: of its left operand compared with zero.
fn is_opposite(graph: &Graph, [left, right, then, otherwise]: [NodeId; 4]) -> bool {
    let is_negative = |of: NodeId| *graph.node(then) == Node::Negate(of);
    let is_pair = is_negative(otherwise) || *graph.node(otherwise) == Node::Negate(then);
    graph.constant(right) == Some(0.0) && otherwise == left && is_pair
}

/// The result of a comparison of a difference with zero, if it has one.
fn result(comparison: Relation, difference: Interval) -> Option<bool> {
    let Interval { lo, hi } = difference;
    match comparison {
        Relation::Less if hi < 0.0 => Some(true),
        Relation::Less if lo >= 0.0 => Some(false),
        Relation::LessOrEqual if hi <= 0.0 => Some(true),
        Relation::LessOrEqual if lo > 0.0 => Some(false),
        Relation::Greater if lo > 0.0 => Some(true),
        Relation::Greater if hi <= 0.0 => Some(false),
        Relation::GreaterOrEqual if lo >= 0.0 => Some(true),
        Relation::GreaterOrEqual if hi < 0.0 => Some(false),
        _ => None,
    }
}

fn constant(value: f64) -> Enclosed {
    Enclosed {
        middle: Interval::point(value),
        range: Interval::point(value),
        slopes: [Interval::point(0.0); MOST_VARIABLES],
    }
}

fn unknown() -> Enclosed {
    Enclosed {
        middle: Interval::ENTIRE,
        range: Interval::ENTIRE,
        slopes: [Interval::ENTIRE; MOST_VARIABLES],
    }
}

/// The range by the mean value theorem, too.
fn narrowed(value: Enclosed, cell: &[Interval]) -> Enclosed {
    let mut mean = value.middle;
    for (slope, side) in value.slopes.iter().zip(cell) {
        mean = mean + *slope * (*side - Interval::point(side.midpoint()));
    }
    Enclosed {
        range: value.range.and(mean),
        ..value
    }
}

fn binary(operator: Binary, left: &Enclosed, right: &Enclosed) -> Enclosed {
    let both = |rule: &dyn Fn(Interval, Interval) -> Interval| {
        [
            rule(left.middle, right.middle),
            rule(left.range, right.range),
        ]
    };
    let [a, b] = [left.range, right.range];
    let [[middle, range], slopes] = match operator {
        Binary::Add => [both(&|a, b| a + b), [Interval::point(1.0); 2]],
        Binary::Subtract => [
            both(&|a, b| a - b),
            [Interval::point(1.0), Interval::point(-1.0)],
        ],
        Binary::Multiply => [both(&|a, b| a * b), [b, a]],
        Binary::Divide => {
            let quotient = both(&|a, b| a / b);
            let by = Interval::point(1.0) / b;
            [quotient, [by, -quotient[1] * by]]
        }
        Binary::Power => {
            let power = both(&Interval::power);
            [power, slopes_of_power(a, b, power[1])]
        }
    };
    Enclosed {
        middle,
        range,
        slopes: std::array::from_fn(|i| slopes[0] * left.slopes[i] + slopes[1] * right.slopes[i]),
    }
}

/// (a^b)' = b a^(b-1) a' + a^b ln(a) b'.
fn slopes_of_power(base: Interval, exponent: Interval, power: Interval) -> [Interval; 2] {
    let is_constant = exponent.lo == exponent.hi;
    let is_whole = is_constant && exponent.lo.fract() == 0.0;
    let has_values = base.lo > 0.0 || (is_whole && exponent.lo > 0.0);
    if !has_values {
        return [Interval::ENTIRE; 2];
    }
    let less = base.power(exponent - Interval::point(1.0));
    let by_exponent = if is_constant {
        Interval::point(0.0)
    } else {
        power * base.call(Function::Ln)
    };
    [exponent * less, by_exponent]
}

fn call(function: Function, argument: &Enclosed) -> Enclosed {
    let range = argument.range.call(function);
    let needs = needs_of(function);
    let slope = if needs.is_none_or(|need| need.holds(argument.range)) {
        argument.range.slope(function, range)
    } else {
        Interval::ENTIRE
    };
    Enclosed {
        middle: argument.middle.call(function),
        range,
        slopes: argument.slopes.map(|inner| slope * inner),
    }
}

/// Over pieces of the interval of its variable.
fn integral(graph: &Graph, inner: &Inner<'_>, cell: &[Interval]) -> Enclosed {
    let Inner { body, variable } = inner;
    let [low, high] = graph.intervals[*variable];
    let root = body.roots[0];
    let mut total = constant(0.0);
    let at = |piece: usize| low + (high - low) * piece as f64 / PIECES as f64;
    for piece in 0..PIECES {
        let side = Interval::new(at(piece), at(piece + 1));
        let length = Interval::point(side.hi) - Interval::point(side.lo);
        let mut whole = cell.to_vec();
        whole[*variable] = side;
        let mut line: Vec<Interval> = cell.iter().map(|c| Interval::point(c.midpoint())).collect();
        line[*variable] = side;
        let [over, middle] = [body.over(&whole), body.over(&line)];
        let part = over.of(root);
        total.range = total.range + length * part.range;
        total.middle = total.middle + length * middle.range(root);
        for (sum, slope) in total.slopes.iter_mut().zip(part.slopes) {
            *sum = *sum + length * slope;
        }
    }
    total.slopes[*variable] = Interval::point(0.0);
    total
}
