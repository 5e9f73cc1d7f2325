//! From nodes of the graph to statements: a subexpression that is used twice, or is long, becomes a
//! constant; some nodes become calls of functions of their own.

use std::collections::{HashMap, HashSet};

use serde::Serialize;

use super::Language;
use super::languages::Row;
use crate::arithmetic::tape::{nodes_below, nodes_by};
use crate::arithmetic::{Graph, Node, NodeId};
use crate::check::margin::Margin;
use crate::language::names::{Callee, Function};
use crate::language::tree::{Binary, callee_name};

/// A longer subexpression becomes a constant, so that no line has more than 100 columns.
const LONGEST: usize = 34;

/// Powers up to this one are products.
const LARGEST_PRODUCT: f64 = 4.0;

/// How tightly a text binds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Binding {
    Sum,
    Product,
    Atom,
}

/// A subexpression as text.
#[derive(Debug, Clone)]
struct LoweredText {
    text: String,
    binding: Binding,
}

impl LoweredText {
    fn new(text: String, binding: Binding) -> Self {
        Self { text, binding }
    }

    fn atom(text: String) -> Self {
        Self::new(text, Binding::Atom)
    }

    /// In brackets unless it binds at least as tightly.
    fn within(&self, least: Binding) -> String {
        if self.binding >= least {
            self.text.clone()
        } else {
            format!("({})", self.text)
        }
    }
}

/// What stands for coordinates, time and parameters in a function.
pub(super) struct LoweringNames<'n> {
    pub(super) language: Language,
    /// The array of the coordinates; empty where there is no point.
    pub(super) array: &'n str,
    pub(super) coordinates: usize,
    /// Time, or its value; none in a file without.
    pub(super) time: Option<&'n str>,
    pub(super) parameters: &'n [String],
}

/// Statements: constants in the order of evaluation, and the values of the roots.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(super) struct Body {
    pub(super) constants: Vec<[String; 2]>,
    pub(super) values: Vec<String>,
    /// Whether coordinates and time occur.
    #[serde(skip)]
    pub(super) uses: [bool; 2],
}

/// The names of the constants of a function by their texts: bodies of several variants have the
/// same name for the same text.
pub(super) type ConstantNames = HashMap<String, String>;

/// * `constants`: those of the same function in other variants; new ones are added.
/// * `helper`: the name of the function whose value is that of a node.
pub(super) fn lower(
    graph: &Graph,
    roots: &[NodeId],
    names: &LoweringNames<'_>,
    constants: &mut ConstantNames,
    helper: &mut dyn FnMut(NodeId) -> String,
) -> Body {
    let mut lowering = Lowering {
        graph,
        row: names.language.row(),
        names,
        constants,
        helper,
        texts: HashMap::new(),
        body: Body {
            constants: vec![],
            values: vec![],
            uses: [false; 2],
        },
    };
    lowering.lower(roots);
    lowering.body
}

struct Lowering<'l> {
    graph: &'l Graph,
    row: &'static Row,
    names: &'l LoweringNames<'l>,
    constants: &'l mut ConstantNames,
    helper: &'l mut dyn FnMut(NodeId) -> String,
    texts: HashMap<NodeId, LoweredText>,
    body: Body,
}

