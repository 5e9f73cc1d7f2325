//! Tokens of an expression.

/// The kind of a token.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum TokenKind {
    /// A number; infinite if it is beyond the range of `f64`.
    Number(f64),
    /// A name: a letter or `_`, then letters, digits and `_`.
    Name,
    /// One of `+ - * / ^ ( ) [ ] , < >`.
    Symbol(char),
    /// `<=` or `>=`, by its first character.
    OrEqual(char),
    /// Anything else.
    Unknown,
    /// The end of the text.
    End,
}

/// A token and its range of bytes in the text.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Token {
    pub(super) kind: TokenKind,
    pub(super) start: usize,
    pub(super) end: usize,
}

/// The first token at or after byte `from`.
pub(super) fn next_token(source: &str, from: usize) -> Token {
    let rest = source[from..].trim_start();
    let start = source.len() - rest.len();
    let (kind, length) = match rest.chars().next() {
        None => (TokenKind::End, 0),
        Some(c) if c.is_ascii_digit() || c == '.' => number(rest),
        Some(c) if c.is_ascii_alphabetic() || c == '_' => (TokenKind::Name, name_length(rest)),
        // The power of other languages, not two products.
        Some('*') if rest.starts_with("**") => (TokenKind::Unknown, 2),
        Some(c @ ('<' | '>')) if rest[1..].starts_with('=') => (TokenKind::OrEqual(c), 2),
        Some(c) if "+-*/^()[],<>".contains(c) => (TokenKind::Symbol(c), 1),
        Some(c) => (TokenKind::Unknown, c.len_utf8()),
    };
    Token {
        kind,
        start,
        end: start + length,
    }
}

/// Whether a character may stand in a name.
pub(crate) fn is_of_name(c: char) -> bool {
    c.is_ascii_alphanumeric() || c == '_'
}

fn name_length(rest: &str) -> usize {
    rest.find(|c| !is_of_name(c)).unwrap_or(rest.len())
}

/// Digits, a point and digits, an exponent: `1`, `.5`, `2.`, `1e-3`.
fn number(rest: &str) -> (TokenKind, usize) {
    let digits = |from: usize| rest[from..].bytes().take_while(u8::is_ascii_digit).count();
    let mut length = digits(0);
    if rest[length..].starts_with('.') {
        length += 1 + digits(length + 1);
    }
    if rest[length..].starts_with(['e', 'E']) {
        let sign = usize::from(rest[length + 1..].starts_with(['+', '-']));
        let exponent = digits(length + 1 + sign);
        // Without digits e is the constant, and an operator is missing before it.
        if exponent > 0 {
            length += 1 + sign + exponent;
        }
    }
    // Only a single point fails to parse.
    rest[..length]
        .parse()
        .map_or((TokenKind::Unknown, 1), |value| {
            (TokenKind::Number(value), length)
        })
}
