//! Evaluation of nodes of a graph at points.

use super::SAME;
use super::node::{Node, NodeId, Nodes, apply, operate};
use super::quadrature::{self, POINTS};
use crate::language::names::Function;
use crate::language::tree::Binary;

/// A value, and its size: the sum of the absolute values of the summands, at every sum.
///
/// A sum may cancel to zero; what rounding leaves of it is still small against its size. The size
/// of f(a), also of a power of a, is `|f'(a)|` times the size of a, or `|f(a)|` if that is larger.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct SizedValue {
    pub(crate) value: f64,
    pub(crate) size: f64,
}

/// The integral of a node over a variable, as a tape of its own.
#[derive(Debug, Clone)]
struct Inner<'g> {
    body: Tape<'g>,
    variable: usize,
    panels: usize,
}

/// The nodes that some roots are made of, in the order of evaluation.
#[derive(Debug, Clone)]
pub(crate) struct Tape<'g> {
    graph: &'g Nodes,
    /// The values of so many nodes of the graph, its first ones, are given.
    given: usize,
    steps: Vec<NodeId>,
    /// For each node of the graph behind those its place among the steps.
    places: Vec<u32>,
    roots: Vec<NodeId>,
    /// In the order of the steps.
    integrals: Vec<Inner<'g>>,
    rule: Vec<[f64; 2]>,
}

/// The values of all steps of a tape at a point, and its switches.
struct Steps {
    values: Vec<SizedValue>,
    switches: Vec<f64>,
}

/// The values of the roots of a tape at a point.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Evaluated {
    pub(crate) roots: Vec<SizedValue>,
    /// What is compared at each switch, as a difference: its sign tells the side.
    pub(crate) switches: Vec<f64>,
}

impl<'g> Tape<'g> {
    pub(crate) fn new(graph: &'g Nodes, roots: &[NodeId]) -> Self {
        Self::behind(graph, 0, roots)
    }

    /// A tape to which the values of the first nodes of the graph are given.
    ///
    /// * `given`: the number of these nodes.
    pub(crate) fn behind(graph: &'g Nodes, given: usize, roots: &[NodeId]) -> Self {
        let steps = nodes_behind(given, roots, |id| graph.node(id).operands());
        let places = steps.last().map_or(0, |last| last.0 as usize + 1 - given);
        let mut places = vec![u32::MAX; places];
        for (place, id) in steps.iter().enumerate() {
            places[id.0 as usize - given] = place as u32;
        }
        let mut integrals = vec![];
        for id in &steps {
            if let Node::Integral {
                body,
                variable,
                panels,
            } = *graph.node(*id)
            {
                let body = Tape::new(graph, &[body]);
                integrals.push(Inner {
                    body,
                    variable,
                    panels,
                });
            }
        }
        Self {
            graph,
            given,
            places,
            roots: roots.to_vec(),
            rule: match integrals.is_empty() {
                true => vec![],
                false => quadrature::gauss(POINTS),
            },
            integrals,
            steps,
        }
    }

    /// The number of nodes that one evaluation takes.
    pub(crate) fn work(&self) -> usize {
        let inner = self.integrals.iter();
        let inner = inner.map(|inner| inner.panels * self.rule.len() * inner.body.work());
        self.steps.len() + inner.sum::<usize>()
    }

    /// The roots at a point, with the parameters of the file.
    pub(crate) fn at(&self, point: &[f64]) -> Evaluated {
        self.with(point, &self.graph.parameters)
    }

    /// The roots at a point.
    pub(crate) fn with(&self, point: &[f64], parameters: &[f64]) -> Evaluated {
        self.with_given(point, parameters, &[])
    }

    /// The roots at a point.
    ///
    /// * `given`: the values of the first nodes of the graph there.
    pub(crate) fn with_given(
        &self,
        point: &[f64],
        parameters: &[f64],
        given: &[SizedValue],
    ) -> Evaluated {
        let Steps { values, switches } = self.steps(point, parameters, given);
        let roots = self.roots.iter();
        Evaluated {
            roots: roots.map(|id| self.value(*id, given, &values)).collect(),
            switches,
        }
    }

