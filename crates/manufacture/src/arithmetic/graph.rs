//! The graph of expressions: each node is stored once, 0, 1 and numbers are folded when a node is
//! made, and each kind of node has one rule for its derivative.

mod steps;
mod substitution;

use rustc_hash::FxHashMap;
use std::ops::Deref;

pub(crate) use steps::Steps;

use super::node::{FieldDerivative, Node, NodeId, Nodes, apply, operate};
use super::quadrature::{self, POINTS};
use super::tape::Tape;
use super::{Algebra, Origin};
use crate::language::names::Function;
use crate::language::tree::{Binary, Relation};

/// A node is made of parameters, so its value is not known before they are.
const PARAMETERS: u8 = 1 << 7;

/// How much a graph holds, to go back to.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Mark {
    nodes: usize,
    derived: usize,
}

/// All expressions of a file.
#[derive(Debug, Default)]
pub(crate) struct Graph {
    nodes: Nodes,
    places: FxHashMap<Node, NodeId>,
    derivatives: FxHashMap<(NodeId, usize), NodeId>,
    /// The keys of `derivatives`, in the order in which they were added.
    derived: Vec<(NodeId, usize)>,
    /// A bit for each variable that a node depends on, and [`PARAMETERS`].
    depends: Vec<u8>,
    /// Exact fields are nodes of their own.
    keeps_fields: bool,
    /// Where choices go over smoothly from one value to the other; `None` if they jump.
    steps: Option<Steps>,
    /// Of operations that the file has, each where it is first.
    origins: FxHashMap<NodeId, Origin>,
}

impl Deref for Graph {
    type Target = Nodes;

    fn deref(&self) -> &Nodes {
        &self.nodes
    }
}

impl Graph {
    pub(crate) fn new(intervals: Vec<[f64; 2]>, parameters: Vec<f64>) -> Self {
        let nodes = Nodes {
            intervals,
            parameters,
            ..Nodes::default()
        };
        Self {
            nodes,
            ..Self::default()
        }
    }

    /// The same graph, where exact fields and their derivatives are nodes of their own.
    pub(crate) fn keeping_fields(self) -> Self {
        Self {
            keeps_fields: true,
            ..self
        }
    }

    /// The same graph, where choices go over smoothly, so that derivatives see the step.
    pub(crate) fn with_steps(self, steps: Steps) -> Self {
        Self {
            steps: Some(steps),
            ..self
        }
    }

    /// Whether it changes with the variable.
    pub(crate) fn depends_on(&self, id: NodeId, variable: usize) -> bool {
        self.depends[id.0 as usize] & (1 << variable) != 0
    }

    /// Where the file has a node as an operation, or as the argument of one.
    pub(crate) fn origin(&self, id: NodeId) -> Option<&Origin> {
        self.origins.get(&id)
    }

    /// How much it holds now.
    pub(crate) fn mark(&self) -> Mark {
        Mark {
            nodes: self.len(),
            derived: self.derived.len(),
        }
    }

    /// Forgets what was added since a mark.
    pub(crate) fn rewind(&mut self, mark: Mark) {
        for key in self.derived.drain(mark.derived..) {
            self.derivatives.remove(&key);
        }
        for node in self.nodes.list.drain(mark.nodes..) {
            self.places.remove(&node);
        }
        self.depends.truncate(mark.nodes);
    }

    fn store(&mut self, node: Node) -> NodeId {
        if let Some(place) = self.places.get(&node) {
            return *place;
        }
        let depends = match node {
            Node::Variable(index) => 1 << index,
            Node::Parameter(_) => PARAMETERS,
            // Of any variable: whether one solution is constant is not seen.
            Node::Field(..) => PARAMETERS | ((1 << self.intervals.len()) - 1),
            Node::Integral { body, variable, .. } => {
                self.depends[body.0 as usize] & !(1 << variable)
            }
            _ => node
                .operands()
                .iter()
                .fold(0, |all, id| all | self.depends[id.0 as usize]),
        };
        let place = NodeId(self.len() as u32);
        self.nodes.list.push(node);
        self.depends.push(depends);
        self.places.insert(node, place);
        place
    }

