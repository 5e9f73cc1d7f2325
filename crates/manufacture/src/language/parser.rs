//! Parser from text to syntax tree, by precedence climbing.

use super::error::SyntaxError;
use super::names::{CALLEES, Callee, LEFT_OUT, Piecewise, nearest};
use super::token::{Token, TokenKind, next_token};
use super::tree::{Binary, Relation, Tree, TreeKind};

/// Largest number of operations one inside the other, where the operands of a sum or a product
/// without brackets stand beside each other. Parsing and evaluating are recursive: this bounds
/// their stack, to less than a thread of 1 MB has in a build without optimisation.
pub const MAX_DEPTH: usize = 96;

/// Largest height of the syntax tree, in which a sum of n terms has the height n. Walks that print,
/// compare and drop it are recursive with small frames; its evaluation goes along sums in a loop.
const MAX_HEIGHT: usize = 1024;

/// Precedence of a sign: above a product, below a power.
const SIGN: u8 = 5;

/// The tokens allowed after an operand.
const AFTER_OPERAND: &str = "one of the operators + - * / ^ or the end";

/// Parses all of `text`.
///
/// # Errors
/// [`SyntaxError`] with the position of the first error.
pub fn parse(text: &str) -> Result<Tree, SyntaxError> {
    parse_for(text, |_| true)
}

/// As [`parse`], for a reader that has not all functions and operators.
///
/// * `has`: which ones a message may name.
///
/// # Errors
/// As [`parse`].
pub fn parse_for(text: &str, has: fn(Callee) -> bool) -> Result<Tree, SyntaxError> {
    let mut parser = Parser {
        text,
        has,
        token: next_token(text, 0),
        end: 0,
        depth: 0,
    };
    let tree = parser.expression(0)?;
    match parser.token.kind {
        TokenKind::End => Ok(tree.tree),
        TokenKind::Symbol(')') => Err(parser.unexpected("the end, because no bracket is open")),
        TokenKind::Symbol('<' | '>') | TokenKind::OrEqual(_) => {
            Err(parser.unexpected("a comparison only as the first argument of `where`"))
        }
        _ => Err(parser.unexpected(AFTER_OPERAND)),
    }
}

/// How far a tree reaches down.
#[derive(Clone, Copy)]
struct Reach {
    /// Operations one inside the other.
    depth: usize,
    height: usize,
}

impl Reach {
    const NONE: Self = Self {
        depth: 0,
        height: 0,
    };

    fn max(self, other: Self) -> Self {
        Self {
            depth: self.depth.max(other.depth),
            height: self.height.max(other.height),
        }
    }
}

/// A tree and its reach.
struct Deep {
    tree: Tree,
    reach: Reach,
}

/// Parts between brackets, and the reach of the deepest.
struct Parts {
    trees: Vec<Tree>,
    reach: Reach,
}

struct Parser<'s> {
    text: &'s str,
    /// Which functions and operators a message may name.
    has: fn(Callee) -> bool,
    /// The next token.
    token: Token,
    /// The byte behind the token before it.
    end: usize,
    /// Number of nested calls of [`Parser::expression`].
    depth: usize,
}

