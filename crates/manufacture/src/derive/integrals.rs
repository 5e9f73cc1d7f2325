//! Integrals over a coordinate, in an arithmetic of functions and in one at a point.

use super::elaborate::{Elaborated, Elaborator, refused};
use super::tensor::{Tensor, combine, scale};
use crate::arithmetic::Algebra;
use crate::language::tree::{Binary, Tree};
use crate::problem::Expression;

impl<A: Algebra> Elaborator<'_, A> {
    /// The integral of each component over the whole interval of a coordinate.
    pub(super) fn integral(&mut self, parts: &[Tree], within: &Expression) -> Elaborated<A> {
        let variable = self.variable(&parts[1], within)?;
        if variable >= self.problem.coordinates.len() {
            return Err(refused(
                within,
                &parts[1],
                "expected a coordinate, found time",
            ));
        }
        let Some(rule) = self.algebra.rule(variable) else {
            let body = self.tree(&parts[0], within)?;
            return self.integrated(&body, variable, &parts[0], within);
        };
        let outside = std::mem::take(&mut self.known);
        let mut sum: Option<Tensor<A::Number>> = None;
        for [x, weight] in rule {
            let before = self.algebra.move_to(variable, x);
            self.known.clear();
            let body = self.tree(&parts[0], within)?;
            let body = self.integrated(&body, variable, &parts[0], within)?;
            self.algebra.move_to(variable, before);
            let weight = self.algebra.number(weight);
            let part = scale(&mut self.algebra, Binary::Multiply, &body, &weight);
            sum = Some(match sum {
                Some(sum) => combine(&mut self.algebra, Binary::Add, &sum, &part),
                None => part,
            });
        }
        self.known = outside;
        sum.ok_or_else(|| refused(within, &parts[0], "expected points of the integral"))
    }

    fn integrated(
        &mut self,
        body: &Tensor<A::Number>,
        variable: usize,
        tree: &Tree,
        within: &Expression,
    ) -> Elaborated<A> {
        let parts = body.parts.iter();
        let parts: Result<Vec<_>, String> = parts
            .map(|part| self.algebra.integral(part, variable))
            .collect();
        let parts = parts.map_err(|problem| refused(within, tree, problem))?;
        Ok(Tensor {
            shape: body.shape.clone(),
            parts,
        })
    }
}
