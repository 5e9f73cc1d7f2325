//! Exact fields as a variant changes them, in any arithmetic.

use super::elaborate::{Elaborated, Elaborator};
use super::tensor::{Tensor, combine, scale};
use crate::arithmetic::Algebra;
use crate::language::tree::Binary;
use crate::problem::{Bubble, VariationStep};
use crate::problem::{InputError, TensorValue};

impl<A: Algebra> Elaborator<'_, A> {
    /// The value of an exact field. A variant is made of the fields of the file: fields that occur
    /// in the expression are those.
    pub(super) fn exact(&mut self, name: &str, value: &TensorValue) -> Elaborated<A> {
        let variation = self.problem.variation.as_ref();
        let variation = variation.filter(|variation| !self.is_plain && variation.concerns(name));
        let Some(variation) = variation else {
            return self.value(value);
        };
        let outside = std::mem::take(&mut self.known);
        self.is_plain = true;
        let varied = self.after(&variation.steps, value);
        self.is_plain = false;
        self.known = outside;
        let mut varied = varied?;
        if let Some(lifts) = variation.lifts.get(name) {
            for (part, lift) in varied.parts.iter_mut().zip(lifts) {
                let lift = self.algebra.number(*lift);
                *part = self.algebra.binary(Binary::Add, part, &lift);
            }
        }
        Ok(varied)
    }

    /// A function after these steps.
    fn after(&mut self, steps: &[VariationStep], value: &TensorValue) -> Elaborated<A> {
        let Some((last, before)) = steps.split_last() else {
            return self.value(value);
        };
        match last {
            VariationStep::Fix { variable, at } => {
                let mut traces = self.traces(before, value, *variable, *at, 0)?;
                Ok(traces.remove(0))
            }
            VariationStep::Flatten {
                variable,
                end,
                degree,
            } => self.flattened(*variable, *end, *degree, before, value),
            VariationStep::Weigh(bubble) => {
                let function = self.after(before, value)?;
                let weight = self.weight(bubble);
                Ok(scale(
                    &mut self.algebra,
                    Binary::Multiply,
                    &function,
                    &weight,
                ))
            }
        }
    }

    /// A function without its Taylor polynomial.
    fn flattened(
        &mut self,
        variable: usize,
        end: f64,
        degree: usize,
        before: &[VariationStep],
        value: &TensorValue,
    ) -> Elaborated<A> {
        let mut rest = self.after(before, value)?;
        let traces = self.traces(before, value, variable, end, degree)?;
        let mut factorial = 1.0;
        for (order, trace) in traces.iter().enumerate() {
            factorial *= order.max(1) as f64;
            let carrier = self.power(variable, end, order, 1.0 / factorial);
            let part = scale(&mut self.algebra, Binary::Multiply, trace, &carrier);
            rest = combine(&mut self.algebra, Binary::Subtract, &rest, &part);
        }
        Ok(rest)
    }

    /// The derivatives of a function by a variable at a value of this variable, from that of order
    /// 0 on.
    fn traces(
        &mut self,
        steps: &[VariationStep],
        value: &TensorValue,
        variable: usize,
        at: f64,
        most: usize,
    ) -> Result<Vec<Tensor<A::Number>>, InputError> {
        // An arithmetic at a point needs the expression at another point.
        let outside = std::mem::take(&mut self.known);
        let from = self.algebra.move_to(variable, at);
        let function = self.after(steps, value);
        self.algebra.move_to(variable, from);
        self.known = outside;
        let mut function = function?;
        let mut traces = vec![];
        for order in 0..=most {
            if order > 0 {
                function = function.map(|part| self.algebra.derivative(part, variable));
            }
            traces.push(function.map(|part| self.algebra.fixed(part, variable, at)));
        }
        Ok(traces)
    }

    /// `factor * (x - end)^exponent`.
    fn power(&mut self, variable: usize, end: f64, exponent: usize, factor: f64) -> A::Number {
        let x = self.algebra.variable(variable);
        let end = self.algebra.number(end);
        let distance = self.algebra.binary(Binary::Subtract, &x, &end);
        let exponent = self.algebra.number(exponent as f64);
        let power = self.algebra.binary(Binary::Power, &distance, &exponent);
        let factor = self.algebra.number(factor);
        self.algebra.binary(Binary::Multiply, &factor, &power)
    }

    fn weight(&mut self, bubble: &Bubble) -> A::Number {
        let [low, high] = bubble.interval;
        let scale = -4.0 / (high - low).powi(2);
        let below = self.power(bubble.variable, low, 1, scale);
        let above = self.power(bubble.variable, high, 1, 1.0);
        let product = self.algebra.binary(Binary::Multiply, &below, &above);
        let exponent = self.algebra.number((bubble.degree + 1) as f64);
        self.algebra.binary(Binary::Power, &product, &exponent)
    }
}
