//! From nodes of the graph to statements: a subexpression that is used twice, or is long, becomes a
//! constant.

use std::collections::{HashMap, HashSet};

use super::Language;
use crate::arithmetic::tape::nodes_below;
use crate::arithmetic::{Graph, Node, NodeId};
use crate::language::tree::Binary;

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
    fn atom(text: String) -> Self {
        Self {
            text,
            binding: Binding::Atom,
        }
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

/// What names stand for in a function.
pub(super) struct LoweringNames<'n> {
    pub(super) language: Language,
    /// The array of the coordinates.
    pub(super) array: &'n str,
    pub(super) coordinates: usize,
    /// Time, or its value.
    pub(super) time: &'n str,
    pub(super) parameters: &'n [String],
    /// The call of the helper for each integral.
    pub(super) integrals: &'n dyn Fn(NodeId) -> String,
}

/// Constants in the order of evaluation, and the values of the roots.
pub(super) struct Lowered {
    pub(super) constants: Vec<[String; 2]>,
    pub(super) roots: Vec<String>,
}

pub(super) fn lower(graph: &Graph, roots: &[NodeId], names: &LoweringNames<'_>) -> Lowered {
    let order = nodes_below(graph, roots);
    let is_constant = constants(graph, roots, &order);
    let mut texts: HashMap<NodeId, LoweredText> = HashMap::new();
    let mut constants: Vec<[String; 2]> = vec![];
    for id in order {
        let text = text(graph, id, &texts, names);
        let is_leaf = matches!(
            graph.node(id),
            Node::Number(_) | Node::Variable(_) | Node::Parameter(_)
        );
        let text = if !is_leaf && (is_constant.contains(&id) || text.text.len() > LONGEST) {
            let name = format!("c{}", constants.len() + 1);
            constants.push([name.clone(), text.text]);
            LoweredText::atom(name)
        } else {
            text
        };
        texts.insert(id, text);
    }
    Lowered {
        constants,
        roots: roots.iter().map(|root| texts[root].text.clone()).collect(),
    }
}

/// Nodes that become constants whatever their length: those used twice, bases of products, operands
/// of choices.
fn constants(graph: &Graph, roots: &[NodeId], order: &[NodeId]) -> HashSet<NodeId> {
    let mut used: HashSet<NodeId> = HashSet::new();
    let mut constants = HashSet::new();
    for id in order {
        let node = graph.node(*id);
        for operand in node.operands().iter() {
            if !used.insert(*operand) || matches!(node, Node::Choose(..)) {
                constants.insert(*operand);
            }
        }
        if let Node::Binary(Binary::Power, [base, exponent]) = node
            && graph.constant(*exponent).is_some_and(is_product)
        {
            constants.insert(*base);
        }
    }
    for root in roots {
        if !used.insert(*root) {
            constants.insert(*root);
        }
    }
    constants
}

/// Whether a power with that exponent is written as a product.
fn is_product(exponent: f64) -> bool {
    exponent.fract() == 0.0 && exponent != 0.0 && exponent.abs() <= LARGEST_PRODUCT
}

fn text(
    graph: &Graph,
    id: NodeId,
    texts: &HashMap<NodeId, LoweredText>,
    names: &LoweringNames<'_>,
) -> LoweredText {
    let language = names.language;
    match graph.node(id) {
        Node::Number(bits) => {
            let value = f64::from_bits(*bits);
            let text = language.number(value);
            let binding = if value < 0.0 {
                Binding::Sum
            } else {
                Binding::Atom
            };
            LoweredText { text, binding }
        }
        Node::Variable(index) if *index == names.coordinates => {
            LoweredText::atom(names.time.to_owned())
        }
        Node::Variable(index) => LoweredText::atom(language.coordinate(names.array, *index)),
        Node::Parameter(index) => LoweredText::atom(names.parameters[*index].clone()),
        Node::Negate(operand) => LoweredText {
            text: format!("-{}", texts[operand].within(Binding::Product)),
            binding: Binding::Sum,
        },
        Node::Binary(operator, [left, right]) => {
            if let (Binary::Power, Some(exponent)) = (operator, graph.constant(*right))
                && is_product(exponent)
            {
                return product(&texts[left], exponent, language);
            }
            binary(*operator, &texts[left], &texts[right], language)
        }
        Node::Call(function, argument) => {
            LoweredText::atom(language.call(*function, &texts[argument].text))
        }
        Node::Choose(comparison, operands) => {
            let operands = operands.map(|operand| texts[&operand].within(Binding::Atom));
            LoweredText::atom(language.choose(*comparison, operands.each_ref().map(String::as_str)))
        }
        Node::Integral { .. } => LoweredText::atom((names.integrals)(id)),
        // No file has one.
        Node::Held(operand) => LoweredText::atom(texts[operand].within(Binding::Atom)),
    }
}

fn binary(
    operator: Binary,
    left: &LoweredText,
    right: &LoweredText,
    language: Language,
) -> LoweredText {
    let symbol = match operator {
        Binary::Add => return sum(left, "+", right),
        Binary::Subtract => return sum(left, "-", right),
        Binary::Multiply => language.texts().arithmetic.times,
        Binary::Divide => language.texts().arithmetic.over,
        Binary::Power => return LoweredText::atom(language.power(&left.text, &right.text)),
    };
    LoweredText {
        text: format!(
            "{}{symbol}{}",
            left.within(Binding::Product),
            right.within(Binding::Atom)
        ),
        binding: Binding::Product,
    }
}

fn sum(left: &LoweredText, symbol: &str, right: &LoweredText) -> LoweredText {
    // A sum on the right keeps its brackets: they say in which order it is added.
    LoweredText {
        text: format!("{} {symbol} {}", left.text, right.within(Binding::Product)),
        binding: Binding::Sum,
    }
}

/// A small whole power as a product.
fn product(base: &LoweredText, exponent: f64, language: Language) -> LoweredText {
    let base = base.within(Binding::Atom);
    let factors =
        vec![base.as_str(); exponent.abs() as usize].join(language.texts().arithmetic.times);
    if exponent > 0.0 {
        return LoweredText {
            text: factors,
            binding: Binding::Product,
        };
    }
    let one = language.number(1.0);
    let below = if exponent == -1.0 {
        factors
    } else {
        format!("({factors})")
    };
    LoweredText {
        text: format!("{one}{}{below}", language.texts().arithmetic.over),
        binding: Binding::Product,
    }
}
