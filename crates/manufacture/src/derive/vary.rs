//! Exact fields as a variant changes them, in any arithmetic.

use super::elaborate::{Elaborated, Elaborator};
use super::tensor::{Tensor, combine, scale};
use crate::arithmetic::Algebra;
use crate::language::tree::Binary;
use crate::problem::{InputError, Value};
use crate::variants::{Carrier, Flattening, Step};

impl<A: Algebra> Elaborator<'_, A> {
    /// The value of an exact field. A variant is made of the fields of the file: fields that occur
    /// in the expression are those.
    pub(super) fn exact(&mut self, name: &str, value: &Value) -> Elaborated<A> {
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
    fn after(&mut self, steps: &[Step], value: &Value) -> Elaborated<A> {
        let Some((last, before)) = steps.split_last() else {
            return self.value(value);
        };
        match last {
            Step::Fix { variable, at } => {
                let mut traces = self.traces(before, value, *variable, *at, 0)?;
                Ok(traces.remove(0))
            }
            Step::Flatten(flattening) => self.flattened(flattening, before, value),
        }
    }

    fn flattened(
        &mut self,
        flattening: &Flattening,
        before: &[Step],
        value: &Value,
    ) -> Elaborated<A> {
        let Flattening {
            variable, degree, ..
        } = *flattening;
        let mut rest = self.after(before, value)?;
        for &end in &flattening.ends {
            let traces = self.traces(before, value, variable, end, degree)?;
            for (order, trace) in traces.iter().enumerate() {
                let carrier = self.carrier(variable, end, &flattening.carrier(end, order));
                let part = scale(&mut self.algebra, Binary::Multiply, trace, &carrier);
                rest = combine(&mut self.algebra, Binary::Subtract, &rest, &part);
            }
        }
        Ok(rest)
    }

    /// The derivatives of a function by a variable at a value of this variable, from that of order
    /// 0 on.
    fn traces(
        &mut self,
        steps: &[Step],
        value: &Value,
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
                for part in &mut function.parts {
                    *part = self.algebra.derivative(part, variable);
                }
            }
            let mut trace = function.clone();
            for part in &mut trace.parts {
                *part = self.algebra.fixed(part, variable, at);
            }
            traces.push(trace);
        }
        Ok(traces)
    }

    fn carrier(&mut self, variable: usize, end: f64, carrier: &Carrier) -> A::Number {
        let x = self.algebra.variable(variable);
        let end = self.algebra.number(end);
        let distance = self.algebra.binary(Binary::Subtract, &x, &end);
        // Horner's scheme.
        let mut value = self.algebra.number(0.0);
        for coefficient in carrier.coefficients.iter().rev() {
            let coefficient = self.algebra.number(*coefficient);
            value = self.algebra.binary(Binary::Multiply, &value, &distance);
            value = self.algebra.binary(Binary::Add, &value, &coefficient);
        }
        let other = self.algebra.number(carrier.other);
        let distance = self.algebra.binary(Binary::Subtract, &x, &other);
        let power = self.algebra.number(carrier.power as f64);
        let weight = self.algebra.binary(Binary::Power, &distance, &power);
        self.algebra.binary(Binary::Multiply, &value, &weight)
    }
}