    /// All steps at a point, in the order of the nodes.
    pub(crate) fn values(&self, point: &[f64], parameters: &[f64]) -> Vec<SizedValue> {
        self.steps(point, parameters, &[]).values
    }

    /// For each node up to the last root its value at a point; `None` where no root needs it: of a
    /// choice only the branch counts that is taken.
    pub(crate) fn needed(&self, point: &[f64]) -> Vec<Option<SizedValue>> {
        let Steps { values, .. } = self.steps(point, &self.graph.parameters, &[]);
        let mut needed: Vec<Option<SizedValue>> = vec![None; self.places.len()];
        for root in &self.roots {
            needed[root.0 as usize] = Some(values[self.place(*root)]);
        }
        for id in self.steps.iter().rev() {
            if needed[id.0 as usize].is_none() {
                continue;
            }
            let node = self.graph.node(*id);
            let skipped = match node {
                Node::Choose(comparison, [left, right, ..]) => {
                    let [left, right] = [left, right].map(|id| values[self.place(*id)].value);
                    Some(if comparison.holds(left, right) { 3 } else { 2 })
                }
                _ => None,
            };
            for (number, operand) in node.operands().iter().enumerate() {
                if Some(number) != skipped {
                    needed[operand.0 as usize] = Some(values[self.place(*operand)]);
                }
            }
        }
        needed
    }

    fn place(&self, id: NodeId) -> usize {
        self.places[id.0 as usize - self.given] as usize
    }

    /// The value of a node, given or a step.
    fn value(&self, id: NodeId, given: &[SizedValue], steps: &[SizedValue]) -> SizedValue {
        let given = given.get(id.0 as usize).copied();
        given.unwrap_or_else(|| steps[self.place(id)])
    }

    /// All steps at a point.
    fn steps(&self, point: &[f64], parameters: &[f64], given: &[SizedValue]) -> Steps {
        let mut values: Vec<SizedValue> = Vec::with_capacity(self.steps.len());
        let mut switches = vec![];
        let mut integrals = self.integrals.iter();
        for id in &self.steps {
            let of = |id: &NodeId| self.value(*id, given, &values);
            let value = match self.graph.node(*id) {
                Node::Number(bits) => exactly(f64::from_bits(*bits)),
                Node::Variable(index) => exactly(point[*index]),
                Node::Parameter(index) => exactly(parameters[*index]),
                Node::Held(operand) | Node::Field(operand, _) => of(operand),
                Node::Negate(operand) => SizedValue {
                    value: -of(operand).value,
                    ..of(operand)
                },
                Node::Binary(operator, [left, right]) => binary(*operator, of(left), of(right)),
                Node::Call(function, argument) => call(*function, of(argument)),
                Node::Choose(comparison, [left, right, then, otherwise]) => {
                    let [left, right] = [of(left).value, of(right).value];
                    switches.push(left - right);
                    let is_true = comparison.holds(left, right);
                    // A comparison with NaN holds for no side.
                    if (left - right).is_nan() {
                        exactly(f64::NAN)
                    } else {
                        of(if is_true { then } else { otherwise })
                    }
                }
                Node::Integral { .. } => integrals.next().map_or(exactly(f64::NAN), |inner| {
                    let mut point = point.to_vec();
                    let Inner {
                        body,
                        variable,
                        panels,
                    } = inner;
                    body.integral(&mut point, *variable, *panels, &self.rule, parameters)
                }),
            };
            values.push(value);
        }
        Steps { values, switches }
    }

