//! A term of the loads: integrals over space, and their coefficient in time.

use super::vectors::Vectors;
use crate::solution::Factors;
use thermobeam::parameters::Beam;

/// A space vector of one equation (0: u, 1: φ, 2: θ) and its time coefficient.
#[derive(Debug, Clone)]
pub(super) struct SourceTerm {
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

impl SourceTerm {
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

/// The terms of all products of a solution.
pub(super) struct ProductTerms<'b> {
    beam: &'b Beam,
    pub(super) list: Vec<SourceTerm>,
}

impl<'b> ProductTerms<'b> {
    pub(super) fn new(beam: &'b Beam) -> Self {
        Self { beam, list: vec![] }
    }

    fn add(
        &mut self,
        equation: usize,
        product: [usize; 2],
        weights: TimeWeights,
        vector: Vec<f64>,
    ) {
        self.list.push(SourceTerm {
            equation,
            product,
            weights,
            vector,
        });
    }

    /// T + ζ T'.
    fn damped(&self) -> TimeWeights {
        TimeWeights {
            rate: self.beam.zeta,
            ..TimeWeights::VALUE
        }
    }

    /// Inertia and tension of product j of u, and its shear in the equation of the rotation.
    pub(super) fn add_displacement(&mut self, j: usize, [in_u, in_phi, _]: &[Vectors; 3]) {
        // (1 + N) T + ζ T'.
        let tension = TimeWeights {
            has_axial_force: true,
            ..self.damped()
        };
        self.add(0, [0, j], TimeWeights::ACCELERATION, in_u.value.clone());
        self.add(0, [0, j], tension, in_u.curvature.clone());
        self.add(1, [0, j], self.damped(), scaled(-1.0, &in_phi.slope));
    }

    /// Bending, shear and inertia of product k of φ, its heat, and its shear in the equation of u.
    pub(super) fn add_rotation(&mut self, k: usize, [in_u, in_phi, in_theta]: &[Vectors; 3]) {
        let curvatures = in_phi.curvature.iter().zip(&in_phi.value);
        let turned = curvatures.map(|(curvature, value)| curvature + value);
        let heat = scaled(self.beam.a, &in_theta.slope);
        self.add(1, [1, k], self.damped(), turned.collect());
        self.add(1, [1, k], TimeWeights::ACCELERATION, in_phi.value.clone());
        self.add(2, [1, k], TimeWeights::RATE, heat);
        self.add(0, [1, k], self.damped(), in_u.slope.clone());
    }

    /// Product l of θ: its moment, conduction and rate. The test functions of θ vanish at both
    /// ends, so there is no boundary load.
    pub(super) fn add_temperature(&mut self, l: usize, [_, in_phi, in_theta]: &[Vectors; 3]) {
        let moment = scaled(self.beam.a, &in_phi.slope);
        self.add(1, [2, l], TimeWeights::VALUE, moment);
        self.add(2, [2, l], TimeWeights::VALUE, in_theta.curvature.clone());
        self.add(2, [2, l], TimeWeights::RATE, in_theta.value.clone());
    }
}

fn scaled(factor: f64, vector: &[f64]) -> Vec<f64> {
    vector.iter().map(|value| factor * value).collect()
}
