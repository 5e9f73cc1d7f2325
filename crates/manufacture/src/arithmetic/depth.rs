//! The largest number of derivatives one inside the other.

use super::Algebra;
use crate::language::names::Function;
use crate::language::tree::{Binary, Relation};

/// An arithmetic whose numbers count the derivatives taken of functions.
#[derive(Debug, Default)]
pub(crate) struct Depth;

impl Algebra for Depth {
    type Number = usize;

    fn number(&mut self, _value: f64) -> usize {
        0
    }

    fn variable(&mut self, _index: usize) -> usize {
        0
    }

    fn parameter(&mut self, _index: usize) -> usize {
        0
    }

    fn binary(&mut self, _operator: Binary, left: &usize, right: &usize) -> usize {
        *left.max(right)
    }

    fn call(&mut self, _function: Function, argument: &usize) -> usize {
        *argument
    }

    fn choose(&mut self, _: Relation, compared: [&usize; 2], then: &usize, other: &usize) -> usize {
        *compared[0].max(compared[1]).max(then).max(other)
    }

    fn derivative(&mut self, of: &usize, _variable: usize) -> usize {
        of + 1
    }

    fn integral(&mut self, body: &usize, _variable: usize) -> Result<usize, String> {
        Ok(*body)
    }
}
