//! Derivatives in space, in all four coordinate systems by one rule.
//!
//! Components are physical ones in the orthonormal basis. The derivative along theta is (1/r)(∂_θ +
//! turn), where turn acts on each index: (f_r, f_θ) becomes (-f_θ, f_r). `grad` appends the index
//! of the direction, `div` contracts it.

use super::tensor::{Tensor, combine, scale, sum_of_products};
use crate::arithmetic::Algebra;
use crate::language::tree::Binary;
use crate::problem::System;

/// A system of coordinates in so many dimensions.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Space {
    pub(crate) system: System,
    /// The number of components of a vector.
    pub(crate) components: usize,
    /// What derivatives know of the basis: all, but for a mistake.
    pub(crate) basis: Basis,
}

/// What a derivative along theta is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Basis {
    /// (1/r)(∂_θ + turn).
    Turning,
    /// (1/r) ∂_θ.
    Unturned,
    /// ∂_θ.
    Flat,
}

impl Space {
    /// The coordinate of a direction; `None` for theta if nothing depends on it.
    fn coordinate(self, direction: usize) -> Option<usize> {
        match (self.system, direction) {
            (System::Axisymmetric, 1) => None,
            (System::Axisymmetric, 2) => Some(1),
            _ => Some(direction),
        }
    }

    /// Whether a tensor has an index that its basis turns with, but which is no index of the space.
    pub(crate) fn refuses<N>(self, tensor: &Tensor<N>) -> bool {
        self.system != System::Cartesian && tensor.shape.iter().any(|n| *n != self.components)
    }

    /// The derivative along a direction of the basis.
    pub(crate) fn along<A: Algebra>(
        self,
        algebra: &mut A,
        of: &Tensor<A::Number>,
        direction: usize,
    ) -> Tensor<A::Number> {
        let coordinate = self.coordinate(direction);
        let derivative = of.map(|part| match coordinate {
            Some(coordinate) => algebra.derivative(part, coordinate),
            None => algebra.number(0.0),
        });
        let is_flat = self.system == System::Cartesian || self.basis == Basis::Flat;
        if is_flat || direction != 1 {
            return derivative;
        }
        let mut sum = derivative;
        if self.basis == Basis::Turning {
            let turned = self.turn(algebra, of);
            sum = combine(algebra, Binary::Add, &sum, &turned);
        }
        let radius = algebra.variable(0);
        scale(algebra, Binary::Divide, &sum, &radius)
    }

    /// What the turning basis adds, over all indices.
    fn turn<A: Algebra>(self, algebra: &mut A, of: &Tensor<A::Number>) -> Tensor<A::Number> {
        let mut parts = vec![];
        for place in 0..of.parts.len() {
            let mut sum = algebra.number(0.0);
            let mut stride = 1;
            for length in of.shape.iter().rev() {
                match place / stride % length {
                    0 => sum = algebra.binary(Binary::Subtract, &sum, &of.parts[place + stride]),
                    1 => sum = algebra.binary(Binary::Add, &sum, &of.parts[place - stride]),
                    _ => (),
                }
                stride *= length;
            }
            parts.push(sum);
        }
        Tensor {
            shape: of.shape.clone(),
            parts,
        }
    }

    /// `grad(v)_ij = ∂v_i/∂x_j`: the new index is the last.
    pub(crate) fn gradient<A: Algebra>(
        self,
        algebra: &mut A,
        of: &Tensor<A::Number>,
    ) -> Tensor<A::Number> {
        let along: Vec<Tensor<A::Number>> = (0..self.components)
            .map(|direction| self.along(algebra, of, direction))
            .collect();
        let mut shape = of.shape.clone();
        shape.push(self.components);
        let mut parts = vec![];
        for place in 0..of.parts.len() {
            parts.extend(along.iter().map(|part| part.parts[place].clone()));
        }
        Tensor { shape, parts }
    }

    /// `div(A)_i = Σ_j ∂A_ij/∂x_j`: the last index is contracted.
    pub(crate) fn divergence<A: Algebra>(
        self,
        algebra: &mut A,
        of: &Tensor<A::Number>,
    ) -> Tensor<A::Number> {
        let mut sum: Option<Tensor<A::Number>> = None;
        for direction in 0..self.components {
            let along = self.along(algebra, of, direction);
            let column = along.parts.iter().skip(direction).step_by(self.components);
            let column = Tensor {
                shape: of.shape[..of.rank() - 1].to_vec(),
                parts: column.cloned().collect(),
            };
            sum = Some(match sum {
                Some(sum) => combine(algebra, Binary::Add, &sum, &column),
                None => column,
            });
        }
        sum.unwrap_or_else(|| of.clone())
    }

    /// Of a vector of three: a vector; of two: ∂_1 v_2 - ∂_2 v_1; of a scalar in two dimensions:
    /// (∂_2 s, -∂_1 s).
    pub(crate) fn curl<A: Algebra>(
        self,
        algebra: &mut A,
        of: &Tensor<A::Number>,
    ) -> Tensor<A::Number> {
        let gradient = self.gradient(algebra, of);
        if of.rank() == 0 {
            let reversed = algebra.negate(&gradient.parts[0]);
            return Tensor::vector(vec![gradient.parts[1].clone(), reversed]);
        }
        let mut entry = |i: usize, j: usize| {
            let [first, second] = [gradient.entry(i, j), gradient.entry(j, i)];
            algebra.binary(Binary::Subtract, first, second)
        };
        if self.components == 2 {
            return Tensor::scalar(entry(1, 0));
        }
        Tensor::vector(vec![entry(2, 1), entry(0, 2), entry(1, 0)])
    }

    /// The gradient divided by its length.
    pub(crate) fn normal<A: Algebra>(
        self,
        algebra: &mut A,
        level: &Tensor<A::Number>,
    ) -> Tensor<A::Number> {
        let gradient = self.gradient(algebra, level);
        let square = sum_of_products(algebra, gradient.parts.iter().zip(&gradient.parts));
        let half = algebra.number(0.5);
        let length = algebra.binary(Binary::Power, &square, &half);
        scale(algebra, Binary::Divide, &gradient, &length)
    }
}
