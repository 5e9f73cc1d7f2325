//! Functions of two cases, of which a comparison chooses one.

use super::elaborate::{Elaborated, Elaborator, refused};
use super::tensor::Tensor;
use crate::arithmetic::Algebra;
use crate::language::names::Piecewise;
use crate::language::tree::{Relation, Tree, TreeKind};
use crate::problem::Expression;

impl<A: Algebra> Elaborator<'_, A> {
    /// `abs`, `min`, `max`, `heaviside` and `where`.
    pub(super) fn piecewise(
        &mut self,
        function: Piecewise,
        parts: &[Tree],
        tree: &Tree,
        within: &Expression,
    ) -> Elaborated<A> {
        if function == Piecewise::Where {
            return self.chosen(parts, tree, within);
        }
        let mut numbers = vec![];
        for part in parts {
            numbers.push(self.scalar(part, within)?);
        }
        let zero = self.algebra.number(0.0);
        let algebra = &mut self.algebra;
        let value = match (function, numbers.as_slice()) {
            (Piecewise::Abs, [a]) => {
                let opposite = algebra.negate(a);
                algebra.choose(Relation::Less, [a, &zero], &opposite, a)
            }
            (Piecewise::Min, [a, b]) => algebra.choose(Relation::LessOrEqual, [a, b], a, b),
            (Piecewise::Max, [a, b]) => algebra.choose(Relation::GreaterOrEqual, [a, b], a, b),
            (Piecewise::Heaviside, [a]) => {
                let one = algebra.number(1.0);
                algebra.choose(Relation::GreaterOrEqual, [a, &zero], &one, &zero)
            }
            _ => {
                return Err(refused(
                    within,
                    tree,
                    "expected another number of arguments",
                ));
            }
        };
        Ok(Tensor::scalar(value))
    }

    fn chosen(&mut self, parts: &[Tree], tree: &Tree, within: &Expression) -> Elaborated<A> {
        let [condition, then, otherwise] = parts else {
            return Err(refused(within, tree, "expected three arguments"));
        };
        let TreeKind::Compare(comparison, operands) = &condition.kind else {
            return Err(refused(within, condition, "expected a comparison"));
        };
        let left = self.scalar(&operands[0], within)?;
        let right = self.scalar(&operands[1], within)?;
        let then = self.tree(then, within)?;
        let otherwise = self.tree(otherwise, within)?;
        if then.shape != otherwise.shape {
            let [then, otherwise] = [then.words(), otherwise.words()];
            let problem = format!("{then} or {otherwise}; expected equal shapes");
            return Err(refused(within, tree, problem));
        }
        let algebra = &mut self.algebra;
        Ok(then.zip(&otherwise, |then, otherwise| {
            algebra.choose(*comparison, [&left, &right], then, otherwise)
        }))
    }
}
