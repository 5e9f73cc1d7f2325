//! The syntax tree of an expression, and its printed form.

use std::fmt;

use super::names::{CALLEES, Callee};

/// An operator between two numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[allow(missing_docs)]
pub enum Binary {
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
}

/// A comparison of two numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[allow(missing_docs)]
pub enum Comparison {
    Less,
    LessOrEqual,
    Greater,
    GreaterOrEqual,
}

impl Comparison {
    /// As written in the language, and in all languages that are emitted.
    pub fn symbol(self) -> &'static str {
        match self {
            Comparison::Less => "<",
            Comparison::LessOrEqual => "<=",
            Comparison::Greater => ">",
            Comparison::GreaterOrEqual => ">=",
        }
    }

    /// Whether it is true of the two numbers.
    pub fn holds(self, left: f64, right: f64) -> bool {
        match self {
            Comparison::Less => left < right,
            Comparison::LessOrEqual => left <= right,
            Comparison::Greater => left > right,
            Comparison::GreaterOrEqual => left >= right,
        }
    }
}

/// A part of an expression, and the byte at which it begins.
#[derive(Debug, Clone, PartialEq)]
pub struct Tree {
    /// What it is.
    pub kind: Kind,
    /// Byte offset in the text; that of the operator for an operation on two operands.
    pub at: usize,
}

/// The kinds of [`Tree`].
#[derive(Debug, Clone, PartialEq)]
pub enum Kind {
    /// A number, and its text.
    Number(f64, String),
    /// A name that is not called.
    Name(String),
    /// A sign.
    Negate(Box<Tree>),
    /// An operation on two operands.
    Binary(Binary, Box<[Tree; 2]>),
    /// A comparison, which is allowed as the first argument of `where` only.
    Compare(Comparison, Box<[Tree; 2]>),
    /// A call.
    Call(Callee, Vec<Tree>),
    /// A vector, or rows of a tensor.
    List(Vec<Tree>),
    /// A component: the tensor, and an index for each of its ranks.
    Index(Box<Tree>, Vec<Tree>),
    /// An expression in brackets.
    Bracket(Box<Tree>),
}

/// A summand of an expression: its sign, and the rest.
#[derive(Debug, Clone, PartialEq)]
pub struct Summand<'t> {
    /// A minus stands before it.
    pub is_negative: bool,
    /// Without that sign.
    pub tree: &'t Tree,
}

impl Tree {
    /// The summands at the top level; brackets hold a sum together.
    pub fn summands(&self) -> Vec<Summand<'_>> {
        let mut summands = vec![];
        let mut rest = self;
        while let Kind::Binary(operator @ (Binary::Add | Binary::Subtract), operands) = &rest.kind {
            summands.push(Summand {
                is_negative: *operator == Binary::Subtract,
                tree: &operands[1],
            });
            rest = &operands[0];
        }
        summands.push(Summand {
            is_negative: false,
            tree: rest,
        });
        summands.reverse();
        summands
    }

    /// The parts directly below.
    pub fn children(&self) -> Vec<&Tree> {
        match &self.kind {
            Kind::Number(..) | Kind::Name(_) => vec![],
            Kind::Negate(inner) | Kind::Bracket(inner) => vec![inner],
            Kind::Binary(_, operands) | Kind::Compare(_, operands) => operands.iter().collect(),
            Kind::Call(_, parts) | Kind::List(parts) => parts.iter().collect(),
            Kind::Index(tensor, indices) => std::iter::once(&**tensor).chain(indices).collect(),
        }
    }
}

impl Tree {
    /// The parts directly below, in the order of [`Tree::children`].
    pub(crate) fn children_mut(&mut self) -> Vec<&mut Tree> {
        match &mut self.kind {
            Kind::Number(..) | Kind::Name(_) => vec![],
            Kind::Negate(inner) | Kind::Bracket(inner) => vec![inner],
            Kind::Binary(_, operands) | Kind::Compare(_, operands) => operands.iter_mut().collect(),
            Kind::Call(_, parts) | Kind::List(parts) => parts.iter_mut().collect(),
            Kind::Index(tensor, indices) => std::iter::once(&mut **tensor).chain(indices).collect(),
        }
    }
}

/// The name of what is called.
pub fn callee_name(callee: Callee) -> &'static str {
    CALLEES
        .iter()
        .find(|entry| entry.1 == callee)
        .map_or("", |entry| entry.0)
}

/// Parts with commas between them.
struct Listed<'t>(&'t [Tree]);

impl fmt::Display for Listed<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (number, part) in self.0.iter().enumerate() {
            let comma = if number > 0 { ", " } else { "" };
            write!(f, "{comma}{part}")?;
        }
        Ok(())
    }
}

impl fmt::Display for Tree {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.kind {
            Kind::Number(_, text) => f.write_str(text),
            Kind::Name(name) => f.write_str(name),
            Kind::Negate(operand) => write!(f, "-{operand}"),
            Kind::Binary(operator, operands) => {
                let [left, right] = operands.as_ref();
                let symbol = match operator {
                    Binary::Add => " + ",
                    Binary::Subtract => " - ",
                    Binary::Multiply => "*",
                    Binary::Divide => "/",
                    Binary::Power => "^",
                };
                write!(f, "{left}{symbol}{right}")
            }
            Kind::Compare(comparison, operands) => {
                let [left, right] = operands.as_ref();
                write!(f, "{left} {} {right}", comparison.symbol())
            }
            Kind::Call(callee, parts) => write!(f, "{}({})", callee_name(*callee), Listed(parts)),
            Kind::List(parts) => write!(f, "[{}]", Listed(parts)),
            Kind::Index(tensor, indices) => write!(f, "{tensor}[{}]", Listed(indices)),
            Kind::Bracket(inner) => write!(f, "({inner})"),
        }
    }
}
