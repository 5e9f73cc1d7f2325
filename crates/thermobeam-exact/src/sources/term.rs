//! A term of the loads: integrals over space, and their coefficient in time.

use crate::solution::Factors;

/// A space vector of one equation (0: u, 1: φ, 2: θ) and its time coefficient.
#[derive(Debug, Clone)]
pub(super) struct Term {
    pub(super) equation: usize,
    /// The field (0: u, 1: φ, 2: θ) and the index of the product in it.
    pub(super) product: [usize; 2],
    pub(super) weights: TimeWeights,
    pub(super) vector: Vec<f64>,
}

/// The time coefficient `a T + b T' + c T''` of a product X(x) T(t).
#[derive(Debug, Clone, Copy)]
pub(super) struct TimeWeights {
    /// a, of T.
    pub(super) value: f64,
    /// b, of T'.
    pub(super) rate: f64,
    /// c, of T''.
    pub(super) acceleration: f64,
    /// Whether N is added to a: in the term with u_xx of (1.1).
    pub(super) has_axial_force: bool,
}

impl TimeWeights {
    const ZERO: Self = Self {
        value: 0.0,
        rate: 0.0,
        acceleration: 0.0,
        has_axial_force: false,
    };

    /// T.
    pub(super) const VALUE: Self = Self {
        value: 1.0,
        ..Self::ZERO
    };

    /// T'.
    pub(super) const RATE: Self = Self {
        rate: 1.0,
        ..Self::ZERO
    };

    /// T''.
    pub(super) const ACCELERATION: Self = Self {
        acceleration: 1.0,
        ..Self::ZERO
    };
}

impl Term {
    /// The time coefficient, at the time of the factors.
    pub(super) fn coefficient(&self, factors: &Factors, n_value: f64) -> f64 {
        let TimeWeights {
            value,
            rate,
            acceleration,
            has_axial_force,
        } = self.weights;
        let [field, j] = self.product;
        let of_field = [&factors.u, &factors.phi, &factors.theta][field];
        let value = if has_axial_force {
            value + n_value
        } else {
            value
        };
        value * of_field.value[j]
            + rate * of_field.rate[j]
            + acceleration * of_field.acceleration[j]
    }

    /// Whether this is `a θ_x` in the equation of the rotation.
    pub(super) fn is_thermal_moment(&self) -> bool {
        self.equation == 1 && self.product[0] == 2
    }
}