impl Parser<'_> {
    /// Parses operands joined by operators whose precedence is at least `minimum`.
    fn expression(&mut self, minimum: u8) -> Result<Deep, SyntaxError> {
        self.depth += 1;
        self.limit(self.depth, self.token.start)?;
        let mut left = self.operand()?;
        while let Some((operator, binds, binds_right)) = infix(self.token.kind) {
            if binds < minimum {
                break;
            }
            let at = self.advance().start;
            let right = self.expression(binds_right)?;
            let reach = Reach {
                // The next operand stands beside the others, not inside.
                depth: left.reach.depth.saturating_sub(1).max(right.reach.depth),
                height: left.reach.height.max(right.reach.height),
            };
            let operands = Box::new([left.tree, right.tree]);
            left = self.grow(at, reach, TreeKind::Binary(operator, operands))?;
        }
        self.depth -= 1;
        Ok(left)
    }

    /// Parses an operand with its indices.
    fn operand(&mut self) -> Result<Deep, SyntaxError> {
        let mut operand = self.primary()?;
        while self.token.kind == TokenKind::Symbol('[') {
            let opened = self.advance().start;
            let indices = self.parts(opened, ']', false)?;
            let reach = operand.reach.max(indices.reach);
            let parts = std::iter::once(operand.tree).chain(indices.trees);
            operand = self.grow(opened, reach, TreeKind::Index(parts.collect()))?;
        }
        Ok(operand)
    }

    /// Parses a number, a name, a call, a list, or an expression in brackets, with or without a
    /// sign.
    fn primary(&mut self) -> Result<Deep, SyntaxError> {
        let token = self.token;
        let at = token.start;
        match token.kind {
            TokenKind::Number(value) => {
                self.advance();
                if !value.is_finite() {
                    let found = shorten(self.slice(token));
                    let most = f64::MAX;
                    let problem = format!("expected a number of at most {most:e}, found {found}");
                    return Err(self.error(at, problem));
                }
                let kind = TreeKind::Number(value, self.slice(token).to_owned());
                self.grow(at, Reach::NONE, kind)
            }
            TokenKind::Name => {
                self.advance();
                self.name(token)
            }
            TokenKind::Symbol('(') => {
                self.advance();
                let inner = self.expression(0)?;
                self.close(at, ')')?;
                // A bracket adds nothing to the depth: it is one call of `expression` already.
                Ok(Deep {
                    tree: Tree {
                        kind: TreeKind::Bracket(Box::new(inner.tree)),
                        at,
                        end: self.end,
                    },
                    reach: inner.reach,
                })
            }
            TokenKind::Symbol('[') => {
                self.advance();
                let parts = self.parts(at, ']', false)?;
                self.grow(at, parts.reach, TreeKind::List(parts.trees))
            }
            TokenKind::Symbol('-') => {
                self.advance();
                let operand = self.expression(SIGN)?;
                self.grow(at, operand.reach, TreeKind::Negate(Box::new(operand.tree)))
            }
            TokenKind::Symbol('+') => {
                self.advance();
                self.expression(SIGN)
            }
            _ => Err(self.unexpected("a number, a name, a function, `(` or `[`")),
        }
    }

    /// Parses a name, or a call if a function or an operator has the name `token`.
    fn name(&mut self, token: Token) -> Result<Deep, SyntaxError> {
        let name = self.slice(token).to_owned();
        let callee = CALLEES.iter().find(|entry| entry.0 == name);
        let is_called = self.token.kind == TokenKind::Symbol('(');
        let Some(&(name, callee, least, most)) = callee else {
            let left_out = LEFT_OUT.iter().find(|entry| entry.0 == name);
            if let (true, Some((name, reason))) = (is_called, left_out) {
                return Err(self.error(token.start, format!("`{name}`: {reason}")));
            }
            if is_called {
                return Err(self.no_function(token, &name));
            }
            return self.grow(token.start, Reach::NONE, TreeKind::Name(name));
        };
        if !is_called {
            return Err(self.unexpected(&format!("`(` after the function `{name}`")));
        }
        let opened = self.advance().start;
        let has_condition = callee == Callee::Piecewise(Piecewise::Where);
        let parts = self.parts(opened, ')', has_condition)?;
        let count = parts.trees.len();
        if !(least..=most).contains(&count) {
            let expected = if least == most {
                least.to_string()
            } else {
                format!("{least} to {most}")
            };
            let problem = format!("`{name}`: expected {expected} argument(s), found {count}");
            return Err(self.error(token.start, problem));
        }
        self.grow(
            token.start,
            parts.reach,
            TreeKind::Call(callee, parts.trees),
        )
    }

    /// The error of a call of `name`, which is neither a function nor an operator.
    ///
    /// A name of the file before a bracket is a product without its `*`. The parser does not know
    /// the names of the file: without a nearest function the message says both.
    fn no_function(&self, token: Token, name: &str) -> SyntaxError {
        let shown = shorten(name);
        // One letter is a variable before a bracket, not a function that is misspelt.
        let near = Some(name).filter(|name| name.len() > 1);
        let known = CALLEES.iter().filter(|entry| (self.has)(entry.1));
        let known: Vec<&str> = known.map(|entry| entry.0).collect();
        let near = near.and_then(|name| nearest(name, known.iter().copied()));
        let remedy = match (name.strip_prefix('d'), near) {
            // `dx` is nearer to `dt` than to what it stands for.
            (Some(variable), _) if variable.len() == 1 && known.contains(&"d") => {
                format!("; a derivative is written `d(..., {variable})`")
            }
            (_, Some(near)) => format!(", did you mean `{near}`?"),
            _ => {
                let problem = format!(
                    "expected {AFTER_OPERAND}, found `(`; a product needs its *, and no function \
                     has the name `{shown}`"
                );
                return self.error(self.token.start, problem);
            }
        };
        let problem = format!(
            "unknown name `{shown}`{remedy}; expected one of {}",
            known.join(" ")
        );
        self.error(token.start, problem)
    }

    /// Parses expressions with commas between them, and the bracket that closes the one at byte
    /// `opened`.
    fn parts(
        &mut self,
        opened: usize,
        closing: char,
        has_condition: bool,
    ) -> Result<Parts, SyntaxError> {
        let first = if has_condition {
            self.condition()?
        } else {
            self.expression(0)?
        };
        let mut reach = first.reach;
        let mut trees = vec![first.tree];
        while self.token.kind == TokenKind::Symbol(',') {
            self.advance();
            let next = self.expression(0)?;
            reach = reach.max(next.reach);
            trees.push(next.tree);
        }
        self.close(opened, closing)?;
        Ok(Parts { trees, reach })
    }

    /// Parses two expressions with a comparison between them.
    fn condition(&mut self) -> Result<Deep, SyntaxError> {
        let left = self.expression(0)?;
        let comparison = match self.token.kind {
            TokenKind::Symbol('<') => Relation::Less,
            TokenKind::Symbol('>') => Relation::Greater,
            TokenKind::OrEqual('<') => Relation::LessOrEqual,
            TokenKind::OrEqual(_) => Relation::GreaterOrEqual,
            _ => return Err(self.unexpected("one of < <= > >= in the condition of `where`")),
        };
        let at = self.advance().start;
        let right = self.expression(0)?;
        let reach = left.reach.max(right.reach);
        let operands = Box::new([left.tree, right.tree]);
        self.grow(at, reach, TreeKind::Compare(comparison, operands))
    }

    /// Consumes the bracket that closes the one at byte `opened`.
    fn close(&mut self, opened: usize, closing: char) -> Result<(), SyntaxError> {
        match self.token.kind {
            TokenKind::Symbol(symbol) if symbol == closing => {
                self.advance();
                Ok(())
            }
            TokenKind::Symbol(',') => {
                Err(self.unexpected("an operator or `)`: no function is being called"))
            }
            TokenKind::Symbol('<' | '>') | TokenKind::OrEqual(_) => {
                Err(self.unexpected("a comparison only as the first argument of `where`"))
            }
            _ => {
                let found = self.found();
                let problem = format!(
                    "expected an operator or `{closing}` for the bracket at byte {opened}, found {found}{}",
                    self.hint(true)
                );
                Err(self.error(self.token.start, problem))
            }
        }
    }

    /// The tree of `kind`, whose subtrees reach no further than `below`.
    fn grow(&self, at: usize, below: Reach, kind: TreeKind) -> Result<Deep, SyntaxError> {
        let reach = Reach {
            depth: below.depth + 1,
            height: below.height + 1,
        };
        self.limit(reach.depth, at)?;
        if reach.height > MAX_HEIGHT {
            let problem = format!(
                "expected at most {MAX_HEIGHT} operations without brackets, found more: split long sums by brackets"
            );
            return Err(self.error(at, problem));
        }
        Ok(Deep {
            tree: Tree {
                kind,
                at,
                end: self.end,
            },
            reach,
        })
    }

    fn limit(&self, depth: usize, at: usize) -> Result<(), SyntaxError> {
        if depth <= MAX_DEPTH {
            return Ok(());
        }
        let problem = format!(
            "expected at most {MAX_DEPTH} nested operations, found more: give parts names in [define]"
        );
        Err(self.error(at, problem))
    }

    fn advance(&mut self) -> Token {
        self.end = self.token.end;
        let following = next_token(self.text, self.end);
        std::mem::replace(&mut self.token, following)
    }

    fn slice(&self, token: Token) -> &str {
        &self.text[token.start..token.end]
    }

    /// The next token, in words.
    fn found(&self) -> String {
        match self.token.kind {
            TokenKind::End if self.text.trim().is_empty() => "an empty text".to_owned(),
            TokenKind::End => "the end".to_owned(),
            _ => format!("`{}`", shorten(self.slice(self.token))),
        }
    }

    /// A remedy that begins with `; `, or nothing.
    fn hint(&self, is_after_operand: bool) -> &'static str {
        let starts_operand = matches!(
            self.token.kind,
            TokenKind::Number(_) | TokenKind::Name | TokenKind::Symbol('(')
        );
        match self.slice(self.token) {
            "**" => "; a power is written ^",
            "−" | "–" => "; a minus is written -",
            "π" => "; write pi",
            "×" | "·" | "⋅" => "; a product is written *",
            _ if is_after_operand && starts_operand => "; a product needs its *",
            _ => "",
        }
    }

    fn unexpected(&self, expected: &str) -> SyntaxError {
        let hint = self.hint(expected == AFTER_OPERAND);
        let problem = format!("expected {expected}, found {}{hint}", self.found());
        self.error(self.token.start, problem)
    }

    fn error(&self, offset: usize, problem: String) -> SyntaxError {
        SyntaxError {
            text: self.text.to_owned(),
            offset,
            problem,
        }
    }
}

/// An operator, its precedence, and the lowest precedence in its right operand.
fn infix(kind: TokenKind) -> Option<(Binary, u8, u8)> {
    let TokenKind::Symbol(symbol) = kind else {
        return None;
    };
    match symbol {
        '+' => Some((Binary::Add, 1, 2)),
        '-' => Some((Binary::Subtract, 1, 2)),
        '*' => Some((Binary::Multiply, 3, 4)),
        '/' => Some((Binary::Divide, 3, 4)),
        // Right-associative: the right operand may contain another power.
        '^' => Some((Binary::Power, 7, 7)),
        _ => None,
    }
}

/// At most 24 characters of a token.
pub(super) fn shorten(text: &str) -> String {
    const LONGEST: usize = 24;
    match text.char_indices().nth(LONGEST) {
        Some((cut, _)) => format!("{}...", &text[..cut]),
        None => text.escape_debug().to_string(),
    }
}