    /// A binary operation whose value is simpler than a new node; `None` if there is none.
    fn folded(&mut self, operator: Binary, left: NodeId, right: NodeId) -> Option<NodeId> {
        let a = self.constant(left);
        let b = self.constant(right);
        if let (Some(a), Some(b)) = (a, b) {
            return Some(self.number(operate(operator, a, b)));
        }
        match (operator, a, b) {
            (Binary::Add, Some(0.0), _) => Some(right),
            (Binary::Add | Binary::Subtract, _, Some(0.0)) => Some(left),
            (Binary::Multiply, Some(0.0), _) | (Binary::Divide, Some(0.0), _) => {
                Some(self.number(0.0))
            }
            (Binary::Multiply, _, Some(0.0)) => Some(self.number(0.0)),
            (Binary::Multiply, Some(1.0), _) => Some(right),
            (Binary::Multiply | Binary::Divide | Binary::Power, _, Some(1.0)) => Some(left),
            (Binary::Power, _, Some(0.0)) => Some(self.number(1.0)),
            (Binary::Power, _, Some(0.5)) => Some(self.call(Function::Sqrt, &left)),
            (Binary::Subtract, Some(0.0), _) | (Binary::Multiply, Some(-1.0), _) => {
                Some(self.opposite(right))
            }
            (Binary::Multiply | Binary::Divide, _, Some(-1.0)) => Some(self.opposite(left)),
            _ => self.signs(operator, left, right),
        }
    }

    fn opposite(&mut self, of: NodeId) -> NodeId {
        match *self.node(of) {
            Node::Negate(inner) => inner,
            Node::Number(bits) => self.number(-f64::from_bits(bits)),
            _ => self.store(Node::Negate(of)),
        }
    }

    /// A sign of an operand moves outwards, so that derivatives of -q and q share their nodes.
    fn signs(&mut self, operator: Binary, left: NodeId, right: NodeId) -> Option<NodeId> {
        match (operator, *self.node(left), *self.node(right)) {
            (Binary::Add, _, Node::Negate(right)) => {
                Some(self.binary(Binary::Subtract, &left, &right))
            }
            (Binary::Subtract, _, Node::Negate(right)) => {
                Some(self.binary(Binary::Add, &left, &right))
            }
            (Binary::Multiply | Binary::Divide, Node::Negate(left), _) => {
                let inner = self.binary(operator, &left, &right);
                Some(self.opposite(inner))
            }
            (Binary::Multiply | Binary::Divide, _, Node::Negate(right)) => {
                let inner = self.binary(operator, &left, &right);
                Some(self.opposite(inner))
            }
            _ => None,
        }
    }

    fn product(&mut self, left: NodeId, right: NodeId) -> NodeId {
        self.binary(Binary::Multiply, &left, &right)
    }

    fn derive(&mut self, of: NodeId, by: usize) -> NodeId {
        match *self.node(of) {
            Node::Number(_) | Node::Parameter(_) | Node::Held(_) => self.number(0.0),
            Node::Variable(index) => self.number(f64::from(u8::from(index == by))),
            Node::Negate(inner) => {
                let slope = self.derivative(&inner, by);
                self.opposite(slope)
            }
            Node::Binary(operator, operands) => self.derive_binary(of, operator, operands, by),
            Node::Field(value, mut derivative) => {
                derivative.times[by] += 1;
                let slope = self.derivative(&value, by);
                self.store(Node::Field(slope, derivative))
            }
            Node::Call(function, argument) => {
                let outer = self.slope(of, function, argument);
                let inner = self.derivative(&argument, by);
                self.product(outer, inner)
            }
            Node::Choose(comparison, [left, right, then, otherwise]) => {
                let then = self.derivative(&then, by);
                let otherwise = self.derivative(&otherwise, by);
                self.choose(comparison, [&left, &right], &then, &otherwise)
            }
            Node::Integral { body, variable, .. } => {
                let slope = self.derivative(&body, by);
                // A slope that is not integrated accurately becomes NaN, which the check reports as
                // singular.
                self.integral(&slope, variable)
                    .unwrap_or_else(|_| self.number(f64::NAN))
            }
        }
    }

