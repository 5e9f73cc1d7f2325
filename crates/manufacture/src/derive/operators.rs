//! The operators of the language on tensors, with the slips that people make in them.

use super::Slip;
use super::elaborate::{Elaborated, Elaborator, matrix, refused};
use super::space::Basis;
use super::tensor::{self, Tensor, combine, scale, sum_of_products};
use crate::arithmetic::Algebra;
use crate::language::names::{Alteration, Callee, Operator};
use crate::language::tree::{Binary, Kind, Tree};
use crate::problem::{Expression, InputError, Value};

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
                self.outer_derivative(&Outer::Partial(by?), &parts[0], tree, within)
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
            Operator::Divergence => {
                self.outer_derivative(&Outer::Divergence, &parts[0], tree, within)
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
        alteration: Alteration,
        operand: &Tree,
        within: &Expression,
    ) -> Elaborated<A> {
        let basis = match alteration {
            Alteration::Held => self.space.basis,
            Alteration::Unturned => Basis::Unturned,
            Alteration::Flat => Basis::Flat,
        };
        let outside = std::mem::replace(&mut self.space.basis, basis);
        let value = self.tree(operand, within);
        self.space.basis = outside;
        let mut value = value?;
        if alteration == Alteration::Held {
            for part in &mut value.parts {
                *part = self.algebra.held(part);
            }
        }
        Ok(value)
    }

    fn partial(&mut self, of: &Tensor<A::Number>, by: &[usize]) -> Tensor<A::Number> {
        let mut derivative = of.clone();
        for variable in by {
            for part in &mut derivative.parts {
                *part = self.algebra.derivative(part, *variable);
            }
        }
        derivative
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
                let gradient = self.space.gradient(algebra, &of);
                let is_transposed = self.slip == Slip::TransposedGradient && of.rank() == 1;
                if is_transposed && gradient.square().is_some() {
                    self.slips += 1;
                    return Ok(gradient.transposed());
                }
                return Ok(gradient);
            }
            Operator::Laplacian => {
                let gradient = self.space.gradient(algebra, &of);
                return Ok(self.space.divergence(algebra, &gradient));
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
                    let is_plain = self.slip == Slip::PlainTranspose && of.square().is_some();
                    self.slips += usize::from(is_plain);
                    return Ok(if is_plain { of } else { of.transposed() });
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
        let is_slip = matches!(self.slip, Slip::PlainSymmetric | Slip::HalfSymmetric);
        self.slips += usize::from(is_slip && operator == Operator::Symmetric);
        let sum = match (operator, self.slip) {
            (Operator::Symmetric, Slip::PlainSymmetric) => return of.clone(),
            (Operator::Symmetric, Slip::HalfSymmetric) => of.clone(),
            (Operator::Symmetric, _) => combine(algebra, Binary::Add, of, &of.transposed()),
            _ => combine(algebra, Binary::Subtract, of, &of.transposed()),
        };
        scale(algebra, Binary::Multiply, &sum, &half)
    }

    /// `div` or `d`, as written or, with that slip, without the derivatives of coefficients.
    fn outer_derivative(
        &mut self,
        outer: &Outer,
        of: &Tree,
        tree: &Tree,
        within: &Expression,
    ) -> Elaborated<A> {
        if self.slip == Slip::ProductRule
            && let Some(value) = self.without_product_rule(outer, of, tree, within)?
        {
            return Ok(value);
        }
        let value = self.tree(of, within)?;
        self.apply(outer, value, tree, within)
    }

    fn apply(
        &mut self,
        outer: &Outer,
        of: Tensor<A::Number>,
        tree: &Tree,
        within: &Expression,
    ) -> Elaborated<A> {
        let by = match outer {
            Outer::Partial(by) => by,
            Outer::Divergence => {
                let is_fit = of.shape.last() == Some(&self.space.components);
                if is_fit && !self.space.refuses(&of) {
                    return Ok(self.space.divergence(&mut self.algebra, &of));
                }
                let expected = format!("a last index of {} components", self.space.components);
                return Err(self.operand_error(
                    Operator::Divergence,
                    &expected,
                    &[of],
                    tree,
                    within,
                ));
            }
        };
        Ok(self.partial(&of, by))
    }

    /// The outer derivative of `k*grad(T)` with k before it, also where a definition hides the
    /// product; `None` where no factor stands out as the coefficient, because it alone has no
    /// derivative.
    fn without_product_rule(
        &mut self,
        outer: &Outer,
        of: &Tree,
        tree: &Tree,
        within: &Expression,
    ) -> Result<Option<Tensor<A::Number>>, InputError> {
        match &of.kind {
            Kind::Bracket(inner) => self.without_product_rule(outer, inner, tree, within),
            Kind::Name(name) => match self.problem.definitions.get(name) {
                Some(definition) if !definition.is_exact => match &definition.value {
                    Value::One(inner) => self.without_product_rule(outer, &inner.tree, tree, inner),
                    Value::List(..) => Ok(None),
                },
                _ => Ok(None),
            },
            Kind::Negate(inner) => {
                let value = self.outer_derivative(outer, inner, tree, within)?;
                let minus = self.algebra.number(-1.0);
                let value = scale(&mut self.algebra, Binary::Multiply, &value, &minus);
                Ok(Some(value))
            }
            Kind::Binary(operator @ (Binary::Add | Binary::Subtract), operands) => {
                let left = self.outer_derivative(outer, &operands[0], tree, within)?;
                let right = self.outer_derivative(outer, &operands[1], tree, within)?;
                Ok(Some(combine(&mut self.algebra, *operator, &left, &right)))
            }
            Kind::Binary(operator @ (Binary::Multiply | Binary::Divide), operands) => {
                let [left, right] = operands.as_ref();
                let has = [left, right].map(|side| self.has_derivative(side));
                let [coefficient, rest] = match (operator, has) {
                    (_, [true, false]) => [right, left],
                    (Binary::Multiply, [false, true]) => [left, right],
                    _ => return Ok(None),
                };
                let coefficient = self.tree(coefficient, within)?;
                if !self.varies(outer, &coefficient) {
                    return Ok(None);
                }
                self.slips += 1;
                let rest = self.outer_derivative(outer, rest, tree, within)?;
                let value = self.binary(*operator, &rest, &coefficient);
                Ok(value.ok())
            }
            _ => Ok(None),
        }
    }

    /// Whether the product rule gives a coefficient a derivative.
    fn varies(&mut self, outer: &Outer, coefficient: &Tensor<A::Number>) -> bool {
        let variables = match outer {
            Outer::Divergence => (0..self.problem.coordinates.len()).collect(),
            Outer::Partial(by) => by.clone(),
        };
        let mut slopes = vec![];
        for variable in variables {
            for part in &coefficient.parts {
                slopes.push(self.algebra.derivative(part, variable));
            }
        }
        slopes.iter().any(|slope| !self.algebra.is_zero(slope))
    }

    /// Whether a derivative occurs in it, also in a definition that it names.
    fn has_derivative(&mut self, tree: &Tree) -> bool {
        match &tree.kind {
            Kind::Call(
                Callee::Operator(
                    Operator::Derivative
                    | Operator::TimeDerivative
                    | Operator::Gradient
                    | Operator::Divergence
                    | Operator::Laplacian
                    | Operator::Curl,
                ),
                _,
            ) => true,
            Kind::Name(name) => {
                if let Some(known) = self.differential.get(name) {
                    return *known;
                }
                let definition = self.problem.definitions.get(name);
                let has = match definition {
                    Some(definition) if !definition.is_exact => {
                        self.value_has_derivative(&definition.value)
                    }
                    _ => false,
                };
                self.differential.insert(name.clone(), has);
                has
            }
            _ => tree
                .children()
                .iter()
                .any(|child| self.has_derivative(child)),
        }
    }

    fn value_has_derivative(&mut self, value: &Value) -> bool {
        match value {
            Value::One(expression) => self.has_derivative(&expression.tree),
            Value::List(_, parts) => parts.iter().any(|part| self.value_has_derivative(part)),
        }
    }
}

/// The derivatives that a product stands in.
enum Outer {
    Divergence,
    /// By these variables, one after the other.
    Partial(Vec<usize>),
}
