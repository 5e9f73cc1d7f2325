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
pub enum Relation {
    Less,
    LessOrEqual,
    Greater,
    GreaterOrEqual,
}

impl Relation {
    /// As written in the language, and in all languages that are emitted.
    pub fn symbol(self) -> &'static str {
        match self {
            Relation::Less => "<",
            Relation::LessOrEqual => "<=",
            Relation::Greater => ">",
            Relation::GreaterOrEqual => ">=",
        }
    }

    /// Whether it is true of the two numbers.
    pub fn holds(self, left: f64, right: f64) -> bool {
        match self {
            Relation::Less => left < right,
            Relation::LessOrEqual => left <= right,
            Relation::Greater => left > right,
            Relation::GreaterOrEqual => left >= right,
        }
    }
}

/// A part of an expression, and the byte at which it begins.
#[derive(Debug, Clone, PartialEq)]
pub struct Tree {
    /// What it is.
    pub kind: TreeKind,
    /// Byte offset in the text; that of the operator for an operation on two operands.
    pub at: usize,
    /// The byte behind it.
    pub end: usize,
}

/// The kinds of [`Tree`].
#[derive(Debug, Clone, PartialEq)]
pub enum TreeKind {
    /// A number, and its text.
    Number(f64, String),
    /// A name that is not called.
    Name(String),
    /// A sign.
    Negate(Box<Tree>),
    /// An operation on two operands.
    Binary(Binary, Box<[Tree; 2]>),
    /// A comparison, which is allowed as the first argument of `where` only.
    Compare(Relation, Box<[Tree; 2]>),
    /// A call.
    Call(Callee, Vec<Tree>),
    /// A vector, or rows of a tensor.
    List(Vec<Tree>),
    /// A component: the tensor, then an index for each of its ranks.
    Index(Vec<Tree>),
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
        while let TreeKind::Binary(operator @ (Binary::Add | Binary::Subtract), operands) =
            &rest.kind
        {
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
    pub fn children(&self) -> &[Tree] {
        match &self.kind {
            TreeKind::Number(..) | TreeKind::Name(_) => &[],
            TreeKind::Negate(inner) | TreeKind::Bracket(inner) => std::slice::from_ref(inner),
            TreeKind::Binary(_, operands) | TreeKind::Compare(_, operands) => &**operands,
            TreeKind::Call(_, parts) | TreeKind::List(parts) | TreeKind::Index(parts) => parts,
        }
    }

    /// The same, to be changed.
    pub(crate) fn children_mut(&mut self) -> &mut [Tree] {
        match &mut self.kind {
            TreeKind::Number(..) | TreeKind::Name(_) => &mut [],
            TreeKind::Negate(inner) | TreeKind::Bracket(inner) => std::slice::from_mut(inner),
            TreeKind::Binary(_, operands) | TreeKind::Compare(_, operands) => &mut **operands,
            TreeKind::Call(_, parts) | TreeKind::List(parts) | TreeKind::Index(parts) => parts,
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
struct CommaList<'t>(&'t [Tree]);

impl fmt::Display for CommaList<'_> {
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
            TreeKind::Number(_, text) => f.write_str(text),
            TreeKind::Name(name) => f.write_str(name),
            TreeKind::Negate(operand) => write!(f, "-{operand}"),
            TreeKind::Binary(operator, operands) => {
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
            TreeKind::Compare(comparison, operands) => {
                let [left, right] = operands.as_ref();
                write!(f, "{left} {} {right}", comparison.symbol())
            }
            TreeKind::Call(callee, parts) => {
                write!(f, "{}({})", callee_name(*callee), CommaList(parts))
            }
            TreeKind::List(parts) => write!(f, "[{}]", CommaList(parts)),
            TreeKind::Index(parts) => write!(f, "{}[{}]", parts[0], CommaList(&parts[1..])),
            TreeKind::Bracket(inner) => write!(f, "({inner})"),
        }
    }
}