    fn derive_binary(
        &mut self,
        of: NodeId,
        operator: Binary,
        operands: [NodeId; 2],
        by: usize,
    ) -> NodeId {
        let [left, right] = operands;
        let [by_left, by_right] = operands.map(|operand| self.derivative(&operand, by));
        match operator {
            Binary::Add | Binary::Subtract => self.binary(operator, &by_left, &by_right),
            Binary::Multiply => {
                let first = self.product(by_left, right);
                let second = self.product(left, by_right);
                self.binary(Binary::Add, &first, &second)
            }
            // (a / b)' = (a' - (a / b) b') / b
            Binary::Divide => {
                let second = self.product(of, by_right);
                let above = self.binary(Binary::Subtract, &by_left, &second);
                self.binary(Binary::Divide, &above, &right)
            }
            // (a^b)' = b a^(b-1) a' + a^b ln(a) b'
            Binary::Power => {
                let one = self.number(1.0);
                let less = self.binary(Binary::Subtract, &right, &one);
                let power = self.binary(Binary::Power, &left, &less);
                let slope = self.product(right, power);
                let first = self.product(slope, by_left);
                if self.constant(by_right) == Some(0.0) {
                    return first;
                }
                let logarithm = self.call(Function::Ln, &left);
                let growth = self.product(of, logarithm);
                let second = self.product(growth, by_right);
                self.binary(Binary::Add, &first, &second)
            }
        }
    }

    /// The derivative of a function at its argument; `of` is its value.
    fn slope(&mut self, of: NodeId, function: Function, argument: NodeId) -> NodeId {
        let one = self.number(1.0);
        let two = self.number(2.0);
        match function {
            Function::Sin => self.call(Function::Cos, &argument),
            Function::Cos => {
                let sine = self.call(Function::Sin, &argument);
                self.opposite(sine)
            }
            Function::Tan | Function::Tanh => {
                let square = self.binary(Binary::Power, &of, &two);
                let is_tan = function == Function::Tan;
                let sign = if is_tan {
                    Binary::Add
                } else {
                    Binary::Subtract
                };
                self.binary(sign, &one, &square)
            }
            Function::Asin | Function::Acos => {
                let square = self.binary(Binary::Power, &argument, &two);
                let rest = self.binary(Binary::Subtract, &one, &square);
                let root = self.call(Function::Sqrt, &rest);
                let slope = self.binary(Binary::Divide, &one, &root);
                if function == Function::Asin {
                    slope
                } else {
                    self.opposite(slope)
                }
            }
            Function::Atan => {
                let square = self.binary(Binary::Power, &argument, &two);
                let sum = self.binary(Binary::Add, &one, &square);
                self.binary(Binary::Divide, &one, &sum)
            }
            Function::Sinh => self.call(Function::Cosh, &argument),
            Function::Cosh => self.call(Function::Sinh, &argument),
            Function::Exp => of,
            Function::Ln => self.binary(Binary::Divide, &one, &argument),
            Function::Log10 => {
                let scale = self.number(std::f64::consts::LN_10);
                let below = self.product(argument, scale);
                self.binary(Binary::Divide, &one, &below)
            }
            Function::Sqrt => {
                let half = self.number(0.5);
                self.binary(Binary::Divide, &half, &of)
            }
        }
    }
}

/// Panels of an integral are halved up to this number.
const MOST_PANELS: usize = 128;

/// Two levels agree if they differ by less than this times the size of the integral.
const AGREEMENT: f64 = 4.0 * f64::EPSILON;

impl Algebra for Graph {
    type Number = NodeId;

    fn number(&mut self, value: f64) -> NodeId {
        // One zero: -0 and 0 are the same node.
        let value = if value == 0.0 { 0.0 } else { value };
        self.store(Node::Number(value.to_bits()))
    }

    fn variable(&mut self, index: usize) -> NodeId {
        self.store(Node::Variable(index))
    }

    fn parameter(&mut self, index: usize) -> NodeId {
        self.store(Node::Parameter(index))
    }

    fn binary(&mut self, operator: Binary, left: &NodeId, right: &NodeId) -> NodeId {
        match self.folded(operator, *left, *right) {
            Some(folded) => folded,
            None => self.store(Node::Binary(operator, [*left, *right])),
        }
    }

    fn call(&mut self, function: Function, argument: &NodeId) -> NodeId {
        match self.constant(*argument) {
            Some(value) => self.number(apply(function, value)),
            None => self.store(Node::Call(function, *argument)),
        }
    }