impl Lowering<'_> {
    fn lower(&mut self, roots: &[NodeId]) {
        let order = nodes_by(roots, |id| self.operands(id));
        let is_constant = self.needed_constants(roots, &order);
        for id in order {
            let mut text = self.text(id);
            let is_leaf = matches!(
                self.graph.node(id),
                Node::Number(_) | Node::Variable(_) | Node::Parameter(_)
            );
            // A root has a line of its own.
            let is_long = text.text.len() > LONGEST && !roots.contains(&id);
            if !is_leaf && (is_constant.contains(&id) || is_long) {
                let next = format!("c{}", self.constants.len() + 1);
                let known = self.constants.entry(text.text.clone());
                let name = known.or_insert(next).clone();
                let constant = [name.clone(), text.text];
                // Nodes that differ may have the same text.
                if !self.body.constants.contains(&constant) {
                    self.body.constants.push(constant);
                }
                text = LoweredText::atom(name);
            }
            self.texts.insert(id, text);
        }
        let values = roots.iter().map(|root| self.texts[root].text.clone());
        self.body.values = values.collect();
    }

    /// The operands whose values a node needs here: helpers compute those that they need.
    fn operands(&self, id: NodeId) -> &[NodeId] {
        match self.graph.node(id) {
            Node::Field(..) => &[],
            Node::Choose(_, operands) if self.has_helpers(operands) => &operands[..2],
            node => node.operands(),
        }
    }

    /// Whether the branches of a choice are functions of their own: over arrays each is evaluated
    /// only where it is taken, if it may not be defined elsewhere.
    fn has_helpers(&self, operands: &[NodeId; 4]) -> bool {
        let has_arrays = self.row.has_arrays && !self.names.array.is_empty();
        has_arrays
            && nodes_below(self.graph, &operands[2..])
                .iter()
                .any(|id| self.is_partial(*id))
    }

    /// Whether an operation has no value, or none that is finite, for some operands.
    fn is_partial(&self, id: NodeId) -> bool {
        let grows = matches!(
            self.graph.node(id),
            Node::Integral { .. } | Node::Call(Function::Exp | Function::Sinh | Function::Cosh, _)
        );
        grows || Margin::of(self.graph, id).is_some()
    }

    /// Nodes that become constants whatever their length: those used twice, bases of products,
    /// operands of choices.
    fn needed_constants(&self, roots: &[NodeId], order: &[NodeId]) -> HashSet<NodeId> {
        let mut used: HashSet<NodeId> = HashSet::new();
        let mut constants = HashSet::new();
        for id in order {
            let node = self.graph.node(*id);
            for operand in self.operands(*id) {
                if !used.insert(*operand) || matches!(node, Node::Choose(..)) {
                    constants.insert(*operand);
                }
            }
            if let Node::Binary(Binary::Power, [base, exponent]) = node
                && self.graph.constant(*exponent).is_some_and(is_product)
            {
                constants.insert(*base);
            }
        }
        constants.extend(roots.iter().filter(|root| !used.insert(**root)));
        constants
    }

    fn text(&mut self, id: NodeId) -> LoweredText {
        let operators = &self.row.operators;
        match *self.graph.node(id) {
            Node::Number(bits) => {
                let value = f64::from_bits(bits);
                let binding = if value < 0.0 {
                    Binding::Sum
                } else {
                    Binding::Atom
                };
                LoweredText::new(self.names.language.number(value), binding)
            }
            Node::Variable(index) if index == self.names.coordinates => {
                self.body.uses[1] = true;
                LoweredText::atom(self.names.time.unwrap_or("t").to_owned())
            }
            Node::Variable(index) => {
                self.body.uses[0] = true;
                LoweredText::atom((operators.coordinate)(self.names.array, index))
            }
            Node::Parameter(index) => LoweredText::atom(self.names.parameters[index].clone()),
            Node::Negate(operand) => LoweredText::new(
                format!("-{}", self.texts[&operand].within(Binding::Product)),
                Binding::Sum,
            ),
            Node::Binary(operator, operands) => self.binary(operator, operands),
            Node::Call(function, argument) => {
                let name = (operators.function)(callee_name(Callee::Function(function)));
                LoweredText::atom(format!("{name}({})", self.texts[&argument].text))
            }
            Node::Choose(relation, operands) => {
                let [left, right, ..] = operands.each_ref();
                let atom = |id: &NodeId| self.texts[id].within(Binding::Atom);
                let condition = (operators.compare)(&atom(left), relation, &atom(right));
                let branches = [operands[2], operands[3]];
                if !self.has_helpers(&operands) {
                    let [then, otherwise] = branches.each_ref().map(atom);
                    return LoweredText::atom((operators.choose)([&condition, &then, &otherwise]));
                }
                let [then, otherwise] = branches.map(&mut *self.helper);
                let point = self.point();
                LoweredText::atom(format!("choose({condition}, {then}, {otherwise}, {point})"))
            }
            Node::Integral { .. } | Node::Field(..) => {
                let name = (self.helper)(id);
                LoweredText::atom(format!("{name}({})", self.point()))
            }
            // No file has one.
            Node::Held(operand) => LoweredText::atom(self.texts[&operand].within(Binding::Atom)),
        }
    }

    /// Coordinates and time as arguments.
    fn point(&mut self) -> String {
        self.body.uses = [true; 2];
        let time = self.names.time.map(|time| format!(", {time}"));
        self.names.array.to_owned() + &time.unwrap_or_default()
    }

    fn binary(&self, operator: Binary, operands: [NodeId; 2]) -> LoweredText {
        let operators = &self.row.operators;
        let [left, right] = operands.map(|operand| &self.texts[&operand]);
        let symbol = match operator {
            // A sum on the right keeps its brackets: they say in which order it is added.
            Binary::Add | Binary::Subtract => {
                let symbol = if operator == Binary::Add { "+" } else { "-" };
                let right = right.within(Binding::Product);
                let text = format!("{} {symbol} {right}", left.text);
                return LoweredText::new(text, Binding::Sum);
            }
            Binary::Power => {
                let exponent = self.graph.constant(operands[1]);
                return match exponent.filter(|exponent| is_product(*exponent)) {
                    Some(exponent) => self.product(left, exponent),
                    None => LoweredText::atom((operators.power)(&left.text, &right.text)),
                };
            }
            Binary::Multiply => operators.times,
            Binary::Divide => operators.over,
        };
        let [left, right] = [left.within(Binding::Product), right.within(Binding::Atom)];
        LoweredText::new(format!("{left}{symbol}{right}"), Binding::Product)
    }

    /// A small whole power as a product.
    fn product(&self, base: &LoweredText, exponent: f64) -> LoweredText {
        let operators = &self.row.operators;
        let base = base.within(Binding::Atom);
        let factors = vec![base.as_str(); exponent.abs() as usize].join(operators.times);
        let text = if exponent > 0.0 {
            factors
        } else {
            let one = self.names.language.number(1.0);
            let is_one = exponent == -1.0;
            let [open, close] = if is_one { ["", ""] } else { ["(", ")"] };
            format!("{one}{}{open}{factors}{close}", operators.over)
        };
        LoweredText::new(text, Binding::Product)
    }
}

/// Whether a power with that exponent is written as a product.
fn is_product(exponent: f64) -> bool {
    exponent.fract() == 0.0 && exponent != 0.0 && exponent.abs() <= LARGEST_PRODUCT
}
