//! Arithmetics that expressions are computed in: a graph with symbolic derivatives, Taylor jets at
//! a point, and the number of derivatives that a jet needs.

mod depth;
pub(crate) mod graph;
pub(crate) mod jet;
mod node;
pub(crate) mod quadrature;
pub(crate) mod tape;

use crate::language::names::Function;
use crate::language::tree::{Binary, Relation, Tree};
use crate::problem::Expression;

pub(crate) use depth::Depth;
pub(crate) use graph::Graph;
pub(crate) use node::{FieldDerivative, Node, NodeId, apply, operate};

/// Values that should be equal may differ by this times their size: derivatives of high order lose
/// digits by rounding.
pub(crate) const SAME: f64 = 1e4 * f64::EPSILON;

/// The place of an operation's argument in the file.
#[derive(Debug, Clone)]
pub(crate) struct Origin {
    pub(crate) within: Expression,
    /// The argument, without brackets around it.
    pub(crate) argument: Tree,
}

/// Numbers that have derivatives. The rules for indices are generic in it.
pub(crate) trait Algebra {
    /// A scalar function of the coordinates and time.
    type Number: Clone;

    fn number(&mut self, value: f64) -> Self::Number;
    /// A coordinate, or time, by its place.
    fn variable(&mut self, index: usize) -> Self::Number;
    fn parameter(&mut self, index: usize) -> Self::Number;
    fn binary(
        &mut self,
        operator: Binary,
        left: &Self::Number,
        right: &Self::Number,
    ) -> Self::Number;
    /// A smooth function of one argument.
    fn call(&mut self, function: Function, argument: &Self::Number) -> Self::Number;
    /// `then` where the comparison holds.
    fn choose(
        &mut self,
        comparison: Relation,
        compared: [&Self::Number; 2],
        then: &Self::Number,
        otherwise: &Self::Number,
    ) -> Self::Number;
    /// The partial derivative by a variable.
    fn derivative(&mut self, of: &Self::Number, variable: usize) -> Self::Number;
    /// Points and weights of the integral over a variable, for an arithmetic at a point.
    fn rule(&self, _variable: usize) -> Option<Vec<[f64; 2]>> {
        None
    }
    /// Moves the point along a variable, and returns where it was.
    fn move_to(&mut self, _variable: usize, _to: f64) -> f64 {
        0.0
    }
    /// The integral of `body` over a variable; in an arithmetic at a point, one of its summands.
    ///
    /// # Errors
    /// In words: the integrand is not integrated accurately.
    fn integral(&mut self, body: &Self::Number, variable: usize) -> Result<Self::Number, String>;
    /// The value of `body` where a variable has this value; an arithmetic at a point has been moved
    /// there before `body` was computed.
    fn fixed(&mut self, body: &Self::Number, _variable: usize, _at: f64) -> Self::Number {
        body.clone()
    }
    /// The same value, which derivatives take for a constant; in an arithmetic without derivatives
    /// the number itself.
    fn held(&mut self, number: &Self::Number) -> Self::Number {
        number.clone()
    }
    /// The value of a component of an exact field, by its place among the fields.
    fn field(&mut self, value: &Self::Number, _field: usize, _component: usize) -> Self::Number {
        value.clone()
    }
    /// Keeps where the file has an operation, and what it is applied to.
    fn keep_origin(&mut self, _of: &Self::Number, _origin: impl FnOnce() -> Origin) {}
    /// The number of nodes that exist; 0 in an arithmetic without.
    fn nodes(&self) -> usize {
        0
    }

    fn negate(&mut self, operand: &Self::Number) -> Self::Number {
        let zero = self.number(0.0);
        self.binary(Binary::Subtract, &zero, operand)
    }
}
