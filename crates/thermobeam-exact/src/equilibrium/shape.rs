//! The bent beam in closed form for given axial force N and stress c.

use crate::stumpff::{c0, c1, c2, c3, c5};

/// A solution of the static equations in the interior and at x = 1; notation as in [`super`], y =
/// 1 - x.
///
/// * N > -1: `φ = α c_0(Xy²) - d y² c_2(Xy²)` with X = q - 1. Entire in q: N = 0 and the buckling
///   values are no special cases.
/// * N < -1: `φ = d (1 - cosh ky / cosh k) / k²` with k² = 1 - q > 1. It satisfies φ(0) = 0. Only
///   ratios of hyperbolic functions occur, so k may be arbitrarily large.
/// * q = ∞, N = -1: the line `u = -aθ_A x` with φ = 0 and c = 0. Without load it is the straight
///   beam, for every N.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shape {
    /// `q = 1 / (1 + N)`.
    pub(super) q: f64,
    /// α = φ(1), only for N > -1.
    pub(super) alpha: f64,
    /// The stress `c = (1 + N) u' - φ`, constant in x.
    pub(super) stress: f64,
    /// The thermal moment aθ_A.
    pub(super) moment: f64,
}

impl Shape {
    /// The line with `u' = -moment`.
    pub(super) fn line(moment: f64) -> Self {
        Self {
            q: f64::INFINITY,
            alpha: 0.0,
            stress: 0.0,
            moment,
        }
    }

    pub(super) fn is_line(&self) -> bool {
        self.q.is_infinite()
    }

    /// Axial force N of the shape; -1 for a line.
    pub(super) fn n_value(&self) -> f64 {
        1.0 / self.q - 1.0
    }

    /// `d = aθ_A + cq`, the constant right-hand side of φ'' + Xφ + d = 0.
    fn d(&self) -> f64 {
        self.moment + self.stress * self.q
    }

    /// X.
    fn x(&self) -> f64 {
        self.q - 1.0
    }

    /// `q/k²`: for N < -1, `u' = (q/k²) (aθ_A + c - d cosh ky / cosh k)`.
    ///
    /// In `u' = q (φ + c)` the stress would cancel near N = -1, where it dominates φ; here it is
    /// cancelled analytically.
    fn factor(&self) -> f64 {
        self.q / (1.0 - self.q)
    }

    /// `‖u'‖² = q² ∫ (αC - dW + c)² dy` with C = c_0(Xy²), W = y² c_2(Xy²).
    ///
    /// By cosh² = (1 + cosh 2·)/2 the products integrate to Stumpff functions of X and 4X.
    pub(super) fn slope_squared(&self) -> f64 {
        if self.is_line() {
            return self.moment * self.moment;
        }
        let x = self.x();
        let alpha = self.alpha;
        let c = self.stress;
        let d = self.d();
        if self.q > 0.0 {
            let cc = 0.5 * (1.0 + c1(4.0 * x));
            let cw = 2.0 * c3(4.0 * x) - c3(x);
            let ww = 8.0 * c5(4.0 * x) - 2.0 * c5(x);
            let squares = alpha * alpha * cc + d * d * ww + c * c;
            let products = alpha * c * c1(x) - alpha * d * cw - d * c * c3(x);
            self.q * self.q * (squares + 2.0 * products)
        } else {
            let (e, t) = (self.moment + c, tanh_ratio(self.q));
            let sech = k(self.q).cosh().recip();
            self.factor().powi(2) * (e * e - 2.0 * e * d * t + 0.5 * d * d * (sech * sech + t))
        }
    }

    /// `u = q ∫₀ˣ (φ + c)` at x in [0, 1].
    pub fn u(&self, x: f64) -> f64 {
        if self.is_line() {
            return (0.0 - self.moment) * x;
        }
        if self.q > 0.0 {
            let y = 1.0 - x;
            let argument = self.x() * y * y;
            let cosine = c1(self.x()) - y * c1(argument);
            let remainder = c3(self.x()) - y.powi(3) * c3(argument);
            self.q * (self.alpha * cosine - self.d() * remainder + self.stress * x)
        } else {
            let sines = sinh_ratio(self.q, 0.0) - sinh_ratio(self.q, x);
            self.factor() * ((self.moment + self.stress) * x - self.d() * sines)
        }
    }

    /// u' at x.
    pub fn u_x(&self, x: f64) -> f64 {
        if self.is_line() {
            0.0 - self.moment
        } else if self.q > 0.0 {
            self.q * (self.phi(x) + self.stress)
        } else {
            self.factor() * (self.moment + self.stress - self.d() * cosh_ratio(self.q, x))
        }
    }

    /// φ at x.
    pub fn phi(&self, x: f64) -> f64 {
        if self.is_line() {
            return 0.0;
        }
        if self.q > 0.0 {
            let y = 1.0 - x;
            let argument = self.x() * y * y;
            self.alpha * c0(argument) - self.d() * y * y * c2(argument)
        } else {
            self.d() * (1.0 - cosh_ratio(self.q, x)) / (1.0 - self.q)
        }
    }

    /// φ' at x.
    pub fn phi_x(&self, x: f64) -> f64 {
        if self.is_line() {
            return 0.0;
        }
        if self.q > 0.0 {
            let y = 1.0 - x;
            (self.alpha * self.x() + self.d()) * y * c1(self.x() * y * y)
        } else {
            self.d() * sinh_ratio(self.q, x)
        }
    }
}

fn k(q: f64) -> f64 {
    (1.0 - q).sqrt()
}

/// `tanh k / k`.
pub(super) fn tanh_ratio(q: f64) -> f64 {
    k(q).tanh() / k(q)
}

/// `cosh ky / cosh k` for y = 1 - x.
fn cosh_ratio(q: f64, x: f64) -> f64 {
    let k = k(q);
    ((-k * x).exp() + (-k * (2.0 - x)).exp()) / (1.0 + (-2.0 * k).exp())
}

/// `sinh ky / (k cosh k)` for y = 1 - x.
fn sinh_ratio(q: f64, x: f64) -> f64 {
    let k = k(q);
    ((-k * x).exp() - (-k * (2.0 - x)).exp()) / (k * (1.0 + (-2.0 * k).exp()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_has_the_square_of_its_slope() {
        assert_eq!(Shape::line(-3.0).slope_squared(), 9.0);
    }
}
