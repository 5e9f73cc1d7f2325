//! Exact solutions: sums of products of a function of x and a function of t.

use crate::function::Factor;

/// A product X(x) T(t).
#[derive(Debug, Clone)]
pub struct Product {
    /// X, a function of x; finite on [0, 1] with its first two derivatives.
    pub x: Factor,
    /// T, a function of t; finite on [0, t_end] with its first two derivatives.
    pub t: Factor,
}

/// An exact solution: a sum of products for each field; an empty sum is 0.
#[derive(Debug, Clone, Default)]
pub struct Manufactured {
    /// Displacement; each X is 0 at x = 0.
    pub u: Vec<Product>,
    /// Rotation; each X is 0 at x = 0.
    pub phi: Vec<Product>,
    /// Physical temperature; the sum is θ_A at x = 0 and 0 at x = 1.
    pub theta: Vec<Product>,
}

impl Manufactured {
    /// u(1, t).
    pub fn tip(&self, t: f64) -> f64 {
        self.u.iter().map(|product| product.x.eval(1.0) * product.t.eval(t)).sum()
    }
}
