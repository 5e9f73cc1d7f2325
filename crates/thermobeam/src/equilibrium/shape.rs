//! The bent beam in closed form for given axial force N and stress c.

use crate::stumpff::{c0, c1, c2, c3, c5};

/// A solution of the static equations in the interior and at x = 1; notation as in [`super`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Shape {
    /// `u = slope x`, `φ = 0`, `c = 0`.
    Line {
        /// u', constant.
        slope: f64,
    },
    /// N > -1.
    AboveMinusOne(AboveMinusOne),
    /// N < -1.
    BelowMinusOne(BelowMinusOne),
}

/// N > -1: `φ = α c_0(Xy²) - d y² c_2(Xy²)` with y = 1 - x, X = q - 1.
///
/// Entire in q: N = 0 and the buckling values are no special cases.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct AboveMinusOne {
    /// `q = 1 / (1 + N) > 0`.
    pub(super) q: f64,
    /// α = φ(1).
    pub(super) alpha: f64,
    /// The stress c.
    pub(super) stress: f64,
    /// The thermal moment aθ_A.
    pub(super) moment: f64,
}

/// N < -1: `φ = d (1 - cosh ky / cosh k) / k²` with y = 1 - x, k² = 1 - q > 1.
///
/// It satisfies φ(0) = 0. Only ratios of hyperbolic functions occur, so k may be arbitrarily large.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct BelowMinusOne {
    /// `q = 1 / (1 + N) < 0`.
    pub(super) q: f64,
    /// The stress c.
    pub(super) stress: f64,
    /// The thermal moment aθ_A.
    pub(super) moment: f64,
}

impl Shape {
    /// Axial force N of the shape; -1 for a line.
    pub(super) fn n_value(&self) -> f64 {
        match self {
            Shape::Line { .. } => -1.0,
            Shape::AboveMinusOne(AboveMinusOne { q, .. }) | Shape::BelowMinusOne(BelowMinusOne { q, .. }) => {
                1.0 / q - 1.0
            }
        }
    }

    /// Stress `c = (1 + N) u' - φ`, constant in x.
    pub(super) fn stress(&self) -> f64 {
        match self {
            Shape::Line { .. } => 0.0,
            Shape::AboveMinusOne(wave) => wave.stress,
            Shape::BelowMinusOne(below) => below.stress,
        }
    }

    /// `‖u'‖² = ∫₀¹ u'² dx`.
    pub(super) fn slope_squared(&self) -> f64 {
        match self {
            Shape::Line { slope } => slope * slope,
            Shape::AboveMinusOne(wave) => wave.slope_squared(),
            Shape::BelowMinusOne(below) => below.slope_squared(),
        }
    }

    /// u at x.
    pub(super) fn u(&self, x: f64) -> f64 {
        match self {
            Shape::Line { slope } => slope * x,
            Shape::AboveMinusOne(wave) => wave.u(x),
            Shape::BelowMinusOne(below) => below.u(x),
        }
    }

    /// u' at x.
    pub(super) fn u_x(&self, x: f64) -> f64 {
        match self {
            Shape::Line { slope } => *slope,
            Shape::AboveMinusOne(wave) => wave.q * (wave.phi(x) + wave.stress),
            Shape::BelowMinusOne(below) => below.u_x(x),
        }
    }

    /// φ at x.
    pub(super) fn phi(&self, x: f64) -> f64 {
        match self {
            Shape::Line { .. } => 0.0,
            Shape::AboveMinusOne(wave) => wave.phi(x),
            Shape::BelowMinusOne(below) => below.phi(x),
        }
    }

    /// φ' at x.
    pub(super) fn phi_x(&self, x: f64) -> f64 {
        match self {
            Shape::Line { .. } => 0.0,
            Shape::AboveMinusOne(wave) => wave.phi_x(x),
            Shape::BelowMinusOne(below) => below.phi_x(x),
        }
    }
}

impl AboveMinusOne {
    /// `d = aθ_A + cq`, the constant right-hand side of φ'' + Xφ + d = 0.
    fn d(&self) -> f64 {
        self.moment + self.stress * self.q
    }

    fn x(&self) -> f64 {
        self.q - 1.0
    }