    /// The integral of the first root over a variable.
    pub(crate) fn integral(
        &self,
        point: &mut [f64],
        variable: usize,
        panels: usize,
        rule: &[[f64; 2]],
        parameters: &[f64],
    ) -> SizedValue {
        let mut total = exactly(0.0);
        for [x, weight] in quadrature::panels(self.graph.intervals[variable], panels, rule) {
            point[variable] = x;
            let part = self.with(point, parameters).roots[0];
            total.value += weight * part.value;
            total.size += weight * part.size;
        }
        total
    }
}

/// The nodes below the roots, in increasing order.
pub(crate) fn nodes_below(graph: &Nodes, roots: &[NodeId]) -> Vec<NodeId> {
    nodes_by(roots, |id| graph.node(id).operands())
}

/// The roots and what they need, in increasing order.
///
/// * `operands`: what a node needs.
pub(crate) fn nodes_by<'n>(
    roots: &[NodeId],
    operands: impl Fn(NodeId) -> &'n [NodeId],
) -> Vec<NodeId> {
    nodes_behind(0, roots, operands)
}

/// The same without the nodes before the place `first`.
fn nodes_behind<'n>(
    first: usize,
    roots: &[NodeId],
    operands: impl Fn(NodeId) -> &'n [NodeId],
) -> Vec<NodeId> {
    let last = roots.iter().max().map_or(0, |last| last.0 as usize + 1);
    let mut is_needed = vec![false; last.saturating_sub(first)];
    for root in roots {
        mark(&mut is_needed, first, *root);
    }
    for place in (0..is_needed.len()).rev() {
        if is_needed[place] {
            for operand in operands(NodeId((first + place) as u32)) {
                mark(&mut is_needed, first, *operand);
            }
        }
    }
    let places = (0..is_needed.len()).filter(|place| is_needed[*place]);
    places.map(|place| NodeId((first + place) as u32)).collect()
}

/// Marks a node that does not stand before the place `first`.
fn mark(is_needed: &mut [bool], first: usize, id: NodeId) {
    if let Some(place) = (id.0 as usize).checked_sub(first) {
        is_needed[place] = true;
    }
}

fn exactly(value: f64) -> SizedValue {
    SizedValue {
        value,
        size: value.abs(),
    }
}

fn binary(operator: Binary, left: SizedValue, right: SizedValue) -> SizedValue {
    let value = operate(operator, left.value, right.value);
    let size = match operator {
        Binary::Add | Binary::Subtract => left.size + right.size,
        Binary::Multiply => left.size * right.size,
        Binary::Divide => {
            let below = right.value.abs();
            left.size / below * (right.size / below).max(1.0)
        }
        // Where the base cancels to zero, its rounding is left in place of it.
        Binary::Power if right.value >= 1.0 => {
            let base = left.value.abs().max(SAME * left.size);
            right.value * base.powf(right.value - 1.0) * left.size
        }
        Binary::Power => value.abs() * (left.size / left.value.abs()).max(1.0),
    };
    SizedValue {
        value,
        size: finite(size, value),
    }
}

/// A size that overflows, or is 0/0, says nothing: the value itself is taken.
fn finite(size: f64, value: f64) -> f64 {
    if size.is_finite() {
        size.max(value.abs())
    } else {
        value.abs()
    }
}

fn call(function: Function, argument: SizedValue) -> SizedValue {
    let x = argument.value;
    let value = apply(function, x);
    let slope = match function {
        Function::Sin => x.cos(),
        Function::Cos => x.sin(),
        Function::Tan => 1.0 + value * value,
        Function::Asin | Function::Acos => 1.0 / (1.0 - x * x).sqrt(),
        Function::Atan => 1.0 / (1.0 + x * x),
        Function::Sinh => x.cosh(),
        Function::Cosh => x.sinh(),
        Function::Tanh => 1.0 - value * value,
        Function::Exp => value,
        Function::Ln | Function::Log10 => 1.0 / x,
        Function::Sqrt => 0.5 / value,
    };
    SizedValue {
        value,
        size: finite(slope.abs() * argument.size, value),
    }
}