    fn choose(
        &mut self,
        comparison: Relation,
        compared: [&NodeId; 2],
        then: &NodeId,
        otherwise: &NodeId,
    ) -> NodeId {
        let [left, right] = compared.map(|id| *id);
        if then == otherwise {
            return *then;
        }
        if let (Some(a), Some(b)) = (self.constant(left), self.constant(right)) {
            let is_true = comparison.holds(a, b);
            return if is_true { *then } else { *otherwise };
        }
        let is_above = matches!(comparison, Relation::Greater | Relation::GreaterOrEqual);
        let compared = if is_above {
            [left, right]
        } else {
            [right, left]
        };
        if let Some(width) = steps::width(self, compared) {
            return steps::step(self, compared, width, *then, *otherwise);
        }
        self.store(Node::Choose(comparison, [left, right, *then, *otherwise]))
    }

    fn derivative(&mut self, of: &NodeId, variable: usize) -> NodeId {
        if !self.depends_on(*of, variable) {
            return self.number(0.0);
        }
        if let Some(known) = self.derivatives.get(&(*of, variable)) {
            return *known;
        }
        let derivative = self.derive(*of, variable);
        self.derivatives.insert((*of, variable), derivative);
        self.derived.push((*of, variable));
        derivative
    }

    fn integral(&mut self, body: &NodeId, variable: usize) -> Result<NodeId, String> {
        let [low, high] = self.intervals[variable];
        if !self.depends_on(*body, variable) {
            let length = self.number(high - low);
            return Ok(self.product(length, *body));
        }
        let rule = quadrature::gauss(POINTS);
        let tape = Tape::new(self, &[*body]);
        let mut panels = 1;
        loop {
            let difference = self.worst_difference(&tape, variable, panels, &rule);
            if difference <= AGREEMENT {
                let body = *body;
                return Ok(self.store(Node::Integral {
                    body,
                    variable,
                    panels,
                }));
            }
            panels *= 2;
            if panels > MOST_PANELS {
                return Err(format!(
                    "the integral differs by {difference:.1e} of its size between {} and {panels} panels of {POINTS} points; \
                     expected a function that is smooth on the whole interval",
                    panels / 2
                ));
            }
        }
    }

    fn fixed(&mut self, body: &NodeId, variable: usize, at: f64) -> NodeId {
        let value = self.number(at);
        self.substituted(*body, variable, value, &mut FxHashMap::default())
    }

    fn held(&mut self, number: &NodeId) -> NodeId {
        match self.depends[number.0 as usize] & !PARAMETERS {
            0 => *number,
            _ => self.store(Node::Held(*number)),
        }
    }

    fn field(&mut self, value: &NodeId, field: usize, component: usize) -> NodeId {
        if !self.keeps_fields {
            return *value;
        }
        let derivative = FieldDerivative {
            field: field as u16,
            component: component as u16,
            times: [0; 4],
        };
        self.store(Node::Field(*value, derivative))
    }

    fn keep_origin(&mut self, of: &NodeId, origin: impl FnOnce() -> Origin) {
        self.origins.entry(*of).or_insert_with(origin);
    }

    fn nodes(&self) -> usize {
        self.len()
    }
}

impl Graph {
    /// The largest relative change of an integral by halving its panels, over a few points of the
    /// other variables.
    fn worst_difference(
        &self,
        tape: &Tape<'_>,
        variable: usize,
        panels: usize,
        rule: &[[f64; 2]],
    ) -> f64 {
        let parameters = &self.parameters;
        let mut worst = 0.0_f64;
        for share in [0.03, 0.29, 0.61, 0.97] {
            let intervals = self.intervals.iter();
            let point = intervals.map(|[low, high]| low + share * (high - low));
            let mut point: Vec<f64> = point.collect();
            let coarse = tape.integral(&mut point, variable, panels, rule, parameters);
            let fine = tape.integral(&mut point, variable, 2 * panels, rule, parameters);
            let difference = (coarse.value - fine.value).abs() / fine.size.max(f64::MIN_POSITIVE);
            // A value that is not finite is reported where the function is used.
            if difference.is_finite() {
                worst = worst.max(difference);
            }
        }
        worst
    }
}
