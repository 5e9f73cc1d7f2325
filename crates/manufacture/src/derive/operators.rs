//! The operators of the language on tensors.

use super::elaborate::{Elaborated, Elaborator, matrix, refused};
use super::space::Basis;
use super::tensor::{self, Tensor, combine, scale, sum_of_products};
use crate::arithmetic::Algebra;
use crate::language::names::{OperandAlteration, Operator};
use crate::language::tree::{Binary, Tree};
use crate::problem::Expression;

impl<A: Algebra> Elaborator<'_, A> {
    pub(super) fn operator(
        &mut self,
        operator: Operator,
        parts: &[Tree],
        tree: &Tree,
        within: &Expression,
    ) -> Elaborated<A> {
        match operator {
            Operator::Derivative => {
                let by: Result<Vec<usize>, _> = parts[1..]
                    .iter()
                    .map(|part| self.variable(part, within))
                    .collect();
                let by = by?;
                let of = self.tree(&parts[0], within)?;
                Ok(self.partial(&of, &by))
            }
            Operator::TimeDerivative => {
                if self.problem.time.is_none() {
                    let problem = "expected `time` in [manufacture]";
                    return Err(refused(within, tree, problem));
                }
                let time = self.problem.coordinates.len();
                let of = self.tree(&parts[0], within)?;
                Ok(self.partial(&of, &[time]))
            }
            Operator::Integral => self.integral(parts, within),
            Operator::Altered(alteration) => self.altered(alteration, &parts[0], within),
            Operator::Dot | Operator::Inner | Operator::Outer | Operator::Cross => {
                let left = self.tree(&parts[0], within)?;
                let right = self.tree(&parts[1], within)?;
                self.product(operator, &[left, right], tree, within)
            }
            _ => {
                let of = self.tree(&parts[0], within)?;
                self.of_one(operator, of, tree, within)
            }
        }
    }

    fn altered(
        &mut self,
        alteration: OperandAlteration,
        operand: &Tree,
        within: &Expression,
    ) -> Elaborated<A> {
        let basis = match alteration {
            OperandAlteration::Held | OperandAlteration::Scaled => self.space.basis,
            OperandAlteration::Unturned => Basis::Unturned,
            OperandAlteration::Flat => Basis::Flat,
        };
        let outside = std::mem::replace(&mut self.space.basis, basis);
        let value = self.tree(operand, within);
        self.space.basis = outside;
        let value = value?;
        Ok(match alteration {
            OperandAlteration::Held => value.map(|part| self.algebra.held(part)),
            OperandAlteration::Scaled => {
                let factor = self.algebra.parameter(self.problem.parameters.len());
                scale(&mut self.algebra, Binary::Multiply, &value, &factor)
            }
            OperandAlteration::Unturned | OperandAlteration::Flat => value,
        })
    }

    fn partial(&mut self, of: &Tensor<A::Number>, by: &[usize]) -> Tensor<A::Number> {
        let by = by.iter();
        by.fold(of.clone(), |derivative, variable| {
            derivative.map(|part| self.algebra.derivative(part, *variable))
        })
    }

    fn product(
        &mut self,
        operator: Operator,
        operands: &[Tensor<A::Number>; 2],
        tree: &Tree,
        within: &Expression,
    ) -> Elaborated<A> {
        let [left, right] = operands;
        let [inside, outside] = [left.shape.last(), right.shape.first()];
        let both = left.parts.iter().zip(&right.parts);
        let algebra = &mut self.algebra;
        let expected = match operator {
            Operator::Dot => {
                if inside.is_some() && inside == outside {
                    return Ok(tensor::dot(algebra, left, right));
                }
                "a last index and a first index of the same length"
            }
            Operator::Inner => {
                if left.shape == right.shape {
                    return Ok(Tensor::scalar(sum_of_products(algebra, both)));
                }
                "equal shapes"
            }
            Operator::Outer => {
                if left.rank() > 0 && right.rank() > 0 {
                    return Ok(tensor::outer(algebra, left, right));
                }
                "vectors"
            }
            _ => {
                let is_vector = left.rank() == 1 && (2..=3).contains(&left.parts.len());
                if is_vector && left.shape == right.shape {
                    return Ok(tensor::cross(algebra, &left.parts, &right.parts));
                }
                "two vectors of 3, or of 2"
            }
        };
        Err(self.operand_error(operator, expected, operands, tree, within))
    }

    fn of_one(
        &mut self,
        operator: Operator,
        of: Tensor<A::Number>,
        tree: &Tree,
        within: &Expression,
    ) -> Elaborated<A> {
        let components = self.space.components;
        let algebra = &mut self.algebra;
        let expected = match operator {
            Operator::Gradient | Operator::Laplacian if self.space.refuses(&of) => {
                "as many components as the space has"
            }
            Operator::Gradient => {
                return Ok(self.space.gradient(algebra, &of));
            }
            Operator::Laplacian => {
                let gradient = self.space.gradient(algebra, &of);
                return Ok(self.space.divergence(algebra, &gradient));
            }
            Operator::Divergence => {
                let is_fit = of.shape.last() == Some(&components);
                if is_fit && !self.space.refuses(&of) {
                    return Ok(self.space.divergence(algebra, &of));
                }
                &format!("a last index of {components} components")
            }
            Operator::Curl => {
                let is_vector = of.shape == [components] && components > 1;
                if is_vector || (of.rank() == 0 && components == 2) {
                    return Ok(self.space.curl(algebra, &of));
                }
                "a vector of 2 or 3 in as many dimensions, or a scalar in 2 dimensions"
            }
            Operator::Transpose => {
                if of.rank() == 2 {
                    return Ok(of.transposed());
                }
                "a tensor"
            }
            Operator::Symmetric | Operator::Skew | Operator::Trace => {
                if of.square().is_some() {
                    return Ok(self.of_square(operator, &of));
                }
                "a square tensor"
            }
            _ => match matrix(algebra, operator, &of) {
                Some(value) => return Ok(value),
                None => "a square tensor of up to 3 rows",
            },
        };
        Err(self.operand_error(operator, expected, &[of], tree, within))
    }

    fn of_square(&mut self, operator: Operator, of: &Tensor<A::Number>) -> Tensor<A::Number> {
        let algebra = &mut self.algebra;
        if operator == Operator::Trace {
            let mut sum = algebra.number(0.0);
            for place in 0..of.shape[0] {
                sum = algebra.binary(Binary::Add, &sum, of.entry(place, place));
            }
            return Tensor::scalar(sum);
        }
        let half = algebra.number(0.5);
        let sign = if operator == Operator::Symmetric {
            Binary::Add
        } else {
            Binary::Subtract
        };
        let sum = combine(algebra, sign, of, &of.transposed());
        scale(algebra, Binary::Multiply, &sum, &half)
    }
}
