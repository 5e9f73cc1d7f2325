//! Time factors: T, T', T'' and their like at one time, exact or as a scheme sees them.

use crate::solution::{Manufactured, Product};

/// Time factors of one field: value, first and second derivative for each product.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FieldFactors {
    /// T_j.
    pub value: Vec<f64>,
    /// T_j'.
    pub rate: Vec<f64>,
    /// T_j''.
    pub acceleration: Vec<f64>,
}

/// Time factors of all three fields at one time.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Factors {
    /// Of the displacement.
    pub u: FieldFactors,
    /// Of the rotation.
    pub phi: FieldFactors,
    /// Of the physical temperature.
    pub theta: FieldFactors,
}

impl FieldFactors {
    fn at(&mut self, products: &[Product], t: f64) {
        self.value.clear();
        self.rate.clear();
        self.acceleration.clear();
        for product in products {
            let [value, rate, acceleration] = product.t.derivatives(t);
            self.value.push(value);
            self.rate.push(rate);
            self.acceleration.push(acceleration);
        }
    }

    /// What the scheme sees of a sequence of values: mean, difference quotient, and the inertia of `scheme.inertia`.
    ///
    /// `old` and `new` hold the values at the ends of the step and the sequence's own velocities v, of which the new one
    /// is `inertia * V + (1 - inertia) v_old` with `V = (T_n - T_{n-1})/dt`: V itself for the paper's scheme, `2 V -
    /// v_old` for the midpoint rule. `(V - v_old) inertia/dt` is then the acceleration.
    fn of_step(&mut self, old: &FieldFactors, new: &mut FieldFactors, inertia: f64, dt: f64) {
        self.value.clear();
        self.rate.clear();
        self.acceleration.clear();
        for j in 0..old.value.len() {
            let velocity = (new.value[j] - old.value[j]) / dt;
            self.value.push(0.5 * (old.value[j] + new.value[j]));
            self.rate.push(velocity);
            self.acceleration.push(inertia / dt * (velocity - old.rate[j]));
            new.rate[j] = inertia * velocity + (1.0 - inertia) * old.rate[j];
        }
    }
}

impl Factors {
    /// The exact factors at time t.
    pub fn at(&mut self, exact: &Manufactured, t: f64) {
        self.u.at(&exact.u, t);
        self.phi.at(&exact.phi, t);
        self.theta.at(&exact.theta, t);
    }

    /// The factors that the scheme's time-discrete operator sees between `old` and `new`; sets the velocities of `new`
    /// to those of the sequence.
    pub fn of_step(&mut self, old: &Factors, new: &mut Factors, inertia: f64, dt: f64) {
        self.u.of_step(&old.u, &mut new.u, inertia, dt);
        self.phi.of_step(&old.phi, &mut new.phi, inertia, dt);
        self.theta.of_step(&old.theta, &mut new.theta, inertia, dt);
    }
}
