//! From text to the syntax tree of a function: the parser is that of `manufacture`, whose language
//! has more.

use manufacture::language::names::{CONSTANTS, Callee, did_you_mean};
use manufacture::language::tree::{Binary, Tree, TreeKind, callee_name};
use manufacture::language::{SyntaxError, parse as tree_of};

use super::Variable;
use super::syntax::{BinaryOperator, FUNCTIONS, SyntaxNode};

/// Parses all of `source`.
pub(super) fn parse(source: &str, variable: Variable) -> Result<SyntaxNode, SyntaxError> {
    let tree = tree_of(source)?;
    Converter { source, variable }.node(&tree)
}

struct Converter<'s> {
    source: &'s str,
    variable: Variable,
}

impl Converter<'_> {
    fn node(&self, tree: &Tree) -> Result<SyntaxNode, SyntaxError> {
        match &tree.kind {
            TreeKind::Number(value, _) => Ok(SyntaxNode::Constant(*value)),
            TreeKind::Name(name) => self.name(name, tree),
            TreeKind::Bracket(inner) => self.node(inner),
            TreeKind::Negate(operand) => Ok(SyntaxNode::negate(self.node(operand)?)),
            TreeKind::Binary(operator, operands) => {
                let operator = match operator {
                    Binary::Add => BinaryOperator::Add,
                    Binary::Subtract => BinaryOperator::Subtract,
                    Binary::Multiply => BinaryOperator::Multiply,
                    Binary::Divide => BinaryOperator::Divide,
                    Binary::Power => BinaryOperator::Power,
                };
                let left = self.node(&operands[0])?;
                Ok(SyntaxNode::binary(operator, left, self.node(&operands[1])?))
            }
            TreeKind::Call(callee, parts) => self.call(*callee, parts, tree),
            TreeKind::List(_) | TreeKind::Index(..) | TreeKind::Compare(..) => {
                let name = self.variable.name();
                Err(self.error(
                    tree,
                    format!("expected a function of {name}, found `{tree}`"),
                ))
            }
        }
    }

    /// The variable or a constant.
    fn name(&self, name: &str, tree: &Tree) -> Result<SyntaxNode, SyntaxError> {
        if name == self.variable.name() {
            return Ok(SyntaxNode::Variable);
        }
        match CONSTANTS.iter().find(|known| known.0 == name) {
            Some(known) => Ok(SyntaxNode::Constant(known.1)),
            None => Err(self.unknown(name, tree)),
        }
    }

    fn call(&self, callee: Callee, parts: &[Tree], tree: &Tree) -> Result<SyntaxNode, SyntaxError> {
        let name = callee_name(callee);
        let Some((_, function)) = FUNCTIONS.iter().find(|known| known.0 == name) else {
            return Err(self.unknown(name, tree));
        };
        // The parser has counted the arguments.
        match parts {
            [only] => Ok(SyntaxNode::call1(*function, self.node(only)?)),
            [first, second] => {
                let arguments = [self.node(first)?, self.node(second)?];
                Ok(SyntaxNode::call2(*function, arguments))
            }
            _ => Err(self.unknown(name, tree)),
        }
    }

    fn unknown(&self, name: &str, tree: &Tree) -> SyntaxError {
        let constants = CONSTANTS.iter().map(|known| known.0);
        let known: Vec<&str> = std::iter::once(self.variable.name())
            .chain(constants)
            .chain(FUNCTIONS.iter().map(|known| known.0))
            .collect();
        // A single letter is a wrong variable: no suggestion.
        let near = if name.len() == 1 {
            String::new()
        } else {
            did_you_mean(name, known.iter().copied())
        };
        let known = known.join(" ");
        self.error(
            tree,
            format!("unknown name `{name}`{near}; expected one of {known}"),
        )
    }

    fn error(&self, tree: &Tree, problem: String) -> SyntaxError {
        SyntaxError {
            text: self.source.to_owned(),
            offset: tree.at,
            problem,
        }
    }
}
