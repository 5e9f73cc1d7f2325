//! The language of expressions: mathematical notation, with operators on tensors.
//!
//! | text | meaning |
//! | --- | --- |
//! | `-x^2` | -(x²): a power has precedence over a sign |
//! | `2^3^2` | 2⁹ = 512: powers are right-associative |
//! | `2^-1`, `2*-x` | a sign may follow an operator |
//! | `1e-3`, `.5`, `2.` | numbers |
//! | `pi`, `e` | constants |
//! | `[a, b]`, `[[a, b], [c, d]]` | a vector; a tensor, row by row |
//! | `v[x]`, `v[1]`, `A[x, y]` | components, by coordinate or by number from 1 |
//! | `where(a < b, then, else)` | piece by piece; also `abs min max heaviside` |
//!
//! A product needs its `*`: `2x` is an error.

mod error;
pub mod names;
mod parser;
mod token;
pub mod tree;

pub use error::SyntaxError;
pub(crate) use error::excerpt;
pub use parser::{MAX_DEPTH, parse, parse_for};
pub(crate) use token::is_of_name;
