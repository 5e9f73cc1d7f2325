//! Parser from text to syntax tree, by precedence climbing.

use super::Variable;
use super::error::{ExpressionError, ExpressionProblem};
use super::syntax::{FUNCTIONS, Function, Node, Operator};
use super::token::{Token, TokenKind, next_token};
use crate::nearest::nearest;

/// Largest depth of the syntax tree. Parsing, evaluating and dropping it are recursive: this bounds
/// their stack.
const MAX_DEPTH: usize = 256;

/// Precedence of a sign: above a product, below a power.
const SIGN: u8 = 5;

/// The constants by name.
const CONSTANTS: [(&str, f64); 2] = [("pi", std::f64::consts::PI), ("e", std::f64::consts::E)];

/// Parses all of `source`.
pub(super) fn parse(source: &str, variable: Variable) -> Result<Node, ExpressionError> {
    let mut parser = Parser {
        source,
        variable,
        token: next_token(source, 0),
        depth: 0,
    };
    let tree = parser.expression(0)?;
    match parser.token.kind {
        TokenKind::End => Ok(tree.node),
        TokenKind::Symbol(')') => Err(parser.unexpected("the end, because no bracket is open")),
        _ => Err(parser.unexpected(AFTER_OPERAND)),
    }
}

/// The tokens allowed after an operand.
const AFTER_OPERAND: &str = "one of the operators + - * / ^ or the end";

/// A node and the depth of the tree below it.
struct Tree {
    node: Node,
    depth: usize,
}

struct Parser<'s> {
    source: &'s str,
    variable: Variable,
    /// The next token.
    token: Token,
    /// Number of nested calls of [`Parser::expression`].
    depth: usize,
}