    /// `‖u'‖² = q² ∫ (αC - dW + c)² dy` with C = c_0(Xy²), W = y² c_2(Xy²).
    ///
    /// By cosh² = (1 + cosh 2·)/2 the products integrate to Stumpff functions of X and 4X.
    fn slope_squared(&self) -> f64 {
        let (x, alpha, c, d) = (self.x(), self.alpha, self.stress, self.d());
        let cc = 0.5 * (1.0 + c1(4.0 * x));
        let cw = 2.0 * c3(4.0 * x) - c3(x);
        let ww = 8.0 * c5(4.0 * x) - 2.0 * c5(x);
        let squares = alpha * alpha * cc + d * d * ww + c * c;
        let products = alpha * c * c1(x) - alpha * d * cw - d * c * c3(x);
        self.q * self.q * (squares + 2.0 * products)
    }

    fn phi(&self, x: f64) -> f64 {
        let y = 1.0 - x;
        let argument = self.x() * y * y;
        self.alpha * c0(argument) - self.d() * y * y * c2(argument)
    }

    fn phi_x(&self, x: f64) -> f64 {
        let y = 1.0 - x;
        (self.alpha * self.x() + self.d()) * y * c1(self.x() * y * y)
    }

    /// `u = q ∫₀ˣ (φ + c)`.
    fn u(&self, x: f64) -> f64 {
        let y = 1.0 - x;
        let argument = self.x() * y * y;
        let cosine = c1(self.x()) - y * c1(argument);
        let remainder = c3(self.x()) - y.powi(3) * c3(argument);
        self.q * (self.alpha * cosine - self.d() * remainder + self.stress * x)
    }
}

impl BelowMinusOne {
    fn d(&self) -> f64 {
        self.moment + self.stress * self.q
    }

    fn k(&self) -> f64 {
        (1.0 - self.q).sqrt()
    }

    /// `tanh k / k`.
    pub(super) fn t(&self) -> f64 {
        self.k().tanh() / self.k()
    }

    /// `q/k²`: `u' = (q/k²) (aθ_A + c - d cosh ky / cosh k)`.
    ///
    /// In `u' = q (φ + c)` the stress would cancel near N = -1, where it dominates φ; here it is cancelled
    /// analytically.
    fn factor(&self) -> f64 {
        self.q / (1.0 - self.q)
    }

    fn slope_squared(&self) -> f64 {
        let (e, d, t) = (self.moment + self.stress, self.d(), self.t());
        let sech = self.k().cosh().recip();
        self.factor().powi(2) * (e * e - 2.0 * e * d * t + 0.5 * d * d * (sech * sech + t))
    }

    /// `cosh ky / cosh k` for y = 1 - x.
    fn cosh_ratio(&self, x: f64) -> f64 {
        let k = self.k();
        ((-k * x).exp() + (-k * (2.0 - x)).exp()) / (1.0 + (-2.0 * k).exp())
    }

    /// `sinh ky / (k cosh k)` for y = 1 - x.
    fn sinh_ratio(&self, x: f64) -> f64 {
        let k = self.k();
        ((-k * x).exp() - (-k * (2.0 - x)).exp()) / (k * (1.0 + (-2.0 * k).exp()))
    }

    fn u(&self, x: f64) -> f64 {
        self.factor() * ((self.moment + self.stress) * x - self.d() * (self.sinh_ratio(0.0) - self.sinh_ratio(x)))
    }

    fn u_x(&self, x: f64) -> f64 {
        self.factor() * (self.moment + self.stress - self.d() * self.cosh_ratio(x))
    }

    fn phi(&self, x: f64) -> f64 {
        self.d() * (1.0 - self.cosh_ratio(x)) / (1.0 - self.q)
    }

    fn phi_x(&self, x: f64) -> f64 {
        self.d() * self.sinh_ratio(x)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_shape_returns_its_axial_force() {
        let wave = Shape::AboveMinusOne(AboveMinusOne { q: 0.25, alpha: 1.0, stress: 0.0, moment: 0.0 });
        let below = Shape::BelowMinusOne(BelowMinusOne { q: -0.5, stress: 0.0, moment: 0.0 });
        assert_eq!([Shape::Line { slope: 2.0 }, wave, below].map(|shape| shape.n_value()), [-1.0, 3.0, -3.0]);
        assert_eq!(Shape::Line { slope: 3.0 }.slope_squared(), 9.0);
    }
}
