//! From text to the syntax tree of a function: the parser is that of `manufacture`, whose language
//! has more.

use manufacture::language::names::{CALLEES, CONSTANTS, Callee, Piecewise, did_you_mean};
use manufacture::language::tree::{Binary, Relation, Tree, TreeKind, callee_name};
use manufacture::language::{SyntaxError, parse_for};

use super::Variable;
use super::syntax::SyntaxNode;

/// Parses all of `source`.
pub(super) fn parse(source: &str, variable: Variable) -> Result<SyntaxNode, SyntaxError> {
    let tree = parse_for(source, is_of_numbers)?;
    Converter { source, variable }.node(&tree)
}

struct Converter<'s> {
    source: &'s str,
    variable: Variable,
}

impl Converter<'_> {
    fn node(&self, tree: &Tree) -> Result<SyntaxNode, SyntaxError> {
        let node = match &tree.kind {
            TreeKind::Number(value, _) => SyntaxNode::Constant(*value),
            TreeKind::Name(name) => self.name(name, tree)?,
            TreeKind::Bracket(inner) => self.node(inner)?,
            TreeKind::Negate(operand) => SyntaxNode::Negate(Box::new(self.node(operand)?)),
            TreeKind::Binary(operator, operands) => {
                let left = self.node(&operands[0])?;
                match (operator, self.node(&operands[1])?) {
                    (Binary::Power, SyntaxNode::Constant(exponent)) => {
                        SyntaxNode::ConstantPower(Box::new(left), exponent)
                    }
                    (_, right) => SyntaxNode::Binary(*operator, Box::new([left, right])),
                }
            }
            TreeKind::Call(callee, parts) => self.call(*callee, parts, tree)?,
            TreeKind::List(_) | TreeKind::Index(..) | TreeKind::Compare(..) => {
                let name = self.variable.name();
                return Err(self.error(
                    tree,
                    format!("expected a function of {name}, found `{tree}`"),
                ));
            }
        };
        Ok(node.folded())
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
        // The parser has counted the arguments.
        match (callee, parts) {
            (Callee::Function(function), [argument]) => {
                Ok(SyntaxNode::Call(function, Box::new(self.node(argument)?)))
            }
            (Callee::Piecewise(Piecewise::Abs), [argument]) => {
                Ok(SyntaxNode::Abs(Box::new(self.node(argument)?)))
            }
            (Callee::Piecewise(Piecewise::Min), [left, right]) => {
                self.choose(Relation::LessOrEqual, left, right)
            }
            (Callee::Piecewise(Piecewise::Max), [left, right]) => {
                self.choose(Relation::GreaterOrEqual, left, right)
            }
            _ => Err(self.unknown(callee_name(callee), tree)),
        }
    }

    fn choose(
        &self,
        relation: Relation,
        left: &Tree,
        right: &Tree,
    ) -> Result<SyntaxNode, SyntaxError> {
        let operands = [self.node(left)?, self.node(right)?];
        Ok(SyntaxNode::Choose(relation, Box::new(operands)))
    }

    fn unknown(&self, name: &str, tree: &Tree) -> SyntaxError {
        let constants = CONSTANTS.iter().map(|known| known.0);
        let callees = CALLEES.iter().filter(|known| is_of_numbers(known.1));
        let known: Vec<&str> = std::iter::once(self.variable.name())
            .chain(constants)
            .chain(callees.map(|known| known.0))
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

/// Whether it takes numbers and gives a number, without a condition.
fn is_of_numbers(callee: Callee) -> bool {
    matches!(
        callee,
        Callee::Function(_) | Callee::Piecewise(Piecewise::Abs | Piecewise::Min | Piecewise::Max)
    )
}