impl Parser<'_> {
    /// Parses operands joined by operators whose precedence is at least `minimum`.
    fn expression(&mut self, minimum: u8) -> Result<Tree, ExpressionError> {
        self.depth += 1;
        self.limit(self.depth, self.token.start)?;
        let mut left = self.operand()?;
        while let Some((operator, binds, binds_right)) = infix(self.token.kind) {
            if binds < minimum {
                break;
            }
            let at = self.advance().start;
            let right = self.expression(binds_right)?;
            left = self.grow(
                at,
                left.depth.max(right.depth),
                Node::binary(operator, left.node, right.node),
            )?;
        }
        self.depth -= 1;
        Ok(left)
    }

    /// Parses a number, a name, a call, or an expression in brackets, with or without a sign.
    fn operand(&mut self) -> Result<Tree, ExpressionError> {
        let token = self.token;
        match token.kind {
            TokenKind::Number(value) => {
                self.advance();
                self.number(token, value)
            }
            TokenKind::Name => {
                self.advance();
                self.name(token)
            }
            TokenKind::Symbol('(') => {
                self.advance();
                let inner = self.expression(0)?;
                self.close(token.start)?;
                Ok(inner)
            }
            TokenKind::Symbol('-') => {
                self.advance();
                let operand = self.expression(SIGN)?;
                self.grow(token.start, operand.depth, Node::negate(operand.node))
            }
            TokenKind::Symbol('+') => {
                self.advance();
                self.expression(SIGN)
            }
            _ => Err(self.unexpected(&format!(
                "a number, {}, pi, e, a function or `(`",
                self.variable.name()
            ))),
        }
    }

    fn number(&self, token: Token, value: f64) -> Result<Tree, ExpressionError> {
        if value.is_finite() {
            return Ok(Tree {
                node: Node::Constant(value),
                depth: 1,
            });
        }
        Err(self.error(
            token.start,
            ExpressionProblem::NumberTooLarge {
                found: shorten(self.text(token)),
            },
        ))
    }

    /// Parses the variable, a constant or a call, whose name is `token`.
    fn name(&mut self, token: Token) -> Result<Tree, ExpressionError> {
        let name = self.text(token);
        if let Some(&(name, function)) = FUNCTIONS.iter().find(|(known, _)| *known == name) {
            return self.call(token, name, function);
        }
        let node = if name == self.variable.name() {
            Node::Variable
        } else if let Some((_, value)) = CONSTANTS.iter().find(|(known, _)| *known == name) {
            Node::Constant(*value)
        } else {
            return Err(self.error(token.start, self.unknown(name)));
        };
        Ok(Tree { node, depth: 1 })
    }

    fn call(
        &mut self,
        token: Token,
        name: &'static str,
        function: Function,
    ) -> Result<Tree, ExpressionError> {
        if self.token.kind != TokenKind::Symbol('(') {
            return Err(self.unexpected(&format!("`(` after the function `{name}`")));
        }
        let opened = self.advance().start;
        let mut arguments = vec![self.expression(0)?];
        while self.token.kind == TokenKind::Symbol(',') {
            self.advance();
            arguments.push(self.expression(0)?);
        }
        self.close(opened)?;
        let (found, expected) = (arguments.len(), function.arguments());
        let depth = arguments
            .iter()
            .map(|argument| argument.depth)
            .max()
            .unwrap_or(0);
        let mut nodes = arguments.into_iter().map(|argument| argument.node);
        let node = match (nodes.next(), nodes.next()) {
            (Some(only), None) if expected == 1 => Node::call1(function, only),
            (Some(first), Some(second)) if expected == 2 && found == 2 => {
                Node::call2(function, [first, second])
            }
            _ => {
                let problem = ExpressionProblem::Arguments {
                    function: name,
                    found,
                    expected,
                };
                return Err(self.error(token.start, problem));
            }
        };
        self.grow(token.start, depth, node)
    }

    /// Consumes the bracket that closes the one at byte `opened`.
    fn close(&mut self, opened: usize) -> Result<(), ExpressionError> {
        match self.token.kind {
            TokenKind::Symbol(')') => {
                self.advance();
                Ok(())
            }
            TokenKind::Symbol(',') => {
                Err(self.unexpected("an operator or `)`: no function is being called"))
            }
            _ => {
                let found = self.found();
                Err(self.error(
                    self.token.start,
                    ExpressionProblem::Unclosed { found, opened },
                ))
            }
        }
    }

    /// The tree of `node`, whose subtrees have at most the depth `below`; `at` is its byte offset.
    fn grow(&self, at: usize, below: usize, node: Node) -> Result<Tree, ExpressionError> {
        let depth = if matches!(node, Node::Constant(_)) {
            1
        } else {
            below + 1
        };
        self.limit(depth, at)?;
        Ok(Tree { node, depth })
    }

    fn limit(&self, depth: usize, at: usize) -> Result<(), ExpressionError> {
        if depth <= MAX_DEPTH {
            return Ok(());
        }
        Err(self.error(at, ExpressionProblem::TooDeep { most: MAX_DEPTH }))
    }

    fn advance(&mut self) -> Token {
        let following = next_token(self.source, self.token.end);
        std::mem::replace(&mut self.token, following)
    }

    fn text(&self, token: Token) -> &str {
        &self.source[token.start..token.end]
    }

    /// The next token, in words.
    fn found(&self) -> String {
        match self.token.kind {
            TokenKind::End if self.source.trim().is_empty() => "an empty text".to_owned(),
            TokenKind::End => "the end".to_owned(),
            _ => format!("`{}`", shorten(self.text(self.token))),
        }
    }

    fn unexpected(&self, expected: &str) -> ExpressionError {
        let hint = match self.text(self.token) {
            "**" => "; a power is written ^",
            "−" | "–" => "; a minus is written -",
            "π" => "; write pi",
            "×" | "·" | "⋅" => "; a product is written *",
            _ if expected == AFTER_OPERAND && starts_operand(self.token.kind) => {
                "; a product needs its *"
            }
            _ => "",
        };
        let problem = ExpressionProblem::Unexpected {
            found: self.found(),
            expected: expected.to_owned(),
            hint,
        };
        self.error(self.token.start, problem)
    }

    fn unknown(&self, name: &str) -> ExpressionProblem {
        let constants = CONSTANTS.iter().map(|(name, _)| *name);
        let known: Vec<&str> = std::iter::once(self.variable.name())
            .chain(constants)
            .chain(FUNCTIONS.iter().map(|f| f.0))
            .collect();
        // A single letter is a wrong variable: no suggestion.
        let suggestion = if name.len() == 1 {
            None
        } else {
            nearest(name, known.iter().copied()).map(str::to_owned)
        };
        ExpressionProblem::UnknownName {
            name: shorten(name),
            suggestion,
            known: known.join(" "),
        }
    }

    fn error(&self, offset: usize, problem: ExpressionProblem) -> ExpressionError {
        ExpressionError {
            source_text: self.source.to_owned(),
            offset,
            problem,
        }
    }
}

/// An operator, its precedence, and the lowest precedence in its right operand.
fn infix(kind: TokenKind) -> Option<(Operator, u8, u8)> {
    let TokenKind::Symbol(symbol) = kind else {
        return None;
    };
    match symbol {
        '+' => Some((Operator::Add, 1, 2)),
        '-' => Some((Operator::Subtract, 1, 2)),
        '*' => Some((Operator::Multiply, 3, 4)),
        '/' => Some((Operator::Divide, 3, 4)),
        // Right-associative: the right operand may contain another power.
        '^' => Some((Operator::Power, 7, 7)),
        _ => None,
    }
}

fn starts_operand(kind: TokenKind) -> bool {
    matches!(
        kind,
        TokenKind::Number(_) | TokenKind::Name | TokenKind::Symbol('(')
    )
}

/// At most 24 characters of a token.
fn shorten(text: &str) -> String {
    const LONGEST: usize = 24;
    match text.char_indices().nth(LONGEST) {
        Some((cut, _)) => format!("{}...", &text[..cut]),
        None => text.escape_debug().to_string(),
    }
}
